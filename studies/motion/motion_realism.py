"""Does the library move as people do? Its walking, running and jumping compared with motion capture (CMU).

python -m studies run motion_realism --mocap <folder with cmu_joints_m_120fps.npz>

Each figure is measured on every recorded clip and on as many generated ones: walks and runs at the speeds of the clips.
Both pass the same smoothing, as the recordings are stored in half precision. A figure is inside where the median of the
generated clips lies between the 5th and the 95th percentile of the recorded ones; the share of generated clips that do
is given too. With six clips (running, jumping) those percentiles are little more than the minimum and the maximum.
"""

import argparse
import hashlib
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from jaxtyping import Float

from mmweaver.core.seeding import stream
from mmweaver.core.skeleton import joint
from mmweaver.motion.animation.assemble import assemble
from mmweaver.motion.animation.root_path import Move, RootPath
from mmweaver.motion.animation.skeleton_proportions import SkeletonProportions
from mmweaver.motion.animation.step_context import PlacedStep
from mmweaver.motion.language.plan import Step
from studies.manifest import StudyRun
from studies.result_rows import complete_rows
from studies.study import Reads

Array = np.ndarray
Places = dict[str, Float[Array, "frame 3"]]
Figures = dict[str, float]

RATE_HZ = 120.0
SMOOTHING = 13  # frames
LEAP_M = 0.95
# Joints of the recordings' 38.
THEIRS = {
    "pelvis": 0, "left_hip": 2, "left_knee": 3, "left_ankle": 4, "left_foot": 5, "right_hip": 8, "right_knee": 9,
    "right_ankle": 10, "right_foot": 11, "left_wrist": 23, "right_wrist": 32,
}  # fmt: skip
UNITS = {
    "cadence_hz": "steps/s", "step_length_m": "m", "ankle_speed_mps": "m/s", "wrist_speed_mps": "m/s",
    "ankle_acceleration_mps2": "m/s2", "wrist_acceleration_mps2": "m/s2", "pelvis_acceleration_mps2": "m/s2",
    "pelvis_oscillation_m": "m", "knee_range_deg": "deg", "planted_foot_speed_mps": "m/s", "left_right_ratio": "",
    "flight_s": "s", "rise_m": "m", "crouch_m": "m", "pelvis_speed_mps": "m/s",
}  # fmt: skip
SPEEDS = {"walking": (0.8, 1.6), "running": (1.8, 5.0)}


def recorded(path: Path, activity: str) -> list[Places]:
    """The clips of one activity, smoothed, z up; gaits are those that are straight, steady and of a usual speed."""
    with np.load(path, allow_pickle=False) as file:
        names, lengths, places = file["names"], file["lengths"], file["pos"].astype(float)
    found = []
    for name, end, length in zip(names, np.cumsum(lengths), lengths, strict=True):
        if f"/{activity}" not in str(name):
            continue
        clip = places[end - length : end][:, :, [0, 2, 1]] * [1, -1, 1]  # y is up there
        joints = {joint_name: _smooth(clip[:, k]) for joint_name, k in THEIRS.items()}
        if activity not in SPEEDS or is_steady(joints["pelvis"], SPEEDS[activity]):
            found.append(joints)
    return found


def _smooth(place: Float[Array, "frame 3"]) -> Float[Array, "n 3"]:
    kernel = np.hanning(SMOOTHING) / np.hanning(SMOOTHING).sum()
    return np.stack([np.convolve(place[:, axis], kernel, "valid") for axis in range(3)], axis=1)


def is_steady(pelvis: Float[Array, "frame 3"], speeds: tuple[float, float]) -> bool:
    """Whether the path is straight, longer than 2 m and of a usual speed."""
    gone = np.linalg.norm(np.diff(pelvis[:, :2], axis=0), axis=1).sum()
    straight = float(np.linalg.norm(pelvis[-1, :2] - pelvis[0, :2]))
    speed_mps = straight / len(pelvis) * RATE_HZ
    return bool(straight > 0.95 * gone and straight > 2.0 and speeds[0] < speed_mps < speeds[1])


def speed_of(joints: Places) -> float:
    pelvis = joints["pelvis"]
    return float(np.linalg.norm(pelvis[-1, :2] - pelvis[0, :2]) / len(pelvis) * RATE_HZ)


def gait_figures(joints: Places) -> Figures:
    """Figures of a straight, steady walk or run."""
    pelvis, speed = joints["pelvis"], speed_of(joints)
    cadence = cadence_hz(joints)
    time = np.arange(len(pelvis))
    height = pelvis[:, 2] - np.polyval(np.polyfit(time, pelvis[:, 2], 1), time)
    feet = np.stack([_speed(joints[f"{side}_foot"][:, :2]) for side in ("left", "right")])
    low = np.stack([joints[f"{side}_foot"][:, 2] for side in ("left", "right")])
    planted = np.where(low < low.min() + 0.03, feet, np.nan)
    planted = planted[:, ~np.isnan(planted).all(axis=0)]
    knees = {side: _knee_deg(joints, side) for side in ("left", "right")}
    return {
        "cadence_hz": cadence,
        "step_length_m": speed / cadence,
        **_limb_figures(joints),
        "pelvis_oscillation_m": float(np.percentile(height, 98) - np.percentile(height, 2)),
        "knee_range_deg": float(np.ptp(knees["left"])),
        "planted_foot_speed_mps": float(np.median(np.nanmin(planted, axis=0))),
        "left_right_ratio": float(np.ptp(knees["left"]) / np.ptp(knees["right"])),
    }


def cadence_hz(joints: Places) -> float:
    """Steps a second, from the distance of the ankles along the path."""
    pelvis = joints["pelvis"]
    direction = (pelvis[-1, :2] - pelvis[0, :2]) / np.linalg.norm(pelvis[-1, :2] - pelvis[0, :2])
    scissors = (joints["left_ankle"] - joints["right_ankle"])[:, :2] @ direction
    scissors = scissors - scissors.mean()
    spectrum = np.abs(np.fft.rfft(scissors * np.hanning(len(scissors)), 16 * len(scissors)))
    return 2 * float(np.fft.rfftfreq(16 * len(scissors), 1 / RATE_HZ)[spectrum.argmax()])


def jump_figures(joints: Places) -> Figures:
    """Figures of the highest jump of a clip."""
    toes = np.minimum(joints["left_foot"][:, 2], joints["right_foot"][:, 2])
    ground = float(np.percentile(toes, 10))
    top = int(np.argmax(toes))
    air = toes > ground + 0.03
    first, last = top, top
    while first > 0 and air[first - 1]:
        first -= 1
    while last < len(air) - 1 and air[last + 1]:
        last += 1
    pelvis = joints["pelvis"][:, 2]
    stand = float(np.median(pelvis))
    around = slice(max(first - 72, 0), last + 72)
    near = {name: place[around] for name, place in joints.items()}
    return {
        "flight_s": (last - first) / RATE_HZ,
        "rise_m": float(pelvis[first : last + 1].max() - stand),
        "crouch_m": float(stand - pelvis[max(first - 72, 0) : first + 1].min()),
        "pelvis_speed_mps": float(_speed(near["pelvis"]).max()),
        **_limb_figures(near),
    }


def _limb_figures(joints: Places) -> Figures:
    """98th percentiles of speeds and accelerations over time."""
    return {
        "ankle_speed_mps": float(np.percentile(_speed(joints["left_ankle"]), 98)),
        "wrist_speed_mps": float(np.percentile(_speed(joints["left_wrist"]), 98)),
        "ankle_acceleration_mps2": float(np.percentile(_acceleration(joints["left_ankle"]), 98)),
        "wrist_acceleration_mps2": float(np.percentile(_acceleration(joints["left_wrist"]), 98)),
        "pelvis_acceleration_mps2": float(np.percentile(_acceleration(joints["pelvis"]), 98)),
    }


def _speed(place: Float[Array, "frame axis"]) -> Float[Array, " frame"]:
    return np.linalg.norm(np.gradient(place, 1 / RATE_HZ, axis=0), axis=1)


def _acceleration(place: Float[Array, "frame 3"]) -> Float[Array, " inner"]:
    return np.linalg.norm(np.gradient(np.gradient(place, 1 / RATE_HZ, axis=0), 1 / RATE_HZ, axis=0), axis=1)[2:-2]


def _knee_deg(joints: Places, side: str) -> Float[Array, " frame"]:
    thigh, shank = (joints[f"{side}_{end}"] - joints[f"{side}_knee"] for end in ("hip", "ankle"))
    cosine = np.sum(thigh * shank, axis=1) / np.linalg.norm(thigh, axis=1) / np.linalg.norm(shank, axis=1)
    return 180 - np.degrees(np.arccos(np.clip(cosine, -1, 1)))


def ours(lower: str, seed: int, *, seconds: float, speed_mps: float = 0.0, count: int = 0) -> Places:
    """One generated clip with a body of random height, smoothed as recordings are; {joint: (frame, 3)} in metres."""
    height = float(stream(seed, "realism", "height").uniform(1.63, 1.9))
    moves = ()
    if speed_mps:
        moves = (
            Move(
                start_s=0.0, end_s=seconds, length_m=speed_mps * seconds, direction_rad=0.0, ramp_in_s=0.0,
                ramp_out_s=0.0,
            ),
        )  # fmt: skip
    pose = assemble(
        (PlacedStep(step=Step(lower=lower, end_s=seconds, count=count), moves=moves),),
        RootPath(start_m=(0.0, 0.0), heading_rad=0.0, moves=moves),
        SkeletonProportions(height), seed=seed, duration_s=seconds, floor_z_m=0.0,
    )  # fmt: skip
    return {name: _smooth(pose.joints_m[:, joint(name)]) for name in THEIRS}


def compare(theirs: list[Figures], generated: list[Figures]) -> dict[str, dict[str, Any]]:
    """Each figure: the median of the generated clips, and the 5th, 50th and 95th percentile of the recorded ones."""
    rows = {}
    for name in theirs[0]:
        real, made = np.array([f[name] for f in theirs]), np.array([f[name] for f in generated])
        low, middle, high = (float(value) for value in np.percentile(real, (5, 50, 95)))
        rows[name] = {
            "value": round(float(np.median(made)), 4),
            "unit": UNITS[name],
            "definition": "median of the generated clips; 98th percentile over time for speeds and accelerations",
            "version": 1,
            "recorded_5_50_95": [round(low, 4), round(middle, 4), round(high, 4)],
            "inside": bool(low <= np.median(made) <= high),
            "share_inside": round(float(np.mean((made >= low) & (made <= high))), 4),
        }
    return rows


def measure(run: StudyRun, folder: Path) -> Path:
    """Writes one row each for walking, running and jumping."""
    path = folder / "cmu_joints_m_120fps.npz"
    digest = hashlib.sha256(path.read_bytes()).hexdigest()
    rows = []
    for activity, lower in (("walking", "walk"), ("running", "jog"), ("jumping", "jump")):
        clips = recorded(path, activity)
        figures: Callable[[Places], Figures] = jump_figures if lower == "jump" else gait_figures
        seeds = range(max(len(clips), 24))
        if lower == "jump":
            made = [  # half of the recorded jumps lead about a metre ahead, half nowhere
                ours("leap", seed, seconds=2.4, speed_mps=LEAP_M / 2.4, count=1)
                if seed % 2
                else ours("jump", seed, seconds=2.4, count=1)
                for seed in seeds
            ]
        else:
            made = [ours(lower, seed, seconds=4.0, speed_mps=speed_of(clips[seed % len(clips)])) for seed in seeds]
        rows.append(
            {
                "dataset": {
                    "name": f"CMU {activity}",
                    "sha256": digest,
                    "split": "its mean joint angles shaped the library",
                },
                "n": len(clips),
                "generated": len(made),
                "seeds": [seeds[0], seeds[-1]],
                "metrics": compare([figures(clip) for clip in clips], [figures(clip) for clip in made]),
            }
        )
    unknown = {"seconds": "see the manifest: all rows together"}
    rows = complete_rows(rows, unknown=unknown)
    return run.write("motion_realism", "library", config={"rate_hz": RATE_HZ}, rows=rows)


def add_options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--mocap", type=Path, action=Reads, required=True, help="folder with cmu_joints_m_120fps.npz")


def run_study(options: argparse.Namespace, run: StudyRun) -> None:
    measure(run, options.mocap)
