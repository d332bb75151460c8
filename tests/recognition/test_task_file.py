"""Task files: everything that may stand in one, and one line for what may not."""

from pathlib import Path

import numpy as np
import pytest

from mmweaver.core.errors import InputError
from mmweaver.recognition.generated_sequences import SequenceRecipe
from mmweaver.recognition.task_file import read_task

EXAMPLES = Path(__file__).resolve().parents[2] / "examples" / "tasks"
ACTIVITIES = '[activities]\nwalk = "a person walks"\nempty = "nobody"\n'
HEAD = 'radar = "iwr1443_mars"\n'


def written(folder: Path, text: str) -> Path:
    file = folder / "task.toml"
    file.write_text(text)
    return file


def test_everything_that_may_be_said(tmp_path: Path):
    np.savez(tmp_path / "empty.npz", frame=np.zeros(1, int), pts=np.zeros((1, 4)))
    task = read_task(written(tmp_path, (
        'radar = "iwr1443_mars"\nwindow_s = 3\nbackground = "empty.npz"\nunlabelled = "empty.npz"\n' + ACTIVITIES
        + "[mount]\nheight_m = 1.2\ntilt_deg = 5\ndistance_m = [1.0, 3]\n"
        '[recordings]\ncolumns = ["x_right", "y_ahead", "z_up", "velocity"]\nframe_rate_hz = 20\ngap_frames = 5\n'
    )))  # fmt: skip
    assert task.recordings.labels == ("empty", "walk")
    assert (task.mount.height_m, task.mount.tilt_deg, task.mount.distance_m) == (1.2, 5.0, (1.0, 3.0))
    assert (task.recordings.window_frames, task.recordings.gap_frames) == (60, 5)
    assert task.recordings.has_single_performances
    assert task.radar.frame_period_s == 0.05
    assert task.background == task.unlabelled == tmp_path / "empty.npz"


def test_an_empty_place_may_be_put_in_other_words(tmp_path: Path):
    task = read_task(written(tmp_path, HEAD + '[activities]\na = "a person walks"\nb = ["an empty room", "nobody"]\n'))
    assert task.activities["b"] == ("nobody",)


def test_what_is_missing_is_unknown(tmp_path: Path):
    task = read_task(written(tmp_path, HEAD + ACTIVITIES))
    assert task.mount.height_m is task.mount.distance_m is task.background is task.recordings.columns is None
    assert (task.recordings.window_s, task.recordings.frame_rate_hz) == (2.0, pytest.approx(10.0))
    assert not task.recordings.has_single_performances


def test_a_cfg_is_looked_for_next_to_the_file(tmp_path: Path):
    (tmp_path / "profile.cfg").write_text("nothing of use\n")
    with pytest.raises(InputError, match=r"profile\.cfg"):
        read_task(written(tmp_path, 'radar = "profile.cfg"\n' + ACTIVITIES))


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (ACTIVITIES, "names no radar"),
        (HEAD, "needs a table"),
        (HEAD + '[activities]\na = "a person walks"\nb = "gibberish of sorts"\n', "b:"),
        (HEAD + '[activities]\na = "a person walks"\nb = ["nobody", "a person waves"]\n', "label of its own"),
        (HEAD + "window = 2\n" + ACTIVITIES, "'window' is unknown"),
        (HEAD + "window_s = true\n" + ACTIVITIES, "window_s must be a number"),
        (HEAD + 'background = "none.npz"\n' + ACTIVITIES, "is not there"),
        (HEAD + ACTIVITIES + "[mount]\ndistance_m = [3, 1]\n", "must rise"),
        (HEAD + ACTIVITIES + "[mount]\nheight = 1\n", "in \\[mount\\] is unknown"),
        (HEAD + ACTIVITIES + '[recordings]\ncolumns = ["x_right", "z_up", "velocity"]\n', "must point ahead"),
        (HEAD + ACTIVITIES + "[recordings]\nframe_rate_hz = 0\n", "frame_rate_hz must be a number"),
    ],
)
def test_what_cannot_be_is_one_line(text: str, message: str, tmp_path: Path):
    with pytest.raises(InputError, match=message) as error:
        read_task(written(tmp_path, text))
    assert "\n" not in str(error.value)


@pytest.mark.parametrize("name", sorted(path.name for path in EXAMPLES.glob("*.toml")))
def test_the_examples_are_tasks(name: str):
    assert len(read_task(EXAMPLES / name).activities) >= 5


def test_clouds_are_as_recorded_where_the_board_has_sdk_3_or_the_task_says_so(tmp_path: Path):
    for radar, more, clouds in (
        ("iwr6843isk", "", "recorded"),
        ("iwr1443_mars", "", "varied"),
        ("iwr1443_mars", 'clouds = "recorded"', "recorded"),
        ("iwr6843isk", 'clouds = "varied"', "varied"),
    ):
        file = tmp_path / "task.toml"
        file.write_text(f'radar = "{radar}"\n{more}\n[activities]\nwalk = ["a person walks"]\nempty = "nobody"\n')
        task = read_task(file)
        assert task.clouds == clouds
        assert ('"clouds": "recorded"' in SequenceRecipe.of(task).as_json()) == (clouds == "recorded")
    file.write_text(file.read_text().replace("varied", "clear"))
    with pytest.raises(InputError, match="clear"):
        read_task(file)
