"""Training the pose network: recipe `pose`."""

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import torch
from torch import Tensor

from mmweaver.core.errors import InputError
from mmweaver.core.seeding import stream
from mmweaver.core.skeleton import PARENTS
from mmweaver.models.pose_network import RECIPE, PoseNetwork
from mmweaver.training.device import Share
from mmweaver.training.pose_examples import PoseBatch, PoseWindows
from mmweaver.training.trainer import BatchSampler, Learner, Listener, LoopRecipe, Trainer

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
    """The network with its loss: distances of joints about the pelvis, of the pelvis, and between ends of bones."""

    def __init__(self, network: PoseNetwork):
        super().__init__()
        self.network = network

    def terms(self, batch: PoseBatch) -> dict[str, Tensor]:
        joints, pelvis = self.network(batch.values, batch.is_there, batch.middle_m)
        wanted = batch.joints_m - batch.joints_m[..., :1, :]
        return {
            "joints": (joints - wanted)[..., 1:, :].norm(dim=-1).mean(),
            "pelvis": PELVIS_WEIGHT * (pelvis - batch.joints_m[..., 0, :]).norm(dim=-1).mean(),
            "bones": BONE_WEIGHT * (_bones(joints) - _bones(wanted)).norm(dim=-1).mean(),
        }


def _bones(joints: Tensor) -> Tensor:
    """Vectors from each joint's parent to it (..., 21, 3)."""
    return joints[..., 1:, :] - joints[..., list(PARENTS[1:]), :]


def mean_pose_m(windows: PoseWindows) -> np.ndarray:
    """The mean of all joints relative to the pelvis (22, 3)."""
    joints = np.concatenate([one.joints_m for one in windows.recordings])
    return (joints - joints[:, :1]).mean(axis=0)


def train_pose(
    windows: PoseWindows, unseen: PoseWindows, out: Path, recipe: PoseRecipe, *,
    start: dict[str, Tensor] | None = None, listener: Listener | None = None, **options: Any,
) -> Trainer[PoseLearner]:  # fmt: skip
    """Trains on windows, or resumes from `out`/checkpoint.pt. The returned Trainer holds the network that is best on
    the recordings of `unseen`. `start`: weights to fine-tune. `options` go to `Trainer`.

    Raises InputError where no recording is as long as a window.
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
        PoseLearner(network), recipe, out, is_tuning=start is not None, train=_sampler(windows, recipe, "pose batch"),
        validation=_sampler(unseen, recipe, "pose validation"), **options,
    )  # fmt: skip
    trainer.run(listener)
    return trainer


def _sampler(windows: PoseWindows, recipe: PoseRecipe, purpose: str) -> BatchSampler:
    """Batches by step."""

    def draw(step: int, share: Share) -> PoseBatch:
        batch = windows.batch(recipe.batch_size, stream(recipe.seed, purpose, step))
        own = slice(share[0], None, share[1])
        return PoseBatch(
            values=batch.values[own], is_there=batch.is_there[own], middle_m=batch.middle_m[own],
            joints_m=batch.joints_m[own],
        )  # fmt: skip

    return draw
