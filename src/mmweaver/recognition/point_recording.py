"""A recording of a point-cloud radar, generated or real, with its activity."""

from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Bool, Float, Int

from mmweaver.core.records import PointCloud

STILL_MPS = 0.1  # up to this radial speed a point counts as at rest


def is_moving(cloud: PointCloud) -> Bool[np.ndarray, " point"]:
    """Which points move, by their radial velocity."""
    return np.abs(cloud.radial_velocity_mps) > STILL_MPS


@dataclass(frozen=True, kw_only=True)
class PointRecording:
    """Points of frames 0 to num_frames - 1 (empty frames included) at a constant frame rate."""

    name: str
    cloud: PointCloud
    num_frames: int
    frame_rate_hz: float
    label: str = ""  # the activity, if known
    first_frame: int = 0  # in the recording that this is a part of
    joints_m: Float[np.ndarray, "frame 22 3"] | None = None  # of one person in the radar's level axes, if known

    @property
    def duration_s(self) -> float:
        return self.num_frames / self.frame_rate_hz

    def windows(self, seconds: float, step_s: float | None = None) -> "list[PointRecording]":
        """Windows of this length, consecutive or every `step_s`; an incomplete last window is dropped."""
        length = max(round(seconds * self.frame_rate_hz), 1)
        step = max(round((step_s or seconds) * self.frame_rate_hz), 1)
        return [self.part(first, length) for first in range(0, self.num_frames - length + 1, step)]

    def part(self, first: int, num_frames: int) -> "PointRecording":
        """`num_frames` frames starting at `first`, renumbered from 0."""
        inside = (self.cloud.frame >= first) & (self.cloud.frame < first + num_frames)
        cloud = self.cloud.select(inside)
        return replace(
            self, cloud=replace(cloud, frame=cloud.frame - first), num_frames=num_frames,
            first_frame=self.first_frame + first,
            joints_m=None if self.joints_m is None else self.joints_m[first : first + num_frames],
        )  # fmt: skip


def index_runs(
    begin: Int[np.ndarray, " run"], end: Int[np.ndarray, " run"]
) -> tuple[Int[np.ndarray, " index"], Int[np.ndarray, " index"]]:
    """All indices from `begin` to `end` - 1 of each run, one run after the other, with the number of their run."""
    count = end - begin
    run = np.repeat(np.arange(len(count)), count)
    return run, np.arange(len(run)) - np.repeat(np.cumsum(count) - count - begin, count)
