"""mmweaver generate --stream: a recording in parts, and clear words for what streams do not have."""

from pathlib import Path

import pytest

from mmweaver.cli.main import main
from mmweaver.recordings.read_recording import read_recording


@pytest.mark.parametrize("frames", [7, 23])
def test_a_stream_has_as_many_frames_as_asked_for(frames: int, tmp_path: Path):
    """Which end within a part, or are fewer than one has."""
    out = tmp_path / "live"
    said = ["--text", "a person waves", "--text", "claps"]
    assert main(["generate", "--demo", "--stream", *said, "--frames", str(frames), "--out", str(out), "--quiet"]) == 0
    assert len(read_recording(out).cube.values) == frames


def test_a_stream_into_a_folder_that_holds_one_says_what_to_do(tmp_path: Path, capsys):
    (tmp_path / "parts.jsonl").write_text("", encoding="utf-8")
    assert main(["generate", "--demo", "--stream", "--text", "a person walks", "--out", str(tmp_path)]) == 2
    message = capsys.readouterr().err
    assert "cannot be continued" in message
    assert "choose another --out" in message
