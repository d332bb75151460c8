"""A view to draw: a stick person walking across a grey room, and a cube that holds its joints as point targets."""

import numpy as np
import pytest

from mmweaver.core.aligned_photo import AlignedPhoto
from mmweaver.core.boards import AWR1843
from mmweaver.core.records import CameraIntrinsics, CubeGrid, PointCloud, PoseSequence, RadarCube, RgbdPhoto
from mmweaver.core.seeding import stream
from mmweaver.signal.windows import hann
from mmweaver.viz.figure_data import FigureData

RADAR_FROM_CAMERA = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]])
STANDING_M = {
    "pelvis": (0, 0.9), "left_hip": (-0.1, 0.85), "right_hip": (0.1, 0.85), "spine1": (0, 1.0),
    "left_knee": (-0.12, 0.48), "right_knee": (0.12, 0.48), "spine2": (0, 1.1), "left_ankle": (-0.12, 0.08),
    "right_ankle": (0.12, 0.08), "spine3": (0, 1.2), "left_foot": (-0.13, 0.02), "right_foot": (0.13, 0.02),
    "neck": (0, 1.4), "left_collar": (-0.08, 1.35), "right_collar": (0.08, 1.35), "head": (0, 1.6),
    "left_shoulder": (-0.18, 1.36), "right_shoulder": (0.18, 1.36), "left_elbow": (-0.25, 1.1),
    "right_elbow": (0.25, 1.1), "left_wrist": (-0.3, 0.85), "right_wrist": (0.3, 0.85),
}  # fmt: skip


def walking_pose(time_s: np.ndarray) -> PoseSequence:
    """Nears the radar at 0.8 m/s from 3 m, 0.3 m to the left, the floor 1.1 m below the radar."""
    body_m = np.array([(x, 0.0, z - 1.1) for x, z in STANDING_M.values()])
    path_m = np.stack([np.full(len(time_s), -0.3), 3.0 - 0.8 * time_s, np.zeros(len(time_s))], axis=1)
    return PoseSequence(time_s=time_s, joints_m=path_m[:, None, :] + body_m, height_m=1.7)


def make_photo(width: int = 160, height: int = 120) -> RgbdPhoto:
    """A grey room 4 m deep with a dark block 1 m before the camera in its lower right."""
    rgb = np.full((height, width, 3), 120, np.uint8)
    depth_m = np.full((height, width), 4.0)
    rgb[70:, 100:], depth_m[70:, 100:] = 40, 1.0
    lens = CameraIntrinsics(fx=140.0, fy=140.0, cx=(width - 1) / 2, cy=(height - 1) / 2, width=width, height=height)
    return RgbdPhoto(rgb=rgb, depth_m=depth_m, intrinsics=lens)


def make_cube(pose: PoseSequence) -> RadarCube:
    """Every joint a point target, in front of a static one at 2 m and weak noise."""
    grid = CubeGrid.of(AWR1843, len(pose.time_s))
    noise = stream(1, "noise")
    values = 1e-3 * (noise.normal(size=grid.shape) + 1j * noise.normal(size=grid.shape))
    velocity_mps = np.gradient(np.linalg.norm(pose.joints_m, axis=2), pose.time_s, axis=0)
    for frame in range(len(pose.time_s)):
        for place_m, speed_mps in zip(pose.joints_m[frame], velocity_mps[frame], strict=True):
            values[frame] += _target(grid, place_m, float(speed_mps))
        values[frame] += 5 * _target(grid, np.array([0.6, 2.0, 0.0]), 0.0)
    return RadarCube(values=values.astype(np.complex64), grid=grid, config=AWR1843, scale=1.0)


def _target(grid: CubeGrid, place_m: np.ndarray, speed_mps: float) -> np.ndarray:
    distance_m = float(np.linalg.norm(place_m))
    in_range = np.sinc((grid.range_m - distance_m) / (grid.range_m[1] - grid.range_m[0]) / 2)
    loops = np.arange(AWR1843.num_loops)
    slow = hann(len(loops)) * np.exp(4j * np.pi / grid.wavelength_m * speed_mps * AWR1843.loop_period_s * loops)
    in_velocity = np.fft.fftshift(np.fft.fft(slow)) / len(loops)
    antennas = np.exp(-2j * np.pi / grid.wavelength_m * (grid.antenna_position_m @ (place_m / distance_m)))
    return in_range[:, None, None] * in_velocity[None, :, None] * antennas


def make_view() -> FigureData:
    time_s = np.arange(12) / 10
    pose, motion = walking_pose(time_s), walking_pose(np.arange(0.0, 1.3, 0.01))
    cloud_m = pose.joints_m[:, 15]
    points = PointCloud(
        frame=np.arange(12), x_m=cloud_m[:, 0], y_m=cloud_m[:, 1], z_m=cloud_m[:, 2],
        radial_velocity_mps=np.full(12, -0.8), snr_db=np.full(12, 20.0),
    )  # fmt: skip
    aligned = AlignedPhoto(photo=make_photo(), radar_from_camera=RADAR_FROM_CAMERA, floor_z_m=-1.0)
    return FigureData(
        title="awr1843: a stick person nears the radar",
        cube=make_cube(pose), points=points, aligned=aligned,
        poses=(pose,), motions=(motion,),
    )  # fmt: skip


@pytest.fixture(scope="session")
def view() -> FigureData:
    return make_view()
