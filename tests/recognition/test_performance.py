"""How people perform: single gestures brisk and wide by people who hold still, standing people still, others sway."""

from dataclasses import replace

import numpy as np
import pytest

from mmweaver.core.seeding import stream
from mmweaver.core.skeleton import joint
from mmweaver.recognition.performance import PerformancePrior, perform, performer, task_variation
from mmweaver.recognition.task_file import Mount
from mmweaver.recognition.train_pose import POSE_PRIOR

PRIOR = PerformancePrior()


def speeds_mps(sentence: str, part: str, *, once: bool) -> list[float]:
    """Greatest horizontal speed of a joint of some people."""
    found = []
    for index in range(8):
        who = performer(PRIOR, task_variation(Mount()), index, 0)
        did = perform(who, PRIOR, sentence, seconds=4.0, once=once, rng=stream(0, "performance", index))
        place_m, time_s = did.pose.joints_m[:, joint(part), :2], did.pose.time_s
        inside = (time_s >= 0) & (time_s <= did.lasts_s)
        found.append(float(np.linalg.norm(np.gradient(place_m[inside], time_s[inside], axis=0), axis=1).max()))
    return found


@pytest.mark.parametrize(
    ("sentence", "once", "calm"),
    [("a person stands", False, True), ("a person claps", False, False), ("a person claps", True, True)],
)
def test_who_holds_still_sways_little(sentence: str, once: bool, calm: bool):
    fastest = max(speeds_mps(sentence, "pelvis", once=once))
    assert (fastest < 0.15) == calm


def test_a_gesture_done_once_is_brisk():
    assert np.median(speeds_mps("a person pushes the right hand forward", "right_wrist", once=True)) > 1.2


def test_the_feet_of_pose_networks_people_are_farther_apart():
    found = []
    for wider_m in (0.0, 0.3):
        prior = replace(POSE_PRIOR, wider_m=(wider_m, wider_m))
        who = performer(prior, task_variation(Mount()), 3, 0)
        did = perform(who, prior, "a person raises both arms", seconds=4.0, once=False, rng=stream(0, "performance"))
        apart_m = did.pose.joints_m[:, joint("left_ankle")] - did.pose.joints_m[:, joint("right_ankle")]
        found.append(np.linalg.norm(apart_m[:, :2], axis=-1))
    np.testing.assert_allclose(found[1] - found[0], 0.3, atol=0.03)
    assert PRIOR.wider_m == (0.0, 0.0)
