"""Is any codec ahead of .mmw on recordings that it was not developed with, cut in many ways?

python -m studies run codec_cuts --data <recordings>        (needs the extra `codecs`)
"""

import argparse
import json
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from mmweaver.core.boards import BGT60
from mmweaver.core.errors import InputError
from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.records import AdcCube
from mmweaver.core.registry import Registry
from mmweaver.io.dca1000 import read_bin
from mmweaver.io.mmwave_studio import read_mmwave_studio
from mmweaver.io.raw_npy import read_adc_npy
from mmweaver.signal.cube import radar_cube
from studies.fields.codecs import CODECS, codec_row
from studies.fields.field_signals import SIGNALS, StudySignal, two_people_radar
from studies.manifest import StudyRun
from studies.result_rows import complete_rows
from studies.study import Reads

SIZES = (2504, 10018, 40072)
USUAL = ("mmw", "klt_context", "top_klt", "svd", "sperr", "jpegxl", "jpeg2000", "blosc2")
Source = Callable[[Path], AdcCube]


def person_breathing(data: Path) -> AdcCube:
    """256 frames of 8 chirps, 3 antennas, 64 real samples."""
    path = data / "radar" / "bgt60_breathing" / "breathing_radar_uint16_256x3x8x64.npy"
    return read_adc_npy(path, BGT60, "frame,rx,loop,sample")


def office(data: Path) -> AdcCube:
    """One frame of 85 loops, 12 antennas, 512 samples: a static room. The first 128 range bins."""
    folder = data / "radar" / "iwr6843_dca1000"
    radar = read_mmwave_studio(folder / "mmwaveDevice.mmwave.json")
    return read_bin(folder / "adc_data_example.bin", replace(radar, first_range_bin=0, num_range_bins=128))


def two_people(data: Path) -> AdcCube:
    """One frame of 128 loops, 8 antennas, 128 samples: two people moving."""
    path = data / "radar" / "openradar_two_people" / "adc_frame_loops_vrx_samples_c64.npy"
    return read_adc_npy(path, two_people_radar(num_loops=128), "loop,vrx,sample")


def cut(
    adc: AdcCube, *, frames: int, loops: int, antennas: int | None = None, ranges: int | None = None, real: bool = False
) -> AdcCube:
    """The first `frames` frames of `loops` loops each, of the first `antennas` receivers and `ranges` bins.

    Loops of all frames count on: a recording of 8 loops has four times as many frames of two. `real`: the real parts.
    """
    config, samples = adc.config, adc.samples
    samples = samples.reshape(-1, *samples.shape[2:])
    samples = samples[: frames * loops].reshape(frames, loops, *samples.shape[1:])
    changes: dict[str, Any] = {"num_loops": loops, "frame_period_s": loops * config.loop_period_s * 1.25}
    if antennas is not None:
        samples = samples[:, :, :1, :antennas]
        changes |= {"tx_position_m": config.tx_position_m[:1], "rx_position_m": config.rx_position_m[:antennas],
                    "tx_order": (0,)}  # fmt: skip
    if ranges is not None:
        changes |= {"num_range_bins": ranges}
    if real:
        samples = np.real(samples).astype(np.complex64)
        changes |= {"complex_samples": False}
    changed: RadarConfig = replace(config, **changes)
    return AdcCube(samples=np.ascontiguousarray(samples), config=changed, scale=float("nan"))


def _signal(name: str, source: Source, **how: Any) -> Callable[[Path | None], StudySignal]:
    def make(data: Path | None) -> StudySignal:
        if data is None:
            raise InputError("this signal is a recording; say where the recordings lie with --data")
        cube = radar_cube(cut(source(data), **how))
        return StudySignal(name=name, origin="recorded", cube=cube, realization=None)

    return make


_WAYS: tuple[tuple[str, Source, dict[str, int | bool]], ...] = (
    ("breathing, 256 frames", person_breathing, {"frames": 256, "loops": 8}),
    ("breathing, 400 frames of 2 loops", person_breathing, {"frames": 400, "loops": 2}),
    ("breathing, 1000 frames of 1 loop", person_breathing, {"frames": 1000, "loops": 1}),
    ("breathing, 1000 frames of 1 loop and 1 antenna", person_breathing, {"frames": 1000, "loops": 1, "antennas": 1}),
    ("breathing, 1 antenna", person_breathing, {"frames": 256, "loops": 8, "antennas": 1}),
    ("breathing, 1 frame", person_breathing, {"frames": 1, "loops": 256}),
    ("office, 1 frame", office, {"frames": 1, "loops": 85}),
    ("office, 4 frames", office, {"frames": 4, "loops": 21, "ranges": 64}),
    ("office, 1 frame, 1 antenna", office, {"frames": 1, "loops": 85, "antennas": 1}),
    ("office, 42 frames of 2 loops", office, {"frames": 42, "loops": 2, "ranges": 64}),
    ("office, 85 frames of 1 loop", office, {"frames": 85, "loops": 1, "ranges": 64}),
    ("office, real samples", office, {"frames": 1, "loops": 85, "real": True}),
    ("two people, 1 frame", two_people, {"frames": 1, "loops": 128}),
    ("two people, 4 frames", two_people, {"frames": 4, "loops": 32}),
    ("two people, 1 frame, 1 antenna", two_people, {"frames": 1, "loops": 128, "antennas": 1}),
    ("two people, 16 frames, 1 antenna", two_people, {"frames": 16, "loops": 8, "antennas": 1}),
    ("two people, 64 frames of 2 loops", two_people, {"frames": 64, "loops": 2}),
    ("two people, 128 frames of 1 loop", two_people, {"frames": 128, "loops": 1}),
)  # fmt: skip
CUTS: Registry[Callable[[Path | None], StudySignal]] = Registry(
    "cut", [(name, _signal(name, source, **how)) for name, source, how in _WAYS]
)


def add_options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "--data", type=Path, action=Reads, required=True, help="folder of recordings (with radar/ in it)"
    )
    parser.add_argument("--codecs", nargs="*", default=list(USUAL))
    parser.add_argument("--signals", nargs="*", default=[*CUTS, *SIGNALS])


def run_study(options: argparse.Namespace, run: StudyRun) -> None:
    """Every codec on every cut, and on the cubes of study `codecs`; one file a codec."""
    for name in options.codecs:
        rows = []
        for signal_name in options.signals:
            signal = (CUTS if signal_name in CUTS else SIGNALS)[signal_name](options.data)
            # codecs without loss take any size: files larger than the cube say nothing
            sizes = [size for size in SIZES if size < signal.cube.values.nbytes]
            rows += [codec_row(CODECS[name](), signal, size) for size in sizes]
            print(json.dumps({"codec": name, "signal": signal.name}), flush=True)
        run.write("codec_cuts", name, config={"sizes": list(SIZES)}, rows=complete_rows(rows))
