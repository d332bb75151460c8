"""How far are generated clouds of an IWR6843 from recorded ones: SNR by range, points and extent per frame?

    python -m studies run cloud_quantiles examples/tasks/iwr6843.toml --people 8

The task's CFAR thresholds become those of the recordings, 10 dB in both directions. RECORDED are medians of recordings
of one such board in one room, one person at a time: figures alone, the recordings are not public.
"""

import argparse
import time
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from mmweaver.core.records import PointCloud
from mmweaver.recognition.generated_sequences import SequenceRecipe, generate_sequence
from mmweaver.recognition.point_recordings import PointRecording
from mmweaver.recognition.task_file import RecognitionTask, read_task
from mmweaver.signal.firmware_cfar import counts_per_db
from studies.manifest import StudyRun, content_of
from studies.schema import metric
from studies.study import Reads

MOVING_MPS, THRESHOLD_DB = 0.01, 10.0
RANGES_M = ((1, 2), (2, 3), (3, 4), (4, 6), (6, 9))
EXTENTS = {"span in range": "range_m", "span across": "x_m", "span in height": "z_m"}
RECORDED: dict[str, dict[str, float]] = {
    "walk": {
        "SNR 1-2 m": 25, "SNR 2-3 m": 20, "SNR 3-4 m": 15, "SNR 4-6 m": 13, "SNR 6-9 m": 10, "moving points": 5.2,
        "static points": 13.2, "share beyond 6 m": 0.12,
        "span in range": 2.6, "span across": 1.6, "span in height": 2.2,
    },
    "run": {
        "SNR 1-2 m": 25, "SNR 2-3 m": 20, "SNR 3-4 m": 16, "SNR 4-6 m": 14, "SNR 6-9 m": 10, "moving points": 6.1,
        "static points": 13.1, "share beyond 6 m": 0.12,
        "span in range": 3.4, "span across": 2.3, "span in height": 3.1,
    },
    "empty": {"moving points": 0.0, "static points": 13.7},
}  # fmt: skip


def with_thresholds(task: RecognitionTask, threshold_db: float) -> RecognitionTask:
    """The task with this CFAR threshold in range and in Doppler."""
    counts = round(threshold_db * counts_per_db(task.firmware.device, task.radar.num_antennas))
    range_cfar, doppler_cfar = (
        None if cfar is None else replace(cfar, threshold=counts)
        for cfar in (task.firmware.range_cfar, task.firmware.doppler_cfar)
    )
    return replace(task, firmware=replace(task.firmware, range_cfar=range_cfar, doppler_cfar=doppler_cfar))


def quantiles(recordings: list[PointRecording]) -> dict[str, float]:
    """Medians as in RECORDED; nan where there are fewer than ten points or frames."""
    frames = sum(one.num_frames for one in recordings)
    moving = [one.cloud.select(np.abs(one.cloud.radial_velocity_mps) > MOVING_MPS) for one in recordings]
    range_m, snr_db = (np.concatenate([getattr(cloud, name) for cloud in moving]) for name in ("range_m", "snr_db"))
    found = {f"SNR {low}-{high} m": _median(snr_db[(range_m >= low) & (range_m < high)]) for low, high in RANGES_M}
    points = sum(len(one.cloud.frame) for one in recordings)
    found |= {"moving points": len(range_m) / frames, "static points": (points - len(range_m)) / frames}
    found["share beyond 6 m"] = float((range_m > 6).mean()) if len(range_m) else np.nan
    for name, axis in EXTENTS.items():
        found[name] = _median(np.concatenate([_extents(cloud, axis) for cloud in moving]))
    return found


def _extents(cloud: PointCloud, axis: str) -> np.ndarray:
    """Extent of the points of each frame that has any, (frame,)."""
    first = np.flatnonzero(np.diff(cloud.frame, prepend=-1))
    values = getattr(cloud, axis)
    if not len(first):
        return np.zeros(0)
    return np.maximum.reduceat(values, first) - np.minimum.reduceat(values, first)


def _median(values: np.ndarray) -> float:
    return float(np.median(values)) if len(values) >= 10 else float("nan")


def add_options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("task", type=Path, action=Reads)
    parser.add_argument("--people", type=int, default=8)


def run_study(options: argparse.Namespace, run: StudyRun) -> None:
    recipe = SequenceRecipe.of(with_thresholds(read_task(options.task), THRESHOLD_DB))
    rows: list[dict[str, Any]] = []
    data = {"sha256": content_of(options.task)["sha256"], "recordings": options.people}
    for label, recorded in RECORDED.items():
        began = time.process_time()
        made = quantiles([generate_sequence(recipe, label, index) for index in range(options.people)])
        print(label, {name: (value, round(made[name], 2)) for name, value in recorded.items()}, flush=True)
        rows.append(
            {
                "dataset": {"name": f"IWR6843, {label}", **data}, "n": options.people, "seeds": [0],
                "seconds": {"generating": round(time.process_time() - began, 1)},
                "metrics": {
                    name.replace(" ", "_"): metric(
                        made[name], "dB" if "SNR" in name else "as named", f"median {name} of generated clouds",
                        baseline={"recorded": value},
                    )
                    for name, value in recorded.items()
                    if np.isfinite(made[name])
                },
            }
        )  # fmt: skip
    run.write("cloud_quantiles", recipe.task.clouds, config={"people": options.people}, rows=rows)
