"""Rows of the recipe `paper`: floors beside it, energy, learning curve."""

import json
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from mmweaver.core.boards import AWR1843
from studies.network.room_cache import RoomCache
from studies.paper import paper_scores
from studies.paper.paper_scores import learning_curve, rows_of, scores_of
from studies.scores.cube_scores import all_zeros
from tests.cubes import point_cube


def _case(seed: int) -> Any:
    cube = point_cube(AWR1843, num_frames=3, seed=seed)
    room = SimpleNamespace(kind="office", layout=seed, folder=Path(f"office_{seed}"), cube=lambda index: cube)
    return SimpleNamespace(room=room, index=0, truth=cube)


def test_a_method_that_writes_zeros_scores_as_zeros_do(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    for name in ("_scores", "_name"):  # cases of a test are not quite cases
        monkeypatch.setattr(paper_scores, name, getattr(paper_scores, name).__wrapped__)
    cases, cache = [_case(seed) for seed in (0, 1)], RoomCache(tmp_path, {})
    scores = scores_of.__wrapped__(  # type: ignore
        cases, lambda case: all_zeros(case.room.cube(0)), cache
    )
    rows = rows_of.__wrapped__(scores, cases)  # type: ignore
    assert [row["method"] for row in rows] == ["zeros", "static_mean", "paper"]
    zeros, _, paper = (row["metrics"] for row in rows)
    assert paper["cssim"]["value"] == zeros["cssim"]["value"] > 0.8
    assert paper["nmse_db"]["value"] == pytest.approx(0.0)
    assert paper["energy_db"]["value"] < -100
    assert rows[0]["num_rooms"] == 2
    assert np.isfinite([metric["value"] for metric in paper.values()]).all()
    again = scores_of.__wrapped__(cases, None, cache)  # type: ignore
    assert np.array_equal(again["paper"]["cssim"], scores["paper"]["cssim"])  # nothing is done twice


def test_a_learning_curve_is_the_validations_of_the_log(tmp_path: Path):
    assert learning_curve(tmp_path) == []
    lines = [{"step": 20, "validation": None}, {"step": 40, "validation": 0.5, "figures": {"nmse": 1.0}}]
    (tmp_path / "log.jsonl").write_text("\n".join(json.dumps(line) for line in lines))
    assert learning_curve(tmp_path) == [{"step": 40, "loss": 0.5, "nmse": 1.0}]
