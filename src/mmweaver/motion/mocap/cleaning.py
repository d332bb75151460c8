"""Cleaning of recordings: gaps, frames of zeros, a T-pose at the start, joints in the wrong order."""

import numpy as np
from jaxtyping import Bool, Float

from mmweaver.core.errors import InputError
from mmweaver.core.skeleton import JOINT_NAMES, joint

Array = np.ndarray
LONGEST_GAP_S = 0.25
JUMP_MPS = 6.0  # mean wrist speed between two frames: no person leaves a T-pose so fast
LONGEST_T_POSE_S = 1.0
BONE_SPREAD = 0.3  # 5th to 95th percentile of a limb's length, as a share of its median
LIMBS = (("hip", "knee"), ("knee", "ankle"), ("shoulder", "elbow"), ("elbow", "wrist"))


def fill_gaps(
    joints: Float[Array, "frame 22 3"], fps: float, source: str
) -> tuple[Float[Array, "frame 22 3"], tuple[str, ...]]:
    """Fills gaps (nan, infinities, frames of zeros) of up to 0.25 s by cubic splines.

    Args:
        joints: Joints (frame, 22, 3) in any unit.
        fps: Frames per second.
        source: Name of the file in messages.

    Returns:
        Joints without gaps, and a note if any were filled.

    Raises:
        InputError: If gaps are longer or at either end, or there is no motion at all.
    """
    joints = np.array(joints, float)
    joints[~np.isfinite(joints)] = np.nan
    extent = np.ptp(np.nan_to_num(joints), axis=1).max(axis=-1)
    if len(joints) < 2:
        raise InputError(f"{source} has no motion, only {_count(len(joints))}; choose another file")
    if not np.isfinite(joints).any() or np.nanmax(extent) <= 0:
        what = "no number (all nan)" if not np.isfinite(joints).any() else "all joints at one point"
        raise InputError(f"{source} has no motion: {what} in all of {_count(len(joints))}; choose another file")
    joints[extent < 1e-3 * np.nanmedian(extent[extent > 0])] = np.nan  # all joints at one point
    missing = np.asarray(np.isnan(joints).any(axis=-1))
    if not missing.any():
        return joints, ()
    longest, name, at = _longest_gap(missing)
    if longest / fps > LONGEST_GAP_S or missing[0].any() or missing[-1].any():
        raise InputError(
            f"{source}: {name} is missing for {longest} frames ({longest / fps:.2f} s) from frame {at}; gaps of up to"
            f" {LONGEST_GAP_S:g} s inside are filled, fill this one where the motion was recorded or cut it off"
        )
    _bridge(joints, missing)
    filled = int(missing.any(axis=1).sum())
    return joints, (f"{_count(filled)} of {source} had joints missing and were filled in",)


def _count(frames: int) -> str:
    return "1 frame" if frames == 1 else f"{frames} frames"


def _longest_gap(missing: Bool[Array, "frame 22"]) -> tuple[int, str, int]:
    """Length in frames, joint and first frame of the longest gap."""
    best = (0, "", 0)
    for k, name in enumerate(JOINT_NAMES):
        edges = np.flatnonzero(np.diff(np.pad(missing[:, k].astype(int), 1)))
        for start, end in edges.reshape(-1, 2):
            best = max(best, (int(end - start), name, int(start)), key=lambda gap: gap[0])
    return best


def _bridge(joints: Float[Array, "frame 22 3"], missing: Bool[Array, "frame 22"]) -> None:
    from scipy.interpolate import CubicSpline

    frame = np.arange(len(joints), dtype=float)
    for k in np.flatnonzero(missing.any(axis=0)):
        there = ~missing[:, k]
        if np.count_nonzero(there) < 2:
            raise InputError(f"{JOINT_NAMES[k]} is missing from all frames but one; give a more complete recording")
        joints[~there, k] = CubicSpline(frame[there], joints[there, k], axis=0)(frame[~there])


def cut_t_pose(
    joints_m: Float[Array, "frame 22 3"], fps: float, source: str
) -> tuple[Float[Array, "left 22 3"], tuple[str, ...]]:
    """Cuts off a T-pose of up to a second at the start if the motion jumps after it; otherwise only notes it.

    Args:
        joints_m: Joints (frame, 22, 3) in metres, z up.
        fps: Frames per second.
        source: Name of the file in messages.

    Returns:
        The remaining joints, and a note if there is a T-pose.
    """
    spread = is_t_pose(joints_m[: max(int(LONGEST_T_POSE_S * fps), 1) + 1])
    if not spread[0]:
        return joints_m, ()
    last = int(np.argmin(spread)) if not spread.all() else len(spread)
    wrists = joints_m[:, [joint("left_wrist"), joint("right_wrist")]]
    speed = np.linalg.norm(np.diff(wrists[: last + 1], axis=0), axis=-1).mean(axis=-1) * fps
    jumps = np.flatnonzero(speed > JUMP_MPS)
    if len(jumps) and len(joints_m) - jumps[-1] > 2:
        first = int(jumps[-1]) + 1
        return joints_m[first:], (f"{_count(first)} of T-pose at the start of {source} cut off",)
    return joints_m, (f"{source} begins in a T-pose, which is shown; --motion-set start=S leaves it out",)


def is_t_pose(joints_m: Float[Array, "frame 22 3"]) -> Bool[Array, " frame"]:
    """Whether each frame has both arms straight and level to the sides and both legs straight down.

    Args:
        joints_m: Joints (frame, 22, 3), z up.

    Returns:
        Mask (frame,).
    """
    result = np.ones(len(joints_m), bool)
    for side in ("left", "right"):
        shoulder, elbow, wrist, hip, ankle = (
            joints_m[:, joint(f"{side}_{part}")] for part in ("shoulder", "elbow", "wrist", "hip", "ankle")
        )
        arm, leg = wrist - shoulder, ankle - hip
        length = np.linalg.norm(arm, axis=-1)
        bones = np.linalg.norm(elbow - shoulder, axis=-1) + np.linalg.norm(wrist - elbow, axis=-1)
        result &= (np.abs(arm[:, 2]) < 0.35 * length) & (length > 0.95 * bones)
        result &= -leg[:, 2] > 0.95 * np.linalg.norm(leg, axis=-1)
    reach = joints_m[:, joint("left_wrist")] - joints_m[:, joint("right_wrist")]
    span = np.linalg.norm(joints_m[:, joint("left_elbow")] - joints_m[:, joint("right_elbow")], axis=-1)
    return result & (np.linalg.norm(reach, axis=-1) > 1.4 * span)


def check_bones(joints: Float[Array, "frame 22 3"], source: str) -> None:
    """Checks the order of the joints: limbs must keep their lengths and be equal on both sides.

    Args:
        joints: Joints (frame, 22, 3) in any unit.
        source: Name of the file in messages.

    Raises:
        InputError: If a limb's length varies or differs between sides by more than 30 %.
    """
    for one, other in LIMBS:
        middles = []
        for side in ("left", "right"):
            bone = joints[:, joint(f"{side}_{other}")] - joints[:, joint(f"{side}_{one}")]
            low, middle, high = np.percentile(np.linalg.norm(bone, axis=-1), [5, 50, 95])
            middles.append(float(middle))
            if middle <= 0 or high - low > BONE_SPREAD * middle:
                raise InputError(
                    f"{source}: the bone from {side} {one} to {side} {other} is {low:.3g} to {high:.3g} units long; the"
                    " joints are not those that are expected there (order: core/skeleton.py)"
                )
        if max(middles) > (1 + BONE_SPREAD) * min(middles):
            raise InputError(
                f"{source}: from {one} to {other} it is {middles[0]:.3g} units on the left and {middles[1]:.3g} on the"
                " right; the joints are not those that are expected there (order: core/skeleton.py)"
            )
