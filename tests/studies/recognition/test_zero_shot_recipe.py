"""Windows generated from sentences: reproducible, with the motion of the sentence."""

import functools
from dataclasses import replace

import numpy as np
import pytest

from mmweaver.core.boards import IWR1443_RADHAR
from mmweaver.core.firmware_settings import FIRMWARE
from mmweaver.recognition.point_recordings import PointRecording
from mmweaver.recognition.random_scene import Variation
from studies.recognition.zero_shot_recipe import GenerationRecipe, generate_window

QUIET = Variation(turn_deg=0.0, noise_db=(-3.0, 0.0), wall_share=0.0, most_panels=0, skin_exponents=(20.0,))
RECIPE = GenerationRecipe(
    activities={"walk": ("a person walks towards the radar slowly",), "stand": ("a person stands",)},
    radar=IWR1443_RADHAR, firmware=FIRMWARE["iwr1443_radhar"], variation=QUIET, window_s=0.5,
)  # fmt: skip


@functools.cache
def window_of(label: str) -> PointRecording:
    return generate_window(RECIPE, label, 0, 3)


def test_the_same_seed_gives_the_same_points_and_another_does_not():
    one, again, other = window_of("walk"), generate_window(RECIPE, "walk", 0, 3), generate_window(RECIPE, "walk", 1, 3)
    assert np.array_equal(one.cloud.x_m, again.cloud.x_m)
    assert np.array_equal(one.cloud.frame, again.cloud.frame)
    assert not np.array_equal(one.cloud.frame, other.cloud.frame)
    assert (one.num_frames, one.label) == (15, "walk")


def test_walking_towards_the_radar_reduces_range():
    walking = window_of("walk").cloud
    moving = walking.radial_velocity_mps[np.abs(walking.radial_velocity_mps) > 0.1]
    assert len(moving) > 15
    assert np.mean(moving < 0) > 0.7


def test_standing_people_hardly_move():
    standing, walking = (window_of(label).cloud for label in ("stand", "walk"))
    assert np.mean(np.abs(standing.radial_velocity_mps) > 0.1) < 0.3 * np.mean(
        np.abs(walking.radial_velocity_mps) > 0.1
    )


def test_more_noise_gives_no_more_points_of_a_body():
    loud = replace(RECIPE, variation=replace(QUIET, noise_db=(55.0, 55.5)))
    noisy = generate_window(loud, "walk", 0, 3)
    moving = [np.abs(one.cloud.radial_velocity_mps) > 0.1 for one in (window_of("walk"), noisy)]
    assert moving[1].sum() < 0.3 * moving[0].sum()


def test_habits_change_one_activity_only():
    still = replace(RECIPE, habits={"walk": {"vigour": (0.9, 0.91)}})
    assert still.variation_of("walk").vigour == (0.9, 0.91)
    assert still.variation_of("stand") == QUIET
    same, other = window_of("stand").cloud, generate_window(still, "stand", 0, 3).cloud
    assert np.array_equal(same.x_m, other.x_m)


@pytest.mark.slow  # test_generated_sequences.py has parts of long performances
def test_a_window_may_be_any_part_of_a_path():
    """Of a few walkers to and fro, some approach, some recede, at different speeds."""
    activities = {**RECIPE.activities, "walk": ("a person walks back and forth",)}
    recipe = replace(RECIPE, activities=activities, variation=replace(QUIET, hurry=(0.3, 0.4)), window_s=1.0)
    clouds = [generate_window(recipe, "walk", index, 5).cloud for index in range(6)]
    speeds = [cloud.radial_velocity_mps[np.abs(cloud.radial_velocity_mps) > 0.1] for cloud in clouds]
    mean = [float(speed.mean()) for speed in speeds if len(speed) > 5]
    assert min(mean) < -0.3 < 0.3 < max(mean)
