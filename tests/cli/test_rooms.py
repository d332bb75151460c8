"""mmweaver rooms, and its rooms through mmweaver generate."""

from pathlib import Path

from mmweaver.cli.main import main


def test_rooms_are_repeated_by_their_request(tmp_path: Path):
    first, again = tmp_path / "first", tmp_path / "again"
    options = ["--rooms", "corridor", "--seed", "3", "--noise", "--quiet"]
    assert main(["rooms", str(first), *options]) == 0
    assert main(["rooms", "--config", str(first / "request.toml"), str(again), "--quiet"]) == 0
    files = sorted(path.relative_to(first) for path in first.rglob("*") if path.is_file())
    assert len(files) >= 7
    assert all((first / file).read_bytes() == (again / file).read_bytes() for file in files)
