"""python -m studies run paper: items are shown, one by name, and only measured where a study is known."""

import pytest

from mmweaver.core.errors import InputError
from studies.run import run_named


def test_an_item_is_shown_with_its_command(capsys: pytest.CaptureFixture[str]):
    assert run_named("paper", ["--table", "har_generic"]) == []
    shown = capsys.readouterr().out
    assert "87.2 %" in shown
    assert "python -m studies run activity_gain" in shown
    assert "RF-Diffusion" not in shown


def test_what_no_study_measures_is_refused():
    with pytest.raises(InputError, match="--measure needs"):
        run_named("paper", ["--table", "hupr", "--measure"])
