"""What a data set will cost before it is made: processor time, and room on the disk."""

import shutil
from collections import Counter
from dataclasses import dataclass
from pathlib import Path

from mmweaver.core.errors import InputError
from mmweaver.core.radar_config import RadarConfig
from mmweaver.datasets.dataset_plan import DatasetPlan
from mmweaver.datasets.dataset_store import is_done

# of benchmarks/dataset.py, for 20 frames; other machines differ
USUAL_FRAMES = 20
SEQUENCE_S = {False: 0.33, True: 0.13}  # of a core; with signals, with geometry alone
ROOM_S = {False: 0.9, True: 1.1}
ROOM_BYTES = {False: 1.0e6, True: 1.27e6}
LOOK_BYTES = 21_500.0  # of a sequence without its signal
PACKED = 0.93  # of a signal's float16 bytes, after compression


@dataclass(frozen=True, kw_only=True)
class DatasetCost:
    """Of what is not there yet; `splits` of the whole plan."""

    rooms: int
    sequences: int
    core_s: float
    disk_bytes: float
    splits: dict[str, int]

    def told(self, workers: int) -> str:
        """In one line."""
        splits = ", ".join(f"{name} {count:,}" for name, count in self.splits.items())
        wall = _time(self.core_s / max(workers, 1))
        return (
            f"{self.sequences:,} sequences in {self.rooms} rooms to make ({splits} in all): about"
            f" {_time(self.core_s)} of one core, {wall} with {workers} {'worker' if workers == 1 else 'workers'},"
            f" {_size(self.disk_bytes)} on the disk"
        )


def cost_of(plan: DatasetPlan, config: RadarConfig, folder: Path) -> DatasetCost:
    """What the rooms of a plan cost that a folder lacks; a few motions will find no place and cost less."""
    rooms = plan.rooms()
    missing = [room for room in rooms if not is_done(folder, room.name)]
    count = sum(len(room.sequences) for room in missing)
    light, share = plan.geometry_only, plan.num_frames / USUAL_FRAMES
    signal = PACKED * plan.num_frames * config.num_range_bins * config.num_loops * config.num_antennas * 4.0
    splits = Counter(sequence.split for room in rooms for sequence in room.sequences)
    return DatasetCost(
        rooms=len(missing), sequences=count,
        core_s=len(missing) * ROOM_S[light] + count * share * SEQUENCE_S[light],
        disk_bytes=len(missing) * ROOM_BYTES[light] + count * (LOOK_BYTES * share if light else signal),
        splits=dict(splits.most_common()),
    )  # fmt: skip


def check_for_space(cost: DatasetCost, folder: Path) -> None:
    """Raises InputError where the disk has no room for it."""
    there = next(path for path in (folder.absolute(), *folder.absolute().parents) if path.exists())
    free = float(shutil.disk_usage(there).free)
    if cost.disk_bytes > free:
        raise InputError(
            f"the data set needs about {_size(cost.disk_bytes)} and {there} has {_size(free)} left; take another disk,"
            " fewer --sequences or --layouts, or --geometry-only"
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
