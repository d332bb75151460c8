"""From 22 joints to HumanML3D's 263 features per frame, the inverse of `mmweaver.motion.mocap.joint_arrays`.

Features need the next frame, so `n` frames of joints give `n - 1` of features.

Reference: Guo et al., Generating Diverse and Natural 3D Human Motions from Text, CVPR 2022 (its data format).
"""

import itertools

import numpy as np
from jaxtyping import Float

from mmweaver.core.errors import InputError
from mmweaver.core.skeleton import NUM_JOINTS, joint
from mmweaver.motion.mocap.joint_arrays import CONTACTS, NUM_FEATURES, ROTATIONS, VELOCITIES, rotated_about_y

Array = np.ndarray
CHAINS = ((0, 2, 5, 8, 11), (0, 1, 4, 7, 10), (0, 3, 6, 9, 12, 15), (9, 14, 17, 19, 21), (9, 13, 16, 18, 20))
# Direction of each joint from its parent in the rest pose: x to the left, y up, z ahead.
REST = np.array([
    (0, 0, 0), (1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0), (0, -1, 0), (0, 1, 0), (0, -1, 0), (0, -1, 0), (0, 1, 0),
    (0, 0, 1), (0, 0, 1), (0, 1, 0), (1, 0, 0), (-1, 0, 0), (0, 0, 1), (0, -1, 0), (0, -1, 0), (0, -1, 0), (0, -1, 0),
    (0, -1, 0), (0, -1, 0),
], float)  # fmt: skip
SMOOTHED_FRAMES = 20.0  # standard deviation of the Gaussian that smooths the root's heading
CONTACT_M2 = 0.002  # squared displacement to the next frame below which a foot is in contact
FEET = ("left_ankle", "left_foot", "right_ankle", "right_foot")


def features_from_joints(joints: Float[Array, "frame 22 3"]) -> Float[Array, "frame_less_one 263"]:
    """Features of joints in metres, y up, at 20 frames a second; first moved to the floor, the origin and facing +z.

    The body is kept as it is; HumanML3D itself first moves every recording onto one skeleton.
    """
    if len(joints) < 2:
        raise InputError("features need at least two frames of joints")
    joints = _facing_z(np.asarray(joints, float))
    half = -0.5 * np.unwrap(_heading_rad(joints))
    half[0] = 0.0  # by definition of the format, the first frame is not rotated
    steps = np.diff(joints, axis=0)
    local = joints - joints[:, :1] * np.array([1.0, 0.0, 1.0])
    local = rotated_about_y(local, half[:, None])
    features = np.empty((len(joints) - 1, NUM_FEATURES))
    features[:, 0] = np.arcsin(np.sin(np.diff(half)))
    features[:, 1:3] = rotated_about_y(steps[:, 0], half[1:])[:, [0, 2]]
    features[:, 3] = joints[:-1, 0, 1]
    features[:, 4:67] = local[:-1, 1:].reshape(len(steps), -1)
    features[:, ROTATIONS] = _rotations(joints, half)[:-1].reshape(len(steps), -1)
    features[:, VELOCITIES] = rotated_about_y(steps, half[:-1, None]).reshape(len(steps), -1)
    feet = steps[:, [joint(name) for name in FEET]]
    features[:, CONTACTS] = np.sum(feet**2, axis=-1) < CONTACT_M2
    return features


def y_up(joints_m: Float[Array, "frame 22 3"]) -> Float[Array, "frame 22 3"]:
    """Our z-up joints in HumanML3D's axes: x stays, height is y."""
    return np.stack([joints_m[..., 0], joints_m[..., 2], -joints_m[..., 1]], axis=-1)


def _facing_z(joints: Float[Array, "frame 22 3"]) -> Float[Array, "frame 22 3"]:
    """Moves the lowest joint of all frames to 0 and the first root over the origin, the first frame facing +z."""
    joints = joints - np.array([joints[0, 0, 0], joints[..., 1].min(), joints[0, 0, 2]])
    across = joints[0, 2] - joints[0, 1] + joints[0, 17] - joints[0, 16]  # to the right
    ahead = np.cross([0.0, 1.0, 0.0], across)
    return rotated_about_y(joints, np.full(joints.shape[:2], -0.5 * np.arctan2(ahead[0], ahead[2])))


def _heading_rad(joints: Float[Array, "frame 22 3"]) -> Float[Array, " frame"]:
    """Smoothed heading from z towards x. The hips enter with exchanged sides, as in the published features, which are
    reproduced only so."""
    from scipy.ndimage import gaussian_filter1d

    across = joints[:, 1] - joints[:, 2] + joints[:, 17] - joints[:, 16]
    across = across / np.maximum(np.linalg.norm(across, axis=-1, keepdims=True), 1e-12)
    ahead = np.cross([0.0, 1.0, 0.0], across)
    ahead = gaussian_filter1d(ahead, SMOOTHED_FRAMES, axis=0, mode="nearest")
    return np.arctan2(ahead[:, 0], ahead[:, 2])


def _rotations(joints: Float[Array, "frame 22 3"], half: Float[Array, " frame"]) -> Float[Array, "frame 21 6"]:
    """Shortest rotations (first two matrix columns) from the rest pose, each relative to its parent bone; the chains of
    the arms start again from the root."""
    zero = np.zeros_like(half)
    root = np.stack([np.cos(half), zero, np.sin(half), zero], axis=-1)
    result = np.zeros((len(joints), NUM_JOINTS - 1, 6))
    for chain in CHAINS:
        above = root
        for parent, child in itertools.pairwise(chain):
            bone = joints[:, child] - joints[:, parent]
            bone = bone / np.maximum(np.linalg.norm(bone, axis=-1, keepdims=True), 1e-12)
            own = _times(above * np.array([1.0, -1.0, -1.0, -1.0]), _between(REST[child], bone))
            result[:, child - 1] = _two_columns(own)
            above = _times(above, own)
    return result


def _between(start: Float[Array, "3"], ends: Float[Array, "frame 3"]) -> Float[Array, "frame 4"]:
    """Quaternions (w, x, y, z) of the shortest rotations from one unit vector to others."""
    turn = np.concatenate([(1.0 + ends @ start)[:, None], np.cross(start, ends)], axis=-1)
    return turn / np.maximum(np.linalg.norm(turn, axis=-1, keepdims=True), 1e-12)


def _times(one: Float[Array, "frame 4"], other: Float[Array, "frame 4"]) -> Float[Array, "frame 4"]:
    """Quaternion product."""
    w = one[:, :1] * other[:, :1] - np.sum(one[:, 1:] * other[:, 1:], axis=-1, keepdims=True)
    v = one[:, :1] * other[:, 1:] + other[:, :1] * one[:, 1:] + np.cross(one[:, 1:], other[:, 1:])
    return np.concatenate([w, v], axis=-1)


def _two_columns(quaternion: Float[Array, "frame 4"]) -> Float[Array, "frame 6"]:
    """First and second column of the rotation matrix."""
    w, x, y, z = quaternion.T
    first = (1 - 2 * (y * y + z * z), 2 * (x * y + z * w), 2 * (x * z - y * w))
    second = (2 * (x * y - z * w), 1 - 2 * (x * x + z * z), 2 * (y * z + x * w))
    return np.stack([*first, *second], axis=-1)
