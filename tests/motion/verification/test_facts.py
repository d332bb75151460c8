"""Facts are those of the joints, whatever a plan says: measured on bodies moved by hand in the test."""

import numpy as np
import pytest

from mmweaver.core.records import PoseSequence
from mmweaver.core.skeleton import joint
from mmweaver.motion.verification.facts import Measurement, lower_edge_m
from tests.rooms import standing_person

FLOOR_M = 0.0


def moved(shift_m: np.ndarray, turn_rad: np.ndarray | None = None) -> PoseSequence:
    """The stiff person of the tests, shifted (n, 2) and turned (n,) about the vertical through the pelvis at 120 Hz."""
    rest = standing_person((0.0, 0.0, 0.0), seconds=0.1).joints_m[0]
    turn = np.zeros(len(shift_m)) if turn_rad is None else turn_rad
    cos, sin = np.cos(turn), np.sin(turn)
    x = cos[:, None] * rest[:, 0] - sin[:, None] * rest[:, 1] + shift_m[:, :1]
    y = sin[:, None] * rest[:, 0] + cos[:, None] * rest[:, 1] + shift_m[:, 1:]
    joints_m = np.stack([x, y, np.broadcast_to(rest[:, 2], x.shape)], axis=-1)
    return PoseSequence(time_s=np.arange(len(shift_m)) / 120, joints_m=joints_m, height_m=1.75)


def still(samples: int) -> np.ndarray:
    """The place (x, y) of somebody who stays 2 m ahead of the radar."""
    return np.tile((0.0, 2.0), (samples, 1))


def test_a_way_has_its_length_speed_and_directions():
    """Two metres straight towards the radar in 2 s; the person looks along -y, towards it."""
    time_s = np.arange(241) / 120
    facts = Measurement(moved(np.stack([0 * time_s, 3.0 - time_s], axis=1)), FLOOR_M).facts(0.0, 2.0)
    assert facts.towards_m == pytest.approx(2.0, abs=0.02)
    assert facts.ahead_m == pytest.approx(2.0, abs=0.02)
    assert facts.path_m == pytest.approx(2.0, abs=0.05)
    assert facts.speed_mps == pytest.approx(1.0, abs=0.02)
    assert facts.net_m == pytest.approx((0.0, -2.0), abs=0.02)
    assert facts.off_radar_deg < 1
    assert facts.posture == "feet"


def test_going_backwards_is_no_way_ahead():
    time_s = np.arange(241) / 120
    facts = Measurement(moved(np.stack([0 * time_s, 1.0 + time_s], axis=1)), FLOOR_M).facts(0.0, 2.0)
    assert facts.ahead_m == pytest.approx(-2.0, abs=0.02)
    assert facts.towards_m == pytest.approx(-2.0, abs=0.02)


@pytest.mark.parametrize("degrees", [90.0, -45.0, 360.0])
def test_a_turn_is_positive_to_the_left(degrees: float):
    turn = np.radians(degrees) * np.clip(np.linspace(-0.2, 1.2, 240), 0, 1)
    facts = Measurement(moved(still(240), turn), FLOOR_M).facts(0.0, 2.0)
    assert facts.turn_deg == pytest.approx(degrees, abs=1.0)


@pytest.mark.parametrize("times", [1, 3, 6])
@pytest.mark.parametrize("side", ["left", "right"])
def test_a_raised_arm_is_counted_and_has_its_side(times: int, side: str):
    pose = moved(still(360))
    up = 0.5 - 0.5 * np.cos(2 * np.pi * times * np.linspace(0, 1, 360))
    for name, share in (("elbow", 0.4), ("wrist", 1.0)):
        pose.joints_m[:, joint(f"{side}_{name}"), 2] += share * up
    facts = Measurement(pose, FLOOR_M).facts(0.0, 3.0)
    assert times in facts.repetitions
    assert facts.arm == side
    assert not facts.leg


def test_who_stands_still_repeats_nothing_and_moves_no_limb():
    facts = Measurement(moved(still(240)), FLOOR_M).facts(0.0, 2.0)
    assert (facts.repetitions, facts.arm, facts.leg, facts.steps) == ((), "", "", 0)
    assert facts.path_m < 0.01


def test_a_lying_body_is_on_the_floor_and_a_sunk_foot_is_seen():
    pose = moved(still(240))
    pose.joints_m[120:, :, 2] = 0.1 + 0.05 * pose.joints_m[120:, :, 2]
    pose.joints_m[120:, :, 1] += np.linspace(0.0, 1.5, 22)
    assert Measurement(pose, FLOOR_M).facts(1.0, 2.0).posture == "floor"
    sunk = moved(still(240))
    before = Measurement(sunk, FLOOR_M).facts(0.0, 2.0).sole_m
    sunk.joints_m[..., 2] -= 0.05
    assert Measurement(sunk, FLOOR_M).facts(0.0, 2.0).sole_m[0] == pytest.approx(before[0] - 0.05, abs=0.03)


def test_the_sole_of_a_flat_foot_is_level():
    ankle, ball = np.array([[0.0, 0.0, 0.0805]]), np.array([[0.131, 0.0, 0.021]])  # of a body of 1.75 m
    assert lower_edge_m(ankle, ball) == pytest.approx(0.0, abs=0.001)
