"""Mapping of joint names of other skeletons to our 22 joints.

Names are split into a side and a part ("LeftForeArm", "lowerarm_l", "Bip01 L Forearm" and "mixamorig:LeftForeArm" are
all left + forearm). Two words mean different joints in different files: a "shoulder" is the collar if the file also has
an arm, a "foot" is the ankle unless the file has an ankle.
"""

import re

import numpy as np
from jaxtyping import Float

from mmweaver.core.errors import InputError
from mmweaver.core.skeleton import JOINT_NAMES, NUM_JOINTS, joint
from mmweaver.motion.mocap.clip import RawMotion

Array = np.ndarray
PREFIX = re.compile(r"^(mixamorig\d*|bip0*1?|valvebiped|character\d*|skeleton|def|jnt|joint(?=root))[ _.:-]*", re.I)
TOKENS = re.compile(r"[A-Z]+(?![a-z])|[A-Z]?[a-z]+|\d+")
SIDES = {"l": "left", "left": "left", "r": "right", "right": "right"}
SIDED: dict[str, tuple[str, ...]] = {
    "hip": ("hip", "upleg", "thigh", "upperleg"),
    "knee": ("knee", "leg", "lowerleg", "lowleg", "shin", "calf"),
    "ankle": ("ankle", "foot"),
    "foot": ("toebase", "toe", "toes", "ball", "forefoot", "foot"),
    "collar": ("collar", "clavicle", "innershoulder", "shoulder"),
    "shoulder": ("upperarm", "uparm", "arm", "shldr", "shoulder"),
    "elbow": ("elbow", "forearm", "lowerarm", "lowarm"),
    "wrist": ("wrist", "hand"),
}
SPINE = {"spine", "chest", "upperchest", "torso", "abdomen", "lowerback", "upperback", "waist", "thorax", "lowertorso"}
VERTEBRAE = re.compile(r"^[lt]\d+$", re.I)  # L5, L3, T12, T8
PELVIS = ("pelvis", "hips", "hip", "root")
# Where the three spine joints of the mean SMPL body lie between pelvis and neck.
SPINE_SHARES = (0.21, 0.47, 0.58)
FINGERS = re.compile(r"thumb|index|middle|ring|pinky|finger|twist|ik|pole|metacarp|hold|prop", re.I)


def parts_of(name: str) -> tuple[str, str, int]:
    """Side ("left", "right" or ""), part and number of a joint's name.

    >>> parts_of("mixamorig:LeftForeArm"), parts_of("spine_02"), parts_of("Bip01 R Thigh")
    (('left', 'forearm', 0), ('', 'spine', 2), ('right', 'thigh', 0))
    """
    bare = PREFIX.sub("", name.split(":")[-1].split("|")[-1])
    if VERTEBRAE.match(bare):
        return "", "spine", 0
    tokens = [token.lower() for token in TOKENS.findall(bare)]
    side = next((SIDES[token] for token in tokens if token in SIDES), "")
    words = [token for token in tokens if token not in SIDES and not token.isdigit()]
    numbers = [int(token) for token in tokens if token.isdigit()]
    part = "".join(words)
    if not side and part[:1] in ("l", "r") and part[1:] in {word for known in SIDED.values() for word in known}:
        side, part = SIDES[part[0]], part[1:]  # lhip, rknee
    return side, part, numbers[-1] if numbers else 0


def to_22(raw: RawMotion, source: str) -> Float[Array, "frame 22 3"]:
    """The 22 joints (frame, 22, 3) of a motion under other names; missing spine, neck, collars, feet are interpolated.

    Raises InputError, naming them, where other joints are missing.
    """
    lowered = [name.lower() for name in raw.names]
    if set(JOINT_NAMES) <= set(lowered):
        return np.asarray(raw.positions[:, [lowered.index(name) for name in JOINT_NAMES]])
    found = _limbs(raw.names)
    known = {name: raw.positions[:, index] for name, index in found.items()}
    neck = _first(raw.names, ("neck",))
    head = _first(raw.names, ("head",))
    pelvis = next((index for word in PELVIS if (index := _first(raw.names, (word,))) is not None), None)
    missing = [
        f"{side}_{part}"
        for side in ("left", "right")
        for part in SIDED
        if part not in ("collar", "foot") and f"{side}_{part}" not in known
    ] + ([] if head is not None else ["head"])
    if missing:
        theirs = ", ".join(raw.names[:12]) + (", ..." if len(raw.names) > 12 else "")
        raise InputError(
            f"{source}: no joint is known as {', '.join(missing[:6])}{' and more' if len(missing) > 6 else ''}; the"
            f" file's joints are {theirs}; rename them as core/skeleton.py does"
        )
    joints = np.full((len(raw.positions), NUM_JOINTS, 3), np.nan)
    for name, place in known.items():
        joints[:, joint(name)] = place
    hips = 0.5 * (known["left_hip"] + known["right_hip"])
    shoulders = 0.5 * (known["left_shoulder"] + known["right_shoulder"])
    joints[:, 0] = hips if pelvis is None else raw.positions[:, pelvis]
    joints[:, joint("head")] = raw.positions[:, head]
    joints[:, joint("neck")] = (
        raw.positions[:, neck] if neck is not None else shoulders + 0.3 * (joints[:, joint("head")] - shoulders)
    )
    chain = [raw.positions[:, k] for k in _spine(raw.names)]
    _fill_spine(joints, chain)
    _fill_ends(joints, known)
    return joints


def _limbs(names: tuple[str, ...]) -> dict[str, int]:
    """Index of each left or right joint in the file's names."""
    parts: dict[tuple[str, str], int] = {}
    for index, name in enumerate(names):
        side, part, _ = parts_of(name)
        if side and not FINGERS.search(name):
            parts.setdefault((side, part), index)
    found: dict[str, int] = {}
    for side in ("left", "right"):
        has = {part for one, part in parts if one == side}
        arm_named = bool(has & {"upperarm", "uparm", "arm", "shldr"})
        for ours, words in SIDED.items():
            for word in words:
                if word not in has:
                    continue
                if ours == "collar" and word == "shoulder" and not arm_named:
                    continue
                if ours == "shoulder" and word == "shoulder" and arm_named:
                    continue
                if ours == "foot" and word == "foot" and "ankle" not in has:
                    continue
                found[f"{side}_{ours}"] = parts[side, word]
                break
    return found


def _first(names: tuple[str, ...], words: tuple[str, ...]) -> int | None:
    """Index of the unsided joint with one of these names and the lowest number; None if there is none."""
    hits = [(parts_of(name)[2], k) for k, name in enumerate(names) if parts_of(name)[:2] in {("", w) for w in words}]
    return min(hits)[1] if hits else None


def _spine(names: tuple[str, ...]) -> list[int]:
    return [k for k, name in enumerate(names) if parts_of(name)[0] == "" and parts_of(name)[1] in SPINE]


def _fill_spine(joints: Float[Array, "frame 22 3"], chain: list[Float[Array, "frame 3"]]) -> None:
    """Interpolates the three spine joints along the file's own spine, from pelvis to neck."""
    knots = np.stack([joints[:, 0], *chain, joints[:, joint("neck")]], axis=1)  # (frame, knot, 3)
    lengths = np.nanmedian(np.linalg.norm(np.diff(knots, axis=1), axis=-1), axis=0)
    distances = np.concatenate([[0.0], np.cumsum(lengths)])
    for name, share in zip(("spine1", "spine2", "spine3"), SPINE_SHARES, strict=True):
        at = share * distances[-1]
        k = int(np.clip(np.searchsorted(distances, at, side="right") - 1, 0, len(lengths) - 1))
        part = (at - distances[k]) / lengths[k] if lengths[k] > 0 else 0.0
        joints[:, joint(name)] = knots[:, k] + part * (knots[:, k + 1] - knots[:, k])


def _fill_ends(joints: Float[Array, "frame 22 3"], known: dict[str, Array]) -> None:
    """Puts collars halfway to the shoulders, and balls of the feet ahead of the ankles, where the file has none."""
    spine3 = joints[:, joint("spine3")]
    for side in ("left", "right"):
        if f"{side}_collar" not in known:
            joints[:, joint(f"{side}_collar")] = 0.5 * (spine3 + joints[:, joint(f"{side}_shoulder")])
        if f"{side}_foot" not in known:
            knee, ankle = joints[:, joint(f"{side}_knee")], joints[:, joint(f"{side}_ankle")]
            shank = ankle - knee
            across = joints[:, joint("left_hip")] - joints[:, joint("right_hip")]
            ahead = np.cross(across, -shank)
            norm = np.linalg.norm(ahead, axis=-1, keepdims=True)
            length = np.linalg.norm(shank, axis=-1, keepdims=True)
            joints[:, joint(f"{side}_foot")] = ankle + 0.32 * length * ahead / np.maximum(norm, 1e-9) + 0.14 * shank
