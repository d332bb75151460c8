"""mmweaver rooms, and its rooms through mmweaver generate."""

from pathlib import Path

import pytest

from mmweaver.cli.main import main


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
