"""What it costs a training that files of its data set are checked: CPU-seconds to read an epoch, with and without.

The first epoch of a process hashes every file, later ones look at inode, size and time. Writes
results/benchmark/checksums.json in the project's results schema and prints the same as a table.
"""

import os
import sys
import tempfile
from dataclasses import replace
from pathlib import Path
from unittest import mock

os.environ.setdefault("OMP_NUM_THREADS", "1")
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import numpy as np
from measuring import least_cpu_seconds, report, results_folder

from mmweaver.core import checksums
from mmweaver.core.boards import AWR1843
from mmweaver.datasets.checked_folder import CheckedFolder
from mmweaver.datasets.dataset_plan import DatasetPlan
from mmweaver.datasets.dataset_store import read_rooms
from mmweaver.datasets.generate_rooms import generate_dataset

PLAN = DatasetPlan(kinds=("office", "kitchen"), lightings=("day", "lamps"), num_layouts=1, sequences_a_room=24)
FRAMES = np.arange(4)  # of a sequence, that a step of the training looks at


def read_epoch(data: Path) -> None:
    """Reads what a training reads of each sequence: some frames of its signal, or the paths that it is made of."""
    for room in read_rooms(data):
        for index in range(len(room.seed)):
            (room.cube if room.geometry is None else room.body_paths)(index, FRAMES)


def costs(data: Path, name: str) -> dict[str, float]:
    """CPU-seconds of one process and a data set."""

    def first() -> None:
        with mock.patch.dict(checksums._checked, clear=True):
            read_epoch(data)

    def unchecked() -> None:
        with mock.patch.object(CheckedFolder, "check"):
            read_epoch(data)

    epochs = {"first_epoch": first, "later_epoch": lambda: read_epoch(data), "unchecked_epoch": unchecked}
    size = sum(file.stat().st_size for file in data.rglob("*") if file.is_file())
    return {
        **{f"{name}_{epoch}_cpu_s": least_cpu_seconds(read, 3) for epoch, read in epochs.items()},
        f"{name}_mb": size / 1e6,
    }


def main() -> int:
    out, load = results_folder(__doc__), os.getloadavg()[0]
    values: dict[str, float] = {}
    with tempfile.TemporaryDirectory() as folder:
        for name, plan in (("signals", PLAN), ("geometry_only", replace(PLAN, geometry_only=True))):
            generate_dataset(Path(folder) / name, plan, AWR1843)
            values |= costs(Path(folder) / name, name)
    dataset = {"name": f"{len(PLAN.kinds)} rooms, {PLAN.sequences_a_room} sequences of {PLAN.num_frames} frames each"}
    config = {"frames_of_a_sequence": len(FRAMES), "load_before": round(load, 1)}
    report(out, "checksums", dataset, values, config)
    return 0


if __name__ == "__main__":
    sys.exit(main())
