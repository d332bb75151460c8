"""A recorded motion: as read (RawMotion), and in our joints, metres and axes (MotionClip)."""

from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from jaxtyping import Float

from mmweaver.core.errors import InputError
from mmweaver.core.shapes import Joints
from mmweaver.core.skeleton import joint
from mmweaver.motion.animation.skeleton_proportions import ALLOWED_M

Array = np.ndarray

# Legs and trunk (hips to shoulders) as a share of the height, as in motion/animation/skeleton_proportions.py; the SMPL
# mean body has 0.776. Spine and head joints would add precision, but skeletons differ in where they place them.
BONES_OF_HEIGHT = 0.474 + 0.295
LEGS = (("hip", "knee"), ("knee", "ankle"))


@dataclass(frozen=True, kw_only=True)
class RawMotion:
    """Joints of a file in its own unit and axes; None where the file does not state them.

    Attributes:
        names: The file's own joint names.
        positions: Joints (frame, joint, 3).
        kind: Kind of file: BVH, SMPL, ...
        fps: Frames per second.
        unit_m: Metres per unit.
        up: Upward axis: y, z, -y, -z, x or -x.
        notes: Sentences on the assumptions made.
    """

    names: tuple[str, ...]
    positions: Float[Array, "frame joint 3"]
    kind: str
    fps: float | None = None
    unit_m: float | None = None
    up: str | None = None
    notes: tuple[str, ...] = ()


@dataclass(frozen=True, kw_only=True)
class MotionClip:
    """A recorded motion of 22 joints: metres, z up, right-handed, uniformly sampled; anywhere on its floor.

    Attributes:
        joints_m: Joints (frame, 22, 3) in metres.
        fps: Frames per second.
        label: Name in titles and meta.json.
        notes: Sentences on the assumptions made.
        has_jitter: Whether marker jitter is to be filtered out (see `clip_resampling`).
        file: File it was read from.
        first_frame: Index in the file.
    """

    joints_m: Joints
    fps: float
    label: str
    notes: tuple[str, ...] = ()
    has_jitter: bool = True
    file: Path | None = None
    first_frame: int = 0

    @property
    def duration_s(self) -> float:
        """Duration in seconds; every frame lasts 1/fps, including the last one."""
        return len(self.joints_m) / self.fps

    @property
    def height_m(self) -> float:
        """Height of the body in metres, estimated from the bones of legs and trunk."""
        return body_height(self.joints_m)

    def after(self, start_s: float) -> "MotionClip":
        """The clip from a start time on.

        Args:
            start_s: Start in seconds.

        Raises:
            InputError: If fewer than two frames remain.
        """
        first = round(start_s * self.fps)
        if not 0 <= first <= len(self.joints_m) - 2:
            raise InputError(
                f"{self.label} lasts {self.duration_s:.2f} s, so it cannot start at {start_s:g} s; choose an earlier"
                " --motion-set start=S"
            )
        return replace(self, joints_m=self.joints_m[first:], first_frame=self.first_frame + first) if first else self

    def scaled_to(self, height_m: float) -> "MotionClip":
        """Scales the body to another height; its paths scale with the legs.

        Args:
            height_m: Height in metres.

        Returns:
            The scaled clip, with a note.

        Raises:
            InputError: If the height is out of range.
        """
        low, high = ALLOWED_M
        if not low <= height_m <= high:
            raise InputError(f"a body height of {height_m:g} m is outside {low:g} to {high:g} m; choose another")
        was = self.height_m
        note = f"the recorded body of about {was:.2f} m was scaled to {height_m:.2f} m, and its steps with it"
        return replace(self, joints_m=self.joints_m * (height_m / was), notes=(*self.notes, note))


def body_height(joints: Joints) -> float:
    """Height of the body from the median lengths of its legs and trunk.

    Accurate to about 8 %: people, and the skeletons of recordings, differ in their proportions.

    Args:
        joints: Joints (frame, 22, 3) in any unit.

    Returns:
        Height in the same unit.
    """

    def length(one: str, other: str) -> float:
        return float(np.median(np.linalg.norm(joints[:, joint(one)] - joints[:, joint(other)], axis=-1)))

    leg = sum(length(f"{side}_{a}", f"{side}_{b}") for side in ("left", "right") for a, b in LEGS) / 2
    hips, shoulders = (joints[:, joint(f"left_{p}")] + joints[:, joint(f"right_{p}")] for p in ("hip", "shoulder"))
    trunk = float(np.median(np.linalg.norm(shoulders - hips, axis=-1))) / 2
    return (leg + trunk) / BONES_OF_HEIGHT
