"""Proportions of a body: bone vectors at rest, from its height alone."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from mmweaver.core.errors import InputError
from mmweaver.core.skeleton import NUM_JOINTS, joint

ALLOWED_M = (0.78, 2.2)
RECORDED_M = (1.2, 2.2)  # of recorded people, whose size determines the unit of a file

# Fractions of the height, in the body's own frame: x forward, y to its left, z up; arms hang, feet point forward.
# Segment lengths after Drillis and Contini (Winter, Biomechanics and Motor Control, 2009), spine split as SMPL does.
_MIDDLE = {
    "spine1": (-0.008, 0.0, 0.060),
    "spine2": (-0.004, 0.0, 0.078),
    "spine3": (0.004, 0.0, 0.032),
    "neck": (-0.006, 0.0, 0.118),
    "head": (0.016, 0.0, 0.052),
}
_LEFT = {
    "hip": (0.0, 0.046, -0.045),
    "knee": (0.0, 0.0, -0.237),
    "ankle": (0.0, 0.0, -0.237),
    "foot": (0.075, 0.0, -0.034),
    "collar": (0.0, 0.042, 0.066),
    "shoulder": (-0.004, 0.066, 0.014),
    "elbow": (0.0, 0.0, -0.160),
    "wrist": (0.0, 0.0, -0.150),
}
ANKLE_HEIGHT = 0.046
HEEL_BEHIND_ANKLE = 0.026
MOUTH_FROM_HEAD = (0.058, 0.0, -0.004)


@dataclass(frozen=True)
class SkeletonProportions:
    """Bone vectors of one person in metres, in the body's own frame (x forward, y left, z up).

    Raises:
        InputError: If the height is outside `ALLOWED_M`.
    """

    height_m: float

    def __post_init__(self) -> None:
        low, high = ALLOWED_M
        if not low <= self.height_m <= high:
            raise InputError(f"a body height of {self.height_m:g} m is outside {low:g} to {high:g} m; choose another")

    @cached_property
    def offset_m(self) -> np.ndarray:
        """Offset of each joint from its parent at rest, (22, 3) in metres; of the pelvis from the floor."""
        offsets = np.zeros((NUM_JOINTS, 3))
        for name, place in _MIDDLE.items():
            offsets[joint(name)] = place
        for name, (x, y, z) in _LEFT.items():
            offsets[joint(f"left_{name}")] = (x, y, z)
            offsets[joint(f"right_{name}")] = (x, -y, z)
        leg = -(_LEFT["hip"][2] + _LEFT["knee"][2] + _LEFT["ankle"][2])
        offsets[joint("pelvis")] = (0.0, 0.0, leg + ANKLE_HEIGHT)
        return offsets * self.height_m

    @cached_property
    def thigh_m(self) -> float:
        return float(-self.offset_m[joint("left_knee"), 2])

    @cached_property
    def shank_m(self) -> float:
        return float(-self.offset_m[joint("left_ankle"), 2])

    @property
    def leg_m(self) -> float:
        """Hip to ankle of the straight leg, in metres."""
        return self.thigh_m + self.shank_m

    @cached_property
    def upper_arm_m(self) -> float:
        return float(-self.offset_m[joint("left_elbow"), 2])

    @cached_property
    def forearm_m(self) -> float:
        return float(-self.offset_m[joint("left_wrist"), 2])

    @property
    def hip_below_pelvis_m(self) -> float:
        return float(-self.offset_m[joint("left_hip"), 2])

    @property
    def ankle_height_m(self) -> float:
        return ANKLE_HEIGHT * self.height_m

    @property
    def heel_m(self) -> float:
        """Distance from the ankle back to the heel, along the sole, in metres."""
        return HEEL_BEHIND_ANKLE * self.height_m

    @property
    def ball_m(self) -> float:
        """Distance from the ankle forward to the ball of the foot, along the sole, in metres."""
        return float(self.offset_m[joint("left_foot"), 0])

    @cached_property
    def mouth_m(self) -> np.ndarray:
        """Offset of the mouth from the head joint in the head's frame, (3,) in metres."""
        return np.array(MOUTH_FROM_HEAD) * self.height_m

    def pelvis_height_m(self, stretch: float) -> float:
        """Height of the pelvis above the floor in metres.

        Args:
            stretch: Extension of the legs as a share of their length.
        """
        return self.ankle_height_m + self.leg_m * stretch + self.hip_below_pelvis_m
