"""From HumanML3D's 263 features per frame to 22 joints (y up, metres, 20 frames per second).

| columns | what |
|---|---|
| 0 | rotation of the root to the next frame, half the angle in radians |
| 1:3 | displacement of the root to the next frame on the floor (x, z), in the root's frame |
| 3 | height of the root |
| 4:67 | joints 1 to 21 relative to the ground point under the root, in the root's frame |
| 67:193 | rotations of joints 1 to 21, the first two columns of their matrices |
| 193:259 | displacement of the 22 joints to the next frame, in the root's frame |
| 259:263 | foot contact of left ankle, left foot, right ankle, right foot |

Joints are recovered from features exactly.

Reference: Guo et al., Generating Diverse and Natural 3D Human Motions from Text, CVPR 2022 (its data format).
"""

import numpy as np
from jaxtyping import Float

from mmweaver.core.skeleton import NUM_JOINTS

Array = np.ndarray
FPS = 20.0
NUM_FEATURES = 263
ROTATIONS, VELOCITIES, CONTACTS = slice(67, 193), slice(193, 259), slice(259, 263)


def joints_from_features(features: Float[Array, "frame 263"]) -> Float[Array, "frame 22 3"]:
    """Recovers joints from HumanML3D features; the root starts at (0, y, 0) and faces +z.

    Args:
        features: Features (frame, 263), not normalised.

    Returns:
        Joints (frame, 22, 3) in metres, y up.
    """
    features = np.asarray(features, float)
    half = np.concatenate([[0.0], np.cumsum(features[:-1, 0])])
    shift = np.zeros((len(features), 3))
    shift[1:, 0], shift[1:, 2] = features[:-1, 1], features[:-1, 2]
    root = np.cumsum(rotated_about_y(shift, -half), axis=0)
    local = features[:, 4:67].reshape(-1, NUM_JOINTS - 1, 3)
    joints = np.empty((len(features), NUM_JOINTS, 3))
    joints[:, 1:] = rotated_about_y(local, -half[:, None])
    joints[:, 1:, 0] += root[:, None, 0]
    joints[:, 1:, 2] += root[:, None, 2]
    joints[:, 0] = root
    joints[:, 0, 1] = features[:, 3]
    return joints


def rotated_about_y(vectors: Float[Array, "*shape 3"], half_rad: Float[Array, "..."]) -> Float[Array, "*shape 3"]:
    """Rotates vectors about y.

    Args:
        vectors: Vectors (..., 3).
        half_rad: Half the angle in radians, broadcast against the vectors.

    Returns:
        Rotated vectors (..., 3).
    """
    cos, sin = np.cos(2 * half_rad), np.sin(2 * half_rad)
    x, y, z = (vectors[..., axis] for axis in range(3))
    return np.stack([cos * x + sin * z, y, cos * z - sin * x], axis=-1)
