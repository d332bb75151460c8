"""What `mmweaver dataset` costs: sequences a second for 1, 2 and 4 workers, processor seconds, bytes.

CPU-seconds are what counts on a machine that others use; sequences a second are of whole runs, start-up included.
Writes results/benchmark/dataset.json in the project's results schema and prints the same as a table.
"""

import os
import resource
import sys
import tempfile
import time
from dataclasses import replace
from pathlib import Path

os.environ.setdefault("OMP_NUM_THREADS", "1")
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

from measuring import report, results_folder

from mmweaver.core.boards import AWR1843
from mmweaver.datasets.dataset_plan import DatasetPlan
from mmweaver.datasets.generate_rooms import generate_dataset

KINDS = ("office", "living_room", "kitchen", "gym")
PLAN = DatasetPlan(kinds=KINDS, lightings=("day", "lamps"), num_layouts=1, sequences_a_room=24)
MANY, A_ROOM, DAY_S = 10_000_000, 120, 86_400.0


def spent_s() -> float:
    """Processor seconds of this process and of its children that ended."""
    usages = [resource.getrusage(who) for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)]
    return sum(usage.ru_utime + usage.ru_stime for usage in usages)


def run(plan: DatasetPlan, workers: int) -> tuple[float, float, int, int]:
    """CPU seconds, wall seconds, sequences, and bytes on disk."""
    with tempfile.TemporaryDirectory() as folder:
        out = Path(folder) / "set"
        cpu, wall = spent_s(), time.perf_counter()
        made = sum(room.num_sequences for room in generate_dataset(out, plan, AWR1843, workers=workers))
        cpu, wall = spent_s() - cpu, time.perf_counter() - wall
        return cpu, wall, made, sum(file.stat().st_size for file in out.rglob("*") if file.is_file())


def costs(plan: DatasetPlan, name: str) -> dict[str, float]:
    """Of one process: what a room takes and what each sequence adds, from many and few sequences a room."""
    run(replace(plan, sequences_a_room=1, num_layouts=1, kinds=KINDS[:1]), 1)  # loads what is loaded once
    cpu_few, _, few, bytes_few = run(replace(plan, sequences_a_room=1), 1)
    cpu, wall, made, size = run(plan, 1)
    cpu_each, bytes_each = (cpu - cpu_few) / (made - few), (size - bytes_few) / (made - few)
    cpu_room, bytes_room = cpu_few / len(KINDS) - cpu_each, bytes_few / len(KINDS) - bytes_each
    return {
        f"{name}_cpu_s_a_sequence": cpu_each,
        f"{name}_cpu_s_a_room": cpu_room,
        f"{name}_kb_a_sequence": bytes_each / 1e3,
        f"{name}_kb_a_room": bytes_room / 1e3,
        f"{name}_sequences_a_s_1_workers": made / wall,
        f"{name}_10_million_core_days": MANY * (cpu_each + cpu_room / A_ROOM) / DAY_S,
        f"{name}_10_million_tb": MANY * (bytes_each + bytes_room / A_ROOM) / 1e12,
    }


def _load() -> float:
    """Processes that want a processor, over the last minute: those of others make the workers' seconds longer."""
    return os.getloadavg()[0]


def main() -> int:
    out, load = results_folder(__doc__), _load()
    values = {**costs(PLAN, "signals"), **costs(replace(PLAN, geometry_only=True), "geometry_only")}
    for workers in (2, 4):
        cpu, wall, made, _ = run(PLAN, workers)
        values[f"signals_sequences_a_s_{workers}_workers"] = made / wall
        values[f"signals_cpu_s_a_sequence_in_all_{workers}_workers"] = cpu / made
    dataset = {"name": f"{len(KINDS)} rooms, {PLAN.sequences_a_room} sequences of 20 frames each"}
    config = {"sequences_a_room_of_10_million": A_ROOM, "load_before": round(load, 1), "load_after": round(_load(), 1)}
    report(out, "dataset", dataset, values, config)
    return 0


if __name__ == "__main__":
    sys.exit(main())
