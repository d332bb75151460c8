"""What a sentence shows on an empty floor, as joints from the floor up, and in the frame of the body."""

from functools import cache

import numpy as np
from jaxtyping import Float

from mmweaver.core.skeleton import joint
from mmweaver.motion.empty_floor import RADAR_HEIGHT_M, act_out

HANDS = ["left_wrist", "right_wrist"]


@cache
def acted(text: str, seed: int = 0, seconds: float | None = None) -> Float[np.ndarray, "frame 22 3"]:
    """Joints of a person of 1.75 m, z from the floor, without the samples before and after the motion."""
    joints_m = act_out(f"a person {text}", duration_s=seconds, seed=seed, height_m=1.75).pose.joints_m[2:-2]
    return joints_m.astype(float) + np.array([0.0, 0.0, RADAR_HEIGHT_M])


def axes(joints_m: Float[np.ndarray, "frame 22 3"]) -> Float[np.ndarray, "3 3"]:
    """Unit vectors ahead, to the left and up of the body in the first frame, by its hips."""
    across = (joints_m[0, joint("left_hip")] - joints_m[0, joint("right_hip")])[:2]
    left = np.append(across / np.hypot(*across), 0.0)
    return np.stack([np.cross(left, [0.0, 0.0, 1.0]), left, [0.0, 0.0, 1.0]])


def away(joints_m: Float[np.ndarray, "frame 22 3"], name: str, origin: str = "pelvis") -> Float[np.ndarray, "frame 3"]:
    """A joint ahead, to the left and up of another, in metres."""
    return (joints_m[:, joint(name)] - joints_m[:, joint(origin)]) @ axes(joints_m).T


def times(is_there: np.ndarray) -> int:
    """How often something begins."""
    return int((np.diff(is_there.astype(int)) == 1).sum())


def bend_deg(joints_m: Float[np.ndarray, "frame 22 3"], one: str, middle: str, other: str) -> np.ndarray:
    """Angle (frame,) at a joint between its two bones: 0 where they are in line."""
    a, b = (joints_m[:, joint(name)] - joints_m[:, joint(middle)] for name in (one, other))
    cosine = np.sum(a * b, axis=1) / np.linalg.norm(a, axis=1) / np.linalg.norm(b, axis=1)
    return 180 - np.degrees(np.arccos(cosine))
