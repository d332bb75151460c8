"""Resampling of a clip of any frame rate to 120 Hz, smooth enough for the radar's slow time.

Between frames the joints follow cubic splines with continuous velocity and acceleration. Recordings of 50 or more
frames per second contain marker jitter, tenths of a millimetre at frequencies at which no limb moves. It would be
visible to the radar (1 mm is half a cycle of its phase), so it is low-pass filtered at 12 Hz.
Reference: Winter, Biomechanics and Motor Control of Human Movement, 2009, 3.4.4 (cut-off of recorded motion).
"""

import numpy as np
from jaxtyping import Float

from mmweaver.core.errors import InputError
from mmweaver.core.shapes import Joints, PerFrame
from mmweaver.motion.animation.assemble import dense_times
from mmweaver.motion.mocap.clip import MotionClip

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
