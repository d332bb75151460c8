"""Errors of predicted skeletons: mean per-joint position error (MPJPE) by alignment and group of joints."""

import numpy as np
from jaxtyping import Bool, Float

from mmweaver.core.skeleton import JOINT_NAMES

Joints = Float[np.ndarray, "frame 22 3"]

# The Kinect joints on which MARS is scored lack collars, spine1 and spine3.
GROUPS = {
    "torso": ("pelvis", "spine2", "left_shoulder", "right_shoulder", "left_hip", "right_hip"),
    "head": ("neck", "head"),
    "arms": ("left_elbow", "right_elbow", "left_wrist", "right_wrist"),
    "legs": ("left_knee", "right_knee", "left_ankle", "right_ankle", "left_foot", "right_foot"),
}
SCORED = tuple(JOINT_NAMES.index(name) for names in GROUPS.values() for name in names)
ALIGNMENTS = ("root", "centroid", "procrustes")


def aligned(predicted_m: Joints, true_m: Joints, alignment: str) -> tuple[np.ndarray, np.ndarray]:
    """Aligns prediction and ground truth frame by frame.

    Args:
        predicted_m: Predicted joints in metres, (frame, 22, 3).
        true_m: Ground truth in metres, (frame, 22, 3).
        alignment: "root": both pelvises at the origin; "centroid": both centroids of the scored joints at the origin;
            "procrustes": the prediction also rotated and scaled by least squares.

    Returns:
        Scored joints of prediction and ground truth, (frame, 18, 3).
    """
    ours, theirs = predicted_m[:, SCORED], true_m[:, SCORED]
    if alignment == "root":
        return ours - predicted_m[:, :1], theirs - true_m[:, :1]
    ours, theirs = ours - ours.mean(axis=1, keepdims=True), theirs - theirs.mean(axis=1, keepdims=True)
    return (_fitted(ours, theirs), theirs) if alignment == "procrustes" else (ours, theirs)


def _fitted(ours: np.ndarray, theirs: np.ndarray) -> np.ndarray:
    """Rotates and scales centred joints (frame, joint, 3) to others by least squares (Umeyama 1991)."""
    left, values, right = np.linalg.svd(np.swapaxes(ours, 1, 2) @ theirs)
    flip = np.sign(np.linalg.det(left @ right))
    values[:, -1] *= flip
    right[:, -1] *= flip[:, None]
    scale = values.sum(axis=1) / np.maximum((ours**2).sum(axis=(1, 2)), 1e-12)
    return scale[:, None, None] * ours @ (left @ right)


def joint_errors_cm(
    predicted_m: Joints, true_m: Joints, alignment: str, measured: Bool[np.ndarray, " frame"] | None = None
) -> dict[str, float]:
    """Computes mean per-joint position errors.

    Args:
        predicted_m: Predicted joints in metres, (frame, 22, 3).
        true_m: Ground truth in metres, (frame, 22, 3).
        alignment: One of ALIGNMENTS, see `aligned`.
        measured: Frames with valid ground truth, (frame,). Default: those without nan.

    Returns:
        Mean distance in cm of "all" scored joints and of each group.
    """
    chosen = np.isfinite(true_m).all(axis=(1, 2)) if measured is None else measured
    ours, theirs = aligned(predicted_m[chosen], true_m[chosen], alignment)
    far_cm = 100 * np.linalg.norm(ours - theirs, axis=-1).mean(axis=0)
    names = [JOINT_NAMES[index] for index in SCORED]
    groups = {group: [names.index(name) for name in members] for group, members in GROUPS.items()}
    return {"all": float(far_cm.mean()), **{group: float(far_cm[own].mean()) for group, own in groups.items()}}
