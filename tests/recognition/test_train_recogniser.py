"""A recogniser from a task to labels: files, live labels, scores, unlabelled recordings, a recorded background."""

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

pytest.importorskip("sklearn")

from mmweaver.core.errors import InputError
from mmweaver.core.records import PointCloud
from mmweaver.recognition import train_recogniser as training
from mmweaver.recognition.live_recogniser import LiveRecogniser
from mmweaver.recognition.point_recordings import PointRecording
from mmweaver.recognition.quantisation import Quantisation
from mmweaver.recognition.recogniser import (
    Recogniser,
    Recognition,
    load_recogniser,
    save_recogniser,
)
from mmweaver.recognition.scoring import score_recordings
from mmweaver.recognition.task_file import read_task
from mmweaver.recognition.train_recogniser import train_recogniser
from tests.recognition.clouds import in_all_frames, with_others
from tests.recognition.small_recogniser import OPTIONS, drawn_sequences, small_recogniser, write_recordings

TASK = """radar = "iwr1443_mars"
window_s = 2.0
{more}
[activities]
rest = "a person stands"
to_and_fro = "a person walks"
[recordings]
columns = ["x_right", "y_ahead", "z_up", "velocity"]
"""


@pytest.fixture
def task_file(tmp_path: Path) -> Path:
    file = tmp_path / "task.toml"
    file.write_text(TASK.format(more=""))
    return file


@pytest.fixture
def drawn(monkeypatch: pytest.MonkeyPatch) -> None:
    """Sequences are drawn instead of simulated."""
    monkeypatch.setattr(
        training, "generate_sequences", lambda recipe, each, *_: drawn_sequences(recipe.task.recordings, each)
    )


@pytest.mark.usefixtures("drawn")
def test_a_folder_is_written_and_read_again(task_file: Path, tmp_path: Path):
    model = train_recogniser(task_file, tmp_path / "model", OPTIONS)
    again = load_recogniser(tmp_path / "model")
    people = drawn_sequences(model.settings, 2, first=50)
    assert [model.recognise(one) for one in people] == [again.recognise(one) for one in people]
    assert again.meta["generated_on_generated"]["balanced_accuracy"] > 0.9
    assert again.meta["task"]["radar"] == "iwr1443_mars"
    assert np.shape(again.meta["generated_on_generated"]["confusion"]) == (2, 2)
    assert set(again.meta["moving_points_a_frame"]) == set(again.labels)
    scores = score_recordings(again, people)
    assert scores["window"]["balanced_accuracy"] == 1.0
    assert np.sum(scores["window"]["confusion"]) == scores["window"]["n"] == 16
    assert scores["warning"] is None
    assert set(scores["distance"]["largest"]) <= set(again.names)
    points = scores["distance"]["moving_points_a_frame"]
    assert points["recorded"] == pytest.approx(points["generated"], rel=0.2)
    assert scores["hardly_distinct"] == []
    json.dumps(scores)


@pytest.mark.usefixtures("drawn")
def test_labels_that_generated_people_do_not_tell_apart_are_named(task_file: Path):
    model = small_recogniser(task_file)
    known = model.meta["generated_on_generated"]
    blurred = replace(model, meta=model.meta | {"generated_on_generated": known | {"confusion": [[6, 4], [2, 8]]}})
    (line,) = score_recordings(blurred, drawn_sequences(model.settings, 3, first=50))["hardly_distinct"]
    assert line.startswith("rest is taken for to_and_fro in 40%")


@pytest.mark.usefixtures("drawn")
def test_recordings_that_lie_outside_are_warned_of(task_file: Path):
    model = small_recogniser(task_file)
    people = drawn_sequences(model.settings, 3, first=50)
    noisy = [
        replace(one, cloud=replace(one.cloud, radial_velocity_mps=one.cloud.radial_velocity_mps * 8)) for one in people
    ]
    scores = score_recordings(model, noisy)
    assert "outside what was generated" in scores["warning"]
    assert {"speed_mean", "speed_90"} & set(scores["distance"]["largest"])
    assert not any(found.is_outside for found in model.recognise(people[1]))
    assert any(found.is_outside for found in model.recognise(noisy[1]))


@pytest.mark.usefixtures("drawn")
def test_what_moves_in_the_empty_place_is_left_out_of_all_windows(task_file: Path, tmp_path: Path):
    """A fan that the recording of the empty place shows changes no label, live or not."""
    empty = in_all_frames([(1.5, 4.0, speed) for speed in (0.712, -0.712, 1.068)], 200, label="rest", name="empty")
    write_recordings(tmp_path / "place", [empty])
    task_file.write_text(TASK.format(more='background = "place/rest/empty.npz"'))
    model = train_recogniser(task_file, tmp_path / "model", OPTIONS)
    again = load_recogniser(tmp_path / "model")
    assert len(model.points.background) == len(again.points.background) == 9
    assert again.points.radar == Quantisation.of(read_task(task_file))
    people = drawn_sequences(model.settings, 2, first=50)
    with_fan = [with_others(one, empty.cloud) for one in people]
    assert [again.recognise(one) for one in with_fan] == [again.recognise(one) for one in people]
    assert score_recordings(again, with_fan)["window"]["balanced_accuracy"] == 1.0


@pytest.mark.usefixtures("drawn")
def test_unlabelled_recordings_and_a_background_are_used(task_file: Path, tmp_path: Path):
    settings = read_task(task_file).recordings
    write_recordings(tmp_path / "some", drawn_sequences(settings, 4, first=20))
    (tmp_path / "some").rename(tmp_path / "unlabelled")
    write_recordings(tmp_path, [replace(drawn_sequences(settings, 1)[0], label="place", name="empty")])
    task_file.write_text(TASK.format(more='unlabelled = "unlabelled"\nbackground = "place/empty.npz"'))
    model = train_recogniser(task_file, tmp_path / "model", OPTIONS)
    assert model.meta["unlabelled_windows"] == 32
    assert model.meta["self_training"]["used"]


@pytest.mark.usefixtures("drawn")
def test_labelled_recordings_train_along(task_file: Path, tmp_path: Path):
    """People who move a tenth as far and fast as those who were generated are recognised from some recordings."""
    settings = read_task(task_file).recordings
    taught, people = (slowed(drawn_sequences(settings, count, first)) for count, first in ((4, 20), (3, 50)))
    write_recordings(tmp_path / "taught", taught)
    model = train_recogniser(task_file, tmp_path / "model", OPTIONS, labelled=tmp_path / "taught")
    assert model.meta["labelled_windows"] == 16
    assert model.meta["trees_of_labelled_alone"] == 0  # nobody rests in them
    plain = score_recordings(small_recogniser(task_file), people)["window"]["balanced_accuracy"]
    assert score_recordings(model, people)["window"]["balanced_accuracy"] > max(0.9, plain + 0.3)
    (tmp_path / "none").mkdir()
    with pytest.raises(InputError, match="holds no recordings"):
        train_recogniser(task_file, tmp_path / "other", OPTIONS, labelled=tmp_path / "none")


def slowed(recordings: list[PointRecording]) -> list[PointRecording]:
    def slower(cloud: PointCloud) -> PointCloud:
        return replace(cloud, radial_velocity_mps=cloud.radial_velocity_mps / 10, y_m=2 + (cloud.y_m - 2) / 10)

    return [replace(one, cloud=slower(one.cloud)) for one in recordings if one.label == "to_and_fro"]


def live_labels(model: Recogniser, recording: PointRecording) -> list[Recognition]:
    live = LiveRecogniser(model)
    return [one for points in frames(recording) for one in live.push(points)] + live.finish()


@pytest.mark.usefixtures("drawn")
@pytest.mark.parametrize("gap_frames", [4, 30])
def test_gaps_are_windows_of_an_empty_place_where_a_label_is_one(gap_frames: int, task_file: Path):
    model = small_recogniser(task_file)
    model = replace(model, settings=replace(model.settings, gap_frames=gap_frames, empty_label="rest"))
    recording = replace(drawn_sequences(model.settings, 1, first=9)[1], label="", num_frames=125)
    length = model.settings.window_frames
    kept = ~np.isin(recording.cloud.frame, [*range(2), *range(20, 20 + 2 * length + 3)])
    recording = replace(recording, cloud=recording.cloud.select(kept))
    found = live_labels(model, recording)
    assert found == model.recognise(recording)
    assert sum(one.first_frame in (20, 20 + length) for one in model.recognise(recording)) == 2
    nothing = replace(recording, cloud=recording.cloud.select(np.zeros(len(kept[kept]), bool)), num_frames=2 * length)
    assert [one.first_frame for one in model.recognise(nothing)] == [0, length]


def frames(recording: PointRecording) -> list[np.ndarray]:
    cloud = recording.cloud
    table = np.stack([cloud.x_m, cloud.y_m, cloud.z_m, cloud.radial_velocity_mps, cloud.snr_db], axis=1)
    return [table[cloud.frame == number] for number in range(recording.num_frames)]


@pytest.mark.parametrize(
    ("file", "content"), [("meta.json", b"{}"), ("meta.json", b"no"), ("trees.npz", b"x"), ("features.npz", b"x")]
)
def test_damaged_folders_are_one_line(file: str, content: bytes, task_file: Path, tmp_path: Path):
    model: Recogniser = small_recogniser(task_file)
    save_recogniser(tmp_path / "model", model)
    (tmp_path / "model" / file).write_bytes(content)
    with pytest.raises(InputError):
        load_recogniser(tmp_path / "model")
    with pytest.raises(InputError, match="holds no recogniser"):
        load_recogniser(tmp_path)
