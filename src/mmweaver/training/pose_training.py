"""Training of the pose network: recipe `pose`."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
import torch
from jaxtyping import Float
from torch import Tensor

from mmweaver.core.errors import InputError
from mmweaver.core.seeding import stream
from mmweaver.core.skeleton import JOINT_NAMES, PARENTS
from mmweaver.models.point_frames import PointFrames, middle_m, near
from mmweaver.models.pose_network import RECIPE, PoseNetwork
from mmweaver.training.device import Share
from mmweaver.training.trainer import BatchSampler, Learner, Listener, LoopRecipe, Trainer

MIRRORED = [
    JOINT_NAMES.index(name.replace("left", "?").replace("right", "left").replace("?", "right")) for name in JOINT_NAMES
]


@dataclass(frozen=True, kw_only=True)
class PosedFrames:
    """A recording as network input, with the person's joints in the radar's level axes."""

    frames: PointFrames
    joints_m: Float[np.ndarray, "frame 22 3"]

    def __len__(self) -> int:
        return len(self.joints_m)


@dataclass(frozen=True, kw_only=True)
class Disturbance:
    """Augmentation of windows: probabilities and standard deviations."""

    mirrored: float = 0.5
    backwards: float = 0.3
    shift_m: tuple[float, float, float] = (0.15, 0.15, 0.08)
    tilt_deg: float = 2.0
    point_m: float = 0.01
    strength_db: float = 2.0
    thinned: float = 0.6
    kept: tuple[float, float] = (0.4, 1.0)  # share of points kept in thinned windows
    with_gaps: float = 0.3
    gaps: float = 0.1  # share of frames lost in windows with gaps


@dataclass(frozen=True, kw_only=True)
class PoseBatch:
    """Windows of equal length."""

    values: Tensor  # (window, frame, point, 5)
    is_there: Tensor  # (window, frame, point)
    middle_m: Tensor  # (window, 3)
    joints_m: Tensor  # (window, frame, 22, 3)


@dataclass(frozen=True, kw_only=True)
class PoseWindows:
    """Windows of equal length, sampled from recordings in proportion to their length."""

    recordings: Sequence[PosedFrames]
    window_frames: int
    disturbance: Disturbance | None = field(default_factory=Disturbance)

    def batch(self, count: int, rng: np.random.Generator) -> PoseBatch:
        """Samples windows at random positions.

        Args:
            count: Number of windows.
            rng: Random generator.

        Returns:
            The batch, augmented if `disturbance` is set.
        """
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
    """Converts windows to tensors; points far from the person are dropped.

    Args:
        windows: Frames and joints of each window.

    Returns:
        The batch.
    """
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
    """Augments a window: mirrored, reversed in time, tilted, shifted, noisy, thinned or with lost frames.

    Args:
        frames: Points of the window.
        joints_m: Joints in metres, (frame, 22, 3).
        how: Strength of the augmentation.
        rng: Random generator.

    Returns:
        Augmented points and joints.
    """
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


PELVIS_WEIGHT, BONE_WEIGHT = 0.5, 0.5


@dataclass(frozen=True, kw_only=True)
class PoseRecipe(LoopRecipe):
    """Hyperparameters of the pose network."""

    name: str = RECIPE
    steps: int = 2000
    batch_size: int = 16
    learning_rate: float = 2e-3
    warm_up_steps: int = 100
    weight_decay: float = 1e-3
    largest_gradient: float | None = 1.0
    validate_every: int = 250
    validation_batches: int = 4


class PoseLearner(Learner):
    """The pose network with its loss: errors of joints relative to the pelvis, of the pelvis, and of bone vectors."""

    def __init__(self, network: PoseNetwork):
        super().__init__()
        self.network = network

    def terms(self, batch: PoseBatch) -> dict[str, Tensor]:
        """Mean errors in metres: joints relative to the pelvis, pelvis, and bone vectors."""
        joints, pelvis = self.network(batch.values, batch.is_there, batch.middle_m)
        wanted = batch.joints_m - batch.joints_m[..., :1, :]
        return {
            "joints": (joints - wanted)[..., 1:, :].norm(dim=-1).mean(),
            "pelvis": PELVIS_WEIGHT * (pelvis - batch.joints_m[..., 0, :]).norm(dim=-1).mean(),
            "bones": BONE_WEIGHT * (_bones(joints) - _bones(wanted)).norm(dim=-1).mean(),
        }


def _bones(joints: Tensor) -> Tensor:
    """Vectors from each joint's parent to the joint, (..., 21, 3)."""
    return joints[..., 1:, :] - joints[..., list(PARENTS[1:]), :]


def mean_pose_m(windows: PoseWindows) -> np.ndarray:
    """Mean joints relative to the pelvis in metres, (22, 3)."""
    joints = np.concatenate([one.joints_m for one in windows.recordings])
    return (joints - joints[:, :1]).mean(axis=0)


def train_pose(
    windows: PoseWindows,
    unseen: PoseWindows,
    out: Path,
    recipe: PoseRecipe,
    *,
    start: dict[str, Tensor] | None = None,
    listener: Listener | None = None,
    **options: Any,
) -> Trainer[PoseLearner]:
    """Trains on windows, or resumes from `out`/checkpoint.pt.

    Args:
        windows: Windows of the training recordings.
        unseen: Windows of the validation recordings.
        out: Folder of the run.
        recipe: Hyperparameters.
        start: Weights to fine-tune. Default: random.
        listener: Called with the progress of each step. Default: none.
        **options: Further arguments of `Trainer`.

    Returns:
        The trainer with the best network on `unseen`.

    Raises:
        InputError: If no recording is as long as a window, or training diverges.
    """
    for one in (windows, unseen):
        if not any(len(recording) >= one.window_frames for recording in one.recordings):
            raise InputError(f"no recording is as long as a window, {one.window_frames} frames; choose shorter windows")
    torch.manual_seed(recipe.seed)
    network = PoseNetwork()
    if start is None:
        network.mean_m.copy_(torch.from_numpy(mean_pose_m(windows)))
    else:
        network.load_state_dict(start)
    trainer = Trainer(
        PoseLearner(network),
        recipe,
        out,
        is_tuning=start is not None,
        batches=(_sampler(windows, recipe, "pose batch"), _sampler(unseen, recipe, "pose validation")),
        **options,
    )
    trainer.run(listener)
    return trainer


def _sampler(windows: PoseWindows, recipe: PoseRecipe, purpose: str) -> BatchSampler:
    """Batches by step."""

    def draw(step: int, share: Share) -> PoseBatch:
        batch = windows.batch(recipe.batch_size, stream(recipe.seed, purpose, step))
        own = slice(share[0], None, share[1])
        return PoseBatch(**{name: values[own] for name, values in vars(batch).items()})

    return draw
