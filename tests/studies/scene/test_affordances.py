import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from mmweaver.scene.procedural.arrangement import KINDS
from mmweaver.scene.procedural.procedural_room import make_room
from studies.manifest import StudyRun
from studies.scene.affordances import DEVELOP, REPORT, Tally, measure, measure_scene


def test_kinds_are_split():
    assert set(DEVELOP) | set(REPORT) == set(KINDS)
    assert not set(DEVELOP) & set(REPORT)


def test_the_true_scene_of_a_room_has_no_errors():
    room, tally = make_room("lab"), Tally()
    scene = room.scene()
    measure_scene(room, scene, tally)
    assert tally.floor_error_m == [pytest.approx(0)]
    assert all(tally.seats)
    assert tally.false_seats
    assert not any(tally.false_seats)
    assert max(tally.facing_error_rad, default=0.0) == pytest.approx(0, abs=1e-6)
    measure_scene(room, replace(scene, floor_z_m=scene.floor_z_m + 0.1, seats=()), tally)
    assert tally.floor_error_m[1] == pytest.approx(0.1)
    assert tally.seats.count(False) == len(tally.seats) / 2


@pytest.mark.slow  # a whole study; what it counts: the test above
def test_a_run_writes_shares(tmp_path: Path):
    (path,) = measure(StudyRun("affordances", tmp_path), [], 1, ("depth",))
    rows = json.loads(path.read_text())["rows"]
    assert [row["dataset"]["name"] for row in rows] == ["procedural, report", "procedural, develop"]
    for row in rows:
        shares = [metric["value"] for metric in row["metrics"].values() if metric["unit"].startswith("share")]
        assert shares
        assert all(0 <= share <= 1 for share in shares)
        assert np.isfinite(row["metrics"]["floor_error_median_m"]["value"])
