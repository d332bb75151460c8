"""mmweaver generate --texts: many sequences, gone on with, refused before any work where they cannot be."""

import json
from pathlib import Path

import numpy as np
import pytest

from mmweaver.cli.batch import read_texts
from mmweaver.cli.main import main
from mmweaver.core.errors import InputError
from mmweaver.formats.npz_files import read_radar_npz

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
    assert [(one["folder"], one["text"], one["seed"]) for one in summary["sequences"]] == [
        ("0000", "a person walks to the left", 5), ("0001", "a person stands", 6),
    ]  # fmt: skip
    assert json.loads((out / "sequences.json").read_text()) == summary
    assert not (out / "0000" / "preview.png").exists()
    first = (out / "0000" / "radar.npz").stat()
    assert main([*words, "--repeat", "2"]) == 0
    assert [one["seed"] for one in json.loads(capsys.readouterr().out)["sequences"]] == [5, 6, 7, 8]
    assert (out / "0000" / "radar.npz").stat().st_mtime_ns == first.st_mtime_ns  # left as it was
    alone = tmp_path / "alone"
    same = ["--seed", "6", "--board", "typical:5"]  # one board for all
    assert main([*SHORT, "--text", "a person stands", *same, "--out", str(alone)]) == 0
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


def test_a_sentence_without_a_place_is_skipped_and_listed(tmp_path: Path, capsys: pytest.CaptureFixture[str]):
    file = tmp_path / "sentences.txt"
    file.write_text("a person stands\na person walks to the door\n")  # there is none in the sample
    words = ["generate", "--demo", "--no-pictures", "--texts", str(file), "--out", str(tmp_path / "set")]
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
        ("a person stands\n", ["--repeat", "0"], "--repeat must be"),
        ("a person stands\n", ["--text", "a person waves"], "leave out --text"),
        ("a person stands\n", ["--at", "0,2"], "leave out --at"),
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


def test_no_text_is_no_list(tmp_path: Path):
    (tmp_path / "picture.png").write_bytes(b"\x89PNG\xff\xfe")
    for name, says in (("picture.png", "no UTF-8 text"), ("nothing.txt", "cannot read")):
        with pytest.raises(InputError, match=says):
            read_texts(tmp_path / name)
