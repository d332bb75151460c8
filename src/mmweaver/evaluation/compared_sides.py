"""Signals of one side of a comparison: files and folders of any kind, records, or folders of these.

Power maps of two signals on common range, velocity and azimuth axes and in the same decibels.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from mmweaver.compression.mmw_codec import read_cube
from mmweaver.core.errors import InputError
from mmweaver.core.records import AdcCube, PointCloud, RadarCube
from mmweaver.core.safe_files.regular_files import check_exists
from mmweaver.core.virtual_array import azimuth_row
from mmweaver.evaluation.signal_evidence import ComparedSignal, SignalEvidence
from mmweaver.io.capture_std import is_capture
from mmweaver.io.stored_result import ADC_FILE, StoredResult, read_result
from mmweaver.io.stream_folder import is_stream
from mmweaver.recordings.read_recording import RawReading, read_recording
from mmweaver.signal.cube import radar_cube, remove_static
from mmweaver.signal.spectra import azimuth_axis_rad, range_azimuth_power, range_doppler_power

MIN_BINS = 4
AZIMUTHS = 61
MIN_DB = -300.0


@dataclass(frozen=True, kw_only=True)
class CommonAxes:
    """Cell centres of the common maps."""

    range_m: np.ndarray
    radial_velocity_mps: np.ndarray | None  # None if a signal has too few loops per frame
    azimuth_rad: np.ndarray | None  # None if a signal has fewer than three antennas in its azimuth row
    reference: str  # meaning of 0 dB

    @property
    def azimuth_deg(self) -> np.ndarray | None:
        """Azimuths in degrees, or None."""
        return None if self.azimuth_rad is None else np.degrees(self.azimuth_rad)


def shown_m(signal: ComparedSignal) -> np.ndarray:
    """Ranges that a signal covers: the entire band of its samples, or the window of its cube.

    Args:
        signal: The signal.

    Returns:
        Ranges of the bins in metres, (range,).
    """
    if signal.adc is None:
        return signal.cube.grid.range_m
    config = signal.adc.config
    return np.arange(config.num_unambiguous_range_bins) * config.range_resolution_m


def common_window_m(
    names: Sequence[str], ranges: Sequence[np.ndarray], wanted_m: tuple[float, float] | None = None
) -> tuple[float, float]:
    """Determines the range window that all signals cover.

    Args:
        names: Names of the signals, for error messages.
        ranges: Ranges of each signal's bins in metres, (bin,).
        wanted_m: Further limits (near, far) in metres. Default: none.

    Returns:
        (near, far) in metres.

    Raises:
        InputError: If it contains fewer than four bins.
    """
    if wanted_m is not None:
        names, ranges = [*names, "--range"], [*ranges, np.linspace(*wanted_m, 2)]
    near, far = max(float(one[0]) for one in ranges), min(float(one[-1]) for one in ranges)
    shown = ranges if wanted_m is None else ranges[:-1]
    step_m = max(float(np.diff(one[:2])[0]) if len(one) > 1 else np.inf for one in shown)
    if far - near < (MIN_BINS - 1) * step_m:
        apart = {[one[0] for one in ranges].index(near), [one[-1] for one in ranges].index(far)}
        spans = [f"{names[at]} shows {ranges[at][0]:.2f} to {ranges[at][-1]:.2f} m" for at in sorted(apart)]
        raise InputError(f"nothing to compare: {', '.join(spans)}; give recordings of common ranges")
    return near, far


def common_axes(a: SignalEvidence, b: SignalEvidence) -> CommonAxes:
    """Determines axes with the coarser resolution of two signals over the window that both cover.

    Args:
        a: First signal.
        b: Second signal.

    Returns:
        The axes and the reference of decibels.

    Raises:
        InputError: If there is no common range.
    """
    configs = [one.cube.config for one in (a, b)]
    near, far = common_window_m((a.signal.name, b.signal.name), (a.range_m, b.range_m))
    near, far = max(near, a.window_m[0]), min(far, a.window_m[1])
    step_m = max(one.range_resolution_m for one in configs)
    velocity = None
    if a.has_doppler and b.has_doppler:
        step = max(one.velocity_resolution_mps for one in configs)
        ends = [
            one.cube.grid.radial_velocity_mps[[0, -1]] / step for one in (a, b)
        ]  # a Doppler axis lacks the positive end
        first, last = max(one[0] for one in ends), min(one[1] for one in ends)
        velocity = np.arange(np.ceil(first - 1e-6), np.floor(last + 1e-6) + 1) * step
    rows = [azimuth_row(one.cube.grid.antenna_position_m, one.cube.grid.wavelength_m) for one in (a, b)]
    azimuth = azimuth_axis_rad(AZIMUTHS) if min(len(row) for row in rows) >= 3 else None
    if all(np.isfinite(one.cube.scale) for one in (a, b)):
        reference = "dBm at the receiver's port"
    elif a.has_doppler and b.has_doppler:
        reference = "dB over the noise of a sample"
    else:
        reference = "dB relative to the strongest static range"
    return CommonAxes(
        range_m=np.arange(near, far + 1e-9, step_m),
        radial_velocity_mps=velocity,
        azimuth_rad=azimuth,
        reference=reference,
    )


def maps_of(evidence: SignalEvidence, axes: CommonAxes) -> dict[str, np.ndarray]:
    """Computes the power maps of one signal on common axes; energy is preserved in resampling.

    Args:
        evidence: The signal.
        axes: The axes.

    Returns:
        Maps in dB by name: "range_profile" (range,), static power, "range_doppler" (range, doppler) and "range_azimuth"
        (range, azimuth), averaged over frames; and "moving" (range, frame) with the mean chirp removed. Maps without
        axes are missing.
    """
    cube, range_m = evidence.cube, evidence.range_m
    power = {"range_profile": _resampled(evidence.still_power.mean(axis=0), range_m, axes.range_m)}
    if axes.radial_velocity_mps is not None:
        own = _resampled(evidence.power.mean(axis=0), range_m, axes.range_m)
        power["range_doppler"] = _resampled(own.T, cube.grid.radial_velocity_mps, axes.radial_velocity_mps).T
        over_time = range_doppler_power(remove_static(cube)).sum(axis=2)
        power["moving"] = _resampled(over_time.T, range_m, axes.range_m)
    if axes.azimuth_rad is not None:
        own = range_azimuth_power(cube, axes.azimuth_rad).mean(axis=0)
        power["range_azimuth"] = _resampled(own, range_m, axes.range_m)
    gain, lowest = _gain(evidence, axes), 10 ** (MIN_DB / 10)
    return {name: 10 * np.log10(np.maximum(one * gain, lowest)) for name, one in power.items()}


def _gain(evidence: SignalEvidence, axes: CommonAxes) -> float:
    """Factor that scales power such that 1 is 0 dB of the common reference."""
    if axes.reference.startswith("dBm"):
        return evidence.cube.scale**2
    if "noise" in axes.reference:
        return evidence.noise_share / max(float(np.median(evidence.noise)), 1e-300)
    return 1 / max(float(evidence.still_power.mean(axis=0)[evidence.in_window].max()), 1e-300)


def _resampled(power: np.ndarray, own: np.ndarray, wanted: np.ndarray) -> np.ndarray:
    """Resamples power along the first axis from cells at `own` to cells at `wanted`; sums are preserved."""
    from_edges, to_edges = _edges(own), _edges(wanted)
    summed = np.concatenate([np.zeros((1, *power.shape[1:])), np.cumsum(power, axis=0)])
    place = np.interp(to_edges, from_edges, np.arange(len(from_edges)))
    low = np.minimum(place.astype(int), len(own) - 1)
    share = (place - low).reshape(-1, *[1] * (power.ndim - 1))
    at_edges = summed[low] + share * (summed[low + 1] - summed[low])
    return np.diff(at_edges, axis=0)


def _edges(centre: np.ndarray) -> np.ndarray:
    half = (centre[1] - centre[0]) / 2
    return np.append(centre - half, centre[-1] + half)


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
