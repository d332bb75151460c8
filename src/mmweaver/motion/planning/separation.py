"""How near two people come to each other: pelvis from pelvis, and skin from skin."""

import numpy as np
from jaxtyping import Float

from mmweaver.core.records import PoseSequence
from mmweaver.core.skeleton import JOINT_NAMES, PARENTS, joint

Array = np.ndarray
PELVISES_APART_M, BODIES_APART_M = 0.5, 0.02
LOOK_HZ = 20.0  # how often bodies are held against each other: a limb at 3 m/s moves 15 cm between
REFERENCE_HEIGHT_M = 1.75
PER_BONE = 4  # spheres along a bone

# How thick a 1.75 m person is about each bone (named by its far joint), from near to far; the trunk at its widest.
_THICKNESS_M = {
    "hip": (0.13, 0.105), "spine1": (0.156, 0.144), "spine2": (0.144, 0.144), "spine3": (0.144, 0.156),
    "neck": (0.15, 0.06), "head": (0.055, 0.085), "collar": (0.12, 0.08), "shoulder": (0.08, 0.06),
    "knee": (0.085, 0.058), "ankle": (0.055, 0.038), "foot": (0.038, 0.06), "elbow": (0.05, 0.042),
    "wrist": (0.042, 0.035),
}  # fmt: skip
CROWN_M, CROWN_RADIUS_M = 0.1, 0.095  # past the head joint
HAND_M, HAND_RADIUS_M = 0.13, 0.03  # past the wrist


def are_apart(one: PoseSequence, other: PoseSequence) -> bool:
    """Whether two people never come too near to each other."""
    pelvis_m, body_m = gaps_m(one, other)
    return pelvis_m >= PELVISES_APART_M and body_m >= BODIES_APART_M


def gaps_m(one: PoseSequence, other: PoseSequence) -> tuple[float, float]:
    """The least distance over time of the pelvises (on the floor), and of the bodies' surfaces (negative: inside)."""
    time_s = _common_times(one, other)
    first, second = (_at(pose, time_s) for pose in (one, other))
    pelvis = joint("pelvis")
    pelvises = np.linalg.norm(first[:, pelvis, :2] - second[:, pelvis, :2], axis=1)
    (centre_a, radius_a), (centre_b, radius_b) = _spheres(first, one.height_m), _spheres(second, other.height_m)
    least = np.inf
    for near in np.flatnonzero(pelvises < 2.2):
        apart = np.linalg.norm(centre_a[near][:, None] - centre_b[near][None], axis=-1)
        least = min(least, float((apart - radius_a[:, None] - radius_b[None, :]).min()))
    return float(pelvises.min()), least


def keeps_clear(track_m: Float[Array, "time 2"], time_s: Float[Array, " time"], other: PoseSequence) -> bool:
    """Whether a way over the floor stays clear of somebody's pelvis and, by half a body's width, of every joint."""
    joints_m = _at(other, time_s)[:, :, :2]
    apart = np.linalg.norm(joints_m - track_m[:, None], axis=-1)
    return bool(apart[:, joint("pelvis")].min() >= PELVISES_APART_M + 0.15 and apart.min() >= 0.4)


def _common_times(one: PoseSequence, other: PoseSequence) -> Float[Array, " time"]:
    first, last = max(one.time_s[0], other.time_s[0]), min(one.time_s[-1], other.time_s[-1])
    return np.linspace(first, last, max(2, int(np.ceil((last - first) * LOOK_HZ)) + 1))


def _at(pose: PoseSequence, time_s: Float[Array, " time"]) -> Float[Array, "time 22 3"]:
    nearest = np.clip(np.searchsorted(pose.time_s, time_s), 0, len(pose.time_s) - 1)
    return np.asarray(pose.joints_m[nearest], dtype=float)


def _spheres(
    joints_m: Float[Array, "time 22 3"], height_m: float
) -> tuple[Float[Array, "time sphere 3"], Float[Array, " sphere"]]:
    """A body as spheres along its bones."""
    centres, radii = [], []
    scale = height_m / REFERENCE_HEIGHT_M
    for child, parent in enumerate(PARENTS):
        if parent < 0:
            continue
        name = JOINT_NAMES[child].removeprefix("left_").removeprefix("right_")
        near, far = _THICKNESS_M[name]
        for share in np.linspace(0, 1, PER_BONE):
            centres.append(joints_m[:, parent] + share * (joints_m[:, child] - joints_m[:, parent]))
            radii.append(near + share * (far - near))
        past = {"head": (CROWN_M, CROWN_RADIUS_M), "wrist": (HAND_M, HAND_RADIUS_M)}.get(name)
        if past:
            bone = joints_m[:, child] - joints_m[:, parent]
            unit = bone / np.maximum(np.linalg.norm(bone, axis=-1, keepdims=True), 1e-6)
            centres += [joints_m[:, child] + share * past[0] * scale * unit for share in (0.5, 1.0)]
            radii += [past[1], past[1]]
    return np.stack(centres, axis=1), np.array(radii) * scale
