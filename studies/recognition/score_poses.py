"""Poses of a network scored on the recordings of MARS, next to what needs no radar: mean poses."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from jaxtyping import Float

from mmweaver.core.errors import InputError
from mmweaver.core.skeleton import joint
from mmweaver.evaluation.pose_errors import ALIGNMENTS, joint_errors_cm
from mmweaver.models.point_frames import point_frames
from mmweaver.recognition.point_recordings import PointRecording
from mmweaver.recognition.train_pose import PoseEstimator
from studies.physics.mars_data import posed_recordings

Joints = Float[np.ndarray, "frame 22 3"]
SPLITS = ("train", "validate", "test")


@dataclass(frozen=True, kw_only=True)
class JointCalibration:
    """Where joints are relative to the pelvis on average, predicted and true, and how much less they should move."""

    predicted_m: Float[np.ndarray, "22 3"]
    true_m: Float[np.ndarray, "22 3"]
    shrink: Float[np.ndarray, "22 1"]

    @staticmethod
    def of(predicted_m: Joints, true_m: Joints) -> "JointCalibration":
        """Fits it by least squares."""
        measured = np.isfinite(true_m).all(axis=(1, 2))
        ours, theirs = (one[measured] - one[measured][:, :1] for one in (predicted_m, true_m))
        here, there = ours.mean(axis=0), theirs.mean(axis=0)
        moved = ((ours - here) ** 2).sum(axis=(0, 2))
        along = ((ours - here) * (theirs - there)).sum(axis=(0, 2))
        return JointCalibration(
            predicted_m=here, true_m=there, shrink=(along / np.maximum(moved, 1e-12)).clip(0, 1)[:, None]
        )

    def apply(self, predicted_m: Joints) -> Joints:
        """Calibrated joints, relative to the pelvis."""
        return self.true_m + self.shrink * (predicted_m - predicted_m[:, :1] - self.predicted_m)


def as_kinect(joints_m: Joints) -> Joints:
    """Our joints where the Kinect has its own: its base of the spine is the middle of the hips."""
    moved = joints_m.copy()
    moved[:, joint("pelvis")] = joints_m[:, [joint("left_hip"), joint("right_hip")]].mean(axis=1)
    return moved


def errors(predicted_m: Joints, true_m: Joints) -> dict[str, dict[str, float]]:
    """Of each alignment, the mean error in cm over all scored joints and by group."""
    return {name: joint_errors_cm(predicted_m, true_m, name) for name in ALIGNMENTS}


def mean_pose(true_m: Joints) -> Float[np.ndarray, "22 3"]:
    """The mean of measured joints relative to the pelvis."""
    return np.nanmean(true_m - true_m[:, :1], axis=0)


def repeated(pose_m: Float[np.ndarray, "22 3"], true_m: Joints) -> Joints:
    """A pose as a prediction of every frame."""
    return np.repeat(pose_m[None], len(true_m), axis=0)


def subject_folders(place: Path | str, split: str) -> list[Path]:
    """Folders of MARS's subjects below a place. Raises InputError where there are none."""
    found = sorted(file.parent for file in Path(place).rglob(f"kinect_data_{split}.csv"))
    if not found:
        raise InputError(f"{place} holds no kinect_data_{split}.csv; give the folder of MARS or of one of its subjects")
    return found


def read_subject(folder: Path, split: str, window_frames: int) -> list[PointRecording]:
    """The stretches of a split that are as long as a window; too short ones are between exercises."""
    return [one for one in posed_recordings(folder, split) if one.num_frames >= window_frames]


def predicted(estimator: PoseEstimator, recordings: Sequence[PointRecording]) -> Joints:
    """Joints of all frames of recordings, one after the other, where the Kinect has its own."""
    return as_kinect(
        np.concatenate([estimator.joints_m(point_frames(one.cloud, one.num_frames)) for one in recordings])
    )


def truth(recordings: Sequence[PointRecording]) -> Joints:
    """True joints of all frames, nan where none was measured."""
    return np.concatenate([one.joints_m for one in recordings if one.joints_m is not None])


def score_poses(estimator: PoseEstimator, place: Path | str, split: str) -> dict[str, Any]:
    """Errors in cm of the network and of mean poses on one split of all subjects below a place.

    The mean pose of real people, and the calibration, come from the same subject's other split where it is there: they
    know the person, the network does not. Raises InputError.
    """
    rows: list[dict[str, Any]] = []
    length = estimator.settings.window_frames
    generated_mean_m = as_kinect(estimator.mean_pose_m[None])[0]
    for folder in subject_folders(place, split):
        recordings = read_subject(folder, split, length)
        if not recordings:
            raise InputError(f"{folder}: no stretch of {split} is as long as a window of {length} frames")
        ours, theirs = predicted(estimator, recordings), truth(recordings)
        row = {
            "subject": folder.name, "frames": int(np.isfinite(theirs).all(axis=(1, 2)).sum()),
            "network": errors(ours, theirs),
            "generated_mean_pose": errors(repeated(generated_mean_m, theirs), theirs),
        }  # fmt: skip
        other = next((one for one in SPLITS if one != split and (folder / f"kinect_data_{one}.csv").is_file()), None)
        if other is not None:
            known = read_subject(folder, other, length)
            row["real_mean_pose"] = errors(repeated(mean_pose(truth(known)), theirs), theirs)
            calibration = JointCalibration.of(predicted(estimator, known), truth(known))
            row["network_calibrated"] = errors(calibration.apply(ours), theirs)
            row["calibrated_on"] = other
        rows.append(row)
    methods = [name for name in rows[0] if isinstance(rows[0][name], dict) and all(name in row for row in rows)]
    mean = {
        method: {
            alignment: {group: float(np.mean([row[method][alignment][group] for row in rows])) for group in groups}
            for alignment, groups in rows[0][method].items()
        }
        for method in methods
    }
    return {"split": split, "unit": "cm", "mean": mean, "subjects": rows}
