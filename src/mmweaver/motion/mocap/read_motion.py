"""From a motion file of any known kind to a MotionClip. Start with this file.

BVH, C3D, .npy, .npz --bvh, c3d, joint_arrays, smpl--> RawMotion (own names, unit, axes)
    --joint_names--> 22 joints --cleaning--> no gaps --axes--> metres, z up --cleaning--> MotionClip
"""

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
from jaxtyping import Float

from mmweaver.core.errors import InputError
from mmweaver.core.safe_files.array_checks import ArrayChecks
from mmweaver.motion.mocap.axes import is_reflected, rotate_z_up, unit_of, up_of
from mmweaver.motion.mocap.bvh import read_bvh
from mmweaver.motion.mocap.c3d import read_c3d
from mmweaver.motion.mocap.cleaning import check_bones, cut_t_pose, fill_gaps
from mmweaver.motion.mocap.clip import MotionClip, RawMotion
from mmweaver.motion.mocap.joint_arrays import MAX_FRAMES, read_npy, read_npz
from mmweaver.motion.mocap.joint_names import to_22

FPS_LIMITS = (1.0, 2000.0)
MAX_UNITS = 1e7  # 10 km in millimetres
KINDS = ".bvh, .c3d, .npy (22 joints, HumanML3D, MDM, Motion-X) or .npz (AMASS, SMPL, CMU, joints)"


def read_motion(
    path: str | Path,
    *,
    fps: float | None = None,
    unit: str | float | None = None,
    up: str | None = None,
    clip: str | None = None,
    body_model: str | Path | None = None,
) -> MotionClip:
    """Reads a recorded motion.

    Args:
        path: A .bvh, .c3d, .npy or .npz file.
        fps: Frames per second; required if the file states none, and overrides its value.
        unit: m, cm, mm, inch, cmu, or the metres per unit; None estimates it from the body.
        up: Upward axis: y, z, ...; None estimates it from the body.
        clip: Name of one motion in a file of several.
        body_model: The user's own SMPL model (.npz); None takes the mean skeleton.

    Returns:
        22 joints in metres, z up; its notes report what was estimated.

    Raises:
        InputError: If the file does not hold a human motion.
    """
    path = Path(path)
    if not path.is_file():
        raise InputError(f"there is no motion file {path}; give {KINDS}")
    kind = path.suffix.lower()
    if clip is not None and kind != ".npz":
        raise InputError(
            f"{path} holds a single motion, so there is no clip {clip!r}; leave out --motion-set clip=NAME"
        )
    if kind == ".bvh":
        raw = read_bvh(path)
    elif kind == ".npy":
        raw = read_npy(path)
    elif kind == ".c3d":
        raw = read_c3d(path)
    elif kind in (".pkl", ".pickle", ".pt", ".pth"):
        raise InputError(
            f"{path} is a pickle, which could run code and is not opened; load it yourself and save its arrays with"
            " numpy.savez(file, global_orient=..., body_pose=..., transl=..., fps=...)"
        )
    elif kind == ".npz":
        raw = read_npz(path, clip, Path(body_model) if body_model is not None else None)
    else:
        raise InputError(f"{path}: motion is read from {KINDS}, not from {kind or 'a file without an ending'}")
    label = path.name if clip is None else f"{path.name} {clip}"
    return replace(to_clip(raw, label, fps=fps, unit=unit, up=up), file=path)


def to_clip(
    raw: RawMotion,
    label: str,
    *,
    fps: float | None = None,
    unit: str | float | None = None,
    up: str | None = None,
) -> MotionClip:
    """Converts a motion to our joints, metres and axes, without gaps.

    Args:
        raw: Motion under any joint names.
        label: Name of the motion in messages.
        fps: As in `read_motion`.
        unit: As in `read_motion`.
        up: As in `read_motion`.

    Returns:
        The clip with notes on what was estimated.

    Raises:
        InputError: As in `read_motion`.
    """
    ArrayChecks(label).numbers("the motion", np.asarray(raw.positions), low=-MAX_UNITS, high=MAX_UNITS, nan=True)
    if not 2 <= len(raw.positions) <= MAX_FRAMES:
        raise InputError(f"{label} has {len(raw.positions)} frames; a motion has 2 to {MAX_FRAMES}")
    rate = _rate(fps if fps is not None else raw.fps, label)
    notes = [*raw.notes]
    joints = to_22(raw, label)
    joints, gaps = fill_gaps(joints, rate, label)
    check_bones(joints, label)
    metres, note = unit_of(joints, unit if unit is not None else raw.unit_m, label)
    notes.append(note)
    axis, note = up_of(joints, up if up is not None else raw.up, label)
    notes.append(note)
    joints_m = rotate_z_up(joints * metres, axis)
    joints_m, mirrored = _mirror_if_reflected(joints_m, label)
    shown, t_pose = cut_t_pose(joints_m, rate, label)
    notes += [*gaps, *mirrored, *t_pose]
    return MotionClip(
        joints_m=shown,
        fps=rate,
        label=label,
        notes=tuple(note for note in notes if note),
        first_frame=len(joints_m) - len(shown),
    )


def _rate(fps: float | None, label: str) -> float:
    low, high = FPS_LIMITS
    if fps is None:
        raise InputError(f"{label} states no frame rate; give --motion-set fps=N (HumanML3D and MotionGPT: 20)")
    if not (math.isfinite(fps) and low <= fps <= high):
        raise InputError(f"a motion has {low:g} to {high:g} frames per second, not {fps:g}; give --motion-set fps=N")
    return float(fps)


def _mirror_if_reflected(
    joints_m: Float[np.ndarray, "frame 22 3"], label: str
) -> tuple[Float[np.ndarray, "frame 22 3"], tuple[str, ...]]:
    if not is_reflected(joints_m):
        return joints_m, ()
    note = f"left and right are exchanged in {label} (left-handed axes): it was mirrored"
    return joints_m * np.array([-1.0, 1.0, 1.0]), (note,)
