"""The ten exercises of MARS as the library does them, and as its first subject did before a Kinect.

python -m studies run mars_exercises --data shared/data/pointclouds/mars/subject1

The recordings hold the exercises one after the other; where one ends was read from the jumps between frames of both
splits. Figures of the last fifths of each (validate and test) are compared with the median of generated ones; the
baseline is the mean pose of all recorded frames, which is what somebody would be shown who does none of them. One
subject: nothing is said of how people differ. How high the arms go in the extensions, and how slowly, was set after a
first look at these figures; the depth, stance and pace of squats and lunges after a second one. So these figures do not
test the library: they say how near it was brought.
"""

import argparse
import hashlib
from pathlib import Path
from typing import Any

import numpy as np
from jaxtyping import Float

from mmweaver.core.skeleton import joint
from mmweaver.motion.empty_floor import act_out
from studies.manifest import StudyRun
from studies.physics.mars_data import FRAME_S, KINECT_COLUMNS, joints_from_kinect
from studies.result_rows import complete_rows
from studies.study import Reads

Array = np.ndarray
Joints = Float[Array, "frame 22 3"]
SEEDS, SECONDS = 6, 12.0
# Of each exercise: its sentence, and its rows in kinect_data_validate.csv and kinect_data_test.csv.
EXERCISES: dict[str, tuple[str, tuple[int, int], tuple[int, int]]] = {
    "left upper limb extension": ("a person extends the left arm up at the side", (0, 178), (0, 148)),
    "right upper limb extension": ("a person extends the right arm up at the side", (214, 431), (196, 428)),
    "both upper limbs extension": ("a person extends both arms up at the sides", (432, 673), (443, 668)),
    "left front lunge": ("a person does front lunges with the left leg with the hands up", (674, 934), (669, 927)),
    "right front lunge": ("a person does front lunges with the right leg with the hands up", (935, 1128), (928, 1120)),
    "squat": ("a person does squats with the hands up", (1129, 1393), (1121, 1384)),
    "left side lunge": ("a person does side lunges with the left leg", (1394, 1620), (1385, 1623)),
    "right side lunge": ("a person does side lunges with the right leg", (1635, 1847), (1624, 1835)),
    "left limb extension": ("a person extends the left arm and leg to the side", (1848, 2100), (1836, 2090)),
    "right limb extension": ("a person extends the right arm and leg to the side", (2172, 2366), (2110, 2351)),
}  # fmt: skip
UNITS = {
    "left_hand_low_m": "m", "left_hand_high_m": "m", "right_hand_low_m": "m", "right_hand_high_m": "m",
    "pelvis_drop_m": "m", "feet_apart_m": "m", "left_knee_deg": "deg", "right_knee_deg": "deg", "period_s": "s",
}  # fmt: skip
MEANING = (
    "hands: 5th and 95th percentile of the wrist over the head joint, in a person of 1.75 m; pelvis: 5th to 95th"
    " percentile; feet: 95th of the ankles' horizontal distance; knees: 95th of their flexion; period: of the strongest"
    " oscillation of the pose"
)


def figures(joints_m: Joints, step_s: float, height_m: float) -> dict[str, float]:
    """Figures of a stretch of one exercise; lengths for a person of 1.75 m."""
    scale = 1.75 / height_m
    found: dict[str, float] = {}
    for side in ("left", "right"):
        hand = (joints_m[:, joint(f"{side}_wrist"), 2] - joints_m[:, joint("head"), 2]) * scale
        low, high = np.percentile(hand, (5, 95))
        found |= {f"{side}_hand_low_m": float(low), f"{side}_hand_high_m": float(high)}
        found[f"{side}_knee_deg"] = float(np.percentile(_knee_deg(joints_m, side), 95))
    apart = np.linalg.norm((joints_m[:, joint("left_ankle")] - joints_m[:, joint("right_ankle")])[:, :2], axis=1)
    found["feet_apart_m"] = float(np.percentile(apart, 95)) * scale
    found["pelvis_drop_m"] = float(np.ptp(np.percentile(joints_m[:, 0, 2], (5, 95)))) * scale
    found["period_s"] = period_s(joints_m, step_s)
    return {name: found[name] for name in UNITS}


def _knee_deg(joints_m: Joints, side: str) -> Float[Array, " frame"]:
    thigh, shank = (
        joints_m[:, joint(f"{side}_{end}")] - joints_m[:, joint(f"{side}_knee")] for end in ("hip", "ankle")
    )
    cosine = np.sum(thigh * shank, axis=1) / np.linalg.norm(thigh, axis=1) / np.linalg.norm(shank, axis=1)
    return 180 - np.degrees(np.arccos(np.clip(cosine, -1, 1)))


def period_s(joints_m: Joints, step_s: float) -> float:
    """Of the strongest oscillation of the pose between 1 and 10 s; nan for a pose that does not move."""
    pose = (joints_m - joints_m[:, :1]).reshape(len(joints_m), -1)
    pose = pose - pose.mean(axis=0)
    if np.abs(pose).max() < 1e-6:
        return float("nan")
    along = pose @ np.linalg.svd(pose, full_matrices=False)[2][0]
    spectrum = np.abs(np.fft.rfft(along * np.hanning(len(along)), 8 * len(along)))
    rate_hz = np.fft.rfftfreq(8 * len(along), step_s)
    usual = (rate_hz > 0.1) & (rate_hz < 1.0)
    return float(1 / rate_hz[usual][spectrum[usual].argmax()])


def recorded(folder: Path) -> dict[str, list[Joints]]:
    """The stretches of each exercise, of frames that the Kinect measured."""
    found: dict[str, list[Joints]] = {name: [] for name in EXERCISES}
    for number, split in enumerate(("validate", "test")):
        table = np.genfromtxt(folder / f"kinect_data_{split}.csv", delimiter=",")
        joints_m = joints_from_kinect(table[:, :KINECT_COLUMNS].reshape(-1, 3, 25).swapaxes(1, 2))
        for name, (_, *rows) in EXERCISES.items():
            begin, end = rows[number]
            stretch = joints_m[begin:end]
            found[name].append(stretch[np.isfinite(stretch).all(axis=(1, 2))])
    return found


def body_m(joints_m: Joints) -> float:
    """Height of the recorded body, from the head joint of standing frames, which is at 0.91 of it in ours."""
    feet = np.minimum(joints_m[:, joint("left_ankle"), 2], joints_m[:, joint("right_ankle"), 2])
    return float(np.percentile(joints_m[:, joint("head"), 2] - feet, 90)) / (0.91 - 0.045)


def result_rows(folder: Path) -> list[dict[str, Any]]:
    """A row an exercise."""
    stretches = recorded(folder)
    height_m = body_m(np.concatenate([one for parts in stretches.values() for one in parts]))
    mean_pose = np.mean([part.mean(axis=0) for parts in stretches.values() for part in parts], axis=0)
    digest = hashlib.sha256((folder / "kinect_data_test.csv").read_bytes()).hexdigest()
    baseline = figures(np.repeat(mean_pose[None], 50, axis=0), FRAME_S, height_m)
    rows = []
    for name, (text, *_) in EXERCISES.items():
        theirs = _median([figures(part, FRAME_S, height_m) for part in stretches[name]])
        poses = [act_out(text, duration_s=SECONDS, seed=seed).pose for seed in range(SEEDS)]
        ours = _median([figures(pose.joints_m, 1 / 120, pose.height_m) for pose in poses])
        metrics = {
            figure: {
                "value": round(ours[figure], 3), "unit": unit, "definition": MEANING, "version": 1,
                "recorded": round(theirs[figure], 3),
                **({} if np.isnan(baseline[figure]) else {"baseline": {"mean_pose": round(baseline[figure], 3)}}),
            }
            for figure, unit in UNITS.items()
        }  # fmt: skip
        rows.append({
            "dataset": {"name": name, "sha256": digest, "split": "validate and test of subject 1"}, "text": text,
            "n": len(stretches[name]), "seeds": list(range(SEEDS)), "metrics": metrics,
        })  # fmt: skip
    return rows


def _median(all_figures: list[dict[str, float]]) -> dict[str, float]:
    return {name: float(np.median([one[name] for one in all_figures])) for name in UNITS}


def add_options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--data", type=Path, action=Reads, required=True, help="folder of MARS's first subject")


def run_study(options: argparse.Namespace, run: StudyRun) -> None:
    rows = complete_rows(
        result_rows(options.data),
        unknown={"seconds": "see the manifest: all rows together", "metrics.period_s.baseline": "a pose has no period"},
    )
    run.write("mars_exercises", "library", config={"seconds": SECONDS}, rows=rows)
