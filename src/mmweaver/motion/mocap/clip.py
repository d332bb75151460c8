"""A recorded motion: as read (RawMotion), and in our joints, metres and axes (MotionClip).

Resampling of a clip of any frame rate to 120 Hz, smooth enough for the radar's slow time.

Between frames the joints follow cubic splines with continuous velocity and acceleration. Recordings of 50 or more
frames per second contain marker jitter, tenths of a millimetre at frequencies at which no limb moves. It would be
visible to the radar (1 mm is half a cycle of its phase), so it is low-pass filtered at 12 Hz.
Reference: Winter, Biomechanics and Motor Control of Human Movement, 2009, 3.4.4 (cut-off of recorded motion).
"""

from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from jaxtyping import Float

from mmweaver.core.errors import InputError
from mmweaver.core.shapes import Joints, PerFrame
from mmweaver.core.skeleton import joint
from mmweaver.motion.animation.assemble import dense_times
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


CUT_OFF_HZ = 12.0
JITTERS_FROM_FPS = 50.0


def check_lasts(clip: MotionClip, duration_s: float) -> None:
    """Checks that a clip is long enough.

    Args:
        clip: The recorded motion.
        duration_s: Required duration in seconds.

    Raises:
        InputError: If the clip is shorter.
    """
    if clip.duration_s < duration_s - 1e-6:
        raise InputError(
            f"{clip.label} lasts {clip.duration_s:.3g} s, {duration_s:.3g} s are asked for; leave out --frames and"
            " --seconds, then it sets the length, or give a longer motion"
        )


def resampled_clip(clip: MotionClip, duration_s: float) -> tuple[PerFrame, Joints]:
    """Resamples a clip to 120 Hz, without jitter.

    Args:
        clip: The recorded motion at any frame rate.
        duration_s: Duration to take from it, in seconds.

    Returns:
        Times (n,) from just before 0 to just after `duration_s`, and joints (n, 22, 3) in metres.

    Raises:
        InputError: If the clip is shorter.
    """
    from scipy.interpolate import CubicSpline

    check_lasts(clip, duration_s)
    joints = low_passed(clip)
    margin = max(2, int(np.ceil(0.1 * clip.fps)))
    joints = _continued(joints, margin)
    frame_s = (np.arange(len(joints)) - min(margin, len(clip.joints_m) - 1)) / clip.fps
    time_s = dense_times(duration_s)
    return time_s, np.asarray(CubicSpline(frame_s, joints, axis=0)(time_s))


def low_passed(clip: MotionClip) -> Joints:
    """Removes jitter above 12 Hz by a Butterworth filter, run both ways for zero phase.

    Args:
        clip: The recorded motion; without jitter, or below 50 frames per second, it is returned unchanged.

    Returns:
        Joints (frame, 22, 3) in metres.
    """
    from scipy.signal import butter, sosfiltfilt

    if not clip.has_jitter or clip.fps < JITTERS_FROM_FPS:
        return clip.joints_m
    sections = butter(2, CUT_OFF_HZ / 0.802, fs=clip.fps, output="sos")  # run twice, it attenuates by 3 dB at 12 Hz
    pad = min(len(clip.joints_m) - 1, int(clip.fps / 2))
    return np.asarray(sosfiltfilt(sections, clip.joints_m, axis=0, padtype="odd", padlen=pad))


def _continued(joints: Float[np.ndarray, "frame 22 3"], frames: int) -> Float[np.ndarray, "more 22 3"]:
    """Extrapolates both ends by point reflection, which continues position and velocity."""
    frames = min(frames, len(joints) - 1)
    before = 2 * joints[0] - joints[frames:0:-1]
    after = 2 * joints[-1] - joints[-2 : -frames - 2 : -1]
    return np.concatenate([before, joints, after])
