"""SMPL poses (AMASS and similar): from axis-angle rotations of a body to its 22 joints.

Without a body model the public mean skeleton is used, and shape coefficients (betas) are ignored. With the user's own
model file (SMPL, SMPL-H or SMPL-X as .npz) the joints are those of that body.

Reference: Loper et al., SMPL, 2015; Mahmood et al., AMASS, 2019.
"""

from pathlib import Path

import numpy as np
from jaxtyping import Float

from mmweaver.core.errors import InputError
from mmweaver.core.safe_files.array_checks import real_numbers
from mmweaver.core.safe_files.safe_arrays import read_npz
from mmweaver.core.skeleton import JOINT_NAMES, NUM_JOINTS, PARENTS
from mmweaver.motion.mocap.clip import RawMotion
from mmweaver.motion.mocap.joint_names import SKELETONS

Array = np.ndarray
MEAN_OFFSET_M = np.array(SKELETONS["smpl_offset_m"])
TRANSLATIONS = ("trans", "transl", "root_translation")
_POSES = ("poses", "pose", "root_orient", "pose_body", "global_orient", "body_pose")
ROOT, BODY = ("root_orient", "global_orient"), ("pose_body", "body_pose")  # of AMASS, and of the smplx package
RATES = ("mocap_framerate", "mocap_frame_rate", "fps", "frame_rate", "framerate")


def is_smpl(arrays: dict[str, Array]) -> bool:
    """Whether the arrays of an .npz are poses of an SMPL body."""
    return bool(set(_POSES) & set(arrays)) and bool(set(TRANSLATIONS) & set(arrays))


def read_smpl(arrays: dict[str, Array], path: Path, body_model: Path | None = None) -> RawMotion:
    """Joints of an AMASS or SMPL .npz by forward kinematics.

    Args:
        arrays: Arrays of the file by name.
        path: The file, for error messages.
        body_model: The user's own SMPL model; None takes the mean skeleton.

    Returns:
        22 joints (frame, 22, 3) in metres.

    Raises:
        InputError: If the shapes are not those of such poses.
    """
    poses = _poses(arrays, path)
    trans = next(real_numbers(path, name, arrays[name]) for name in TRANSLATIONS if name in arrays)
    if trans.shape != (len(poses), 3):
        raise InputError(f"{path}: the translation has shape {trans.shape}, {(len(poses), 3)} fits the poses")
    offsets, note = MEAN_OFFSET_M, "the mean SMPL skeleton is used for the recorded body (no body model was given)"
    if body_model is not None:
        betas = arrays.get("betas", arrays.get("shape"))
        offsets = _own_offsets(body_model, np.zeros(0) if betas is None else real_numbers(path, "betas", betas))
        note = f"bones of the body model {body_model.name}"
    positions = forward(poses[:, :NUM_JOINTS], trans, offsets)
    return RawMotion(
        names=JOINT_NAMES, positions=positions, kind="SMPL", fps=rate_of(arrays, path), unit_m=1.0, notes=(note,)
    )


def rate_of(arrays: dict[str, Array], path: Path) -> float | None:
    """Frame rate stated by an .npz.

    Args:
        arrays: Arrays of the file by name.
        path: The file, for error messages.

    Returns:
        Hz; None if there is none.
    """
    found = [name for name in RATES if name in arrays and arrays[name].size == 1 and arrays[name].dtype.kind in "fiuc"]
    if not found:
        return None
    rate = float(real_numbers(path, found[0], arrays[found[0]]).reshape(()))
    return rate if rate > 0 else None


def forward(
    rotations: Float[Array, "frame 22 3"], trans: Float[Array, "frame 3"], offsets_m: Float[Array, "22 3"]
) -> Float[Array, "frame 22 3"]:
    """Forward kinematics of the SMPL skeleton.

    Args:
        rotations: Axis-angle rotations in radians, each in its parent's frame, (frame, 22, 3).
        trans: Translation of the root in metres, (frame, 3).
        offsets_m: Offset of each joint from its parent in metres, (22, 3).

    Returns:
        Joints (frame, 22, 3) in metres; nan in frames with a missing rotation.
    """
    from scipy.spatial.transform import Rotation

    missing = np.asarray(~np.isfinite(rotations).all(axis=(1, 2)))
    local = Rotation.from_rotvec(np.where(missing[:, None, None], 0.0, rotations).reshape(-1, 3)).as_matrix()
    local = np.asarray(local).reshape(len(rotations), NUM_JOINTS, 3, 3)
    turned, positions = local.copy(), np.zeros((len(rotations), NUM_JOINTS, 3))
    positions[:, 0] = trans + offsets_m[0]
    for k, parent in enumerate(PARENTS):
        if parent >= 0:
            positions[:, k] = positions[:, parent] + turned[:, parent] @ offsets_m[k]
            turned[:, k] = turned[:, parent] @ local[:, k]
    positions[missing] = np.nan
    return positions


def _poses(arrays: dict[str, Array], path: Path) -> Float[Array, "frame joint 3"]:
    if any(np.size(arrays[name]) == 0 for name in _POSES if name in arrays):
        raise InputError(f"{path} has no frames: its poses are empty; choose another file")
    found = tuple(next((name for name in names if name in arrays), "") for names in (ROOT, BODY))
    names = found if all(found) else ("poses",) if "poses" in arrays else ("pose",)
    if missing := [name for name in names if name not in arrays]:
        raise InputError(f"{path} holds a part of SMPL poses only; {missing[0]} is missing")
    parts = [real_numbers(path, "poses" if name == "pose" else name, arrays[name]) for name in names]
    parts = [_rotation_vectors(part) if part.shape[-2:] == (3, 3) and part.ndim == 4 else part for part in parts]
    rows = [part.reshape(len(part), -1) if part.ndim >= 2 else np.zeros((0, 0)) for part in parts]
    poses = np.concatenate(rows, axis=1) if len({len(row) for row in rows}) == 1 else np.zeros((0, 0))
    if poses.shape[1] < 3 * NUM_JOINTS or poses.shape[1] % 3:
        raise InputError(
            f"{path} holds no SMPL poses: {poses.shape[1]} numbers per frame, at least 66 (22 axis-angle rotations) are"
            " needed"
        )
    return poses.reshape(len(poses), -1, 3)


def _rotation_vectors(matrices: Float[Array, "frame joint 3 3"]) -> Float[Array, "frame joint 3"]:
    """Axis-angle of rotation matrices, as WHAM and 4D-Humans give them; nan stays nan."""
    from scipy.spatial.transform import Rotation

    is_sound = np.isfinite(matrices).all(axis=(2, 3)) & (np.abs(np.linalg.det(matrices) - 1) < 0.1)
    sound = np.where(is_sound[..., None, None], matrices, np.eye(3))
    vectors = np.asarray(Rotation.from_matrix(sound.reshape(-1, 3, 3)).as_rotvec()).reshape(*matrices.shape[:2], 3)
    return np.where(is_sound[..., None], vectors, np.nan)


def _own_offsets(body_model: Path, betas: Array) -> Float[Array, "22 3"]:
    """Joint offsets (22, 3) in metres of a body model's .npz with the recording's shape coefficients."""
    if body_model.suffix != ".npz":
        raise InputError(f"{body_model}: the body model must be an .npz (pickles are not opened); SMPL-H has model.npz")
    names = ("v_template", "shapedirs", "J_regressor")
    model = read_npz(body_model, only=names)
    if set(model) != set(names):
        raise InputError(f"{body_model} is no body model: v_template, shapedirs and J_regressor are needed")
    template, shapes, regressor = (real_numbers(body_model, name, model[name]) for name in names)
    fits = (
        template.ndim == 2
        and shapes.ndim == 3
        and shapes.shape[:2] == template.shape
        and regressor.shape[1:] == (len(template),)
    )
    if not fits or len(regressor) < NUM_JOINTS:
        raise InputError(f"{body_model} is no body model: its shapes do not fit each other")
    count = min(betas.size, shapes.shape[2])
    joints = regressor[:NUM_JOINTS] @ (template + shapes[:, :, :count] @ betas.reshape(-1)[:count])
    return joints - np.where(np.array(PARENTS)[:, None] < 0, 0.0, joints[list(PARENTS)])
