import numpy as np
import pytest

from studies.fields.codecs import CODECS, SCORES, codec_row, errors_db
from studies.fields.field_signals import StudySignal
from tests.compression.echoes import crowd


def test_a_row_has_its_bytes_scores_and_floors():
    signal = StudySignal(name="crowd", origin="simulated", cube=crowd(), realization=None)
    row = codec_row(CODECS["top_klt"](), signal, 4000)
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
