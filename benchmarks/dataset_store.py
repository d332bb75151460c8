"""A store of a million small sequences, really written: files, bytes and CPU of writing and reading.

Geometry only, two frames each. What a room holds is computed once and written for each of the 1,000 rooms with its own
plan, since placing a million motions takes a day: the store, its plan, checksums and reader are what is measured.
Writes results/benchmark/dataset_store.json in the project's results schema and prints the same as a table.
"""

import os
import sys
import tempfile
import time
from dataclasses import replace
from pathlib import Path
from unittest import mock

os.environ.setdefault("OMP_NUM_THREADS", "1")
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

from measuring import report, results_folder

from mmweaver.core.boards import AWR1843
from mmweaver.datasets import room_generation
from mmweaver.datasets.dataset_plan import DatasetPlan
from mmweaver.datasets.dataset_store import read_rooms
from mmweaver.datasets.generate_rooms import generate_dataset

PLAN = DatasetPlan(
    kinds=("office", "living_room", "dining_room", "gym"), lightings=("day",), num_layouts=250, sequences_a_room=1000,
    num_frames=2, geometry_only=True, packed=True,
)  # fmt: skip


def main() -> int:
    out = results_folder(__doc__)
    first = PLAN.room(0)
    few = replace(first, sequences=first.sequences[:20])
    made = room_generation.generate_room(few, AWR1843, PLAN.num_frames, geometry_only=True)

    def repeated(spec, *_, **__):
        """The content of the first room under the specifications of another."""
        sequences = tuple(
            replace(made.sequences[number % len(made.sequences)], spec=one) for number, one in enumerate(spec.sequences)
        )
        return replace(made, spec=spec, sequences=sequences, refused=())

    patched = mock.patch.object(room_generation, "generate_room", repeated)
    with tempfile.TemporaryDirectory() as folder, patched:
        start = time.process_time()
        reports = generate_dataset(Path(folder) / "set", PLAN, AWR1843)
        written_s = time.process_time() - start
        files = [file for file in Path(folder).rglob("*") if file.is_file()]
        start = time.process_time()
        one = read_rooms(Path(folder) / "set")[-1]
        cube = one.cube(len(one.text) - 1)
        values = {
            "sequences": float(sum(report.num_sequences for report in reports)),
            "files": float(len(files)),
            "disk_gb": sum(file.stat().st_size for file in files) / 1e9,
            "writing_cpu_s": written_s,
            "reading_all_rooms_cpu_s": time.process_time() - start,
        }
        assert cube.values.shape[0] == PLAN.num_frames
    report(out, "dataset_store", {"name": "1,000 rooms of 1,000 sequences of 2 frames, geometry only"}, values, {})
    return 0


if __name__ == "__main__":
    sys.exit(main())
