"""Does a simulation with a calibrated board show the features of the recording that an ideal and a typical one miss?

Each recording is halved: the board is calibrated on the first half (loops, or frames where there are several), and the
features of `mmweaver compare` are taken from the second half and from empty rooms simulated with the ideal board, with
typical ones and with the calibrated one. A frame's first chirp is in the first half alone, so it is fitted and compared
on the same frame.

python -m studies run board_match --data <recordings>
"""

import argparse
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from mmweaver.calibration.calibrate import calibrate
from mmweaver.comparison.compare_signals import measure_all
from mmweaver.comparison.signal_evidence import ComparedSignal, SignalEvidence
from mmweaver.core.board import Board
from mmweaver.core.boards import IDEAL_BOARD, typical_board
from mmweaver.core.presets import BGT60
from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.records import AdcCube
from mmweaver.dsp.cube import radar_cube
from mmweaver.formats.raw_npy import read_adc_npy
from studies.fields.field_signals import sample_scene, simulator_of
from studies.manifest import StudyRun
from studies.physics.signal_statistics import recorded_hall, recorded_people
from studies.result_rows import complete_rows
from studies.study import Reads

EXPERIMENT = "board_match"
TYPICAL_BOARDS = 5
MOST_FRAMES = 32
OF_FIRST_CHIRP = ("first_chirp_amplitude", "first_chirp_phase")
FEATURES = (
    "if_last_of_band", "if_near_band", "leakage_level", "leakage_spread", "leakage_skirt", *OF_FIRST_CHIRP, "drift",
    "plane_wave_share", "antenna_spread",
)  # fmt: skip


def recorded_breath(data: Path) -> AdcCube:
    """A person who breathes, 256 short frames of real samples."""
    path = data / "radar" / "bgt60_breathing" / "breathing_radar_uint16_256x3x8x64.npy"
    return read_adc_npy(path, BGT60, "frame,rx,loop,sample")


RECORDINGS: dict[str, Callable[[Path], AdcCube]] = {
    "openradar_two_people": recorded_people, "iwr6843_dca1000": recorded_hall, "bgt60_breathing": recorded_breath,
}  # fmt: skip


def halves(adc: AdcCube) -> tuple[AdcCube, AdcCube]:
    """The first and the second half of the frames, or of the loops of one frame."""
    frames, loops = adc.samples.shape[:2]
    if frames > 1:
        return replace(adc, samples=adc.samples[: frames // 2]), replace(adc, samples=adc.samples[frames // 2 :])
    config = replace(adc.config, num_loops=loops // 2)
    first, second = adc.samples[:, : loops // 2], adc.samples[:, loops - loops // 2 :]
    return replace(adc, samples=first, config=config), replace(adc, samples=second, config=config)


def features_of(adc: AdcCube) -> dict[str, float]:
    """Median over the frames of each feature that the samples show."""
    evidence = SignalEvidence(ComparedSignal(name="", cube=radar_cube(adc), adc=adc))
    found = {name: value for name, value in measure_all(evidence).items() if name in FEATURES}
    return {name: float(one.spread.median) for name, one in found.items() if one.spread is not None}


def whole_band(config: RadarConfig) -> RadarConfig:
    """The radar with all its range bins, and a transmit power where the recording's is unknown."""
    return replace(
        config, first_range_bin=0, num_range_bins=config.num_unambiguous_range_bins, tx_power_dbm=12.0
    )  # fmt: skip


def simulated(like: AdcCube, board: Board, seed: int) -> AdcCube:
    """The empty sample room with its clutter, recorded by a radar and board of this kind."""
    frames = min(len(like.samples), MOST_FRAMES)
    simulator = simulator_of(sample_scene(), whole_band(like.config), board=board)
    return simulator.run((), num_frames=frames, seed=seed).adc


def rows_of(name: str, adc: AdcCube) -> list[dict[str, Any]]:
    """A row for each feature that the recording shows."""
    first, second = halves(adc)
    board, whole = calibrate(first, name=name).board, calibrate(adc, name=name).board
    board = replace(
        board, first_chirp_amplitude_percent=whole.first_chirp_amplitude_percent,
        first_chirp_phase_mrad=whole.first_chirp_phase_mrad,
    )  # fmt: skip
    recorded = {
        **features_of(second),
        **{key: value for key, value in features_of(adc).items() if key in OF_FIRST_CHIRP},
    }
    ideal, own = (features_of(simulated(adc, one, 0)) for one in (IDEAL_BOARD, board))
    boards = [typical_board(whole_band(adc.config), number) for number in range(TYPICAL_BOARDS)]
    typical = [features_of(simulated(adc, one, number)) for number, one in enumerate(boards)]
    rows = []
    for feature in (feature for feature in FEATURES if feature in recorded and feature in own):
        middle = [one[feature] for one in typical if feature in one]
        baseline = {"ideal": ideal.get(feature), "typical": float(np.median(middle)) if middle else None}
        rows.append(_row(name, feature, own[feature], baseline, recorded[feature], adc))
    return rows


def _row(
    name: str, feature: str, value: float, baseline: dict[str, float | None], recorded: float, adc: AdcCube
) -> dict[str, Any]:
    from mmweaver.comparison.compare_signals import FEATURES as COMPARED

    what = next(one for one in COMPARED if one.name == feature)
    metric = {
        "value": round(value, 3), "unit": what.unit, "definition": what.definition, "version": 1,
        "baseline": {key: round(one, 3) for key, one in baseline.items() if one is not None},
        "oracle": {"recorded": round(recorded, 3)},
    }  # fmt: skip
    split = "calibrated on the first half, compared with the second"
    if feature in OF_FIRST_CHIRP:
        split = "calibrated on and compared with the same frame"
    return {
        "dataset": {"name": name, "origin": "recorded", "split": split, "shape": list(adc.samples.shape)},
        "method": feature, "title": f"{what.title}, {what.unit}", "n": 1, "seeds": [0], "metrics": {"feature": metric},
    }  # fmt: skip


UNKNOWN = {
    "dataset.sha256": "recordings are hashed in the manifest", "seconds": "see the manifest: all rows together",
}  # fmt: skip


def add_options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "--data", type=Path, action=Reads, required=True, help="folder of recordings (with radar/ in it)"
    )


def run_study(options: argparse.Namespace, run: StudyRun) -> None:
    """One file a recording."""
    for name, read in RECORDINGS.items():
        rows = rows_of(name, read(options.data))
        config = {"room": "bundled sample, nobody in it", "typical": f"median of {TYPICAL_BOARDS} boards"}
        run.write(EXPERIMENT, name, config=config, rows=complete_rows(rows, unknown=UNKNOWN))
        for row in rows:
            print(name, row["method"], row["metrics"]["feature"], flush=True)
