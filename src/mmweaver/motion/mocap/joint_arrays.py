""".npy and .npz files of joints, of HumanML3D features, of SMPL poses, and the CMU collection with 38 joints.

From HumanML3D's 263 features per frame to 22 joints (y up, metres, 20 frames per second).

| columns | what |
|---|---|
| 0 | rotation of the root to the next frame, half the angle in radians |
| 1:3 | displacement of the root to the next frame on the floor (x, z), in the root's frame |
| 3 | height of the root |
| 4:67 | joints 1 to 21 relative to the ground point under the root, in the root's frame |
| 67:193 | rotations of joints 1 to 21, the first two columns of their matrices |
| 193:259 | displacement of the 22 joints to the next frame, in the root's frame |
| 259:263 | foot contact of left ankle, left foot, right ankle, right foot |

Joints are recovered from features exactly.

Reference: Guo et al., Generating Diverse and Natural 3D Human Motions from Text, CVPR 2022 (its data format).
"""

from dataclasses import replace
from pathlib import Path

import numpy as np
from jaxtyping import Float

from mmweaver.core.errors import InputError
from mmweaver.core.safe_files import safe_arrays
from mmweaver.core.safe_files.array_checks import ArrayChecks, real_numbers
from mmweaver.core.skeleton import JOINT_NAMES, NUM_JOINTS
from mmweaver.motion.mocap.clip import RawMotion
from mmweaver.motion.mocap.joint_names import SKELETONS
from mmweaver.motion.mocap.smpl import is_smpl, rate_of, read_smpl

Array = np.ndarray
FPS = 20.0
NUM_FEATURES = 263
ROTATIONS, VELOCITIES, CONTACTS = slice(67, 193), slice(193, 259), slice(259, 263)


def joints_from_features(features: Float[Array, "frame 263"]) -> Float[Array, "frame 22 3"]:
    """Recovers joints from HumanML3D features; the root starts at (0, y, 0) and faces +z.

    Args:
        features: Features (frame, 263), not normalised.

    Returns:
        Joints (frame, 22, 3) in metres, y up.
    """
    features = np.asarray(features, float)
    half = np.concatenate([[0.0], np.cumsum(features[:-1, 0])])
    shift = np.zeros((len(features), 3))
    shift[1:, 0], shift[1:, 2] = features[:-1, 1], features[:-1, 2]
    root = np.cumsum(rotated_about_y(shift, -half), axis=0)
    local = features[:, 4:67].reshape(-1, NUM_JOINTS - 1, 3)
    joints = np.empty((len(features), NUM_JOINTS, 3))
    joints[:, 1:] = rotated_about_y(local, -half[:, None])
    joints[:, 1:, 0] += root[:, None, 0]
    joints[:, 1:, 2] += root[:, None, 2]
    joints[:, 0] = root
    joints[:, 0, 1] = features[:, 3]
    return joints


def rotated_about_y(vectors: Float[Array, "*shape 3"], half_rad: Float[Array, "..."]) -> Float[Array, "*shape 3"]:
    """Rotates vectors about y.

    Args:
        vectors: Vectors (..., 3).
        half_rad: Half the angle in radians, broadcast against the vectors.

    Returns:
        Rotated vectors (..., 3).
    """
    cos, sin = np.cos(2 * half_rad), np.sin(2 * half_rad)
    x, y, z = (vectors[..., axis] for axis in range(3))
    return np.stack([cos * x + sin * z, y, cos * z - sin * x], axis=-1)


JOINT_KEYS = ("joints_m", "joints", "positions", "keypoints3d", "pos")
NAME_KEYS = ("joint_names", "names")
CMU_FPS = 120.0
CMU_NAMES = {int(index): name for index, name in SKELETONS["cmu"].items()}
MAX_FRAMES = 200_000  # half an hour at 100 frames per second; 0.6 GB while it is read
MOTION_X, MOTION_X_FPS = 322, 30.0  # numbers per frame: root, body, hands, face, translation, shape
SMPL_JOINTS = (24, 45, 52, 55, 127, 144)  # of SMPL, SMPL-H and SMPL-X, with and without landmarks
NORMALISED_BELOW_M = 0.25  # features with a lower mean root height must be normalised


def read_npy(path: Path) -> RawMotion:
    """Reads joints or HumanML3D features.

    Args:
        path: .npy with joints (frame, 22, 3), (frame, 66) or, as MDM has them, (22, 3, frame); joints of SMPL, SMPL-H
            and SMPL-X begin with the same 22. Or features (frame, 263), or poses of Motion-X (frame, 322).

    Returns:
        The motion; features are in metres, y up, at 20 frames per second.

    Raises:
        InputError: If the array has another shape or type.
    """
    values = safe_arrays.read_npy(path, mapped=True)
    if values.dtype.kind not in "fiu":
        raise InputError(f"{path} holds values of type {values.dtype}; a motion has real numbers, saved alone")
    if max(values.shape[:2], default=0) > MAX_FRAMES:  # the second, of a batch
        raise InputError(f"{path} has shape {values.shape}; a motion has 2 to {MAX_FRAMES} frames")
    with np.errstate(all="ignore"):  # what does not fit is refused with its range
        values = values.astype(float)
    if values.shape[:1] == (1,) and (values.ndim == 4 or values.shape[2:] == (NUM_FEATURES,)):
        values = values[0]  # a batch of one
    if values.ndim == 2 and values.shape[1] == NUM_FEATURES:
        return _read_features(values, path)
    if values.ndim == 2 and values.shape[1] == MOTION_X:
        held = {"root_orient": values[:, :3], "pose_body": values[:, 3:66], "trans": values[:, 309:312]}
        return replace(read_smpl(held, path), kind="Motion-X", fps=MOTION_X_FPS)
    if values.ndim == 3 and values.shape[:2] == (NUM_JOINTS, 3):
        return replace(_joints(values.transpose(2, 0, 1), path), fps=FPS)  # of MDM, joint by joint
    return _joints(values, path)


def _joints(values: Array, path: Path) -> RawMotion:
    return RawMotion(names=JOINT_NAMES, positions=_check_22(values, path), kind="joints")


def read_npz(path: Path, clip: str | None = None, body_model: Path | None = None) -> RawMotion:
    """Reads SMPL poses, clips of the CMU collection, or joints under a known key.

    Args:
        path: The .npz file.
        clip: Name of a clip in a file of several.
        body_model: The user's own SMPL model; None takes the mean skeleton.

    Returns:
        The motion in the file's own unit and axes.

    Raises:
        InputError: If the file holds anything else.
    """
    arrays = dict(safe_arrays.read_npz(path, skip_unreadable=True))
    if {"names", "lengths", "pos", "parents"} <= set(arrays):
        return _read_cmu(arrays, path, clip)
    if clip is not None:
        raise InputError(
            f"{path} holds a single motion, so there is no clip {clip!r}; leave out --motion-set clip=NAME"
        )
    if is_smpl(arrays):
        return read_smpl(arrays, path, body_model)
    key = next((name for name in JOINT_KEYS if name in arrays), None)
    if key is None:
        raise InputError(
            f"{path} holds {', '.join(list(arrays)[:8]) or 'nothing'}; neither SMPL poses (poses, trans) nor joints"
            f" ({', '.join(JOINT_KEYS)}) are among them"
        )
    names = next((tuple(map(str, arrays[name])) for name in NAME_KEYS if name in arrays), None)
    if len(arrays[key].shape) and len(arrays[key]) > MAX_FRAMES:
        raise InputError(f"{path} has {len(arrays[key])} frames; a motion has 2 to {MAX_FRAMES}")
    positions = real_numbers(path, key, arrays[key])
    if names is None:
        positions, names = _check_22(positions, path), JOINT_NAMES
    elif positions.ndim != 3 or positions.shape[1:] != (len(names), 3):
        raise InputError(
            f"{path}: {key} has shape {positions.shape}, {len(names)} joint names need (frame, {len(names)}, 3)"
        )
    ours = key == "joints_m"
    return RawMotion(
        names=names,
        positions=positions,
        kind="joints",
        fps=rate_of(arrays, path) or _rate_of_times(arrays, path),
        unit_m=1.0 if ours else None,
        up="z" if ours else None,
    )


def clips_of(path: Path) -> tuple[str, ...]:
    """Names of the motions of a file.

    Args:
        path: Motion file.

    Returns:
        Names; () if the file holds a single motion.
    """
    arrays = safe_arrays.read_npz(path, only=("names", "lengths")) if path.suffix.lower() == ".npz" else {}
    return tuple(map(str, arrays["names"])) if {"names", "lengths"} <= set(arrays) else ()


def _read_features(values: Float[Array, "frame 263"], path: Path) -> RawMotion:
    if len(values) < 2:
        raise InputError(f"{path} has {len(values)} frames; a motion has at least 2")
    if np.isfinite(values[:, 3]).all() and abs(float(values[:, 3].mean())) < NORMALISED_BELOW_M:
        mean, std = ((path.parent / name, path.parent.parent / name) for name in ("Mean.npy", "Std.npy"))
        mean, std = (next((one for one in two if one.is_file()), None) for two in (mean, std))
        if mean is not None and std is not None:
            whole = values * _statistics(std) + _statistics(mean)
            note = f"the features were normalised, and were multiplied by {std.name} and added to {mean.name}"
            return replace(_read_features(whole, path), notes=(note,))
        raise InputError(
            f"{path}: the features seem to be normalised (their root is {values[:, 3].mean():.2f} high); put"
            " HumanML3D's Mean.npy and Std.npy next to the file"
        )
    return RawMotion(
        names=JOINT_NAMES, positions=joints_from_features(values), kind="HumanML3D", fps=FPS, unit_m=1.0, up="y"
    )


def _statistics(path: Path) -> Float[Array, " feature"]:
    values = safe_arrays.read_npy(path)
    if values.shape != (NUM_FEATURES,) or values.dtype.kind != "f" or not np.isfinite(values).all():
        raise InputError(f"{path} holds {values.dtype} of shape {values.shape}; it must be ({NUM_FEATURES},)")
    return values.astype(float)


def _check_22(values: Array, path: Path) -> Float[Array, "frame 22 3"]:
    if values.ndim == 2 and values.shape[1] == 3 * NUM_JOINTS:
        values = values.reshape(-1, NUM_JOINTS, 3)
    if values.ndim == 3 and values.shape[1] in SMPL_JOINTS and values.shape[2] == 3:
        values = values[:, :NUM_JOINTS]  # hands and face come last
    if values.ndim != 3 or values.shape[1:] != (NUM_JOINTS, 3):
        raise InputError(
            f"{path} has shape {values.shape}; (frame, 22, 3) joints in SMPL order or (frame, 263) HumanML3D features"
            " are read, other skeletons from .npz with joint_names"
        )
    return np.asarray(values, float)


def _read_cmu(arrays: dict[str, Array], path: Path, clip: str | None) -> RawMotion:
    lengths = ArrayChecks(path).numbers("lengths", arrays["lengths"], ("clip",), kinds="iu", low=0, high=1e9)
    names, positions = [str(name) for name in np.ravel(arrays["names"])], arrays["pos"]
    if (
        positions.ndim != 3
        or positions.shape[1:] != (38, 3)
        or lengths.sum() != len(positions)
        or len(names) != len(lengths)
    ):
        raise InputError(f"{path}: names, lengths and pos do not fit each other or the 38 joints of CMU's skeleton")
    if clip is None and len(names) > 1:
        raise InputError(f"{path} holds {len(names)} motions; choose one, for example --motion-set clip={names[0]}")
    hits = [k for k, name in enumerate(names) if clip is None or name == clip]
    hits = hits or [k for k, name in enumerate(names) if clip is not None and clip in name]
    if len(hits) != 1:
        few = ", ".join(names[k] for k in hits[:4]) or ", ".join(names[:4])
        raise InputError(f"{path}: {clip!r} names {len(hits)} of its {len(names)} motions; write one out, as {few}")
    start = int(lengths[: hits[0]].sum())
    chosen = real_numbers(path, "pos", positions[start : start + int(lengths[hits[0]])])
    return RawMotion(
        names=tuple(CMU_NAMES.values()),
        positions=chosen[:, list(CMU_NAMES)],
        kind="CMU",
        fps=CMU_FPS,
        unit_m=1.0,
        up="y",
    )


def _rate_of_times(arrays: dict[str, Array], path: Path) -> float | None:
    times = arrays.get("frame_time_s", arrays.get("time_s"))
    if times is None or times.ndim != 1 or len(times) < 2:
        return None
    step = np.diff(real_numbers(path, "the frames' times", times))
    even = step.min() > 0 and np.ptp(step) < 1e-3 * step.mean()
    return float(1 / step.mean()) if even else None
