"""Arms that are held out: where they point while the person stands or walks."""

import numpy as np
import pytest

from mmweaver.core.skeleton import joint
from mmweaver.motion.empty_floor import act_out


def ahead_and_aside_m(text: str) -> tuple[float, float]:
    """How far the left wrist is ahead of and beside the left shoulder in the middle of a motion."""
    joints = act_out(f"a person {text}", seed=3).pose.joints_m.astype(float)
    joints = joints[int(0.55 * len(joints))]
    away = (joints[joint("left_wrist")] - joints[joint("left_shoulder")])[:2]
    left = (joints[joint("left_hip")] - joints[joint("right_hip")])[:2]
    left /= np.hypot(*left)
    return float(away @ [left[1], -left[0]]), float(away @ left)


@pytest.mark.parametrize(
    ("text", "is_ahead"),
    [
        ("walks forward with the arms out to the sides", False),
        ("walks with the arms stretched out in front of him", True),
        ("holds the arms out to the sides", False),
        ("holds the arms out in front", True),
    ],
)
def test_arms_are_held_out_where_the_sentence_says_whichever_way_the_walk_goes(text: str, is_ahead: bool) -> None:
    ahead_m, aside_m = ahead_and_aside_m(text)
    assert (ahead_m > 0.3) == is_ahead
    assert (aside_m > 0.3) != is_ahead
