"""The 22-joint skeleton in SMPL order (Loper et al. 2015; HumanML3D uses the same 22 joints)."""

JOINT_NAMES = (
    "pelvis",
    "left_hip",
    "right_hip",
    "spine1",
    "left_knee",
    "right_knee",
    "spine2",
    "left_ankle",
    "right_ankle",
    "spine3",
    "left_foot",
    "right_foot",
    "neck",
    "left_collar",
    "right_collar",
    "head",
    "left_shoulder",
    "right_shoulder",
    "left_elbow",
    "right_elbow",
    "left_wrist",
    "right_wrist",
)
NUM_JOINTS = len(JOINT_NAMES)
PARENTS = (-1, 0, 0, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 9, 9, 12, 13, 14, 16, 17, 18, 19)
BONES = tuple((parent, child) for child, parent in enumerate(PARENTS) if parent >= 0)


def joint(name: str) -> int:
    """Index of a joint.

    Args:
        name: Name in `JOINT_NAMES`.

    Returns:
        Index from 0 to 21.

    >>> joint("left_wrist")
    20
    """
    return JOINT_NAMES.index(name)
