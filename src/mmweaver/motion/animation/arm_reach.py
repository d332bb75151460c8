"""Arm angles that put a wrist at a given position: two-bone inverse kinematics in the chest's frame."""

from collections.abc import Sequence

import numpy as np
from jaxtyping import Float

from mmweaver.core.skeleton import joint
from mmweaver.motion.animation.controls import LEFT
from mmweaver.motion.animation.kinematics import collar_frame, rotated
from mmweaver.motion.animation.profiles import cap
from mmweaver.motion.animation.skeleton_proportions import SkeletonProportions

Array = np.ndarray


def reach(
    body: SkeletonProportions, target_m: Float[Array, "n 3"], elbow: Sequence[float] = (-0.3, 0.5, -1.0)
) -> Float[Array, "n 4"]:
    """Arm angles that bring a wrist to a position; a target out of reach is approached as far as the arm extends.

    Args:
        body: Bone lengths.
        target_m: Position of the wrist (n, 3) in metres from spine3 in the chest's frame, y outward (left for the left
            arm, right for the right one), so that one target serves both arms.
        elbow: Direction in which the elbow points, in the same axes.

    Returns:
        Flexion, abduction, twist and elbow flexion (n, 4) in radians.
    """
    angles = np.zeros((len(target_m), 4))
    collar = body.offset_m[joint("left_collar")]
    rest = body.offset_m[joint("left_shoulder")]
    for _ in range(4):  # the shoulder rises with the arm: iterate to a fixed point
        shoulder = collar + rotated(collar_frame(angles, LEFT), rest)
        angles = _angles(body, target_m - shoulder, np.array(elbow))
    return angles


def _angles(body: SkeletonProportions, away: Float[Array, "n 3"], elbow: Array) -> Float[Array, "n 4"]:
    upper, fore = body.upper_arm_m, body.forearm_m
    distance = np.linalg.norm(away, axis=1)
    direction = away / distance[:, None]
    length = cap(distance, 0.985 * (upper + fore), 0.03)
    along = (upper**2 - fore**2 + length**2) / (2 * length)
    aside = np.sqrt(np.maximum(upper**2 - along**2, 1e-8))
    square = elbow - (direction @ elbow)[:, None] * direction
    square /= np.linalg.norm(square, axis=1, keepdims=True)
    to_elbow = (along[:, None] * direction + aside[:, None] * square) / upper
    to_wrist = (length[:, None] * direction - upper * to_elbow) / fore
    bend = np.arccos(np.clip(np.sum(to_elbow * to_wrist, axis=1), -1.0, 1.0))
    x = to_wrist - np.sum(to_wrist * to_elbow, axis=1, keepdims=True) * to_elbow
    x /= np.linalg.norm(x, axis=1, keepdims=True)
    z = -to_elbow
    y = np.cross(z, x)
    flexion = -np.arctan2(z[:, 0], z[:, 2])
    abduction = np.arcsin(np.clip(-z[:, 1], -1.0, 1.0))
    twist = np.arctan2(x[:, 1], y[:, 1])
    return np.stack([np.unwrap(flexion), abduction, np.unwrap(twist), bend], axis=1)
