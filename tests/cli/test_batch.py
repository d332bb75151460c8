"""mmweaver generate --texts: many sequences, gone on with, refused before any work where they cannot be."""

import json
from pathlib import Path

import numpy as np
import pytest

from mmweaver.cli.main import main
from mmweaver.io.npz_files import read_radar_npz

SHORT = ["generate", "--demo", "--frames", "6", "--no-pictures", "--json"]


@pytest.fixture
def texts(tmp_path: Path) -> Path:
    file = tmp_path / "sentences.txt"
    file.write_text("# of a test\na person walks to the left\n\n  a person stands  \n")
    return file


def test_a_folder_for_each_and_more_of_them_later(texts: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]):
    out = tmp_path / "set"
    words = [*SHORT, "--texts", str(texts), "--seed", "5", "--out", str(out)]
    assert main(words) == 0
    summary = json.loads(capsys.readouterr().out)
    made = summary["sequences"]
    assert [(one["folder"], one["seed"]) for one in made] == [("0000", 5), ("0001", 5)]
    assert {one["text"] for one in made} == {"a person walks to the left", "a person stands"}
    assert made[0]["at"] == made[1]["at"]  # a matched draw: place, heading and person are the same
    assert (made[0]["heading_deg"], made[0]["subject"]) == (made[1]["heading_deg"], made[1]["subject"])
    assert json.loads((out / "sequences.json").read_text()) == summary
    assert not (out / "0000" / "preview.png").exists()
    first = (out / "0000" / "radar.npz").stat()
    assert main([*words, "--per-class", "2"]) == 0
    more = json.loads(capsys.readouterr().out)
    assert [one["seed"] for one in more["sequences"]] == [5, 5, 6, 6]
    assert "leaks" in more
    assert json.loads((out / "leaks.json").read_text())["of"]["start_place"]["sequences"] == 4
    assert (out / "0000" / "radar.npz").stat().st_mtime_ns == first.st_mtime_ns  # left as it was
    alone = tmp_path / "alone"
    assert main(["generate", "--config", str(out / "0001" / "request.toml"), "--out", str(alone)]) == 0
    cubes = [read_radar_npz(folder / "radar.npz").values for folder in (out / "0001", alone)]
    assert np.array_equal(cubes[0], cubes[1])


def test_what_an_earlier_run_made_otherwise_is_not_touched(
    texts: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
):
    words = [*SHORT, "--texts", str(texts), "--out", str(tmp_path / "set")]
    assert main(words) == 0
    for more in (["--method", "physics"], ["--seed", "1"], ["--radar", "mmmesh"], ["--bin"]):
        assert main([*words, *more]) == 2
        assert "holds something else" in capsys.readouterr().err
    assert main([*words, "--method", "physics", "--overwrite"]) == 0
    assert json.loads((tmp_path / "set" / "0001" / "meta.json").read_text())["method"] == "physics"


def test_place_person_and_heading_may_be_given(texts: Path, tmp_path: Path):
    given = ["--at", "0.1,2", "--heading", "40", "--subject", "7", "--height", "1.8"]
    assert main([*SHORT, "--texts", str(texts), *given, "--out", str(tmp_path / "set")]) == 0
    for name in ("0000", "0001"):
        meta = json.loads((tmp_path / "set" / name / "meta.json").read_text())
        assert (meta["at"], meta["placed"]["subject"], meta["placed"]["height_m"]) == ([0.1, 2.0], 7, 1.8)
        assert meta["placed"]["heading_rad"] == pytest.approx(np.radians(40 - 90))


def test_without_a_length_all_are_as_long_as_the_longest(tmp_path: Path):
    file = tmp_path / "sentences.txt"
    file.write_text("a person stands\na person sits down, then stands up\n")
    words = ["generate", "--demo", "--no-pictures", "--json", "--texts", str(file), "--out", str(tmp_path)]
    assert main(words) == 0
    frames = {len(read_radar_npz(tmp_path / name / "radar.npz").values) for name in ("0000", "0001")}
    assert len(frames) == 1


def test_a_sentence_without_a_place_is_skipped_and_listed(tmp_path: Path, capsys: pytest.CaptureFixture[str]):
    file = tmp_path / "sentences.txt"
    file.write_text("a person stands\na person walks to the door\n")  # there is none in the sample
    words = ["generate", "--demo", "--no-pictures", "--missing", "refuse", "--texts", str(file)]
    words += ["--out", str(tmp_path / "set")]
    assert main(words) == 0
    shown = capsys.readouterr().out
    assert shown.startswith("1 sequence in ")
    assert "skipped 0001, 'a person walks to the door'" in shown
    assert not (tmp_path / "set" / "0001").exists()
    file.write_text("a person walks to the door\n")
    assert main([*words[:-1], str(tmp_path / "none")]) == 2
    assert "none of 1 sequences" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("content", "more", "says"),
    [
        ("a person stands\na person photosynthesises\n", [], "photosynthesises"),
        ("# nothing\n", [], "no sentence"),
        ("a person stands\n", ["--per-class", "0"], "--per-class must be"),
        ("a person stands\n", ["--text", "a person waves"], "leave out --text"),
        ("a person stands\n", ["--at", "0,2", "--at", "1,2"], "give --at once"),
        ("a person stands\n", ["--at", "0,20"], "0,20"),
    ],
)
def test_bad_lists_are_one_line_and_leave_nothing(
    content: str, more: list[str], says: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
):
    file = tmp_path / "sentences.txt"
    file.write_text(content)
    assert main([*SHORT, "--texts", str(file), "--out", str(tmp_path / "set"), *more]) == 2
    error = capsys.readouterr().err.strip()
    assert says in error
    assert "\n" not in error
    assert not (tmp_path / "set").exists()
