"""Signals of one side of a comparison: files and folders of any kind, records, or folders of these."""

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from mmweaver.compression.mmw_codec import read_cube
from mmweaver.core.errors import InputError
from mmweaver.core.records import AdcCube, PointCloud, RadarCube
from mmweaver.core.safe_files.regular_files import check_exists
from mmweaver.evaluation.signal_evidence import ComparedSignal
from mmweaver.io.capture_std import is_capture
from mmweaver.io.stored_result import ADC_FILE, StoredResult, read_result
from mmweaver.io.stream_folder import is_stream
from mmweaver.recordings.read_recording import RawReading, read_recording
from mmweaver.signal.cube import radar_cube

CUBE, POINTS = "radar.npz", "points.npz"
RAW_SUFFIXES = (".bin", ".npy", ".npz", ".pcap", ".pcapng")
MAX_RECORDINGS, MAX_BYTES = 200, 4_000_000_000


def signals_of(source: Any, reading: RawReading, name: str) -> list[ComparedSignal]:
    """Loads the signals of one side.

    Args:
        source: A file, a folder, a record with a cube, samples, or a sequence of these.
        reading: How to read raw samples.
        name: Name of the side.

    Returns:
        One signal, or several for a folder or sequence.

    Raises:
        InputError: If the source is anything else or cannot be read.
    """
    if isinstance(source, ComparedSignal):
        return [source]
    if isinstance(source, str | Path):
        return _path_signals(Path(source), reading)
    if isinstance(source, AdcCube):
        return [ComparedSignal(name=name, cube=radar_cube(source), adc=source)]
    if isinstance(source, RadarCube):
        return [ComparedSignal(name=name, cube=source)]
    if isinstance(getattr(source, "cube", None), RadarCube):  # Generation, Recording, ProcessedRecording, StoredResult
        return [_record_signal(source, name)]
    if isinstance(source, Sequence) and source:
        return [one for part in source for one in signals_of(part, reading, name)]
    raise InputError(f"{name} cannot be compared: give a path, a RadarCube, an AdcCube or what Weaver.generate gives")


def _record_signal(source: Any, name: str) -> ComparedSignal:
    if isinstance(source, StoredResult):
        return _result_signal(source)
    adc, points, meta = (getattr(source, part, None) for part in ("adc", "points", "meta"))
    is_seen_by_cube = getattr(source, "compensate_tdm", True)
    return ComparedSignal(
        name=name,
        cube=source.cube,
        adc=adc if isinstance(adc, AdcCube) and is_seen_by_cube else None,
        points=points if isinstance(points, PointCloud) else None,
        meta=meta if isinstance(meta, dict) else {},
    )


def _path_signals(path: Path, reading: RawReading) -> list[ComparedSignal]:
    check_exists(path, "a recording, a result folder or a .mmw file")
    if not path.is_dir() or _is_signal(path) or reading.layout == "hupr":
        return [_path_signal(path, reading)]
    inside = sorted(one for one in path.iterdir() if _is_signal(one))
    inside += sorted(path.glob("*/adc_data.bin")) if not inside else []
    if not inside:
        return [_path_signal(path, reading)]  # its reader reports what is missing
    if len(inside) > MAX_RECORDINGS:
        raise InputError(f"{path} holds {len(inside)} recordings; compare at most {MAX_RECORDINGS} at a time")
    signals: list[ComparedSignal] = []
    size = 0
    for one in inside:
        signals.append(_path_signal(one, reading))
        size += signals[-1].cube.values.nbytes + (0 if signals[-1].adc is None else signals[-1].adc.samples.nbytes)
        if size > MAX_BYTES:
            raise InputError(
                f"{path}: the first {len(signals)} of {len(inside)} recordings fill the memory; give fewer"
            )
    return signals


def _is_signal(path: Path) -> bool:
    """Whether a path is a single signal."""
    if path.is_dir():
        return (path / CUBE).is_file() or is_stream(path) or is_capture(path)
    return path.suffix.lower() in (".mmw", *RAW_SUFFIXES) and path.name not in (POINTS, "pose.npz", "analysis.npz")


def _path_signal(path: Path, reading: RawReading) -> ComparedSignal:
    if path.suffix.lower() == ".mmwl":
        raise InputError(f"{path} holds packed raw samples; unpack it first: mmweaver decompress FILE -o ADC_DATA.bin")
    if path.suffix.lower() == ".mmw":
        return ComparedSignal(name=path.name, cube=read_cube(path))
    if path.is_dir() and (path / CUBE).is_file() and (path / POINTS).is_file():
        return _result_signal(read_result(path))
    return replace(_record_signal(read_recording(path, **vars(_reading_of(path, reading))), path.name), name=path.name)


def _reading_of(path: Path, reading: RawReading) -> RawReading:
    """Options that apply to this path; the others belong to the other side."""
    if path.is_dir() and _is_signal(path):
        return RawReading()
    if path.suffix == ".npz":
        return RawReading(radar=None if path.with_name("radar.json").is_file() else reading.radar)
    return reading if path.is_dir() or path.suffix == ".npy" else replace(reading, axes=None, layout=None)


def _result_signal(result: StoredResult) -> ComparedSignal:
    """Signal of a result folder, with raw samples in the scale of its cube if there are any."""
    adc = None
    if (result.folder / ADC_FILE).is_file():
        counts = (result.meta.get("adc_data_bin") or {}).get("counts_per_unit")
        scale = result.cube.scale / counts if isinstance(counts, int | float) and counts > 0 else np.nan
        adc = replace(result.adc, scale=float(scale))
    return ComparedSignal(
        name=result.folder.name or str(result.folder), cube=result.cube, adc=adc, points=result.points, meta=result.meta
    )
