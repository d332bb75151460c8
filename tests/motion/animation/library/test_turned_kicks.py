"""Roundhouse and side kicks: which leg, which way round, how high, and where the other foot stays."""

import numpy as np
import pytest

from mmweaver.core.skeleton import joint
from mmweaver.motion.empty_floor import act_out


def _kick(text: str, side: str, seed: int) -> tuple[np.ndarray, np.ndarray, float]:
    """The kicking ankle (n, 3) ahead, outward and up of where it stands; the other one's way; how far the hips turn."""
    joints = act_out(f"a person {text} with the {side} leg", seed=seed, height_m=1.75).pose.joints_m.astype(float)
    across = (joints[:, joint("left_hip")] - joints[:, joint("right_hip")])[:, :2]
    left = across[0] / np.hypot(*across[0])
    out = np.append(left * (1 if side == "left" else -1), 0.0)
    ahead = np.cross(np.append(left, 0.0), [0.0, 0.0, 1.0])
    frame = np.stack([ahead, out, [0.0, 0.0, 1.0]])
    ankle = joints[:, joint(f"{side}_ankle")]
    other = joints[:, joint("right_ankle" if side == "left" else "left_ankle")]
    turn = np.unwrap(np.arctan2(across[:, 1], across[:, 0]))
    away = (turn - turn[0]) * (-1 if side == "left" else 1)
    return (ankle - ankle[0]) @ frame.T, np.linalg.norm(other - other[0], axis=1), float(away.max())


@pytest.mark.parametrize("side", ["left", "right"])
def test_a_roundhouse_comes_from_the_side_and_the_body_turns_with_it(side: str):
    for seed in range(3):
        foot, other_m, turn_rad = _kick("does a roundhouse kick", side, seed)
        hit = np.argmax(foot[:, 0])
        assert foot[hit, 0] > 0.5
        assert foot[hit, 2] > 0.5
        assert foot[:hit, 1].max() > 0.3
        assert np.degrees(turn_rad) > 55
        assert other_m.max() < 0.04
        assert np.linalg.norm(foot[-1]) < 0.05


@pytest.mark.parametrize("side", ["left", "right"])
def test_a_side_kick_goes_out_to_its_own_side(side: str):
    foot, other_m, _ = _kick("does a side kick", side, 0)
    hit = np.argmax(foot[:, 1])
    assert foot[hit, 1] > 0.5
    assert foot[hit, 2] > 0.4
    assert other_m.max() < 0.04
