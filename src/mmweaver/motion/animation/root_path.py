"""Position and heading of the body's root over time: straight or curved moves and turns, all C2.

Resampling of a motion by cubic splines through the joints.
"""

from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float

from mmweaver.core.errors import InputError
from mmweaver.core.records import PoseSequence
from mmweaver.core.shapes import Joints, PerFrame
from mmweaver.motion.animation.profiles import rise, travel


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


Array = np.ndarray
Times = Float[Array, "*shape"]


@dataclass(frozen=True, kw_only=True)
class Move:
    """A move along an arc (a line if the curvature is 0) at constant speed, with ramps at its ends.

    Attributes:
        start_s: Start in seconds.
        end_s: End in seconds.
        length_m: Length of the path in metres.
        direction_rad: Direction at the start, from +x towards +y.
        ramp_in_s: Time of acceleration; 0 if the person was moving before the start.
        ramp_out_s: Time of deceleration; 0 if the person keeps moving after the end.
        curvature_per_m: Inverse radius, positive to the person's left.
    """

    start_s: float
    end_s: float
    length_m: float
    direction_rad: float
    ramp_in_s: float
    ramp_out_s: float
    curvature_per_m: float = 0.0

    def gone_m(self, time_s: Times) -> Times:
        """Distance covered since the start of the move.

        Args:
            time_s: Times in seconds, any shape.

        Returns:
            Metres, same shape.
        """
        span_s = self.end_s - self.start_s
        u = np.asarray((time_s - self.start_s) / span_s)
        return np.asarray(self.length_m * travel(u, self.ramp_in_s / span_s, self.ramp_out_s / span_s))

    @property
    def speed_mps(self) -> float:
        """Speed between the ramps, in m/s."""
        return self.length_m / (self.end_s - self.start_s - self.ramp_in_s / 2 - self.ramp_out_s / 2)

    def shift_m(self, time_s: Times) -> Float[Array, "*shape 2"]:
        """Displacement since the start of the move.

        Args:
            time_s: Times in seconds, any shape.

        Returns:
            (x, y) in metres, (..., 2).
        """
        return self.shift_after_m(self.gone_m(time_s))

    def shift_after_m(self, gone: Float[Array, "*shape"]) -> Float[Array, "*shape 2"]:
        """Displacement after a distance along the path.

        Args:
            gone: Distance in metres, any shape.

        Returns:
            (x, y) in metres, (..., 2).
        """
        bend = self.curvature_per_m
        ahead = np.sin(bend * gone) / bend if bend else gone
        left = (1 - np.cos(bend * gone)) / bend if bend else np.zeros_like(gone)
        cos, sin = np.cos(self.direction_rad), np.sin(self.direction_rad)
        return np.stack([ahead * cos - left * sin, ahead * sin + left * cos], axis=-1)

    @property
    def end_shift_m(self) -> Float[Array, "2"]:
        """Displacement (x, y) of the whole move."""
        return self.shift_m(np.array([self.end_s]))[0]


@dataclass(frozen=True, kw_only=True)
class Turn:
    """A turn on the spot.

    Attributes:
        start_s: Start in seconds.
        end_s: End in seconds.
        angle_rad: Angle, positive to the person's left.
    """

    start_s: float
    end_s: float
    angle_rad: float


@dataclass(frozen=True, kw_only=True)
class RootPath:
    """Path of the floor point below a person. Frame: x right, y away from the radar.

    Attributes:
        start_m: Start (x, y) in metres.
        heading_rad: Initial heading, from +x towards +y.
        moves: Moves in temporal order.
        turns: Turns on the spot in temporal order.
    """

    start_m: tuple[float, float]
    heading_rad: float
    moves: tuple[Move, ...] = ()
    turns: tuple[Turn, ...] = ()

    def position_m(self, time_s: Times) -> Float[Array, "*shape 2"]:
        """Position of the root.

        Args:
            time_s: Times in seconds, any shape.

        Returns:
            (x, y) in metres, (..., 2).
        """
        position = np.zeros((*np.shape(time_s), 2)) + np.array(self.start_m)
        for move in self.moves:
            position = position + move.shift_m(time_s)
        return position

    def facing_rad(self, time_s: Times) -> Times:
        """Heading of the root.

        Args:
            time_s: Times in seconds, any shape.

        Returns:
            Radians from +x towards +y, same shape.
        """
        heading = np.full(np.shape(time_s), self.heading_rad)
        for turn in self.turns:
            heading = heading + turn.angle_rad * rise((time_s - turn.start_s) / (turn.end_s - turn.start_s))
        for move in self.moves:
            heading = heading + move.curvature_per_m * move.gone_m(time_s)
        return heading

    def speed_mps(self, time_s: Times) -> Times:
        """Speed over the floor, by central differences.

        Args:
            time_s: Times in seconds, any shape.

        Returns:
            m/s, same shape.
        """
        step = 1e-3
        gap = self.position_m(time_s + step) - self.position_m(time_s - step)
        return np.hypot(gap[..., 0], gap[..., 1]) / (2 * step)
