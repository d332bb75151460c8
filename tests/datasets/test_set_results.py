"""A labelled set becomes result folders and other formats, and result folders a labelled set."""

import json
from pathlib import Path

import numpy as np
import pytest

from mmweaver.cli.main import main
from mmweaver.datasets import RadarDataset
from mmweaver.datasets.activity_store import read_activity_set
from mmweaver.datasets.room_sequences import read_labelled
from mmweaver.io.stored_result import read_result
from tests.datasets.conftest import activity_set  # noqa: F401  (a fixture)

pytest.importorskip("zarr")


def test_a_set_becomes_folders_and_folders_the_same_set(activity_set: Path, tmp_path: Path):  # noqa: F811
    folders, again = tmp_path / "folders", tmp_path / "again"
    assert main(["export", str(activity_set), "--to", "results", "--out", str(folders)]) == 0
    stored = read_activity_set(activity_set)
    assert len(list(folders.iterdir())) == len(stored)
    one = read_result(folders / "000004")
    np.testing.assert_array_equal(one.cube.values, stored.cube(4).values)
    assert one.text == stored.columns["text"][4]
    assert main(["verify", str(folders)]) == 0
    activities = str(activity_set / "activities.toml")
    assert main(["dataset", str(again), "--from-results", str(folders), "--activities", activities]) == 0
    back = read_activity_set(again)
    assert back.label_names == stored.label_names
    for name, values in stored.columns.items():
        if name != "split_sentence":  # sentences have no numbers there
            np.testing.assert_array_equal(back.columns[name], values, err_msg=name)
    np.testing.assert_array_equal(back.cube(7).values, stored.cube(7).values)
    np.testing.assert_array_equal(back.joints_m, stored.joints_m)
    assert json.loads((again / "leaks.json").read_text())["of"]["start_place"]["sequences"] == len(stored)
    assert main(["verify", str(again)]) == 0


def test_a_data_set_of_rooms_becomes_folders_and_they_a_labelled_set(tiny_signals: Path, tmp_path: Path):
    folders, again = tmp_path / "folders", tmp_path / "again"
    assert main(["export", str(tiny_signals), "--to", "results", "--out", str(folders)]) == 0
    stored = read_labelled(tiny_signals)
    assert main(["dataset", str(again), "--from-results", str(folders)]) == 0
    back = read_activity_set(again)
    for name in ("text", "subject", "split"):
        np.testing.assert_array_equal(back.columns[name], stored.columns[name])
    np.testing.assert_allclose(back.columns["height"], stored.columns["height"], rtol=1e-6)
    assert len(set(back.columns["room"])) == len(set(stored.columns["room"]))
    np.testing.assert_array_equal(back.cube(1).values, stored.cube(1).values)
    np.testing.assert_array_equal(RadarDataset(again, ["rd"])[1]["rd"], RadarDataset(tiny_signals, ["rd"])[1]["rd"])


def test_a_set_in_other_formats(activity_set: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]):  # noqa: F811
    assert main(["export", str(activity_set), "--to", "radhar", "--out", str(tmp_path / "radhar")]) == 0
    assert len(list((tmp_path / "radhar").glob("*/radhar.txt"))) == len(read_activity_set(activity_set))
    assert main(["export", str(activity_set), "--to", "hupr", "--out", str(tmp_path / "hupr")]) == 2
    assert "needs raw samples" in capsys.readouterr().err
    assert not (tmp_path / "hupr").exists()


@pytest.mark.parametrize(
    ("words", "says"), [(["--per-class", "3"], "leave out --per-class"), ([], "holds no result folders")]
)
def test_bad_sources_are_one_line(words: list[str], says: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]):
    (tmp_path / "source").mkdir()
    source, out = str(tmp_path / "source"), tmp_path / "set"
    assert main(["dataset", str(out), "--from-results", source, *words]) == 2
    assert says in capsys.readouterr().err
    assert not out.exists()
