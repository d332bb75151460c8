"""mmweaver fit and mmweaver sample: a field of a signal, and its signal at finer coordinates."""

import json
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from mmweaver.cli.main import main
from mmweaver.datasets.room_sequences import read_labelled
from mmweaver.inr import load
from mmweaver.io.npz_files import read_radar_npz, write_radar_npz
from tests.compression.echoes import error_db
from tests.cubes import SMALL, point_cube

FEW = ("--values", "1200", "--steps", "100", "--quiet")


@pytest.fixture(scope="module")
def walk(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("fit") / "walk"
    folder.mkdir()
    (folder / "radar.json").write_text(SMALL.to_json())
    write_radar_npz(folder / "radar.npz", point_cube(num_frames=3, noise=0.05))
    return folder


@pytest.fixture(scope="module")
def field(walk: Path) -> Path:
    out = walk.parent / "walk.safetensors"
    assert main(["fit", str(walk / "radar.npz"), "--out", str(out), *FEW]) == 0
    return out


def test_a_fit_writes_field_and_picture_and_reports_its_error(walk: Path, tmp_path: Path, capsys):
    out = tmp_path / "a.safetensors"
    words = ["fit", str(walk / "radar.npz"), "--out", str(out), "--values", "1200", "--steps", "100", "--json"]
    assert main(words) == 0
    summary = json.loads(capsys.readouterr().out)
    truth, again = read_radar_npz(walk / "radar.npz").values, load(out).cube().values
    assert summary["error_db"] == pytest.approx(error_db(again, truth), abs=0.01)
    assert summary["error_db"] < -10
    assert summary["values"] <= 1200
    picture = np.asarray(Image.open(tmp_path / "a.png").convert("RGB"))
    assert len(np.unique(picture.reshape(-1, 3), axis=0)) > 100


@pytest.mark.parametrize("options", [("--field", "scatterers"), ("--field", "base", "--steps", "3")])
def test_other_fields_are_fitted_too(walk: Path, tmp_path: Path, options: tuple[str, ...]):
    out = tmp_path / "a.safetensors"
    assert main(["fit", str(walk / "radar.npz"), *options, "--values", "1500", "-o", str(out), "--quiet"]) == 0
    assert load(out).num_values <= 1500


@pytest.mark.slow  # the parts: this file, tests/datasets
def test_a_sequence_of_a_set_is_fitted(tiny_signals: Path, tmp_path: Path, capsys):
    out, words = tmp_path / "a.safetensors", ["--field", "scatterers", "--values", "20000", "--quiet"]
    assert main(["fit", str(tiny_signals), "--sequence", "1", "-o", str(out), *words]) == 0
    truth = read_labelled(tiny_signals).cube(1).values
    assert error_db(load(out).cube().values, truth) < -10
    assert main(["fit", str(tiny_signals), "--sequence", "99", "-o", str(tmp_path / "no.safetensors"), *words]) == 2
    assert "there is no sequence 99" in capsys.readouterr().err


def test_the_papers_recipe_has_the_papers_network(walk: Path, tmp_path: Path):
    """4,898 shared values and 256 of each of three frames; more would make other layers."""
    out, count = tmp_path / "a.safetensors", 4_898 + 3 * 256
    words = ["--preset", "paper", "--steps", "2", "--values", str(count), "--quiet"]
    assert main(["fit", str(walk / "radar.npz"), "-o", str(out), *words]) == 0
    assert load(out).num_values == count


def test_a_field_is_sampled_more_finely(field: Path, tmp_path: Path):
    out = tmp_path / "finer.npz"
    assert main(["sample", str(field), "--finer", "2,2,1", "--out", str(out), "--quiet"]) == 0
    with np.load(out) as held:
        assert held["cube"].shape == (3, 64, 32, 12)
        assert np.allclose(held["range_m"][::2], SMALL.range_m)
        native = load(field).cube().values
        assert np.allclose(held["cube"][:, ::2, ::2], native, atol=1e-4 * np.abs(native).max())


def test_a_field_is_read_back_as_a_signal_of_its_radar(field: Path, tmp_path: Path):
    out = tmp_path / "again.npz"
    assert main(["sample", str(field), "-o", str(out), "--quiet"]) == 0
    again = read_radar_npz(out)  # with the radar.json next to it
    assert again.config == SMALL
    assert np.array_equal(again.values, load(field).cube().values)


def test_a_mmw_file_is_sampled_too(walk: Path, tmp_path: Path):
    file, out = tmp_path / "walk.mmw", tmp_path / "finer.npz"
    assert main(["compress", str(walk / "radar.npz"), "-o", str(file), "--bytes", "4000", "--quiet"]) == 0
    assert main(["sample", str(file), "--finer", "1.5,1,1", "-o", str(out), "--quiet"]) == 0
    with np.load(out) as held:
        assert held["cube"].shape == (3, 48, 16, 12)


@pytest.mark.parametrize(
    ("words", "reason"),
    [
        (("fit", "WALK", "-o", "a.npz"), "safetensors"),
        (("fit", "WALK", "-o", "a.safetensors", "--values", "30"), "too few"),
        (("fit", "WALK", "-o", "a.safetensors", "--sequence", "1"), "--sequence is of a set"),
        (("fit", "WALK", "-o", "a.safetensors", "--field", "scatterers", "--steps", "5"), "are of networks"),
        (("sample", "FIELD"), "--out"),
        (("sample", "FIELD", "-o", "a.npz", "--finer", "0.5,1,1"), "at least 1"),
        (("sample", "room", "--finer", "2,2,1"), "is no field"),
    ],
)
def test_bad_requests_are_one_line_and_write_nothing(
    walk: Path, field: Path, tmp_path: Path, monkeypatch, capsys, words: tuple[str, ...], reason: str
):
    monkeypatch.chdir(tmp_path)
    places = {"WALK": str(walk / "radar.npz"), "FIELD": str(field)}
    assert main([places.get(word, word) for word in words]) == 2
    error = capsys.readouterr().err
    assert reason in error
    assert len(error.splitlines()) == 1
    assert not list(tmp_path.iterdir())
