"""Kneeling, lying and falling: where the trunk is, what touches the floor, and the way back up."""

import numpy as np
import pytest

from mmweaver.core.skeleton import joint
from mmweaver.motion.empty_floor import RADAR_HEIGHT_M, act_out
from mmweaver.motion.language.plan import Step


def heights(text: str, seconds: float, seed: int = 0) -> np.ndarray:
    """Joints over the floor, (frame, 22)."""
    return act_out(text, duration_s=seconds, seed=seed, height_m=1.75).pose.joints_m[..., 2] + RADAR_HEIGHT_M


@pytest.mark.parametrize("text", ["a person lies down", "a person falls", "a person falls forward"])
@pytest.mark.parametrize("seed", range(3))
def test_who_is_down_lies_level_near_the_floor(text: str, seed: int):
    z = heights(text, 5.0, seed)
    assert z[0, joint("head")] > 1.4
    trunk = z[-1, [joint(name) for name in ("pelvis", "spine1", "spine2", "spine3", "neck", "head")]]
    assert trunk.max() < 0.35
    assert trunk.min() > 0.02, "a body is thick"


@pytest.mark.parametrize("seed", range(3))
def test_a_fall_is_over_within_two_seconds_and_lying_down_is_not(seed: int):
    fast, slow = heights("falls", 6.0, seed)[:, 0], heights("lies down", 6.0, seed)[:, 0]
    assert (fast > 0.4).sum() / 120 < 1.2
    assert (slow > 0.4).sum() / 120 > 0.9
    assert (fast > 0.4).sum() < (slow > 0.4).sum()
    assert np.abs(np.gradient(fast, 1 / 120)).max() > 1.2


def test_forwards_is_on_the_belly_and_otherwise_on_the_back():
    for text, ahead in (("falls forward", True), ("falls", False)):
        pose = act_out(text, duration_s=5.0, seed=1, height_m=1.75).pose
        start, end = pose.joints_m[0], pose.joints_m[-1]
        across = start[joint("left_hip"), :2] - start[joint("right_hip"), :2]
        ahead_way = np.array([across[1], -across[0]]) / np.linalg.norm(across)
        gone = (end[joint("head"), :2] - start[0, :2]) @ ahead_way
        assert (gone > 0.8) if ahead else (gone < -0.4)


def test_kneeling_stands_on_knees_and_toes():
    z = heights("kneels down", 4.0)
    knees = z[-1, [joint("left_knee"), joint("right_knee")]]
    assert np.all((knees > 0.02) & (knees < 0.15))
    assert 0.45 < z[-1, 0] < 0.65
    assert z[-1, joint("head")] > 1.0


@pytest.mark.parametrize(
    ("text", "seconds"),
    [("lies down, then gets up", 9.0), ("kneels down, then stands up", 6.0), ("falls, gets up", 8.0)],
)
def test_what_goes_down_comes_up_to_where_it_was(text: str, seconds: float):
    z = heights(text, seconds)
    assert abs(z[-1, joint("head")] - z[0, joint("head")]) < 0.03
    assert z[:, joint("head")].min() < 1.25


def test_postures_have_names():
    assert [Step(lower=key).posture for key in ("lie", "kneel", "sit", "walk")] == ["floor", "knees", "seat", "feet"]


@pytest.mark.parametrize("side", ["left", "right"])
def test_one_knee_is_on_the_floor_where_one_is_named(side: str):
    z, other = heights(f"a person kneels down on the {side} knee", 3.0)[-1], {"left": "right", "right": "left"}[side]
    assert z[joint(f"{side}_knee")] < 0.12
    assert z[joint(f"{other}_knee")] > 0.35
    assert z[joint(f"{other}_ankle")] < 0.2
