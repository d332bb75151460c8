"""Constant bone lengths: the decoder predicts joints independently, so that bones stretch by per cents between frames.

A radar would observe the stretching as motion.
"""

import numpy as np
from jaxtyping import Float

from mmweaver.core.skeleton import PARENTS


def fix_bone_lengths(joints: Float[np.ndarray, "frame 22 3"]) -> Float[np.ndarray, "frame 22 3"]:
    """Rescales each bone to its median length, with unchanged directions.

    The pelvis keeps its position on the floor, the lower foot its height.

    Args:
        joints: Joints in metres, z up, (frame, 22, 3).

    Returns:
        Joints (frame, 22, 3) with constant bone lengths.
    """
    steady = joints.copy()
    for child, parent in enumerate(PARENTS):
        if parent >= 0:
            bone = joints[:, child] - joints[:, parent]
            length = np.linalg.norm(bone, axis=-1, keepdims=True)
            steady[:, child] = steady[:, parent] + bone * (np.median(length) / np.maximum(length, 1e-9))
    sunk = steady[..., 2].min(axis=1) - joints[..., 2].min(axis=1)
    steady[..., 2] -= sunk[:, None]
    return steady
