"""The MARS recordings: point clouds of an IWR1443 and the joints of a Kinect at the same moments.

Reference: An and Ogras, "MARS: mmWave-based Assistive Rehabilitation System", 2021; its public repository, MIT.
"""

from dataclasses import dataclass, fields, replace
from pathlib import Path
from typing import TypeVar

import numpy as np
from jaxtyping import Float, Int

from mmweaver.core.errors import InputError
from mmweaver.core.records import PointCloud, PoseSequence
from mmweaver.core.safe_files.regular_files import MEGABYTE
from mmweaver.core.safe_files.safe_text import read_text
from mmweaver.core.skeleton import JOINT_NAMES
from mmweaver.recognition.point_recordings import PointRecording
from mmweaver.signal.firmware import FirmwareCloud

FRAME_S = 0.1
LONGEST_GAP = 3  # frames; joints are interpolated over shorter gaps, a longer one begins another recording
RADAR_COLUMNS, KINECT_COLUMNS = 8, 75
MAX_BYTES = 200 * MEGABYTE

# Our joints as mixtures of the Kinect's: (joint, joint, share of the second).
SPINE_BASE, SPINE_MID, NECK, HEAD, SPINE_SHOULDER = 0, 1, 2, 3, 20
LEFT = {"shoulder": 4, "elbow": 5, "wrist": 6, "hip": 12, "knee": 13, "ankle": 14, "foot": 15}
RIGHT = {"shoulder": 8, "elbow": 9, "wrist": 10, "hip": 16, "knee": 17, "ankle": 18, "foot": 19}
MIXED: dict[str, tuple[int, int, float]] = {
    "pelvis": (SPINE_BASE, SPINE_BASE, 0.0),
    "spine1": (SPINE_BASE, SPINE_MID, 0.5),
    "spine2": (SPINE_MID, SPINE_MID, 0.0),
    "spine3": (SPINE_MID, SPINE_SHOULDER, 0.5),
    "neck": (NECK, NECK, 0.0),
    "head": (NECK, HEAD, 0.75),
    "left_collar": (SPINE_SHOULDER, LEFT["shoulder"], 0.35),
    "right_collar": (SPINE_SHOULDER, RIGHT["shoulder"], 0.35),
    **{f"left_{name}": (index, index, 0.0) for name, index in LEFT.items()},
    **{f"right_{name}": (index, index, 0.0) for name, index in RIGHT.items()},
}


@dataclass(frozen=True, kw_only=True)
class MarsStretch:
    """Frames of one recording without long gaps: `frame` counts tenths of a second from its first."""

    frame: Int[np.ndarray, " sample"]
    joints_m: Float[np.ndarray, "sample 22 3"]  # in the Kinect's frame: x right, y away, z up
    clouds: tuple[FirmwareCloud, ...]  # one a sample, in the radar's frame


def read_mars(folder: Path | str, split: str) -> list[MarsStretch]:
    """The stretches of a split ("validate" or "test") of one subject.

    Raises InputError where the files are missing or do not belong together.
    """
    folder = Path(folder)
    radar = _table(folder / f"radar_data_{split}.csv", RADAR_COLUMNS)
    kinect = _table(folder / f"kinect_data_{split}.csv", KINECT_COLUMNS)
    number, start, count = np.unique(radar[:, 0].astype(int), return_index=True, return_counts=True)
    if len(number) != len(kinect):
        raise InputError(f"{folder}: the radar has {len(number)} frames of {split}, the Kinect {len(kinect)}")
    joints = joints_from_kinect(kinect.reshape(-1, 3, 25).swapaxes(1, 2))
    clouds = [cloud_of(radar[first : first + num]) for first, num in zip(start, count, strict=True)]
    cuts = np.flatnonzero(np.diff(number) > LONGEST_GAP) + 1
    parts = np.split(np.arange(len(number)), cuts)
    return [
        MarsStretch(
            frame=number[part] - number[part[0]],
            joints_m=joints[part],
            clouds=tuple(clouds[index] for index in part),
        )
        for part in parts
        if len(part) > 1
    ]


def posed_recordings(folder: Path | str, split: str) -> list[PointRecording]:
    """The stretches of a split as recordings with joints, nan in frames that were not recorded.

    Joints lie in the Kinect's axes, points in the radar's; strength is the intensity in dB.
    """
    found = []
    for number, stretch in enumerate(read_mars(folder, split)):
        frames = int(stretch.frame[-1]) + 1
        joints_m = np.full((frames, len(JOINT_NAMES), 3), np.nan)
        joints_m[stretch.frame] = stretch.joints_m
        columns = {
            column: np.concatenate([getattr(cloud, column) for cloud in stretch.clouds])
            for column in ("x_m", "y_m", "z_m", "radial_velocity_mps", "intensity")
        }
        snr_db = 20 * np.log10(np.maximum(columns.pop("intensity"), 1.0))
        frame = np.repeat(stretch.frame, [len(cloud.x_m) for cloud in stretch.clouds])
        found.append(
            PointRecording(
                name=f"{split} {number}", cloud=PointCloud(frame=frame, snr_db=snr_db, **columns), num_frames=frames,
                frame_rate_hz=1 / FRAME_S, joints_m=joints_m,
            )
        )  # fmt: skip
    return found


def joints_from_kinect(kinect_m: Float[np.ndarray, "sample 25 3"]) -> Float[np.ndarray, "sample 22 3"]:
    """Our 22 joints from the Kinect's 25."""
    mixed = [MIXED[name] for name in JOINT_NAMES]
    return np.stack([kinect_m[:, one] * (1 - share) + kinect_m[:, two] * share for one, two, share in mixed], axis=1)


def cloud_of(rows: Float[np.ndarray, "point 8"]) -> FirmwareCloud:
    """One frame's rows: frame, count, x, y, z, velocity, intensity, time. All points count as frame 0."""
    none = np.zeros(len(rows), int)
    return FirmwareCloud(
        frame=none, x_m=rows[:, 2], y_m=rows[:, 3], z_m=rows[:, 4], radial_velocity_mps=rows[:, 5],
        snr_db=np.full(len(rows), np.nan), intensity=rows[:, 6], noise_db=np.full(len(rows), np.nan),
        range_bin=none, doppler_bin=none,
    )  # fmt: skip


def _table(path: Path, columns: int) -> Float[np.ndarray, "row column"]:
    if not path.is_file():
        raise InputError(f"cannot read {path}; give the folder of a MARS subject")
    rows = [line.split(",") for line in read_text(path, max_bytes=MAX_BYTES).splitlines()[1:] if line.strip()]
    try:
        values = np.array(rows, float).reshape(len(rows), -1)
    except ValueError as error:
        raise InputError(f"{path} is no table of numbers ({error})") from None
    if not len(rows) or values.shape[1] != columns:
        raise InputError(f"{path} has {values.shape[1] if rows else 0} columns, {columns} are needed")
    return values


# pieces to simulate -------------------------------------------------------------------------------------------------
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
