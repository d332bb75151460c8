"""Where a head faces, and a face for it: without one nobody sees in a picture that a head nods, shakes or looks around.

The 22 joints hold no rotation of the head. But the head's joint is a little in front of the neck's, so half of a turn
of the head and half of a nod move it relative to the chest, which gives the whole.
"""

import numpy as np
from jaxtyping import Float

from mmweaver.core.skeleton import joint
from mmweaver.geometry.body_capsules import scale_of

REST_TILT_RAD = float(np.arctan2(0.016, 0.052))  # of the head's joint ahead of the neck's, upright
_MOST_YAW_RAD, _MOST_PITCH_RAD = 1.4, 1.0
# Two capsules of somebody of reference height, in the head's frame (ahead, up from the head's joint), and their radii.
_FACE_M = np.array([[(0.042, 0.015), (0.042, 0.1)], [(0.1, 0.075), (0.135, 0.045)]])
_FACE_RADIUS_M = np.array([(0.066, 0.072), (0.014, 0.02)])
COUNT = len(_FACE_M)  # of the capsules: the face and its nose


def face_capsules(
    joints_m: Float[np.ndarray, "time 22 3"], height_m: float
) -> tuple[Float[np.ndarray, "time 2 2 3"], Float[np.ndarray, "2 2"]]:
    """Ends and radii in metres of the face and of its nose."""
    ahead, up = head_axes(joints_m)
    place_m = _FACE_M * scale_of(height_m)
    head = joints_m[:, None, None, joint("head")]
    ends = head + place_m[..., :1] * ahead[:, None, None] + place_m[..., 1:] * up[:, None, None]
    return ends, _FACE_RADIUS_M * scale_of(height_m)


def head_axes(
    joints_m: Float[np.ndarray, "time 22 3"],
) -> tuple[Float[np.ndarray, "time 3"], Float[np.ndarray, "time 3"]]:
    """Unit vectors to where the head faces and to its crown."""
    left = _unit(joints_m[:, joint("left_collar")] - joints_m[:, joint("right_collar")])
    up = (joints_m[:, joint("left_collar")] + joints_m[:, joint("right_collar")]) / 2 - joints_m[:, joint("spine3")]
    up = _unit(up - (up * left).sum(-1, keepdims=True) * left)
    ahead = np.cross(left, up)
    bone = joints_m[:, joint("head")] - joints_m[:, joint("neck")]
    x, y, z = ((bone * axis).sum(-1) for axis in (ahead, left, up))
    tilt = np.arctan2(np.hypot(x, y), z)
    clear = np.clip(tilt / REST_TILT_RAD, 0.0, 1.0) * (x > 0)  # a head above its neck does not say where it faces
    yaw = np.clip(2.0 * np.arctan2(y, np.maximum(x, 1e-9)) * clear, -_MOST_YAW_RAD, _MOST_YAW_RAD)[:, None]
    signed = np.where(x >= 0, tilt, -tilt)
    pitch = np.clip(2.0 * (signed - REST_TILT_RAD), -_MOST_PITCH_RAD, _MOST_PITCH_RAD)[:, None]
    level = np.cos(yaw) * ahead + np.sin(yaw) * left
    return np.cos(pitch) * level - np.sin(pitch) * up, np.sin(pitch) * level + np.cos(pitch) * up


def _unit(vector: Float[np.ndarray, "time 3"]) -> Float[np.ndarray, "time 3"]:
    return vector / np.maximum(np.linalg.norm(vector, axis=-1, keepdims=True), 1e-9)
