"""Names of a dozen exporters all mean the same 22 joints."""

import numpy as np
import pytest
from mocap_files import walk

from mmweaver.core.errors import InputError
from mmweaver.core.skeleton import JOINT_NAMES, joint
from mmweaver.motion.mocap.clip import RawMotion
from mmweaver.motion.mocap.joint_names import to_22

PELVIS, SPINES, NECK, HEAD = "pelvis", ("spine1", "spine2", "spine3"), "neck", "head"
LIMBS = ("hip", "knee", "ankle", "foot", "collar", "shoulder", "elbow", "wrist")


def sided(pattern: str, words: tuple[str, ...], sides: tuple[str, str]) -> dict[str, str]:
    """Ours -> theirs for both sides; an empty word is a joint that they lack."""
    pairs = zip(("left", "right"), sides, strict=True)
    return {
        f"{ours}_{part}": pattern.format(side=side, part=word)
        for ours, side in pairs
        for part, word in zip(LIMBS, words, strict=True)
        if word
    }


MIXAMO = ("UpLeg", "Leg", "Foot", "ToeBase", "Shoulder", "Arm", "ForeArm", "Hand")
CONVENTIONS = {
    "mixamo": sided("mixamorig:{side}{part}", MIXAMO, ("Left", "Right"))
    | {"pelvis": "mixamorig:Hips", "spine1": "mixamorig:Spine", "spine2": "mixamorig:Spine1",
       "spine3": "mixamorig:Spine2", "neck": "mixamorig:Neck", "head": "mixamorig:Head"},
    "cmu": sided("{side}{part}", MIXAMO, ("Left", "Right"))
    | {"pelvis": "Hips", "spine1": "LowerBack", "spine2": "Spine", "spine3": "Spine1", "neck": "Neck", "head": "Head"},
    "unreal": sided(
        "{part}_{side}",
        ("thigh", "calf", "foot", "ball", "clavicle", "upperarm", "lowerarm", "hand"),
        ("l", "r"),
    )
    | {"pelvis": "pelvis", "spine1": "spine_01", "spine2": "spine_02", "spine3": "spine_03", "neck": "neck_01",
       "head": "head"},
    "biped": sided(
        "Bip01 {side} {part}",
        ("Thigh", "Calf", "Foot", "Toe0", "Clavicle", "UpperArm", "Forearm", "Hand"),
        ("L", "R"),
    )
    | {"pelvis": "Bip01 Pelvis", "spine1": "Bip01 Spine", "spine2": "Bip01 Spine1", "spine3": "Bip01 Spine2",
       "neck": "Bip01 Neck", "head": "Bip01 Head"},
    "biovision": sided(
        "{side}{part}",
        ("Hip", "Knee", "Ankle", "Toe", "Collar", "Shoulder", "Elbow", "Wrist"),
        ("Left", "Right"),
    )
    | {"pelvis": "Hips", "spine1": "Chest", "neck": "Neck", "head": "Head"},
    "xsens": sided(
        "{side}{part}",
        ("UpperLeg", "LowerLeg", "Foot", "Toe", "Shoulder", "UpperArm", "ForeArm", "Hand"),
        ("Left", "Right"),
    )
    | {"pelvis": "Hips", "spine1": "L5", "spine2": "L3", "spine3": "T12", "neck": "Neck", "head": "Head"},
    "poser": sided("{side}{part}", ("Thigh", "Shin", "Foot", "Toe", "Collar", "Shldr", "ForeArm", "Hand"), ("l", "r"))
    | {"pelvis": "hip", "spine1": "abdomen", "spine2": "chest", "neck": "neck", "head": "head"},
    "bandai": sided(
        "{part}_{side}",
        ("UpperLeg", "LowerLeg", "Foot", "Toes", "Shoulder", "UpperArm", "LowerArm", "Hand"),
        ("L", "R"),
    )
    | {"pelvis": "Hips", "spine1": "Spine", "spine2": "Chest", "neck": "Neck", "head": "Head"},
    "short": sided("{side}{part}", ("hip", "knee", "ankle", "toe", "", "shoulder", "elbow", "wrist"), ("l", "r"))
    | {"pelvis": "pelvis", "neck": "neck", "head": "head"},
}  # fmt: skip


def renamed(convention: dict[str, str]) -> RawMotion:
    joints = walk()
    ours = [name for name in JOINT_NAMES if name in convention]
    extra = joints[:, :1] + 5.0  # a joint that means nothing
    positions = np.concatenate([joints[:, [joint(name) for name in ours]], extra], axis=1)
    return RawMotion(names=(*(convention[name] for name in ours), "LeftHandThumb1"), positions=positions, kind="test")


@pytest.mark.parametrize("name", CONVENTIONS)
def test_limbs_are_found_exactly_and_the_rest_nearby(name: str):
    convention = CONVENTIONS[name]
    joints, truth = to_22(renamed(convention), "walk"), walk()
    assert np.isfinite(joints).all()
    for k, ours in enumerate(JOINT_NAMES):
        error_m = np.linalg.norm(joints[:, k] - truth[:, k], axis=-1).max()
        if ours in SPINES:
            assert error_m < 0.12
        elif ours in convention:
            assert error_m < 1e-9, ours
        else:
            assert error_m < 0.13, ours


def test_our_own_names_in_any_order():
    order = np.random.default_rng(0).permutation(22)
    raw = RawMotion(names=tuple(JOINT_NAMES[k].upper() for k in order), positions=walk()[:, order], kind="test")
    np.testing.assert_array_equal(to_22(raw, "walk"), walk())


def test_feet_that_are_put_in_point_ahead():
    convention = {ours: theirs for ours, theirs in CONVENTIONS["biovision"].items() if not ours.endswith("_foot")}
    joints, truth = to_22(renamed(convention), "walk"), walk()
    toes = (joints - joints[:, [7]])[:, 10], (truth - truth[:, [7]])[:, 10]
    assert np.all(np.sum(toes[0] * toes[1], axis=-1) > 0.5 * np.sum(toes[1] ** 2, axis=-1))


def test_what_is_missing_is_named():
    convention = {ours: theirs for ours, theirs in CONVENTIONS["cmu"].items() if "knee" not in ours}
    with pytest.raises(InputError, match=r"left_knee, right_knee; .* Hips"):
        to_22(renamed(convention), "walk.bvh")
    tags = RawMotion(names=tuple(f"marker{k}" for k in range(40)), positions=np.zeros((3, 40, 3)), kind="test")
    with pytest.raises(InputError, match="and more"):
        to_22(tags, "markers.npz")
