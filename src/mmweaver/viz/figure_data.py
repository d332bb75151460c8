"""FigureData: the data of all pictures, with power maps computed once."""

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from jaxtyping import Bool, Float, Int

from mmweaver.core.aligned_photo import AlignedPhoto
from mmweaver.core.records import PointCloud, PoseSequence, RadarCube
from mmweaver.core.shapes import Array, PerFrame
from mmweaver.core.virtual_array import has_elevation
from mmweaver.signal.cube import remove_static
from mmweaver.signal.doppler_spectrogram import MicroDoppler, micro_doppler_of_cube
from mmweaver.signal.slow_time import MIN_FRAMES, SlowTimeCell, moving_cells, slow_time_doppler, zero_doppler
from mmweaver.signal.spectra import (
    azimuth_axis_rad,
    elevation_axis_rad,
    noise_power,
    range_azimuth_power,
    range_doppler_power,
    range_elevation_power,
)
from mmweaver.signal.windows import MIN_HANN_LOOPS
from mmweaver.viz.theme import PowerScale, evenly_spaced

MAX_FRAMES = 100  # longer sequences are thinned out
SLOW_OVER_NOISE = 10.0  # minimum power of changes between frames over the noise
SLOW_OVER_FAST = 316.0  # and over motion within frames: 25 dB (a walk has -7 to 14, waving 19, standing 38)
MOVING_BINS = 0.75  # slower points are static echoes in a neighbouring Doppler bin: 7 % of them lie near the body
BELOW_FLOOR_M = 0.15  # points deeper below the floor are multipath or noise
Power = Float[Array, "frame range column"]
RangeAngle = Float[Array, "range column"]
Raster = Float[Array, "ahead aside"]


@dataclass(frozen=True, kw_only=True)
class FigureData:
    """A cube and its points; photo and poses for a generated signal, none for a recording.

    `poses` contain each person's joints at the cube's frames, `motions` the same people densely in time.
    """

    title: str
    cube: RadarCube
    points: PointCloud
    aligned: AlignedPhoto | None = None
    poses: tuple[PoseSequence, ...] = ()
    motions: tuple[PoseSequence, ...] = ()

    @cached_property
    def frames(self) -> Int[Array, " shown"]:
        """Indices of the shown frames: all, or evenly spaced ones."""
        count = len(self.cube.grid.frame_time_s)
        return evenly_spaced(count, MAX_FRAMES)

    @cached_property
    def time_s(self) -> PerFrame:
        return self.cube.grid.frame_time_s[self.frames]

    @property
    def heading(self) -> str:
        """The title, with the number of shown frames if not all are shown."""
        count = len(self.cube.grid.frame_time_s)
        return self.title if count == len(self.frames) else f"{self.title}   {len(self.frames)} of {count} frames shown"

    @cached_property
    def shown_points(self) -> PointCloud:
        """The points of the shown frames."""
        return self.points.select(np.isin(self.points.frame, self.frames))

    @cached_property
    def moving_points(self) -> PointCloud:
        """Shown points above the floor that are faster than MOVING_BINS Doppler bins; all points of slow motion."""
        points = self.shown_points
        if self.is_slow:
            return points
        slowest_mps = MOVING_BINS * self.cube.config.velocity_resolution_mps
        return points.select((np.abs(points.radial_velocity_mps) >= slowest_mps) & ~self.is_below_floor)

    @cached_property
    def shown_poses(self) -> tuple[PoseSequence, ...]:
        """The poses at the shown frames."""
        return tuple(
            replace(pose, time_s=pose.time_s[self.frames], joints_m=pose.joints_m[self.frames]) for pose in self.poses
        )

    @cached_property
    def _shown(self) -> RadarCube:
        grid = replace(self.cube.grid, frame_time_s=self.time_s)
        return replace(self.cube, values=self.cube.values[self.frames], grid=grid)

    @cached_property
    def _moving(self) -> RadarCube:
        """The cube without the mean chirp of each frame; for slow motion, without the mean over frames."""
        return remove_static(self._shown, "mean_frame" if self.is_slow else "mean_chirp")

    @property
    def is_single(self) -> bool:
        """Whether there is one frame only, so that nothing can be shown over time."""
        return len(self.frames) == 1

    @cached_property
    def is_slow(self) -> bool:
        """Whether motion is visible between frames only: too few loops per frame, or a person who only breathes."""
        if len(self.cube.values) < MIN_FRAMES:
            return False
        if self.cube.config.num_loops < MIN_HANN_LOOPS:
            return True
        noise = self._noise
        if not noise:
            return False
        within = range_doppler_power(remove_static(self._shown, "mean_chirp")).mean(axis=0)
        still = zero_doppler(self._shown)
        over = (np.abs(still - still.mean(axis=0)) ** 2).mean(axis=(0, 2))
        return bool(over.max() > max(SLOW_OVER_NOISE * noise, SLOW_OVER_FAST * within.max()))

    @cached_property
    def _noise(self) -> float | None:
        """Noise power per cell; with one loop per frame, the median over range of the changes between frames."""
        found = noise_power(self._shown)
        if found is None and len(self.cube.values) > 1:
            still = zero_doppler(self._shown)
            found = float(np.median((np.abs(still - still.mean(axis=0)) ** 2).mean(axis=(0, 2))))
        return found

    @cached_property
    def scale(self) -> PowerScale:
        """The scale of decibels of every picture of this cube."""
        return PowerScale.of(float(self.range_doppler.max(initial=0.0)), self._noise, self.cube.scale)

    @cached_property
    def micro_doppler(self) -> MicroDoppler:
        """Spectrogram over the chirps of each frame without clutter, of the strongest range bin at each time."""
        return micro_doppler_of_cube(self._moving)

    @cached_property
    def slow_doppler(self) -> tuple[Float[Array, "range doppler"], Float[Array, " doppler"]]:
        """Power over range and slow-time velocity of all frames, and the velocities in m/s."""
        return slow_time_doppler(self.cube)

    @cached_property
    def slow_cells(self) -> list[SlowTimeCell]:
        """The range bins with the strongest motion across frames."""
        return moving_cells(self.cube)

    @property
    def is_below_floor(self) -> Bool[Array, " point"]:
        """Mask of the shown points below the floor: multipath over the floor, or noise."""
        if self.aligned is None or not has_elevation(self.cube.config):
            return np.zeros(len(self.shown_points.frame), bool)
        return self.shown_points.z_m < self.aligned.floor_z_m - BELOW_FLOOR_M

    @cached_property
    def range_doppler(self) -> Power:
        """Power (frame, range, doppler) with static clutter."""
        return range_doppler_power(self._shown)

    @cached_property
    def range_doppler_moving(self) -> Power:
        """Power (frame, range, doppler) without clutter."""
        return range_doppler_power(self._moving)

    @cached_property
    def azimuth_rad(self) -> Float[Array, " column"]:
        return azimuth_axis_rad()

    @cached_property
    def elevation_rad(self) -> Float[Array, " column"]:
        return elevation_axis_rad()

    @cached_property
    def range_azimuth(self) -> Power:
        """Power (frame, range, azimuth) with static clutter."""
        return range_azimuth_power(self._shown, self.azimuth_rad)

    @cached_property
    def range_azimuth_moving(self) -> Power:
        """Power (frame, range, azimuth) without clutter."""
        return range_azimuth_power(self._moving, self.azimuth_rad)

    @cached_property
    def range_elevation_moving(self) -> Power:
        """Power (frame, range, elevation) without clutter."""
        return range_elevation_power(self._moving, self.elevation_rad)

    @cached_property
    def most_active_frame(self) -> int:
        """Index into `frames` of the frame with the most power without clutter."""
        return int(np.argmax(self.range_doppler_moving.sum(axis=(1, 2))))

    @property
    def range_edges_m(self) -> tuple[float, float]:
        """Outer edges of the first and the last range bin in metres."""
        range_m = self.cube.grid.range_m
        half = self.cube.config.range_resolution_m / 2
        return float(range_m[0]) - half, float(range_m[-1]) + half

    @property
    def velocity_edges_mps(self) -> tuple[float, float]:
        """Outer edges of the first and the last Doppler bin in m/s."""
        velocity_mps = self.cube.grid.radial_velocity_mps
        half = self.cube.config.velocity_resolution_mps / 2
        return float(velocity_mps[0]) - half, float(velocity_mps[-1]) + half

    @property
    def frame_step_s(self) -> float:
        """Time from one shown frame to the next in seconds."""
        return float(self.time_s[1] - self.time_s[0]) if len(self.time_s) > 1 else self.cube.config.frame_period_s

    @property
    def time_edges_s(self) -> tuple[float, float]:
        """Start of the first and end of the last frame in seconds."""
        return float(self.time_s[0]), float(self.time_s[-1]) + self.frame_step_s


@dataclass(frozen=True, kw_only=True)
class Fan:
    """A Cartesian raster in metres for (range, angle) maps; nan outside the fan.

    Angle 0 points along `ahead`, positive angles towards `aside`. `extent` is (aside from, aside to, ahead from, ahead
    to) in metres.
    """

    range_index: Int[Array, "ahead aside"]
    angle_index: Int[Array, "ahead aside"]
    inside: Bool[Array, "ahead aside"]
    extent: tuple[float, float, float, float]

    @classmethod
    def over(cls, range_m: Array, angle_rad: Array, size: int = 260) -> "Fan":
        """The smallest raster that contains a fan.

        Args:
            range_m: Ranges (range,), evenly spaced.
            angle_rad: Angles (angle,), increasing.
            size: Number of rows.
        """
        step_m = float(range_m[1] - range_m[0]) if len(range_m) > 1 else 1.0
        reach_m = float(range_m[-1]) + step_m / 2
        ahead_m = np.linspace(0.0, reach_m, size)[:, None]
        width_m = reach_m * float(np.sin(min(np.max(np.abs(angle_rad)), np.pi / 2)))
        aside_m = np.linspace(-width_m, width_m, round(2 * size * width_m / reach_m))[None, :]
        distance_m, angle = np.hypot(ahead_m, aside_m), np.arctan2(aside_m, ahead_m)
        range_index = np.round((distance_m - range_m[0]) / step_m).astype(int)
        nearest = np.clip(np.searchsorted(angle_rad, angle), 1, len(angle_rad) - 1)
        closer_below = angle - angle_rad[nearest - 1] < angle_rad[nearest] - angle
        half_rad = (angle_rad[1] - angle_rad[0]) / 2
        inside = (
            (range_index >= 0)
            & (range_index < len(range_m))
            & (angle >= angle_rad[0] - half_rad)
            & (angle <= angle_rad[-1] + half_rad)
        )
        return cls(
            range_index=np.clip(range_index, 0, len(range_m) - 1),
            angle_index=nearest - closer_below,
            inside=inside,
            extent=(-width_m, width_m, 0.0, reach_m),
        )

    def lay(self, values: RangeAngle) -> Raster:
        """Resamples a map (range, angle) to the raster (ahead, aside)."""
        return np.where(self.inside, values[self.range_index, self.angle_index], np.nan)
