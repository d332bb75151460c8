import json
from pathlib import Path

import numpy as np
import pytest

from studies.fields.codecs import CODECS, SCORES, codec_row, errors_db, in_order, kept_rows
from studies.fields.field_signals import StudySignal
from tests.fields.echoes import crowd


def test_a_row_has_its_bytes_scores_and_floors():
    signal = StudySignal(name="crowd", origin="simulated", cube=crowd(), realization=None)
    row = codec_row(CODECS["top_cells"](), signal, 4000)
    assert row["size"]["bytes"] <= 4000
    assert row["seconds"]["decode"] is not None
    for name in SCORES:
        metric = row["metrics"][name]
        assert metric["value"] < metric["baseline"]["zeros"] == 0.0
        assert metric["unit"] == "dB"


def test_impossible_sizes_have_no_score():
    signal = StudySignal(name="crowd", origin="simulated", cube=crowd(), realization=None)
    row = codec_row(CODECS["mmw"](), signal, 30)
    assert row["size"]["bytes"] is None
    assert row["metrics"]["nmse_db"]["value"] is None


def test_errors_are_those_of_the_cells():
    cube = crowd()
    assert errors_db(np.zeros_like(cube.values), cube)["nmse_db"] == pytest.approx(0.0)
    assert errors_db(0.9 * cube.values, cube)["nmse_moving_db"] == pytest.approx(-20.0, abs=0.01)


def test_rows_of_other_signals_are_kept_with_their_commit(tmp_path: Path):
    rows = [{"dataset": {"name": "walking"}}, {"dataset": {"name": "waving"}, "commit": "old"}]
    (tmp_path / "a.json").write_text(json.dumps({"provenance": {"commit": "first"}, "rows": rows}))
    kept = kept_rows(tmp_path / "a.json", ["sitting"])
    assert [row["commit"] for row in kept] == ["first", "old"]
    assert kept_rows(tmp_path / "a.json", ["walking", "waving"]) == []
    assert kept_rows(tmp_path / "none.json", []) == []
    assert [row["dataset"]["name"] for row in in_order(kept[::-1])] == ["walking", "waving"]
