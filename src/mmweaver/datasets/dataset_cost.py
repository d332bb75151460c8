"""Estimated cost of a data set before generation: CPU time and disk space."""

import shutil
from dataclasses import dataclass
from pathlib import Path

from mmweaver.core.errors import InputError
from mmweaver.core.radar_config import RadarConfig
from mmweaver.datasets.dataset_folder import finished
from mmweaver.datasets.dataset_plan import DatasetPlan

# measured by benchmarks/dataset.py for 20 frames; other machines differ
BENCHMARK_FRAMES = 20
SEQUENCE_S = {False: 0.37, True: 0.09}  # CPU seconds; with signals, with geometry only
ROOM_S = {False: 1.2, True: 1.6}
ROOM_BYTES = {False: 1.02e6, True: 1.32e6}
GEOMETRY_BYTES = 21_700.0  # per sequence without signal
ROOT_FILES, FILES_A_ROOM = 14, {False: 32, True: 50}  # without --packed
SIGNAL_SHARE = 1.02  # stored bytes / float16 bytes of a signal: not compressible, plus joints


@dataclass(frozen=True, kw_only=True)
class DatasetCost:
    """Cost of the missing rooms; `splits` counts the sequences of the entire plan."""

    rooms: int
    sequences: int
    core_s: float
    disk_bytes: float
    files: int
    splits: dict[str, int]

    def summary(self, workers: int) -> str:
        """Formats the cost in one line.

        Args:
            workers: Number of parallel processes.

        Returns:
            Text with CPU time, wall time and disk space.
        """
        splits = ", ".join(f"{name} {count:,}" for name, count in self.splits.items())
        wall = _time(self.core_s / max(workers, 1))
        return (
            f"{self.sequences:,} sequences in {self.rooms:,} rooms to generate ({splits} in total): about"
            f" {_time(self.core_s)} of one core, {wall} with {workers} {'worker' if workers == 1 else 'workers'},"
            f" {_size(self.disk_bytes)} on disk in some {self.files:,} files"
        )


def estimate_cost(plan: DatasetPlan, config: RadarConfig, folder: Path, numbers: range | None = None) -> DatasetCost:
    """Estimates the cost of the rooms that are missing; an upper bound, since some motions fit nowhere.

    Args:
        plan: The plan.
        config: The radar.
        folder: The data set.
        numbers: Numbers of the rooms that this machine makes. Default: all.

    Returns:
        The cost.

    Raises:
        InputError: If the plan leaks (`DatasetPlan.check`).
    """
    names = map(plan.name_of, range(plan.num_rooms) if numbers is None else numbers)
    missing = (plan.num_rooms if numbers is None else len(numbers)) - len(finished(folder, names))
    count = missing * plan.sequences_a_room
    geometry_only, share = plan.geometry_only, plan.num_frames / BENCHMARK_FRAMES
    signal = SIGNAL_SHARE * plan.num_frames * config.num_range_bins * config.num_loops * config.num_antennas * 4.0
    each = GEOMETRY_BYTES * share if geometry_only else signal
    return DatasetCost(
        rooms=missing,
        sequences=count,
        core_s=missing * ROOM_S[geometry_only] + count * share * SEQUENCE_S[geometry_only],
        disk_bytes=missing * ROOM_BYTES[geometry_only] + count * each,
        files=ROOT_FILES + missing * (1 if plan.packed else FILES_A_ROOM[geometry_only]),
        splits=dict(sorted(plan.check().items(), key=lambda one: -one[1])),
    )


def check_for_space(cost: DatasetCost, folder: Path) -> None:
    """Checks the free disk space.

    Args:
        cost: Estimated cost.
        folder: Where the data set will be written.

    Raises:
        InputError: If it is insufficient.
    """
    there = next(path for path in (folder.absolute(), *folder.absolute().parents) if path.exists())
    free = float(shutil.disk_usage(there).free)
    if cost.disk_bytes > free:
        raise InputError(
            f"the data set needs about {_size(cost.disk_bytes)} and {there} has {_size(free)} free; use another disk,"
            " fewer sequences, or none of their signals (--geometry-only; of a labelled set --iq none)"
        )


def _time(seconds: float) -> str:
    for unit, size in (("days", 86_400.0), ("hours", 3600.0), ("minutes", 60.0)):
        if seconds >= 1.5 * size:
            return f"{seconds / size:.1f} {unit}"
    return f"{seconds:.0f} s"


def _size(num: float) -> str:
    for unit, size in (("TB", 1e12), ("GB", 1e9)):
        if num >= size:
            return f"{num / size:.1f} {unit}"
    return f"{num / 1e6:.0f} MB"
