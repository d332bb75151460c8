"""python -m studies: run, list, tables, check."""

import ast
import json
from pathlib import Path

import pytest

from studies.manifest import StudyRun
from studies.run import RESULTS, check_result, main
from studies.schema import metric
from studies.study import study_files

ROW = {
    "dataset": {"name": "data", "sha256": "0"}, "n": 1, "seeds": [0], "seconds": {"all": 0.1},
    "metrics": {"rd_ssim": metric(0.5, "1", "similarity", baseline={"zeros": 0.0})},
}  # fmt: skip


def test_the_options_of_a_study_are_reachable(capsys: pytest.CaptureFixture[str]):
    with pytest.raises(SystemExit) as stopped:
        main(["run", "codecs", "--help"])
    assert stopped.value.code == 0
    shown = capsys.readouterr().out
    assert "--codecs" in shown
    assert "--results" in shown
    assert "--threads" in shown


def test_no_study_declares_an_option_that_the_runner_has():
    own = {
        (name, word.value)
        for name, file in study_files().items()
        for call in ast.walk(ast.parse(file.read_text("utf-8")))
        if isinstance(call, ast.Call) and getattr(call.func, "attr", "") == "add_argument"
        for word in call.args
        if isinstance(word, ast.Constant) and word.value in ("--results", "--threads")
    }
    assert not own


def test_list_names_every_study_with_its_question(capsys: pytest.CaptureFixture[str]):
    assert main(["list"]) == 0
    shown = capsys.readouterr().out
    assert "\nphysics:\n  mars " in shown
    assert "paper_scores" in shown


def test_bad_input_is_one_line(capsys: pytest.CaptureFixture[str]):
    for words, message in (
        (["run", "no_such_study"], "no study is called"),
        (["run", "mars", "--data", "no/such/folder"], "does not exist"),
        (["run", "mars", "--data", ".", "--threads", "0"], "--threads"),
    ):
        assert main(words) == 2
        error = capsys.readouterr().err
        assert message in error
        assert error.count("\n") == 1


def test_a_study_runs_and_its_result_says_how(tmp_path: Path, capsys: pytest.CaptureFixture[str]):
    assert main(["run", "kitml", "--sentences", str(sentences(tmp_path)), "--results", str(tmp_path / "out")]) == 0
    path = tmp_path / "out" / "kitml" / "reading.json"
    assert capsys.readouterr().out.strip().endswith(str(path))
    manifest = json.loads(path.read_text())["manifest"]
    assert [one["name"] for one in manifest["inputs"]] == ["data"]
    assert manifest["options"]["sentences"] == "data"  # no path of this machine
    assert check_result(path, tmp_path / "out") == []


def sentences(tmp_path: Path) -> Path:
    folder = tmp_path / "data"
    folder.mkdir()
    texts = ("a person walks forwards", "a person waves with the left hand", "colourless green ideas")
    notes = [{"seg_id": f"00001_{index}", "text": text} for index, text in enumerate(texts)]
    (folder / "kitml_annotations.json").write_text(json.dumps({"00001": {"annotations": notes}}))
    return folder


def test_a_result_that_was_edited_is_found(tmp_path: Path):
    path = StudyRun("one", tmp_path).write("one", "two", config={}, rows=[ROW])
    assert check_result(path, tmp_path) == []
    record = json.loads(path.read_text())
    record["rows"][0]["metrics"]["rd_ssim"]["value"] = 0.9
    path.write_text(json.dumps(record))
    assert any("rows_sha256" in line for line in check_result(path, tmp_path))


def test_results_and_tables_of_the_project_are_whole(capsys: pytest.CaptureFixture[str]):
    """If this fails: python -m studies check says what is wrong, python -m studies tables fills stale tables."""
    assert main(["check", "--results", str(RESULTS)]) == 0, capsys.readouterr().err
