"""Resampling of a motion by cubic splines through the joints."""

from dataclasses import replace

import numpy as np

from mmweaver.core.errors import InputError
from mmweaver.core.records import PoseSequence
from mmweaver.core.shapes import Joints, PerFrame


def resample(pose: PoseSequence, time_s: PerFrame) -> PoseSequence:
    """Resamples a motion by cubic interpolation, for radar frames or chirps.

    Args:
        pose: The motion.
        time_s: Times (frame,) in seconds.

    Returns:
        The motion at these times.

    Raises:
        InputError: If a time is outside the motion, which is never extrapolated.
    """
    from scipy.interpolate import CubicSpline

    first, last = float(pose.time_s[0]), float(pose.time_s[-1])
    if len(time_s) and (time_s.min() < first - 1e-9 or time_s.max() > last + 1e-9):
        raise InputError(
            f"the motion lasts from {first:.3f} to {last:.3f} s, times from {time_s.min():.3f} to {time_s.max():.3f} s"
            " were requested; make the motion longer"
        )
    joints = np.asarray(CubicSpline(pose.time_s, pose.joints_m, axis=0)(time_s), dtype=float)
    return replace(pose, time_s=time_s, joints_m=joints)


def joints_and_velocities(pose: PoseSequence, time_s: PerFrame) -> tuple[Joints, Joints]:
    """Joints and their velocities by cubic interpolation; times are clamped to the motion.

    Args:
        pose: The motion.
        time_s: Times (time,) in seconds.

    Returns:
        Joints in metres and velocities in m/s, float32, (time, 22, 3) each.
    """
    from scipy.interpolate import CubicSpline

    spline = CubicSpline(pose.time_s, pose.joints_m, axis=0)
    time_s = np.clip(time_s, pose.time_s[0], pose.time_s[-1])
    return spline(time_s).astype(np.float32), spline(time_s, 1).astype(np.float32)
