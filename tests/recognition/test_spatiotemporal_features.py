"""Order, sides and course of a motion, whatever the place of the radar and however long people rest around it."""

from dataclasses import replace

import numpy as np
import pytest

from mmweaver.recognition.point_recordings import PointRecording
from mmweaver.recognition.spatiotemporal_features import spatiotemporal_features
from tests.recognition.clouds import recording_of


def arm(*, rising: bool = True, shift_m: float = 0.0, across_m: float = 0.2) -> PointRecording:
    """A hand that goes half a metre up or down, first nearer and then away."""
    frame = np.repeat(np.arange(20), 3)
    share = frame / 19 if rising else 1 - frame / 19
    return recording_of(
        frame, x_m=across_m + shift_m, y_m=2.0 + 0.1 * share, z_m=0.5 * share + shift_m,
        velocity_mps=np.where(share < 0.5, -0.4, 0.4),
    )  # fmt: skip


def raised_arm(before: int, after: int, *, back: bool = False, side: float = 1.0) -> PointRecording:
    """A hand that rises by 0.8 m in 12 frames, first nearer and then away; a body that hardly moves all the time."""
    frames = before + 12 + after
    hand = np.repeat(np.arange(12), 2)
    share = (11 - hand if back else hand) / 11
    body = np.repeat(np.arange(frames), 3)
    return recording_of(
        np.concatenate([before + hand, body]), x_m=np.repeat([0.3 * side, 0.0], [24, len(body)]),
        y_m=np.concatenate([2.0 - 0.4 * np.sin(np.pi * share), np.full(len(body), 2.0)]),
        z_m=np.concatenate([0.8 * share - 0.4, np.tile([-0.1, 0.0, 0.1], frames)]),
        velocity_mps=np.concatenate([np.where(share < 0.5, -1.5, 1.5) * (-1 if back else 1),
                                     np.tile([-0.3, 0.3, 0.3], frames)]),
    )  # fmt: skip


def test_up_and_down_differ_in_their_order():
    up, down = spatiotemporal_features(arm()), spatiotemporal_features(arm(rising=False))
    assert up["order_up_0"] < 0 < up["order_up_5"]
    assert down["order_up_0"] > 0 > down["order_up_5"]
    assert up["order_away_less_near"] > 0.3 > -0.3 > down["order_away_less_near"]
    assert up["turns"] == 1


def test_the_place_of_the_radar_does_not_matter_sideways_and_up():
    here, there = spatiotemporal_features(arm()), spatiotemporal_features(arm(shift_m=0.4))
    for name in ("order_up_0", "order_aside_3", "reach_up_above", "fast_up", "order_lasts"):
        assert np.isclose(here[name], there[name], atol=1e-6)


def test_rests_change_little():
    brief, long = spatiotemporal_features(raised_arm(2, 2)), spatiotemporal_features(raised_arm(14, 20))
    for name in ("course_up_1", "course_up_4", "course_velocity_1", "course_velocity_4", "course_lasts"):
        assert np.isclose(brief[name], long[name], atol=0.12), name
    assert 1.0 < long["course_lasts"] < 1.5


def test_the_order_of_heights_and_velocities_is_seen():
    up, down = spatiotemporal_features(raised_arm(3, 3)), spatiotemporal_features(raised_arm(3, 3, back=True))
    assert up["course_up_0"] < -0.2 < 0.2 < up["course_up_5"]
    assert down["course_up_0"] > 0.2 > -0.2 > down["course_up_5"]
    assert up["course_velocity_1"] < -1 < 1 < up["course_velocity_4"]
    assert np.isclose(up["course_fastest_away"], 1.5)


def test_a_left_arm_is_none_of_the_right():
    right, left = (spatiotemporal_features(raised_arm(3, 3, side=side)) for side in (1.0, -1.0))
    assert right["side_energy_aside"] > 0.1 > -0.1 > left["side_energy_aside"]
    for name in ("side_energy_aside", "order_aside_3", "course_aside_3"):
        assert np.isclose(right[name], -left[name], atol=1e-9), name
    assert right["side_right_high_speed"] > 1.5 * left["side_right_high_speed"]


@pytest.mark.parametrize("window", [arm(), raised_arm(1, 1)])
def test_without_motion_all_are_unknown_and_have_the_same_names(window: PointRecording):
    still = replace(window, cloud=replace(window.cloud, radial_velocity_mps=np.zeros(len(window.cloud.frame))))
    found = spatiotemporal_features(still)
    assert set(found) == set(spatiotemporal_features(window))
    assert all(np.isnan(value) for value in found.values())
