"""Windows of points with joints, disturbed as boards and places differ, for training the pose network."""

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
import torch
from jaxtyping import Float
from torch import Tensor

from mmweaver.core.skeleton import JOINT_NAMES
from mmweaver.models.point_frames import PointFrames, middle_m, near

MIRRORED = [
    JOINT_NAMES.index(name.replace("left", "?").replace("right", "left").replace("?", "right")) for name in JOINT_NAMES
]


@dataclass(frozen=True, kw_only=True)
class PosedFrames:
    """A recording as the network reads it, with the joints of the person in the radar's level axes."""

    frames: PointFrames
    joints_m: Float[np.ndarray, "frame 22 3"]

    def __len__(self) -> int:
        return len(self.joints_m)


@dataclass(frozen=True, kw_only=True)
class Disturbance:
    """How much each window is disturbed: shares of windows, and standard deviations."""

    mirrored: float = 0.5
    backwards: float = 0.3
    shift_m: tuple[float, float, float] = (0.15, 0.15, 0.08)
    tilt_deg: float = 2.0
    point_m: float = 0.01
    strength_db: float = 2.0
    thinned: float = 0.6
    kept: tuple[float, float] = (0.4, 1.0)  # of points, where thinned
    with_gaps: float = 0.3
    gaps: float = 0.1  # of frames, where there are gaps


@dataclass(frozen=True, kw_only=True)
class PoseBatch:
    """Windows of equal length."""

    values: Tensor  # (window, frame, point, 5)
    is_there: Tensor  # (window, frame, point)
    middle_m: Tensor  # (window, 3)
    joints_m: Tensor  # (window, frame, 22, 3)


@dataclass(frozen=True, kw_only=True)
class PoseWindows:
    """Windows of so many frames, drawn from recordings by their length."""

    recordings: Sequence[PosedFrames]
    window_frames: int
    disturbance: Disturbance | None = field(default_factory=Disturbance)

    def batch(self, count: int, rng: np.random.Generator) -> PoseBatch:
        """`count` windows, each from anywhere."""
        usable = [one for one in self.recordings if len(one) >= self.window_frames]
        share = np.array([len(one) for one in usable], float)
        windows = []
        for index in rng.choice(len(usable), count, p=share / share.sum()):
            one = usable[index]
            first = int(rng.integers(len(one) - self.window_frames + 1))
            frames, joints = (
                one.frames.part(first, self.window_frames),
                one.joints_m[first : first + self.window_frames],
            )
            if self.disturbance is not None:
                frames, joints = disturbed(frames, joints, self.disturbance, rng)
            windows.append((frames, joints))
        return batch_of(windows)


def batch_of(windows: Sequence[tuple[PointFrames, Float[np.ndarray, "frame 22 3"]]]) -> PoseBatch:
    """Windows as tensors; points far from the person are left out."""
    middles = [middle_m(frames) for frames, _ in windows]
    kept = [near(frames, middle) for (frames, _), middle in zip(windows, middles, strict=True)]
    return PoseBatch(
        values=torch.from_numpy(np.stack([one.values for one in kept])),
        is_there=torch.from_numpy(np.stack([one.is_there for one in kept])),
        middle_m=torch.from_numpy(np.stack(middles)),
        joints_m=torch.from_numpy(np.stack([joints for _, joints in windows]).astype(np.float32)),
    )


def disturbed(
    frames: PointFrames, joints_m: Float[np.ndarray, "frame 22 3"], how: Disturbance, rng: np.random.Generator
) -> tuple[PointFrames, Float[np.ndarray, "frame 22 3"]]:
    """A window as another board might see it, of a person elsewhere, of another hand, or the other way in time."""
    values, is_there, joints = frames.values.copy(), frames.is_there.copy(), joints_m.copy()
    if rng.random() < how.mirrored:
        values[..., 0] *= -1
        joints = joints[:, MIRRORED] * np.array([-1, 1, 1])
    if rng.random() < how.backwards:
        values, is_there, joints = values[::-1].copy(), is_there[::-1].copy(), joints[::-1]
        values[..., 3] *= -1
    tilt = np.radians(rng.normal(0, how.tilt_deg))
    ahead, up = values[..., 1].copy(), values[..., 2].copy()
    values[..., 1] = np.cos(tilt) * ahead - np.sin(tilt) * up
    values[..., 2] = np.sin(tilt) * ahead + np.cos(tilt) * up
    shift = rng.normal(0, how.shift_m)
    values[..., :3] += shift + rng.normal(0, how.point_m, values[..., :3].shape)
    values[..., 4] += rng.normal(0, how.strength_db, values[..., 4].shape)
    if rng.random() < how.thinned:
        is_there &= rng.random(is_there.shape) < rng.uniform(*how.kept)
    if rng.random() < how.with_gaps:
        is_there &= rng.random((len(is_there), 1)) >= how.gaps
    return PointFrames(values=values, is_there=is_there), joints + shift
