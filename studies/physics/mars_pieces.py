"""Pieces of MARS's recordings to simulate: equally long, within the published box, with a motion and a height."""

from dataclasses import fields, replace
from typing import TypeVar

import numpy as np

from mmweaver.core.records import PointCloud, PoseSequence
from mmweaver.core.skeleton import JOINT_NAMES
from studies.physics.mars_data import FRAME_S, MarsStretch

# The published clouds end sharply here (validate: 868 points in the highest 10 cm below 1 m, none above): whoever made
# them cut away what lies beyond, mostly second azimuth peaks with absurd heights.
ASIDE_M, UP_M, AHEAD_M = 1.0, 1.0, 3.0
CROWN_OVER_HEAD_M = 0.11  # the Kinect's head is the middle of the head
Cloud = TypeVar("Cloud", bound=PointCloud)


def pose_of(stretch: MarsStretch, shift_m: tuple[float, float, float], height_m: float) -> PoseSequence:
    """The joints as a motion in the radar's frame, `shift_m` from the Kinect's."""
    joints = stretch.joints_m + np.asarray(shift_m)
    return PoseSequence(time_s=stretch.frame * FRAME_S, joints_m=joints, height_m=height_m)


def as_published(cloud: Cloud) -> Cloud:
    """Points within the box of the published recordings: |x| and |z| up to 1 m, y up to 3 m."""
    kept = (np.abs(cloud.x_m) <= ASIDE_M) & (np.abs(cloud.z_m) <= UP_M) & (cloud.y_m <= AHEAD_M)
    return type(cloud)(**{field.name: getattr(cloud, field.name)[kept] for field in fields(cloud)})


def cut(stretches: list[MarsStretch], length: int, most: int) -> list[MarsStretch]:
    """Up to `most` pieces of `length` consecutive frames, spread evenly."""
    pieces = []
    for stretch in stretches:
        for first in range(0, int(stretch.frame[-1]) - length + 2, length):
            chosen = np.flatnonzero((stretch.frame >= first) & (stretch.frame < first + length))
            # it begins and ends with a measured pose, so that nothing is extrapolated
            if (
                len(chosen) > length // 2
                and stretch.frame[chosen[0]] == first
                and stretch.frame[chosen[-1]] == first + length - 1
            ):
                pieces.append(
                    replace(
                        stretch,
                        frame=stretch.frame[chosen] - first,
                        joints_m=stretch.joints_m[chosen],
                        clouds=tuple(stretch.clouds[index] for index in chosen),
                    )
                )
    step = max(len(pieces) / most, 1.0)
    return [pieces[int(at * step)] for at in range(min(most, len(pieces)))]


def body_height_m(stretches: list[MarsStretch]) -> float:
    """Height of the person: the 90 % quantile of head over feet, and the crown above it."""
    joints = np.concatenate([stretch.joints_m for stretch in stretches])
    head, neck = JOINT_NAMES.index("head"), JOINT_NAMES.index("neck")
    feet = [JOINT_NAMES.index("left_foot"), JOINT_NAMES.index("right_foot")]
    middle_of_head = joints[:, neck, 2] + (joints[:, head, 2] - joints[:, neck, 2]) / 0.75
    return float(np.quantile(middle_of_head - joints[:, feet, 2].mean(axis=1), 0.9)) + CROWN_OVER_HEAD_M
