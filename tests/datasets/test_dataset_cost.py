"""Estimated cost of a data set: existing rooms cost nothing; a disk that is too small is refused."""

from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import pytest

from mmweaver.core.boards import AWR1843
from mmweaver.core.errors import InputError
from mmweaver.datasets.dataset_cost import check_for_space, estimate_cost
from mmweaver.datasets.dataset_plan import DatasetPlan
from tests.training.tiny_data import TINY_PLAN

PLAN = DatasetPlan(kinds=("office", "gym"), lightings=("day",), num_layouts=3, sequences_a_room=10)


def test_existing_rooms_cost_nothing(tmp_path: Path):
    whole = estimate_cost(PLAN, AWR1843, tmp_path)
    assert (whole.rooms, whole.sequences) == (6, 60)
    assert sum(whole.splits.values()) == 60
    (tmp_path / "office_001").mkdir()
    (tmp_path / "office_001" / "zarr.json").touch()
    rest = estimate_cost(PLAN, AWR1843, tmp_path)
    assert (rest.rooms, rest.sequences) == (5, 50)
    assert rest.disk_bytes < whole.disk_bytes


def test_time_and_disk_grow_with_frames_and_shrink_without_signals(tmp_path: Path):
    own = estimate_cost(PLAN, AWR1843, tmp_path)
    longer = estimate_cost(replace(PLAN, num_frames=40), AWR1843, tmp_path)
    light = estimate_cost(replace(PLAN, geometry_only=True), AWR1843, tmp_path)
    assert longer.disk_bytes > 1.8 * own.disk_bytes
    assert longer.core_s > 1.5 * own.core_s
    assert light.disk_bytes < 0.1 * own.disk_bytes
    assert "of one core" in own.summary(1)
    assert "with 4 workers" in own.summary(4)


@pytest.mark.parametrize("geometry_only", [False, True])
def test_a_disk_that_holds_what_is_written_is_enough_and_a_smaller_one_is_refused(
    geometry_only: bool, tmp_path: Path, request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch
):
    """The estimate that is compared with the disk, within a factor of 1.5 of bytes that were measured."""
    made = request.getfixturevalue("tiny_geometry" if geometry_only else "tiny_signals")
    measured = sum(file.stat().st_size for file in made.rglob("*") if file.is_file())
    cost = estimate_cost(replace(TINY_PLAN, geometry_only=geometry_only), AWR1843, tmp_path)
    monkeypatch.setattr("shutil.disk_usage", lambda path: SimpleNamespace(free=1.5 * measured))
    check_for_space(cost, tmp_path)
    monkeypatch.setattr("shutil.disk_usage", lambda path: SimpleNamespace(free=0.9 * measured))
    with pytest.raises(InputError, match="free"):
        check_for_space(cost, tmp_path)
