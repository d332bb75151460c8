"""Errors of predicted skeletons: mean distances of joints (MPJPE), by what is aligned first and by group of joints."""

import numpy as np
from jaxtyping import Bool, Float

from mmweaver.core.skeleton import JOINT_NAMES

Joints = Float[np.ndarray, "frame 22 3"]

# The joints of the Kinect that MARS is scored on have no collars and no spine1, spine3 of their own.
GROUPS = {
    "torso": ("pelvis", "spine2", "left_shoulder", "right_shoulder", "left_hip", "right_hip"),
    "head": ("neck", "head"),
    "arms": ("left_elbow", "right_elbow", "left_wrist", "right_wrist"),
    "legs": ("left_knee", "right_knee", "left_ankle", "right_ankle", "left_foot", "right_foot"),
}
SCORED = tuple(JOINT_NAMES.index(name) for names in GROUPS.values() for name in names)
ALIGNMENTS = ("root", "centroid", "procrustes")


def aligned(predicted_m: Joints, true_m: Joints, alignment: str) -> tuple[np.ndarray, np.ndarray]:
    """The scored joints of both (frame, 18, 3) after an alignment frame by frame.

    root: both pelvises at the origin; centroid: both means of the scored joints; procrustes: the prediction also
    rotated and scaled as fits best.
    """
    ours, theirs = predicted_m[:, SCORED], true_m[:, SCORED]
    if alignment == "root":
        return ours - predicted_m[:, :1], theirs - true_m[:, :1]
    ours, theirs = ours - ours.mean(axis=1, keepdims=True), theirs - theirs.mean(axis=1, keepdims=True)
    return (_fitted(ours, theirs), theirs) if alignment == "procrustes" else (ours, theirs)


def _fitted(ours: np.ndarray, theirs: np.ndarray) -> np.ndarray:
    """Centred joints (frame, joint, 3) rotated and scaled to others by least squares (Umeyama 1991)."""
    left, values, right = np.linalg.svd(np.swapaxes(ours, 1, 2) @ theirs)
    flip = np.sign(np.linalg.det(left @ right))
    values[:, -1] *= flip
    right[:, -1] *= flip[:, None]
    scale = values.sum(axis=1) / np.maximum((ours**2).sum(axis=(1, 2)), 1e-12)
    return scale[:, None, None] * ours @ (left @ right)


def joint_errors_cm(
    predicted_m: Joints, true_m: Joints, alignment: str, measured: Bool[np.ndarray, " frame"] | None = None
) -> dict[str, float]:
    """Mean distance in cm: `all` scored joints and each group; frames whose truth is not `measured` do not count."""
    chosen = np.isfinite(true_m).all(axis=(1, 2)) if measured is None else measured
    ours, theirs = aligned(predicted_m[chosen], true_m[chosen], alignment)
    far_cm = 100 * np.linalg.norm(ours - theirs, axis=-1).mean(axis=0)
    names = [JOINT_NAMES[index] for index in SCORED]
    groups = {group: [names.index(name) for name in members] for group, members in GROUPS.items()}
    return {"all": float(far_cm.mean()), **{group: float(far_cm[own].mean()) for group, own in groups.items()}}
