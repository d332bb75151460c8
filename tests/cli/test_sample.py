"""mmweaver sample: a room, a recording of it with nobody in it, and what the other commands read."""

import json
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from mmweaver.cli.main import main
from mmweaver.core.checksums import SUMS_FILE
from mmweaver.datasets.build_set import read_activities
from mmweaver.io.dca1000 import read_bin
from mmweaver.io.radar_file import load_radar
from mmweaver.recognition.task_file import read_task
from mmweaver.scene.photo_files import RoomFiles, sample_photo


@pytest.fixture(scope="module")
def sample(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("sample") / "room"
    assert main(["sample", str(folder), "--quiet"]) == 0
    return folder


def test_the_picture_is_that_of_the_bundled_room(sample: Path):
    files = RoomFiles.find(sample)
    assert files.camera is not None
    with Image.open(files.rgb) as picture:
        np.testing.assert_array_equal(np.asarray(picture), sample_photo()[0].rgb)


def test_the_recording_is_of_a_room_in_which_nothing_moves(sample: Path):
    """Three seconds; the room's echoes stand still, what changes from chirp to chirp is noise, equally strong."""
    radar = load_radar(str(sample / "profile.cfg"))
    recorded = read_bin(sample / "empty.bin", radar)
    assert len(recorded.samples) * radar.frame_period_s == pytest.approx(3.0)
    spectrum = np.fft.fft(recorded.samples[:, 2:] * np.hanning(radar.num_samples), axis=-1)  # first chirps differ
    static, changing = np.abs(spectrum.mean(axis=(0, 1))) ** 2, spectrum.var(axis=(0, 1))
    bins = slice(round(1.0 / radar.range_resolution_m), round(4.0 / radar.range_resolution_m))  # floor, couch, walls
    assert (static[..., bins].max(axis=-1) > 20 * changing[..., bins].max(axis=-1)).all()
    assert changing[..., bins].max() < 2 * np.median(changing[..., bins])


def test_the_lists_of_activities_are_read(sample: Path):
    task = read_task(sample / "TASK.toml")
    assert task.radar.num_samples == load_radar(str(sample / "profile.cfg")).num_samples
    assert len(task.activities) >= 3
    assert len(tuple(read_activities(sample / "activities.toml"))) >= 3


def test_the_same_files_every_time(sample: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]):
    assert main(["sample", str(tmp_path), "--json"]) == 0
    written = json.loads(capsys.readouterr().out)
    assert set(written["files"]) == {file.name for file in tmp_path.iterdir()} - {SUMS_FILE}
    assert (tmp_path / SUMS_FILE).read_text() == (sample / SUMS_FILE).read_text()


def test_a_folder_that_holds_something_is_left_alone(tmp_path: Path, capsys: pytest.CaptureFixture[str]):
    (tmp_path / "mine.txt").write_text("mine")
    assert main(["sample", str(tmp_path)]) == 2
    assert "--overwrite" in capsys.readouterr().err
    assert [file.name for file in tmp_path.iterdir()] == ["mine.txt"]


def test_the_sample_recording_is_read_without_a_warning(tmp_path: Path, capsys: pytest.CaptureFixture[str]):
    """As README's example does: a room that fills the range axis of complex samples gives no hint to read I and Q
    otherwise."""
    assert main(["sample", str(tmp_path / "s"), "--quiet"]) == 0
    sample = tmp_path / "s"
    words = [str(sample / "empty.bin"), "--radar", str(sample / "profile.cfg"), "--out", str(tmp_path / "empty")]
    assert main(["process", *words, "--no-pictures", "--no-analysis"]) == 0
    assert "warning" not in capsys.readouterr().out
