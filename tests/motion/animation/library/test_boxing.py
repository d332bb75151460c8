"""Punches by name: which fist, which way, how fast, and that the other one stays in the guard."""

import numpy as np
import pytest

from mmweaver.core.skeleton import joint
from mmweaver.motion.empty_floor import act_out

WRISTS = {side: joint(f"{side}_wrist") for side in ("left", "right")}
FASTEST_MPS2 = 150.0  # of any joint, as in streams; published fists reach 60 to 100


def _in_the_chest(text: str, seed: int = 0) -> tuple[np.ndarray, np.ndarray]:
    """Wrists (n, 2, 3) ahead, to the left and up of spine3, turned with the hips at the start; and joints."""
    joints = act_out(text, seed=seed, height_m=1.75).pose.joints_m[2:-2].astype(float)
    across = (joints[0, joint("left_hip")] - joints[0, joint("right_hip")])[:2]
    left = np.append(across / np.hypot(*across), 0.0)
    frame = np.stack([np.cross(left, [0.0, 0.0, 1.0]), left, [0.0, 0.0, 1.0]])
    hands = joints[:, list(WRISTS.values())] - joints[:, None, joint("spine3")]
    return hands @ frame.T, joints


@pytest.mark.parametrize("name", ["jab", "cross", "hook", "uppercut"])
def test_the_named_fist_hits_ahead_and_comes_back_while_the_other_stays(name: str):
    for side, acting in (("left", 0), ("right", 1)):
        hands, _ = _in_the_chest(f"a person throws a {side} {name}")
        gone = np.linalg.norm(hands - hands[0], axis=2).max(axis=0)
        assert gone[acting] > 0.15
        assert hands[:, acting, 0].max() > 0.33
        assert gone[1 - acting] < gone[acting]
        assert np.linalg.norm(hands[-1, acting] - hands[0, acting]) < 0.08


def test_a_hook_goes_around_and_an_uppercut_comes_from_below():
    jab, _ = _in_the_chest("a person throws a left jab")
    hook, _ = _in_the_chest("a person throws a left hook")
    uppercut, _ = _in_the_chest("a person throws a right uppercut")
    assert np.ptp(hook[:, 0, 1]) > np.ptp(jab[:, 0, 1]) + 0.05
    assert uppercut[:, 1, 2].min() < uppercut[0, 1, 2] - 0.12


def test_the_hand_in_front_jabs_and_hooks_and_the_other_one_crosses():
    for name, acting in (("jab", 0), ("cross", 1), ("hook", 0)):
        hands, _ = _in_the_chest(f"a boxer throws a {name}")
        gone = np.linalg.norm(hands - hands[0], axis=2).max(axis=0)
        assert gone[acting] > gone[1 - acting]


@pytest.mark.parametrize("text", ["throws a jab, a cross, a hook and an uppercut", "punches quickly"])
def test_fists_are_as_fast_as_fists(text: str):
    for seed in range(4):
        _, joints = _in_the_chest(f"a person {text}", seed)
        speed = np.linalg.norm(np.diff(joints, axis=0), axis=-1) * 120
        acceleration = np.linalg.norm(np.diff(joints, 2, axis=0), axis=-1) * 120**2
        assert 2.5 < speed[:, list(WRISTS.values())].max() < 9.0
        assert acceleration.max() < FASTEST_MPS2
