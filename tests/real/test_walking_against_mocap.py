"""Our walk beside recorded ones (CMU motion capture): tempo, joint speeds, knees, at the same walking speed."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest

from mmweaver.core.skeleton import joint
from mmweaver.motion.animation.assemble import assemble
from mmweaver.motion.animation.root_path import Move, RootPath
from mmweaver.motion.animation.skeleton_proportions import SkeletonProportions
from mmweaver.motion.animation.step_context import PlacedStep
from mmweaver.motion.language.plan import Step

RATE_HZ = 120.0
# Joints of the recordings' 38: root, left and right hip, knee, ankle, toes, wrist.
THEIRS = {"pelvis": 0, "left_hip": 2, "left_knee": 3, "left_ankle": 4, "right_ankle": 10, "left_wrist": 23}


@dataclass
class Gait:
    """Figures of one walk."""

    speed_mps: float
    steps_hz: float
    ankle_mps: float
    wrist_mps: float
    knee_deg: float
    bob_m: float


def gait_of(joints: dict[str, np.ndarray]) -> Gait:
    """From joints (frame, 3) with z up."""
    pelvis = joints["pelvis"]
    way = pelvis[-1, :2] - pelvis[0, :2]
    ahead = way / np.linalg.norm(way)
    scissors = (joints["left_ankle"] - joints["right_ankle"])[:, :2] @ ahead
    scissors = scissors - scissors.mean()
    spectrum = np.abs(np.fft.rfft(scissors * np.hanning(len(scissors)), 16 * len(scissors)))
    frequency = np.fft.rfftfreq(16 * len(scissors), 1 / RATE_HZ)
    speed = {name: np.linalg.norm(np.gradient(place, 1 / RATE_HZ, axis=0), axis=1) for name, place in joints.items()}
    thigh, shank = joints["left_hip"] - joints["left_knee"], joints["left_ankle"] - joints["left_knee"]
    cosine = np.sum(thigh * shank, axis=1) / np.linalg.norm(thigh, axis=1) / np.linalg.norm(shank, axis=1)
    time = np.arange(len(pelvis))
    height = pelvis[:, 2] - np.polyval(np.polyfit(time, pelvis[:, 2], 1), time)
    return Gait(
        speed_mps=float(np.linalg.norm(way) / len(pelvis) * RATE_HZ),
        steps_hz=float(2 * frequency[spectrum.argmax()]),
        ankle_mps=float(np.percentile(speed["left_ankle"], 98)),
        wrist_mps=float(np.percentile(speed["left_wrist"], 98)),
        knee_deg=float(np.ptp(180 - np.degrees(np.arccos(cosine)))),
        bob_m=float(np.percentile(height, 98) - np.percentile(height, 2)),
    )


def recorded(folder: Path) -> list[Gait]:
    """Straight, steady walks of the recordings between 0.9 and 1.5 m/s."""
    with np.load(folder / "motion" / "cmu" / "cmu_joints_m_120fps.npz", allow_pickle=False) as file:
        names, lengths, places = file["names"], file["lengths"], file["pos"].astype(float)
    found = []
    for name, end, length in zip(names, np.cumsum(lengths), lengths, strict=True):
        if "/walking" not in str(name):
            continue
        # y is up there; half precision is coarse, so speeds are taken after a little smoothing
        clip = places[end - length : end][:, :, [0, 2, 1]] * [1, -1, 1]
        kernel = np.hanning(13) / np.hanning(13).sum()
        joints = {
            joint_name: np.stack([np.convolve(clip[:, k, axis], kernel, "valid") for axis in range(3)], axis=1)
            for joint_name, k in THEIRS.items()
        }
        gone = np.linalg.norm(np.diff(joints["pelvis"][:, :2], axis=0), axis=1).sum()
        straight = np.linalg.norm(joints["pelvis"][-1, :2] - joints["pelvis"][0, :2])
        if straight > 0.97 * gone and straight > 2.5 and 0.9 < straight / length * RATE_HZ < 1.5:
            found.append(gait_of(joints))
    return found


@pytest.fixture(scope="module")
def pairs(real_data: Path) -> list[tuple[Gait, Gait]]:
    """Recorded walks, and ours at the same speed."""
    return [(gait, ours(gait.speed_mps, k)) for k, gait in enumerate(recorded(real_data))]


def ours(speed_mps: float, seed: int) -> Gait:
    seconds = 4.0
    move = Move(
        start_s=0.0, end_s=seconds, length_m=speed_mps * seconds, direction_rad=0.0, ramp_in_s=0.0, ramp_out_s=0.0
    )
    pose = assemble(
        (PlacedStep(step=Step(lower="walk", end_s=seconds), moves=(move,)),),
        RootPath(start_m=(0.0, 0.0), heading_rad=0.0, moves=(move,)),
        SkeletonProportions(1.75),
        seed=seed,
        duration_s=seconds,
        floor_z_m=0.0,
    )
    return gait_of({name: pose.joints_m[:, joint(name)] for name in THEIRS})


@pytest.mark.parametrize(
    ("figure", "least", "most"),
    [
        ("steps_hz", 0.85, 1.15),
        ("ankle_mps", 0.75, 1.3),
        ("wrist_mps", 0.6, 1.5),
        ("knee_deg", 0.7, 1.25),
        ("bob_m", 0.5, 1.6),
    ],
)
def test_our_walk_is_like_recorded_ones(pairs: list[tuple[Gait, Gait]], figure: str, least: float, most: float):
    """The median ratio of ours to theirs at the same speed."""
    assert len(pairs) >= 5
    ratios = [getattr(own, figure) / getattr(gait, figure) for gait, own in pairs]
    assert least < np.median(ratios) < most
