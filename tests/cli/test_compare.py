"""mmweaver compare: numbers on stdout, files where asked, one line for what cannot be compared."""

import json
from pathlib import Path

import pytest

from mmweaver.cli.main import main
from tests.evaluation.test_compared_sides import write_result


@pytest.fixture(scope="module")
def results(tmp_path_factory: pytest.TempPathFactory) -> tuple[str, str]:
    folder = tmp_path_factory.mktemp("results")
    return str(write_result(folder / "a")), str(write_result(folder / "b"))


def test_numbers_and_files(results: tuple[str, str], tmp_path: Path, capsys: pytest.CaptureFixture[str]):
    assert main(["compare", *results, "--out", str(tmp_path / "out")]) == 0
    printed = capsys.readouterr().out
    assert "plane wave" in printed
    assert "window is cut" in printed
    assert sorted(path.name for path in (tmp_path / "out").iterdir()) == [
        "comparison.html", "comparison.json", "comparison.png",
    ]  # fmt: skip
    assert main(["compare", *results, "--json", "--range", "1,1.3"]) == 0
    assert json.loads(capsys.readouterr().out)["common"]["range_m"] == pytest.approx([1.0, 1.3], abs=0.05)  # whole bins
    assert main(["compare", *results, "--range", "90,95"]) == 2
    assert "--range shows 90.00 to 95.00 m" in capsys.readouterr().err
    assert main(["compare", *results, "--json"]) == 0
    assert json.loads(capsys.readouterr().out) == json.loads((tmp_path / "out" / "comparison.json").read_text())


def test_bad_input_is_one_line_and_leaves_nothing(
    results: tuple[str, str], tmp_path: Path, capsys: pytest.CaptureFixture[str]
):
    out = tmp_path / "out"
    for argv, words in (
        (["compare", results[0], str(tmp_path / "absent"), "--out", str(out)], "does not exist"),
        (["compare", *results, "--out", results[0] + "/radar.npz"], "not a folder"),
    ):
        assert main(argv) == 2
        error = capsys.readouterr().err
        assert words in error
        assert len(error.splitlines()) == 1
    assert not out.exists()
