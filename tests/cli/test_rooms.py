"""mmweaver rooms, and its rooms through mmweaver generate."""

import json
from pathlib import Path

import pytest

from mmweaver.cli.main import main


@pytest.mark.slow  # tests/scene/procedural and tests/cli/test_generate.py hold its parts
def test_rooms_are_written_and_generated_from(tmp_path: Path, capsys: pytest.CaptureFixture[str]):
    out = tmp_path / "rooms"
    assert main(["rooms", str(out), "--rooms", "living_room,corridor", "--layouts", "2", "--seed", "1", "--json"]) == 0
    made = json.loads(capsys.readouterr().out)
    assert made["rooms"] == ["living_room_00", "living_room_01", "corridor_00", "corridor_01"]
    for name in made["rooms"]:
        files = {path.name for path in (out / name).iterdir()}
        assert files == {"rgb.png", "depth.png", "camera.json", "classes.png", "classes.json", "truth.json"}
    room = out / "living_room_00"
    words = ["generate", "--rgb", room / "rgb.png", "--depth", room / "depth.png", "--camera", room / "camera.json"]
    words += ["--text", "a person waves", "--out", tmp_path / "wave", "--frames", "2", "--quiet", "--no-pictures"]
    assert main([str(word) for word in words]) == 0
    assert (tmp_path / "wave" / "radar.npz").is_file()


def test_rooms_are_repeated_by_their_request(tmp_path: Path):
    first, again = tmp_path / "first", tmp_path / "again"
    options = ["--rooms", "corridor", "--seed", "3", "--noise", "--quiet"]
    assert main(["rooms", str(first), *options]) == 0
    assert main(["rooms", "--config", str(first / "request.toml"), str(again), "--quiet"]) == 0
    files = sorted(path.relative_to(first) for path in first.rglob("*") if path.is_file())
    assert len(files) >= 7
    assert all((first / file).read_bytes() == (again / file).read_bytes() for file in files)


@pytest.mark.parametrize(
    ("words", "complaint"),
    [(["--rooms", "castle"], "known: office"), (["--layouts", "0"], "--layouts"), (["--seed", "-1"], "seed")],
)
def test_bad_requests_leave_nothing(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], words: list[str], complaint: str
):
    assert main(["rooms", str(tmp_path / "rooms"), *words]) == 2
    assert complaint in capsys.readouterr().err
    assert not (tmp_path / "rooms").exists()
