"""Point clouds in the layouts of public data sets: RadHAR's text, MARS's tables with Kinect joints."""

from pathlib import Path

import numpy as np
from jaxtyping import Float

from mmweaver.core.errors import InputError
from mmweaver.core.shapes import Array
from mmweaver.core.skeleton import joint
from mmweaver.datasets.formats import export_format
from mmweaver.io.stored_result import StoredResult

START_S = 1_500_000_000  # start of the time stamps, since a result has no date
KINECT_JOINTS = {
    "SpineBase": "pelvis",
    "SpineMid": "spine2",
    "Neck": "neck",
    "Head": "head",
    "ShoulderLeft": "left_shoulder",
    "ElbowLeft": "left_elbow",
    "WristLeft": "left_wrist",
    "HandLeft": "left_wrist",
    "ShoulderRight": "right_shoulder",
    "ElbowRight": "right_elbow",
    "WristRight": "right_wrist",
    "HandRight": "right_wrist",
    "HipLeft": "left_hip",
    "KneeLeft": "left_knee",
    "AnkleLeft": "left_ankle",
    "FootLeft": "left_foot",
    "HipRight": "right_hip",
    "KneeRight": "right_knee",
    "AnkleRight": "right_ankle",
    "FootRight": "right_foot",
    "SpineShoulder": "spine3",
    "HandTipLeft": "left_wrist",
    "ThumbLeft": "left_wrist",
    "HandTipRight": "right_wrist",
    "ThumbRight": "right_wrist",
}


@export_format("radhar", "RadHAR's text of points")
def write_radhar(result: StoredResult, out: Path) -> str:
    """Writes `radhar.txt`: one block per point, as ROS prints the messages of ti_mmwave_rospkg.

    x is ahead, y to the left, z up, in metres; velocity in m/s; bearing in degrees, positive to the left; intensity is
    the SNR in dB.

    Reference: Singh et al., RadHAR (mmNets 2019), as of its public data.
    """
    points, grid = result.points, result.cube.grid
    config = result.cube.config
    lines = []
    for index in range(len(grid.frame_time_s)):
        stamp_s = START_S + float(grid.frame_time_s[index])
        for number, row in enumerate(np.flatnonzero(points.frame == index)):
            ahead, left, up = float(points.y_m[row]), -float(points.x_m[row]), float(points.z_m[row])
            velocity = float(points.radial_velocity_mps[row])
            lines += [
                "header: ",
                f"  seq: {index}",
                "  stamp: ",
                f"    secs: {int(stamp_s)}",
                f"    nsecs: {round(stamp_s % 1 * 1e9)}",
                '  frame_id: "base_radar_link"',
                f"point_id: {number}",
                f"x: {ahead!r}",
                f"y: {left!r}",
                f"z: {up!r}",
                f"range: {float(np.hypot(np.hypot(ahead, left), up))!r}",
                f"velocity: {velocity!r}",
                f"doppler_bin: {round(velocity / config.velocity_resolution_mps)}",
                f"bearing: {float(np.degrees(np.arctan2(left, ahead)))!r}",
                f"intensity: {float(points.snr_db[row])!r}",
                "---",
            ]
    (out / "radhar.txt").write_text("\n".join(lines) + "\n", encoding="utf-8")
    return f"{len(points.frame)} points as RadHAR's text"


@export_format("mars", "MARS's tables of points and joints")
def write_mars(result: StoredResult, out: Path) -> str:
    """Writes `radar_data.csv`, one row per point, and `kinect_data.csv`, one row of 25 joints per frame, as in MARS.

    Metres from the radar: X to the right, Y ahead, Z up; velocity in m/s; intensity is the SNR in dB. Hands, hand tips
    and thumbs, which the skeleton lacks, are placed at the wrists.

    Reference: An and Ogras, MARS (ACM TECS 2021), as of its public data.

    Raises:
        InputError: If the result does not have exactly one person.
    """
    if len(result.poses) != 1:
        raise InputError(f"MARS has one person with joints, this result has {len(result.poses)}")
    points, grid = result.points, result.cube.grid
    counts = np.bincount(points.frame, minlength=len(grid.frame_time_s))
    rows = ["Frame #,# Obj,X,Y,Z,Doppler,Intensity,Abs Time"]
    for row in range(len(points.frame)):
        frame = int(points.frame[row])
        values = (points.x_m[row], points.y_m[row], points.z_m[row], points.radial_velocity_mps[row])
        rows.append(
            f"{frame},{counts[frame]},{','.join(f'{float(value):.5g}' for value in values)},"
            f"{float(points.snr_db[row]):.5g},{START_S + float(grid.frame_time_s[frame]):.3f}"
        )
    (out / "radar_data.csv").write_text("\n".join(rows) + "\n", encoding="utf-8")
    joints_m = kinect_joints_m(result.poses[0].joints_m)
    header = [f"{name}_{axis}" for axis in "XYZ" for name in KINECT_JOINTS]
    table = joints_m.transpose(0, 2, 1).reshape(len(joints_m), -1)
    body = [",".join(f"{value:.6g}" for value in row) for row in table]
    (out / "kinect_data.csv").write_text("\n".join([",".join(header), *body]) + "\n", encoding="utf-8")
    return f"{len(points.frame)} points and {len(joints_m)} poses as in MARS"


def kinect_joints_m(joints_m: Float[Array, "frame 22 3"]) -> Float[Array, "frame 25 3"]:
    """The Kinect's 25 joints in its order, (frame, 25, 3)."""
    return joints_m[:, [joint(name) for name in KINECT_JOINTS.values()]]
