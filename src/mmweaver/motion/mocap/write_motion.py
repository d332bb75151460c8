"""Motions of 22 joints as files that other programs read: BVH (Blender, Unity), AMASS (SMPL) and HumanML3D.

Joint angles follow from the joints: where a joint has several children, its rotation is the one that fits them best;
where it has one, the smallest rotation that turns the rest pose's bone into the bone. Twist about a bone is not in the
joints and stays that of the parent.

Reference: Kabsch, Acta Cryst. A32, 1976 (best rotation); Loper et al., SMPL, 2015; Mahmood et al., AMASS, 2019.
"""

from pathlib import Path

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import Rotation

from mmweaver.core.records import PoseSequence
from mmweaver.core.skeleton import JOINT_NAMES, NUM_JOINTS, PARENTS
from mmweaver.motion.mocap.humanml3d_features import features_from_joints, y_up
from mmweaver.motion.mocap.joint_arrays import FPS
from mmweaver.motion.mocap.smpl import MEAN_OFFSET_M

Array = np.ndarray
CHILDREN = [[child for child, parent in enumerate(PARENTS) if parent == joint] for joint in range(NUM_JOINTS)]
CENTIMETRES = 100.0
END_M = 0.08  # length of the bones after the last joints
AMASS_ROTATIONS = 52  # joints of SMPL-H; the hands stay in their rest pose


def joint_rotations(joints_m: Float[Array, "frame 22 3"], offsets_m: Float[Array, "22 3"]) -> Float[Array, "f 22 3 3"]:
    """Rotations of the joints of a body, each in its parent's frame.

    Args:
        joints_m: Joints, (frame, 22, 3), in any axes.
        offsets_m: Offset of each joint from its parent in the rest pose, (22, 3).

    Returns:
        Rotation matrices, (frame, 22, 3, 3), that of the root in the world.
    """
    world = np.empty((len(joints_m), NUM_JOINTS, 3, 3))
    for joint, children in enumerate(CHILDREN):
        before = world[:, PARENTS[joint]] if joint else np.broadcast_to(np.eye(3), (len(joints_m), 3, 3))
        bones = joints_m[:, children] - joints_m[:, joint, None]
        bones = bones / np.maximum(np.linalg.norm(bones, axis=2, keepdims=True), 1e-9)
        rest = offsets_m[children] / np.maximum(np.linalg.norm(offsets_m[children], axis=1, keepdims=True), 1e-9)
        if len(children) > 1:
            world[:, joint] = _best(rest, bones)
        elif children:
            world[:, joint] = _smallest(before @ rest[0], bones[:, 0]) @ before
        else:
            world[:, joint] = before
    local = world.copy()
    local[:, 1:] = world[:, list(PARENTS[1:])].swapaxes(2, 3) @ world[:, 1:]
    return local


def _best(rest: Float[Array, "bone 3"], bones: Float[Array, "frame bone 3"]) -> Float[Array, "frame 3 3"]:
    u, _, v = np.linalg.svd(np.einsum("bi,fbj->fij", rest, bones))
    turn = np.ones((len(bones), 3))
    turn[:, 2] = np.linalg.det(u @ v)
    return ((u * turn[:, None]) @ v).swapaxes(1, 2)


def _smallest(one: Float[Array, "frame 3"], other: Float[Array, "frame 3"]) -> Float[Array, "frame 3 3"]:
    """The smallest rotation of a unit vector into another."""
    axis = np.cross(one, other)
    sine, cosine = np.linalg.norm(axis, axis=1, keepdims=True), (one * other).sum(axis=1, keepdims=True)
    angle = np.arctan2(sine, cosine)
    return np.asarray(Rotation.from_rotvec(axis / np.maximum(sine, 1e-12) * angle).as_matrix())


def _rate(pose: PoseSequence) -> float:
    return float((len(pose.time_s) - 1) / (pose.time_s[-1] - pose.time_s[0])) if len(pose.time_s) > 1 else 1.0


def write_bvh(path: Path, pose: PoseSequence) -> None:
    """Writes a motion as BVH: centimetres, y up, our joint names, rotations in the order z, x, y.

    Args:
        path: The file.
        pose: The motion, z up.
    """
    joints_m = pose.joints_m.astype(float)
    joints_m = np.stack([joints_m[..., 0], joints_m[..., 2], -joints_m[..., 1]], axis=-1)
    lengths = np.linalg.norm(joints_m[:, 1:] - joints_m[:, list(PARENTS[1:])], axis=2).mean(axis=0)
    offsets = np.zeros((NUM_JOINTS, 3))
    offsets[1:] = MEAN_OFFSET_M[1:] / np.linalg.norm(MEAN_OFFSET_M[1:], axis=1, keepdims=True) * lengths[:, None]
    for joint, children in enumerate(CHILDREN):
        if len(children) > 1:  # the body's own hips and shoulders
            bones = joints_m[:, children] - joints_m[:, joint, None]
            offsets[children] = (bones @ _best(offsets[children], bones)).mean(axis=0)
    rotations = joint_rotations(joints_m, offsets)
    order = _depth_first(0)
    angles = Rotation.from_matrix(rotations[:, order].reshape(-1, 3, 3)).as_euler("ZXY", degrees=True)
    rows = np.concatenate([CENTIMETRES * joints_m[:, 0], angles.reshape(len(joints_m), -1)], axis=1)
    motion = [" ".join(f"{value:.5f}" for value in row) for row in rows]
    head = [f"Frames: {len(rows)}", f"Frame Time: {1 / _rate(pose):.7f}"]
    path.write_text(
        "\n".join(["HIERARCHY", *_hierarchy(0, offsets, 0), "MOTION", *head, *motion, ""]), encoding="utf-8"
    )


def _depth_first(joint: int) -> list[int]:
    return [joint, *(below for child in CHILDREN[joint] for below in _depth_first(child))]


def _hierarchy(joint: int, offsets: np.ndarray, depth: int) -> list[str]:
    """Lines of a joint and all below it."""
    indent = "  " * depth
    place = " ".join(f"{CENTIMETRES * value:.5f}" for value in offsets[joint])
    moves = "3" if joint else "6 Xposition Yposition Zposition"
    lines = [
        f"{indent}{'JOINT' if joint else 'ROOT'} {JOINT_NAMES[joint]}",
        f"{indent}{{",
        f"{indent}  OFFSET {place}",
        f"{indent}  CHANNELS {moves} Zrotation Xrotation Yrotation",
    ]
    for child in CHILDREN[joint]:
        lines += _hierarchy(child, offsets, depth + 1)
    if not CHILDREN[joint]:
        along = offsets[joint] / np.linalg.norm(offsets[joint]) * END_M * CENTIMETRES
        end = " ".join(f"{value:.5f}" for value in along)
        lines += [f"{indent}  End Site", f"{indent}  {{", f"{indent}    OFFSET {end}", f"{indent}  }}"]
    return [*lines, f"{indent}}}"]


def write_amass(path: Path, pose: PoseSequence) -> None:
    """Writes a motion as an .npz of AMASS: SMPL-H poses of the mean body, z up.

    Args:
        path: The file.
        pose: The motion; its bones become those of the mean body, its path stays.
    """
    joints_m = pose.joints_m.astype(float)
    rotations = joint_rotations(joints_m, MEAN_OFFSET_M)
    poses = np.zeros((len(joints_m), AMASS_ROTATIONS, 3))
    poses[:, :NUM_JOINTS] = Rotation.from_matrix(rotations.reshape(-1, 3, 3)).as_rotvec().reshape(-1, NUM_JOINTS, 3)
    with path.open("wb") as file:
        np.savez(
            file,
            poses=poses.reshape(len(poses), -1),
            trans=joints_m[:, 0] - MEAN_OFFSET_M[0],
            betas=np.zeros(16),
            dmpls=np.zeros((len(poses), 8)),
            gender=np.array("neutral"),
            mocap_framerate=np.array(_rate(pose)),
        )


def write_humanml3d(path: Path, pose: PoseSequence) -> None:
    """Writes a motion as HumanML3D's features, float32 (frame, 263), at 20 frames per second, not normalised.

    Args:
        path: The file.
        pose: The motion, z up; its body is kept, where HumanML3D moves every recording onto one skeleton.
    """
    time_s = np.arange(pose.time_s[0], pose.time_s[-1], 1 / FPS)
    flat = pose.joints_m.reshape(len(pose.time_s), -1)
    joints = np.stack([np.interp(time_s, pose.time_s, column) for column in flat.T], axis=1)
    with path.open("wb") as file:
        np.save(file, features_from_joints(y_up(joints.reshape(-1, NUM_JOINTS, 3))).astype(np.float32))
