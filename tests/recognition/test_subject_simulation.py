"""How people perform: single gestures brisk and wide by people who hold still, standing people still, others sway."""

import numpy as np
import pytest

from mmweaver.core.seeding import stream
from mmweaver.core.skeleton import joint
from mmweaver.recognition.subject_simulation import (
    Performance,
    PerformancePrior,
    perform,
    performer,
    spread_feet,
    task_variation,
)
from mmweaver.recognition.task_file import Mount

PRIOR = PerformancePrior()


def performance(sentence: str, index: int, seconds: float, *, once: bool = False) -> Performance:
    who = performer(PRIOR, task_variation(Mount()), index, 0)
    return perform(who, PRIOR, sentence, seconds=seconds, once=once, rng=stream(0, "performance", index))


def speeds_mps(sentence: str, part: str, *, once: bool) -> list[float]:
    """Greatest horizontal speed of a joint of some people."""
    found = []
    for index in range(8):
        did = performance(sentence, index, 4.0, once=once)
        place_m, time_s = did.pose.joints_m[:, joint(part), :2], did.pose.time_s
        inside = (time_s >= 0) & (time_s <= did.lasts_s)
        found.append(float(np.linalg.norm(np.gradient(place_m[inside], time_s[inside], axis=0), axis=1).max()))
    return found


@pytest.mark.parametrize(
    ("sentence", "once", "between_mps"),
    [
        ("a person stands", False, (0.02, 0.3)),
        ("a person claps", False, (0.15, 1.0)),
        ("a person claps", True, (0.0, 0.15)),
    ],
)
def test_who_holds_still_sways_little(sentence: str, once: bool, between_mps: tuple[float, float]):
    """Less for a gesture than to stay in a posture, and less for that than for what goes on on the spot."""
    fastest = max(speeds_mps(sentence, "pelvis", once=once))
    assert between_mps[0] < fastest < between_mps[1]


@pytest.mark.parametrize("sentence", ["a person falls", "a person sits down on a chair"])
def test_what_happens_once_is_in_every_sequence(sentence: str):
    """Whoever falls stands first and lies at the end, in people of any tempo."""
    for index in range(6):
        did = performance(sentence, index, 6.0)
        assert did.lasts_s == 6.0
        assert did.pose.time_s[-1] > 6.0
        height_m = np.interp([0.0, 0.1, 6.0], did.pose.time_s, did.pose.joints_m[:, joint("pelvis"), 2])
        assert height_m[1] == pytest.approx(height_m[0], abs=0.02)
        assert height_m[2] < height_m[0] - 0.15


def test_what_is_counted_goes_on():
    """Three jumps are not all of it: people who "jump repeatedly" jump in the last second, too."""
    for index in range(6):
        did = performance("a person jumps repeatedly", index, 4.0)
        last = (did.pose.time_s > 2.3) & (did.pose.time_s <= 4.0)
        assert np.ptp(did.pose.joints_m[last, joint("pelvis"), 2]) > 0.05


def test_a_gesture_done_once_is_brisk():
    assert np.median(speeds_mps("a person pushes the right hand forward", "right_wrist", once=True)) > 1.2


def drawn_stance(apart_m: float) -> np.ndarray:
    """Joints (1, 22, 3) of somebody who faces the radar, with the ankles this far apart on the floor."""
    joints_m = np.zeros((1, 22, 3))
    joints_m[0, :, 2] = 1.0
    for side, sign in (("left", 0.5), ("right", -0.5)):
        joints_m[0, joint(f"{side}_hip")] = (0.2 * sign, 2.0, 0.9)
        for part, height in (("knee", 0.5), ("ankle", 0.08), ("foot", 0.02)):
            joints_m[0, joint(f"{side}_{part}")] = (apart_m * sign, 2.0, height)
    return joints_m


def test_legs_that_are_apart_already_are_not_spread():
    np.testing.assert_array_equal(spread_feet(drawn_stance(0.6), 0.2), drawn_stance(0.6))


def test_the_body_is_over_the_foot_that_stands():
    both = np.repeat(drawn_stance(0.2), 2, axis=0)
    both[1, [joint("left_ankle"), joint("left_foot")], 2] += 0.3
    wider = spread_feet(both, 0.2)
    standing = wider[:, joint("right_ankle"), 0] - wider[:, joint("pelvis"), 0]
    np.testing.assert_allclose(standing - both[:, joint("right_ankle"), 0], (-0.1, 0.0), atol=1e-9)
    np.testing.assert_allclose(wider[:, joint("right_ankle")], wider[:1, joint("right_ankle")].repeat(2, 0))
