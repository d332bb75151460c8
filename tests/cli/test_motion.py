import json
from pathlib import Path

import numpy as np
import pytest

from mmweaver.cli.main import main


def test_a_sentence_is_read_and_acted_out(tmp_path: Path, capsys: pytest.CaptureFixture[str]):
    out, picture = tmp_path / "m.npz", tmp_path / "m.png"
    assert main(["motion", "a person bows, then waves", "--out", str(out), "--out", str(picture), "--json"]) == 0
    facts = json.loads(capsys.readouterr().out)
    assert [step["name"] for step in facts["steps"]] == ["bowing", "waving"]
    assert [step["shown"] for step in facts["steps"]] == ["bowing once", "waving with one hand repeatedly"]
    with np.load(out, allow_pickle=False) as file:
        assert file["joints_m"].shape[1:] == (22, 3)
        assert file["frame_time_s"][-1] >= facts["seconds"]
    assert picture.read_bytes()[:4] == b"\x89PNG"
    assert main(["motion", "a person bows"]) == 0
    assert "bowing once" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("words", "told"),
    [
        (["a person flies"], "did you mean"),
        (["a person bows", "--out", "m.txt"], ".npz"),
        (["a person bows", "--out", "m.txt"], ".png"),
        (["nobody"], "empty place"),
        (["a person bows, then waves", "--seconds", "0.5"], "at least 0.7 s"),
    ],
)
def test_bad_input_is_one_line(words: list[str], told: str, capsys: pytest.CaptureFixture[str]):
    assert main(["motion", *words]) == 2
    message = capsys.readouterr().err
    assert told in message
    assert message.count("\n") == 1


def test_a_movement_that_is_cut_ends_with_its_time(capsys: pytest.CaptureFixture[str]):
    assert main(["motion", "a person bows", "--seconds", "0.7", "--json"]) == 0
    facts = json.loads(capsys.readouterr().out)
    assert facts["steps"][0]["end_s"] == facts["seconds"] == 0.7
    assert facts["clauses"][0]["status"] == "approximated"
