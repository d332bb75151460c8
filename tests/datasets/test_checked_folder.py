"""Damage of a data set is noticed by whoever reads it, and repaired to the bit by the command that is named."""

import random
import shutil
from collections import Counter
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from mmweaver.core.errors import InputError
from mmweaver.core.presets import AWR1843
from mmweaver.datasets.dataset_store import read_rooms
from mmweaver.datasets.generate_rooms import generate_dataset
from studies.trust.damaged_sets import damage, read_all
from tests.training.tiny_data import TINY_PLAN


@pytest.mark.parametrize("geometry_only", [False, True])
def test_no_damage_is_accepted(geometry_only: bool, request: pytest.FixtureRequest, tmp_path: Path):
    """A deleted file, a flipped bit and a cut file, anywhere in the set; more of them: studies/trust."""
    whole = request.getfixturevalue("tiny_geometry" if geometry_only else "tiny_signals")
    shutil.copytree(whole, tmp_path / "set")
    rng = random.Random(5)
    outcomes = Counter(damage(tmp_path / "set", rng, ["deleted", "bit", "cut"][k % 3]).outcome for k in range(3))
    assert outcomes == {"refused": 3}


@pytest.mark.slow  # test_no_damage_is_accepted finds it
def test_a_damaged_room_is_made_anew(tiny_geometry: Path, tmp_path: Path):
    data = tmp_path / "set"
    shutil.copytree(tiny_geometry, data)
    before = read_all(data)
    file = data / "office_000" / "joints_m" / "c" / "0" / "0" / "0" / "0"
    file.write_bytes(file.read_bytes()[:-1] + b"\x00")
    with pytest.raises(InputError, match=r"joints_m.* is not as it was written.*mmweaver dataset .* --repair"):
        read_rooms(data)
    shutil.rmtree(data / "dining_room_000" / "geometry" / "room" / "face" / "c")
    (data / "plan.json").write_text((data / "plan.json").read_text().replace('"seed": 0', '"seed": 1'))
    (data / "range" / "zarr.json").unlink()
    reports = generate_dataset(data, replace(TINY_PLAN, geometry_only=True), AWR1843, repair=True)
    assert sorted(report.name for report in reports) == ["dining_room_000", "office_000"]
    assert read_all(data) == before
    assert not list(data.glob(".*"))


def test_a_set_without_one_of_its_rooms_is_refused(tiny_signals: Path, tmp_path: Path):
    data = tmp_path / "set"
    shutil.copytree(tiny_signals, data)
    shutil.rmtree(data / "office_000")
    with pytest.raises(InputError, match=r"office_000.*mmweaver dataset"):
        read_rooms(data)


def test_damage_after_the_room_was_opened_is_noticed(tiny_signals: Path, tmp_path: Path):
    """Training reads signals again and again, long after it has opened the set."""
    data = tmp_path / "set"
    shutil.copytree(tiny_signals, data)
    room = read_rooms(data)[0]
    assert np.isfinite(room.cube(0).values).all()
    chunk = room.folder / "iq" / "c" / "0" / "0" / "0" / "0" / "0" / "0"
    chunk.unlink()
    with pytest.raises(InputError, match="is missing"):
        room.cube(0)
