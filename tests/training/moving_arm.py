"""Recordings of a person whose left arm is up or down: points at the joints, so that a tiny training can learn them."""

import numpy as np

from mmweaver.core.records import PointCloud
from mmweaver.core.seeding import stream
from mmweaver.core.skeleton import JOINT_NAMES, joint
from mmweaver.recognition.point_recordings import PointRecording
from tests.rooms import STANDING_M


def moving_arm(number: int, frames: int = 40) -> PointRecording:
    """Two seconds up, two seconds down, in turn; a wall 4 m away stands still behind."""
    rng = stream(number, "moving arm")
    joints_m = np.repeat(np.array([STANDING_M[name] for name in JOINT_NAMES], float)[None], frames, axis=0)
    is_up = (np.arange(frames) + 10 * number) // 10 % 2 == 1
    joints_m[is_up, joint("left_wrist")] += [0.1, 0.0, 1.0]
    joints_m[is_up, joint("left_elbow")] += [0.1, 0.0, 0.5]
    joints_m += [rng.normal(0, 0.1), 2.0 + rng.normal(0, 0.1), -1.0]
    own = joints_m + rng.normal(0, 0.02, joints_m.shape)
    wall = np.broadcast_to([0.5, 4.0, 0.0], (frames, 3, 3))
    points = np.concatenate([own, wall], axis=1)
    velocity = np.concatenate([np.full((frames, 22), 0.3), np.zeros((frames, 3))], axis=1).ravel()
    x, y, z = points.reshape(-1, 3).T
    frame = np.repeat(np.arange(frames), points.shape[1])
    cloud = PointCloud(frame=frame, x_m=x, y_m=y, z_m=z, radial_velocity_mps=velocity, snr_db=np.full(len(frame), 20.0))
    return PointRecording(
        name=f"arm_{number}", cloud=cloud, num_frames=frames, frame_rate_hz=10.0, label="arm", joints_m=joints_m
    )
