"""Separation of two people: the distance of their pelvises, and that of their body surfaces."""

import numpy as np
from jaxtyping import Float

from mmweaver.core.body_capsules import TRUNK, TRUNK_WIDTH_PER_DEPTH, capsule_between, part_of, scale_of
from mmweaver.core.records import PoseSequence
from mmweaver.core.skeleton import JOINT_NAMES, PARENTS, joint

Array = np.ndarray
MIN_PELVIS_DISTANCE_M, MIN_SURFACE_DISTANCE_M = 0.5, 0.02
CHECK_RATE_HZ = 20.0  # comparison rate: a limb at 3 m/s moves 15 cm in between
SPHERES_PER_BONE = 4
TRACK_MARGIN_M, HALF_BODY_WIDTH_M = 0.15, 0.4  # for a person who is not animated yet: only the pelvis's track is known
_FARTHEST_REACH_M = 2.2  # bodies whose pelvises are farther apart cannot touch

# Bones inside the trunk that no capsule follows: radius at the near and the far joint.
_TRUNK_BONES_M = {"hip": (0.13, capsule_between("left_hip", "left_hip").start_radius_m), "collar": (0.12, 0.08)}
# Added to a capsule's radius at the near and the far joint, since a row of spheres has no caps: the back of the head,
# the shoulder's muscle, toes and palm.
_MARGIN_M = {"head": (0.0, 0.01), "shoulder": (0.01, 0.0), "foot": (0.0, 0.025), "wrist": (0.0, 0.005)}
_HAND_LONGER_M, _HAND_THINNER_M = 0.01, 0.01  # than its capsule: an outstretched, flat hand


def are_separate(one: PoseSequence, other: PoseSequence) -> bool:
    """Whether two people keep their minimum distances at all times.

    Args:
        one: Motion of one person.
        other: Motion of the other person.

    Returns:
        True if the pelvises stay 0.5 m apart and the body surfaces 2 cm.
    """
    pelvis_m, body_m = separations_m(one, other)
    return pelvis_m >= MIN_PELVIS_DISTANCE_M and body_m >= MIN_SURFACE_DISTANCE_M


def separations_m(one: PoseSequence, other: PoseSequence) -> tuple[float, float]:
    """Minimum distances of two people over time.

    Args:
        one: Motion of one person.
        other: Motion of the other person.

    Returns:
        Metres between the pelvises on the floor, and between the body surfaces (negative: overlap).
    """
    time_s = _common_times(one, other)
    first, second = (_at(pose, time_s) for pose in (one, other))
    pelvis = joint("pelvis")
    pelvises = np.linalg.norm(first[:, pelvis, :2] - second[:, pelvis, :2], axis=1)
    (centre_a, radius_a), (centre_b, radius_b) = _spheres(first, one.height_m), _spheres(second, other.height_m)
    least = np.inf
    for near in np.flatnonzero(pelvises < _FARTHEST_REACH_M):
        distance = np.linalg.norm(centre_a[near][:, None] - centre_b[near][None], axis=-1)
        least = min(least, float((distance - radius_a[:, None] - radius_b[None, :]).min()))
    return float(pelvises.min()), least


def is_clear_of(track_m: Float[Array, "time 2"], time_s: Float[Array, " time"], other: PoseSequence) -> bool:
    """Whether a track on the floor stays clear of a person's pelvis and, by half a body's width, of all joints.

    Args:
        track_m: Positions (x, y) in metres, (time, 2).
        time_s: Times (time,) in seconds.
        other: Motion of the person.
    """
    joints_m = _at(other, time_s)[:, :, :2]
    distance_m = np.linalg.norm(joints_m - track_m[:, None], axis=-1)
    pelvis_m = distance_m[:, joint("pelvis")].min()
    return bool(pelvis_m >= MIN_PELVIS_DISTANCE_M + TRACK_MARGIN_M and distance_m.min() >= HALF_BODY_WIDTH_M)


def _common_times(one: PoseSequence, other: PoseSequence) -> Float[Array, " time"]:
    first, last = max(one.time_s[0], other.time_s[0]), min(one.time_s[-1], other.time_s[-1])
    return np.linspace(first, last, max(2, int(np.ceil((last - first) * CHECK_RATE_HZ)) + 1))


def _at(pose: PoseSequence, time_s: Float[Array, " time"]) -> Float[Array, "time 22 3"]:
    nearest = np.clip(np.searchsorted(pose.time_s, time_s), 0, len(pose.time_s) - 1)
    return np.asarray(pose.joints_m[nearest], dtype=float)


def _bone_radii_m(parent: str, child: str) -> tuple[float, float]:
    """Half the body's width about a bone at its near and far joint, at reference height."""
    part = part_of(child)
    if part in _TRUNK_BONES_M:
        return _TRUNK_BONES_M[part]
    capsule, margin = capsule_between(parent, child), _MARGIN_M.get(part, (0.0, 0.0))
    near = capsule.start_radius_m * (TRUNK_WIDTH_PER_DEPTH if parent in TRUNK else 1.0) + margin[0]
    far = capsule.end_radius_m * (TRUNK_WIDTH_PER_DEPTH if child in TRUNK else 1.0) + margin[1]
    return round(near, 3), round(far, 3)


def _tip_m(child: str) -> tuple[float, float] | None:
    """Extension of the body past its last joint, and the radius there; None if the bone ends the chain."""
    if part_of(child) not in ("head", "wrist"):
        return None
    tip = capsule_between(child, child)
    if part_of(child) == "head":
        return tip.extend_m, tip.end_radius_m
    return round(tip.extend_m + _HAND_LONGER_M, 3), round(tip.end_radius_m - _HAND_THINNER_M, 3)


def _spheres(
    joints_m: Float[Array, "time 22 3"], height_m: float
) -> tuple[Float[Array, "time sphere 3"], Float[Array, " sphere"]]:
    """A body as spheres along its bones: centres and radii, in metres."""
    centres, radii = [], []
    scale = scale_of(height_m)
    for child, parent in enumerate(PARENTS):
        if parent < 0:
            continue
        near, far = _bone_radii_m(JOINT_NAMES[parent], JOINT_NAMES[child])
        for share in np.linspace(0, 1, SPHERES_PER_BONE):
            centres.append(joints_m[:, parent] + share * (joints_m[:, child] - joints_m[:, parent]))
            radii.append(near + share * (far - near))
        tip = _tip_m(JOINT_NAMES[child])
        if tip:
            bone = joints_m[:, child] - joints_m[:, parent]
            unit = bone / np.maximum(np.linalg.norm(bone, axis=-1, keepdims=True), 1e-6)
            centres += [joints_m[:, child] + share * tip[0] * scale * unit for share in (0.5, 1.0)]
            radii += [tip[1], tip[1]]
    return np.stack(centres, axis=1), np.array(radii) * scale
