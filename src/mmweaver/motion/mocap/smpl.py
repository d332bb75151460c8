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

Array = np.ndarray
# Offset of each joint from its parent in the mean neutral body, metres; x left, y up, z forward. Public values, as in
# the humanoid models of physics simulators.
MEAN_OFFSET_M = np.array([
    (0.0, 0.0, 0.0), (0.0695, -0.0914, -0.0068), (-0.0677, -0.0905, -0.0043), (-0.0025, 0.1090, -0.0267),
    (0.0343, -0.3752, -0.0045), (-0.0383, -0.3826, -0.0089), (0.0055, 0.1352, 0.0011), (-0.0136, -0.3980, -0.0437),
    (0.0158, -0.3984, -0.0423), (0.0015, 0.0529, 0.0254), (0.0264, -0.0558, 0.1193), (-0.0254, -0.0481, 0.1233),
    (-0.0028, 0.2139, -0.0429), (0.0788, 0.1217, -0.0341), (-0.0818, 0.1188, -0.0386), (0.0052, 0.0650, 0.0513),
    (0.0910, 0.0305, -0.0089), (-0.0960, 0.0326, -0.0091), (0.2596, -0.0128, -0.0275), (-0.2537, -0.0133, -0.0214),
    (0.2492, 0.0090, -0.0012), (-0.2553, 0.0078, -0.0056),
])  # fmt: skip
TRANSLATIONS = ("trans", "transl", "root_translation")
_POSES = ("poses", "pose", "root_orient", "pose_body")
RATES = ("mocap_framerate", "mocap_frame_rate", "fps", "frame_rate", "framerate")


def is_smpl(arrays: dict[str, Array]) -> bool:
    """Whether an .npz holds poses of an SMPL body."""
    return bool({"poses", "pose", "root_orient", "pose_body"} & set(arrays)) and bool(set(TRANSLATIONS) & set(arrays))


def read_smpl(arrays: dict[str, Array], path: Path, body_model: Path | None = None) -> RawMotion:
    """Joints (frame, 22, 3) in metres of an AMASS or SMPL .npz. Raises InputError for shapes that are no such poses."""
    poses = _poses(arrays, path)
    trans = next(real_numbers(path, name, arrays[name]) for name in TRANSLATIONS if name in arrays)
    if trans.shape != (len(poses), 3):
        raise InputError(f"{path}: the translation has shape {trans.shape}, {(len(poses), 3)} fits the poses")
    betas = arrays.get("betas", arrays.get("shape"))
    if body_model is not None:
        offsets, note = (
            _own_offsets(body_model, None if betas is None else real_numbers(path, "betas", betas)),
            f"bones of the body model {body_model.name}",
        )
    else:
        offsets, note = MEAN_OFFSET_M, "the mean SMPL skeleton is used for the recorded body (no body model was given)"
    positions = forward(poses[:, :NUM_JOINTS], trans, offsets)
    return RawMotion(
        names=JOINT_NAMES, positions=positions, kind="SMPL", fps=rate_of(arrays, path), unit_m=1.0, notes=(note,)
    )


def rate_of(arrays: dict[str, Array], path: Path) -> float | None:
    """The frame rate that an .npz states, if it does."""
    found = [name for name in RATES if name in arrays and arrays[name].size == 1 and arrays[name].dtype.kind in "fiuc"]
    if not found:
        return None
    rate = float(real_numbers(path, found[0], arrays[found[0]]).reshape(()))
    return rate if rate > 0 else None


def forward(
    rotations: Float[Array, "frame 22 3"], trans: Float[Array, "frame 3"], offsets_m: Float[Array, "22 3"]
) -> Float[Array, "frame 22 3"]:
    """Forward kinematics of axis-angle rotations in radians, each in its parent's frame; metres."""
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
    whole = "pose_body" in arrays and "root_orient" in arrays
    if any(np.size(arrays[name]) == 0 for name in _POSES if name in arrays):
        raise InputError(f"{path} has no frames: its poses are empty; choose another file")
    if whole:
        parts = [_rows(real_numbers(path, name, arrays[name])) for name in ("root_orient", "pose_body")]
        poses = np.concatenate(parts, axis=1) if len(parts[0]) == len(parts[1]) else np.zeros((0, 0))
    else:
        poses = _rows(real_numbers(path, "poses", arrays["poses"] if "poses" in arrays else arrays["pose"]))
    if poses.shape[1] < 3 * NUM_JOINTS or poses.shape[1] % 3:
        raise InputError(
            f"{path} holds no SMPL poses: {poses.shape[1]} numbers a frame, at least 66 (22 axis-angle rotations) are"
            " needed"
        )
    return poses.reshape(len(poses), -1, 3)


def _rows(values: Array) -> Array:
    """Numbers of a frame in one row; no rows for anything else."""
    return values.reshape(len(values), -1) if values.ndim >= 2 else np.zeros((0, 0))


def _own_offsets(body_model: Path, betas: Array | None) -> Float[Array, "22 3"]:
    """Joint offsets (22, 3) in metres of a body model's .npz with the recording's shape coefficients."""
    if body_model.suffix != ".npz":
        raise InputError(f"{body_model}: the body model must be an .npz (pickles are not opened); SMPL-H has model.npz")
    model = read_npz(body_model, only=("v_template", "shapedirs", "J_regressor"))
    if set(model) != {"v_template", "shapedirs", "J_regressor"}:
        raise InputError(f"{body_model} is no body model: v_template, shapedirs and J_regressor are needed")
    template, shapes, regressor = (
        real_numbers(body_model, name, model[name]) for name in ("v_template", "shapedirs", "J_regressor")
    )
    fits = (
        template.ndim == 2
        and shapes.ndim == 3
        and shapes.shape[:2] == template.shape
        and regressor.shape[1:] == (len(template),)
    )
    if not fits or len(regressor) < NUM_JOINTS:
        raise InputError(f"{body_model} is no body model: its shapes do not fit each other")
    count = 0 if betas is None else min(betas.size, shapes.shape[2])
    shape = np.zeros(0) if betas is None else betas.reshape(-1)[:count]
    joints = regressor[:NUM_JOINTS] @ (template + shapes[:, :, :count] @ shape)
    parents = np.array([max(parent, 0) for parent in PARENTS])
    offsets = joints - joints[parents]
    offsets[0] = joints[0]
    return offsets
