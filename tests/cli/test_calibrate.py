"""mmweaver calibrate: a board's file from recordings, or one line that says why not."""

import json
import re
from pathlib import Path

import numpy as np
import pytest

from mmweaver.cli.main import main
from mmweaver.core.board import read_board
from mmweaver.io.npz_files import read_npz
from tests.evaluation.test_calibrate import RADAR, cluttered_room


@pytest.fixture(scope="module")
def recording(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """An empty room's samples as .npy, with the radar's file."""
    from mmweaver.core.boards import typical_board

    folder = tmp_path_factory.mktemp("recording")
    (folder / "radar.json").write_text(RADAR.to_json(), encoding="utf-8")
    np.save(folder / "adc.npy", cluttered_room(typical_board(RADAR, 1), frames=2).samples)
    return folder


def words(recording: Path, out: Path) -> list[str]:
    axes = "frame,loop,tx,rx,sample"
    source, radar = str(recording / "adc.npy"), str(recording / "radar.json")
    return ["calibrate", source, "--radar", radar, "--layout", axes, "--out", str(out)]


def test_it_writes_a_board_that_generate_takes(recording: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]):
    out = tmp_path / "board.json"
    assert main(words(recording, out)) == 0
    said = capsys.readouterr().out
    assert "IF response" in said
    assert "not seen" in said
    board = read_board(out)
    assert board.name == "board"
    assert board.made_from == "adc.npy"
    assert main([*words(recording, out), "--overwrite", "--json"]) == 0
    values = json.loads(capsys.readouterr().out)
    assert values["board"]["board_version"] == 1
    made = tmp_path / "made"
    short = ["--demo", "--frames", "2", "--no-pictures", "--quiet", "--text", "a person stands"]
    radar = ["--radar", str(recording / "radar.json"), "--board", str(out)]
    assert main(["generate", *short, *radar, "--out", str(made)]) == 0
    assert read_board(made / "board.json").digest == board.digest
    assert json.loads((made / "meta.json").read_text())["board"]["name"] == "board"
    assert read_npz(made / "radar.npz")["cube"].shape[-1] == 12


def test_it_looks_at_a_range(recording: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]):
    """Fewer cells show the antennas; leakage and noise are seen as before."""
    seen = []
    for name, more in (("all", []), ("some", ["--range", "1,4"])):
        assert main([*words(recording, tmp_path / f"{name}.json"), *more, "--json"]) == 0
        said = json.loads(capsys.readouterr().out)
        seen.append({**said["found"], **said["not_seen"]})
    cells = [int(re.search(r"(\d+) cells", one["antenna gains and phases"])[1]) for one in seen]
    assert 10 < cells[1] < 0.6 * cells[0]
    assert {one["leakage"] for one in seen} == {seen[0]["leakage"]}
    assert main([*words(recording, tmp_path / "none.json"), "--range", "200,300"]) == 2


@pytest.mark.parametrize(
    ("content", "why"),
    [(None, "does not exist"), (b"", "no plain .npy"), (b"\x93NUMPY garbage", "adc"), (b"x" * 1000, "adc")],
)
def test_hostile_input_is_one_line(content: bytes | None, why: str, recording: Path, tmp_path: Path, capsys):
    given, out = words(recording, tmp_path / "board.json"), tmp_path / "board.json"
    given[1] = str(tmp_path / "adc.npy")
    if content is not None:
        (tmp_path / "adc.npy").write_bytes(content)
    assert main(given) == 2
    error = capsys.readouterr().err
    assert error.count("\n") == 1
    assert why in error
    assert not out.exists()
