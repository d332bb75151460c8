import json
from pathlib import Path

import pytest

from mmweaver.cli.main import main
from mmweaver.core.atomic_files import staged_folder


def test_exit_status_and_words(tmp_path: Path, capsys: pytest.CaptureFixture[str]):
    out = tmp_path / "out"
    with staged_folder(out) as stage:
        (stage / "radar.npz").write_text("cube")
    assert main(["verify", str(out)]) == 0
    assert "1 file" in capsys.readouterr().out
    (out / "radar.npz").write_text("CUBE")
    assert main(["verify", str(out)]) == 1
    assert "radar.npz" in capsys.readouterr().out
    assert main(["verify", str(out), "--json"]) == 1
    assert json.loads(capsys.readouterr().out)["damaged"] == [
        {"file": str(out / "radar.npz"), "what": "is not as it was written"}
    ]
    assert main(["verify", str(out), "--quiet"]) == 1
    assert main(["verify", str(tmp_path / "no")]) == 2
    captured = capsys.readouterr()
    assert captured.out == ""
    assert captured.err.count("\n") == 1


def test_a_stream_that_was_killed_is_not_taken_for_an_old_one(tmp_path: Path, capsys: pytest.CaptureFixture[str]):
    """As after a kill: whole parts and their list, no checksums next to them."""
    part = tmp_path / "live" / "parts" / "00000000"
    with staged_folder(part) as stage:
        (stage / "radar.npz").write_text("cube")
    (tmp_path / "live" / "parts.jsonl").write_text('{"first_frame": 0, "frames": 1}\n')
    assert main(["verify", str(tmp_path / "live")]) == 0
    said = capsys.readouterr().out
    assert "stream" in said
    assert "earlier version" not in said
