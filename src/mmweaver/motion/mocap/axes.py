"""Unit, upward axis and handedness of a motion: given by the user, else estimated from the body."""

import numpy as np
from jaxtyping import Float

from mmweaver.core.errors import InputError
from mmweaver.core.skeleton import joint
from mmweaver.motion.animation.skeleton_proportions import RECORDED_M
from mmweaver.motion.mocap.clip import body_height

Array = np.ndarray
# "cmu": unit of the CMU collection, whose skeletons are in inches scaled by 0.45 (its FAQ; length 0.45 in asf files)
UNITS_M = {"m": 1.0, "cm": 0.01, "mm": 0.001, "inch": 0.0254, "cmu": 0.0254 / 0.45}
UPS = ("y", "z", "-y", "-z", "x", "-x")
CLEAR = 0.8  # share of the body's length that must lie along one axis


def unit_of(joints: Float[Array, "frame 22 3"], given: str | float | None, source: str) -> tuple[float, str]:
    """Unit of length of a file.

    Estimated only if exactly one unit makes the body 1.2 to 2.2 m tall.

    Args:
        joints: Joints in the file's unit, (frame, 22, 3).
        given: Name in UNITS_M or metres per unit; None estimates it.
        source: Name of the file in messages.

    Returns:
        Metres per unit, and a note ("" if the unit was given).

    Raises:
        InputError: If the unit is unknown or cannot be estimated.
    """
    if given is not None:
        return metres_of(given), ""
    size = body_height(joints)
    low, high = RECORDED_M
    fits = [name for name, metres in UNITS_M.items() if low <= size * metres <= high]
    if len(fits) == 1:
        metres = UNITS_M[fits[0]]
        name = "the CMU collection's unit of 0.05644 m" if fits[0] == "cmu" else fits[0]
        return metres, f"lengths of {source} are taken as {name}: the body is then {size * metres:.2f} m tall"
    raise InputError(
        f"{source}: the body is {size:.4g} units tall, which in no unit ({', '.join(UNITS_M)}) is a person of"
        f" {low:g} to {high:g} m; give --motion-set unit=UNIT, a name or the metres in one unit"
    )


def metres_of(given: str | float) -> float:
    """Metres per unit of a name, such as "cm", or of a number.

    Args:
        given: Name in UNITS_M, or metres per unit.

    Raises:
        InputError: If it is neither a known unit nor a plausible number.

    >>> metres_of("inch"), metres_of("0.056444")
    (0.0254, 0.056444)
    """
    if isinstance(given, str) and given in UNITS_M:
        return UNITS_M[given]
    try:
        metres = float(given)
    except ValueError:
        metres = float("nan")
    if not 1e-6 < metres < 1e3:
        raise InputError(
            f"{given!r} is no unit of length; choose {', '.join(UNITS_M)} or the metres in one unit of the file"
        )
    return metres


def up_of(joints: Float[Array, "frame 22 3"], given: str | None, source: str) -> tuple[str, str]:
    """Upward axis of a file.

    Args:
        joints: Joints (frame, 22, 3) in any unit.
        given: Axis in UPS; None estimates it from the standing body.
        source: Name of the file in messages.

    Returns:
        The axis, and a note ("" if the axis was given).

    Raises:
        InputError: If the axis is unknown or cannot be estimated.
    """
    if given is not None:
        if given not in UPS:
            raise InputError(f"the upward axis is one of {', '.join(UPS)}, not {given!r}")
        return given, ""
    feet = joints[:, [joint("left_ankle"), joint("right_ankle")]].mean(axis=1)
    stands = np.nanmedian(joints[:, joint("head")] - feet, axis=0)
    stands = stands / max(float(np.linalg.norm(stands)), 1e-12)
    axis = int(np.abs(stands).argmax())
    if abs(stands[axis]) < CLEAR:
        raise InputError(
            f"{source}: the upward axis cannot be estimated, as the body does not stand; give --motion-set up=y or up=z"
        )
    up = ("-" if stands[axis] < 0 else "") + "xyz"[axis]
    return up, f"{up} is taken as the upward axis of {source}, because the head is there"


def rotate_z_up(joints: Float[Array, "frame 22 3"], up: str) -> Float[Array, "frame 22 3"]:
    """Rotates joints (never mirrors them) so that z is up; y up becomes (x, -z, y).

    Args:
        joints: Joints (frame, 22, 3).
        up: Upward axis, in UPS.

    Returns:
        Joints (frame, 22, 3), z up.
    """
    x, y, z = (joints[..., axis] for axis in range(3))
    rotated = {"z": (x, y, z), "-z": (x, -y, -z), "y": (x, -z, y), "-y": (x, z, -y), "x": (-z, y, x), "-x": (z, y, -x)}[
        up
    ]
    return np.stack(rotated, axis=-1)


def is_reflected(joints: Float[Array, "frame 22 3"]) -> bool:
    """Whether left and right are exchanged (left-handed axes), so that the toes point backwards.

    Args:
        joints: Joints (frame, 22, 3), z up.
    """
    across = joints[:, joint("left_hip")] - joints[:, joint("right_hip")]
    across = across + joints[:, joint("left_shoulder")] - joints[:, joint("right_shoulder")]
    ahead = np.stack([across[:, 1], -across[:, 0]], axis=-1)
    toes = sum(joints[:, joint(f"{s}_foot"), :2] - joints[:, joint(f"{s}_ankle"), :2] for s in ("left", "right"))
    forwards = np.sum(ahead * np.asarray(toes), axis=-1)
    return bool(np.nanmedian(forwards) < 0 and np.nanmean(forwards < 0) > 0.9)
