"""A data set of two rooms for tests of training."""

from dataclasses import replace
from pathlib import Path

from mmweaver.core.boards import AWR1843
from mmweaver.datasets.dataset_plan import DatasetPlan
from mmweaver.datasets.generate_rooms import generate_dataset

# plan version 3: the sequences on which the tolerances of these tests were measured
TINY_PLAN = DatasetPlan(
    kinds=("office", "dining_room"), lightings=("day",), num_layouts=1, sequences_a_room=3, num_frames=4,
    geometry_only=True, plan_version=3,
)  # fmt: skip


def tiny_data(folder: Path, *, geometry_only: bool) -> Path:
    """An office to train on and a dining room to validate on; an existing one is reused."""
    generate_dataset(folder, replace(TINY_PLAN, geometry_only=geometry_only), AWR1843)
    return folder


class StoppedError(Exception):
    """What a test interrupts training with."""
