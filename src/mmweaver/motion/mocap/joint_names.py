"""Maps joint names of other skeletons to our 22 joints.

Names are split into a side and a part ("LeftForeArm", "lowerarm_l", "Bip01 L Forearm" and "mixamorig:LeftForeArm" are
all left + forearm). Two words are ambiguous between files: a "shoulder" is the collar if the file also has an arm, a
"foot" is the ankle unless the file has an ankle.
"""

import re
from pathlib import Path

import numpy as np
from jaxtyping import Float

from mmweaver.core.errors import InputError
from mmweaver.core.safe_files.safe_text import read_toml
from mmweaver.core.skeleton import JOINT_NAMES, NUM_JOINTS, joint
from mmweaver.motion.mocap.clip import RawMotion

Array = np.ndarray
PREFIX = re.compile(r"^(mixamorig\d*|bip0*1?|valvebiped|character\d*|skeleton|def|jnt|joint(?=root))[ _.:-]*", re.I)
TOKENS = re.compile(r"[A-Z]+(?![a-z])|[A-Z]?[a-z]+|\d+")
SIDES = {"l": "left", "left": "left", "r": "right", "right": "right"}
SKELETONS = read_toml(Path(__file__).with_name("skeletons.toml"))
SIDED = {ours: words.split() for ours, words in SKELETONS["sided"].items()}
SIDED_WORDS = {word for words in SIDED.values() for word in words}
SPINE, PELVIS = SKELETONS["spine"].split(), SKELETONS["pelvis"].split()
VERTEBRAE = re.compile(r"^[lt]\d+$", re.I)  # L5, L3, T12, T8
FINGERS = re.compile(r"thumb|index|middle|ring|pinky|finger|twist|ik|pole|metacarp|hold|prop", re.I)


def parts_of(name: str) -> tuple[str, str, int]:
    """Side ("left", "right" or ""), part and number of a joint's name.

    Args:
        name: Name in any known convention.

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
    if not side and part[:1] in ("l", "r") and part[1:] in SIDED_WORDS:
        side, part = SIDES[part[0]], part[1:]  # lhip, rknee
    return side, part, numbers[-1] if numbers else 0


def to_22(raw: RawMotion, source: str) -> Float[Array, "frame 22 3"]:
    """Maps the joints of a motion to our 22; missing spine, neck, collars and feet are interpolated.

    Args:
        raw: Motion under any joint names.
        source: Name of the file in messages.

    Returns:
        Joints (frame, 22, 3) in the file's unit and axes.

    Raises:
        InputError: If other joints are missing, naming them.
    """
    lowered = [name.lower() for name in raw.names]
    if set(JOINT_NAMES) <= set(lowered):
        return np.asarray(raw.positions[:, [lowered.index(name) for name in JOINT_NAMES]])
    known = {name: raw.positions[:, index] for name, index in _limbs(raw.names).items()}
    for name, words in (("neck", ["neck"]), ("head", ["head"]), ("pelvis", PELVIS)):
        index = next((index for word in words if (index := _first(raw.names, word)) is not None), None)
        known |= {} if index is None else {name: raw.positions[:, index]}
    needed = [f"{side}_{part}" for side in ("left", "right") for part in SIDED if part not in ("collar", "foot")]
    missing = [name for name in (*needed, "head") if name not in known]
    if missing:
        theirs = ", ".join(raw.names[:12]) + (", ..." if len(raw.names) > 12 else "")
        raise InputError(
            f"{source}: no joint is known as {', '.join(missing[:6])}{' and more' if len(missing) > 6 else ''}; the"
            f" file's joints are {theirs}; rename them as core/skeleton.py does"
        )
    shoulders = 0.5 * (known["left_shoulder"] + known["right_shoulder"])
    known.setdefault("pelvis", 0.5 * (known["left_hip"] + known["right_hip"]))
    known.setdefault("neck", shoulders + 0.3 * (known["head"] - shoulders))
    joints = np.full((len(raw.positions), NUM_JOINTS, 3), np.nan)
    for name, place in known.items():
        joints[:, joint(name)] = place
    spine = [k for k, (side, part, _) in enumerate(map(parts_of, raw.names)) if not side and part in SPINE]
    _fill_spine(joints, [raw.positions[:, k] for k in spine])
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
        # a shoulder is the collar if there is an arm, a foot the ankle unless there is an ankle
        other = [("shoulder" if arm_named else "collar", "shoulder"), ("" if "ankle" in has else "foot", "foot")]
        for ours, words in SIDED.items():
            word = next((word for word in words if word in has and (ours, word) not in other), None)
            if word:
                found[f"{side}_{ours}"] = parts[side, word]
    return found


def _first(names: tuple[str, ...], word: str) -> int | None:
    """Index of the unsided joint of that name with the lowest number; None if there is none."""
    hits = [(parts_of(name)[2], k) for k, name in enumerate(names) if parts_of(name)[:2] == ("", word)]
    return min(hits)[1] if hits else None


def _fill_spine(joints: Float[Array, "frame 22 3"], chain: list[Float[Array, "frame 3"]]) -> None:
    """Interpolates the three spine joints along the file's own spine, from pelvis to neck."""
    knots = np.stack([joints[:, 0], *chain, joints[:, joint("neck")]], axis=1)  # (frame, knot, 3)
    lengths = np.nanmedian(np.linalg.norm(np.diff(knots, axis=1), axis=-1), axis=0)
    distances = np.concatenate([[0.0], np.cumsum(lengths)])
    for name, share in zip(("spine1", "spine2", "spine3"), SKELETONS["spine_shares"], strict=True):
        at = share * distances[-1]
        k = int(np.clip(np.searchsorted(distances, at, side="right") - 1, 0, len(lengths) - 1))
        part = (at - distances[k]) / lengths[k] if lengths[k] > 0 else 0.0
        joints[:, joint(name)] = knots[:, k] + part * (knots[:, k + 1] - knots[:, k])


def _fill_ends(joints: Float[Array, "frame 22 3"], known: dict[str, Array]) -> None:
    """Puts collars halfway to the shoulders, and balls of the feet ahead of the ankles, if the file has none."""
    across = known["left_hip"] - known["right_hip"]
    for side in ("left", "right"):
        if f"{side}_collar" not in known:
            joints[:, joint(f"{side}_collar")] = 0.5 * (joints[:, joint("spine3")] + known[f"{side}_shoulder"])
        if f"{side}_foot" not in known:
            ankle = known[f"{side}_ankle"]
            shank = ankle - known[f"{side}_knee"]
            ahead = np.cross(across, -shank)
            norm, length = (np.linalg.norm(one, axis=-1, keepdims=True) for one in (ahead, shank))
            joints[:, joint(f"{side}_foot")] = ankle + 0.32 * length * ahead / np.maximum(norm, 1e-9) + 0.14 * shank
