"""Point-cloud recordings from columns."""

from dataclasses import replace
from typing import Any

import numpy as np

from mmweaver.core.records import PointCloud
from mmweaver.recognition.point_recordings import PointRecording
from mmweaver.recognition.quantisation import Quantisation

RADAR = Quantisation(
    range_step_m=0.05, velocity_step_mps=0.12, max_velocity_mps=0.96, removes_static=False, groups_range=True,
    groups_velocity=True, knows_place=False,
)  # fmt: skip


def recording_of(
    frame: Any, *, x_m: Any = 0.0, y_m: Any = 2.0, z_m: Any = 0.0, velocity_mps: Any = 0.0, snr_db: Any = np.nan,
    num_frames: int | None = None, rate_hz: float = 10.0, **more: Any,
) -> PointRecording:  # fmt: skip
    """Points (point,), in the order of frames; a number holds for all of them."""
    frame = np.asarray(frame, int)
    order = np.argsort(frame, kind="stable")
    x, y, z, velocity, snr = (np.broadcast_to(one, frame.shape)[order] for one in (x_m, y_m, z_m, velocity_mps, snr_db))
    cloud = PointCloud(frame=frame[order], x_m=x, y_m=y, z_m=z, radial_velocity_mps=velocity, snr_db=snr)
    frames = int(frame.max(initial=-1)) + 1 if num_frames is None else num_frames
    return PointRecording(**{"name": "one", "num_frames": frames, "frame_rate_hz": rate_hz, "cloud": cloud} | more)


def in_all_frames(places: Any, frames: int, **more: Any) -> PointRecording:
    """Points at (right, ahead, velocity) in each of `frames` frames."""
    x, y, velocity = np.repeat(np.asarray(places, float), frames, axis=0).T
    return recording_of(np.tile(np.arange(frames), len(places)), x_m=x, y_m=y, velocity_mps=velocity, **more)


def with_others(recording: PointRecording, *others: PointCloud) -> PointRecording:
    """The recording with other points after those of the person in each of its frames."""
    clouds = [recording.cloud, *(cloud.select(cloud.frame < recording.num_frames) for cloud in others)]
    columns = {name: np.concatenate([getattr(cloud, name) for cloud in clouds]) for name in vars(recording.cloud)}
    return replace(recording, cloud=PointCloud(**columns).select(np.argsort(columns["frame"], kind="stable")))
