"""Each condition changes what it says, and nothing else."""

import numpy as np
import pytest

from mmweaver.recognition.task_file import read_task
from studies.recognition.blind_recognition import TASKS
from studies.recognition.other_boards import CONDITIONS, Condition, empty_place
from studies.recognition.recognised_elsewhere import strangers_recipe
from tests.recognition.small_recogniser import drawn_recording

TASK = read_task(TASKS / "iwr6843.toml")
ONE = drawn_recording(TASK.recordings, "walk", 1)
BY_NAME = {condition.name: condition for condition in CONDITIONS}


def test_conditions_differ_by_name_and_in_something():
    assert len(BY_NAME) == len(CONDITIONS)
    plain = [one.name for one in CONDITIONS if one.recipe is None and one.points is None]
    assert plain == ["as generated"]


@pytest.mark.parametrize("condition", [one for one in CONDITIONS if one.points], ids=lambda one: one.name)
def test_recordings_stay_recordings_and_the_same_seed_gives_the_same(condition: Condition):
    (once,), (again,) = condition.recorded([ONE], 3), condition.recorded([ONE], 3)
    cloud = once.cloud
    assert (np.diff(cloud.frame) >= 0).all()
    assert cloud.frame.max() < once.num_frames
    assert np.array_equal(cloud.x_m, again.cloud.x_m)
    assert once.label == "walk"


@pytest.mark.parametrize("condition", [one for one in CONDITIONS if one.recipe], ids=lambda one: one.name)
def test_recipes_differ_and_keep_the_activities(condition: Condition):
    assert condition.recipe is not None
    own = strangers_recipe(TASK)
    other = condition.recipe(own)
    assert other.task.activities == own.task.activities
    assert other.seed == own.seed
    assert other.as_json() != own.as_json()


def test_points_a_frame_are_limited_to_the_nearest():
    (few,) = BY_NAME["16 points a frame at most"].recorded([ONE], 0)
    assert np.bincount(few.cloud.frame).max() <= 16


def test_half_the_rate_has_half_the_frames():
    (slower,) = BY_NAME["half the frame rate, not said"].recorded([ONE], 0)
    assert slower.num_frames == ONE.num_frames // 2
    assert slower.cloud.frame.max() < slower.num_frames


def test_a_fan_moves_in_the_empty_place_too():
    (fan,) = BY_NAME["fan"].recorded([empty_place(10.0, 10.0)], 0)
    assert (np.bincount(fan.cloud.frame, minlength=100) > 0).mean() > 0.5
    assert np.hypot(fan.cloud.x_m - 1.1, fan.cloud.y_m - 3.0).max() < 1.0
