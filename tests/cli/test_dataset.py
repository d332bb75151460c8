"""mmweaver dataset on the command line."""

import json
from pathlib import Path

import pytest

from mmweaver.cli.main import main

pytest.importorskip("zarr")


def test_a_small_set_and_going_on(tmp_path: Path, capsys: pytest.CaptureFixture[str]):
    words = ["dataset", str(tmp_path / "d"), "--rooms", "office", "--layouts", "1", "--sequences", "1", "--frames", "3"]
    assert main([*words, "--json"]) == 0
    told = json.loads(capsys.readouterr().out)
    assert (told["rooms_made"], told["sequences_made"]) == (1, 1)
    assert main([*words, "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["rooms_already_there"] == 1


@pytest.mark.parametrize(
    ("words", "told"),
    [(["--rooms", "castle"], "unknown kind of room"), (["--layouts", "0"], "num_layouts"), (["--radar", "x"], "x")],
)
def test_bad_wishes_make_nothing(words: list[str], told: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]):
    assert main(["dataset", str(tmp_path / "d"), *words]) == 2
    assert told in capsys.readouterr().err
    assert not (tmp_path / "d").exists()
