"""Which leg acts, how high, how often."""

import numpy as np
import pytest

from mmweaver.core.skeleton import joint
from mmweaver.motion.empty_floor import RADAR_HEIGHT_M, act_out
from mmweaver.motion.language.sentence import parse


def feet(text: str, seconds: float = 3.0, seed: int = 0) -> dict[str, np.ndarray]:
    joints = act_out(text, duration_s=seconds, seed=seed, height_m=1.75).pose.joints_m
    return {side: joints[:, joint(f"{side}_ankle"), 2] + RADAR_HEIGHT_M for side in ("left", "right")}


@pytest.mark.parametrize("side", ["left", "right"])
@pytest.mark.parametrize("text", ["kicks with the {} foot", "raises the {} leg", "stamps with the {} foot"])
def test_the_leg_that_is_said_acts(text: str, side: str):
    z = feet(text.format(side), seed=3)
    other = "right" if side == "left" else "left"
    assert z[side].max() > 0.2
    assert z[other].max() < 0.12, "the other one stands"


def test_on_the_left_leg_the_right_one_is_lifted():
    for text in ("stands on the left leg", "hops on the left leg"):
        z = feet(text)
        middle = slice(len(z["left"]) // 3, 2 * len(z["left"]) // 3)
        assert z["right"][middle].min() > z["left"][middle].max()


def test_a_high_kick_is_higher():
    high = [max(z.max() for z in feet("performs a high kick", seed=seed).values()) for seed in range(4)]
    low = [max(z.max() for z in feet("kicks", seed=seed).values()) for seed in range(4)]
    assert min(high) > max(low)


@pytest.mark.parametrize("count", [2, 4])
def test_hops_are_counted_and_about_two_a_second(count: int):
    z = np.minimum(*feet(f"hops {count} times", seconds=0.6 + 0.5 * count).values())
    air = z > z.min() + 0.03
    assert (np.diff(air.astype(int)) == 1).sum() == count


def test_stepping_up_lifts_the_body_by_a_stair_and_returns():
    motion = act_out("a person steps up and down twice", seed=1)
    height_m = motion.pose.joints_m[2:-2, 0, 2]
    assert 0.12 < np.ptp(height_m) < 0.25
    assert abs(height_m[-1] - height_m[0]) < 0.03
    plan = parse("she walks up the stairs")
    assert plan.steps[0].lower == "stairs"
    assert "stairs are shown as" in plan.clauses[0].how


@pytest.mark.parametrize(
    "text", ["a child hops on one leg in a circle", "a person hops forward five times on the right leg"]
)
def test_hops_carry_the_body_and_the_foot_stays_where_it_lands(text: str) -> None:
    motion = act_out(text, seed=1)
    joints_m, feet = motion.pose.joints_m, [joint("left_ankle"), joint("right_ankle")]
    gone_m = np.hypot(*np.diff(joints_m[::12, 0, :2], axis=0).T).sum()
    assert gone_m > 1.2
    hops_with = feet[int(np.argmin(joints_m[60:-60, feet, 2].mean(axis=0)))]
    foot = joints_m[:, hops_with]
    speed_mps = np.hypot(*(np.diff(foot[:, :2], axis=0) * 120).T)
    on_floor = foot[1:, 2] < foot[:, 2].min() + 0.005
    assert np.median(speed_mps[on_floor]) < 0.1
    assert np.linalg.norm(np.diff(joints_m, n=2, axis=0) * 120**2, axis=-1).max() < 90.0


@pytest.mark.parametrize(("direction", "sign"), [("back", -1.0), ("forwards", 1.0)])
def test_a_leg_is_kicked_to_the_side_that_is_said(direction: str, sign: float):
    joints = act_out(f"a person kicks the right leg {direction}", seed=0).pose.joints_m
    across = joints[0, joint("left_hip"), :2] - joints[0, joint("right_hip"), :2]
    ahead = np.array([across[1], -across[0]]) / np.hypot(*across)
    way_m = (joints[:, joint("right_ankle"), :2] - joints[:, joint("pelvis"), :2]) @ ahead
    assert sign * way_m[np.argmax(np.abs(way_m))] > 0.3
