"""Bones of one length: a decoder gives every joint by itself, so that bones stretch by per cents between frames.

A radar would see the stretching as movement.
"""

import numpy as np
from jaxtyping import Float

from mmweaver.core.skeleton import PARENTS


def with_constant_bone_lengths(joints: Float[np.ndarray, "frame 22 3"]) -> Float[np.ndarray, "frame 22 3"]:
    """The same directions of all bones, each of its median length; the pelvis stays where it is, and so does the height
    of the lower foot over the floor."""
    steady = joints.copy()
    for child, parent in enumerate(PARENTS):
        if parent >= 0:
            bone = joints[:, child] - joints[:, parent]
            length = np.linalg.norm(bone, axis=-1, keepdims=True)
            steady[:, child] = steady[:, parent] + bone * (np.median(length) / np.maximum(length, 1e-9))
    sunk = steady[..., 2].min(axis=1) - joints[..., 2].min(axis=1)
    steady[..., 2] -= sunk[:, None]
    return steady
