"""Training of the small diffusion (`signal_diffusion`): frames of a data set's rooms, batches, loss and weights."""

import math
from dataclasses import dataclass
from functools import cached_property, partial
from pathlib import Path
from typing import Any

import numpy as np
import torch
from torch import Tensor

from mmweaver.core.seeding import stream
from mmweaver.datasets.dataset_store import StoredRoom, read_rooms
from mmweaver.models.weights import load_into
from mmweaver.training.device import Share
from mmweaver.training.model_card import Page
from mmweaver.training.trained_weights import write_recipe_weights
from mmweaver.training.trainer import Learner, LoopRecipe, Trainer
from studies.peers.signal_diffusion import PICTURE, FrameBatch, SignalDiffusion, mixed

RECIPE = "signal_diffusion"
KEPT = 4  # frames of each sequence, synthesised once and kept in memory: 0.1 MB each
PAGE = Page(
    unit="of the energy",
    about="""A small time-frequency diffusion over chirps, after RF-Diffusion's paper, kept for comparison: a person's
joints and a photo in, frames of a complex signal out. For use take recipe weaver.

    python -m studies run diffusion_scores --data DATASET --weights weights.safetensors --runs build/diffusion""",
    limits="- Its frames are generated one by one.\n- One radar ({radar}).",
)


@dataclass(frozen=True, kw_only=True)
class DiffusionRecipe(LoopRecipe):
    """Hyperparameters of the small diffusion."""

    name: str = RECIPE
    steps: int = 8000
    batch_size: int = 6  # sequences, all kept frames of each
    learning_rate: float = 1e-3
    warm_up_steps: int = 100
    validate_every: int = 500
    validation_batches: int = 8


class DiffusionRoom:
    """One stored room as the diffusion sees it."""

    def __init__(self, room: StoredRoom, split: str = "train"):
        self.room = room
        self.indices = [index for index, name in enumerate(room.split) if name == split]
        self._kept: dict[int, Tensor] = {}

    @cached_property
    def picture(self) -> Tensor:
        """The photo in few pixels, (960,): colour, distance in 4 m, and whether that is known."""
        photo = self.room.photo
        depth = np.nan_to_num(photo.depth_m)
        channels = np.concatenate([photo.rgb / 255.0, depth[..., None] / 4, (depth > 0)[..., None]], axis=-1)
        whole = torch.from_numpy(channels).float().permute(2, 0, 1)
        return torch.nn.functional.adaptive_avg_pool2d(whole, PICTURE[1:]).flatten()

    def motion(self, index: int) -> Tensor:
        """Joints and velocities (frame, 132)."""
        parts = (self.room.joints_m[index], self.room.joint_velocity_mps[index])
        return torch.from_numpy(np.concatenate(parts, axis=-1)).float().flatten(1) / 2

    def signal(self, index: int, frames: np.ndarray) -> Tensor:
        """Frames in slow time, (frame, loop, range, antenna), in sqrt(mW)."""
        return slow_time(self.room.cube(index, frames).values)

    def kept_frames(self, index: int) -> np.ndarray:
        """The frames of a sequence that are trained on, evenly spread over it."""
        length = len(self.room.joints_m[index])
        return np.unique(np.linspace(0, length - 1, min(KEPT, length)).round().astype(int))

    def kept_signal(self, index: int, unit: Tensor) -> Tensor:
        """`signal` of the `kept_frames` over `unit`, in half precision with real and imaginary part last."""
        if index not in self._kept:
            values = self.signal(index, self.kept_frames(index)) / unit[:, None]
            self._kept[index] = torch.view_as_real(values).half()
        return self._kept[index]


def slow_time(values: np.ndarray) -> Tensor:
    """Cube values (frame, range, doppler, antenna) -> windowed loops (frame, loop, range, antenna)."""
    return torch.fft.ifft(torch.from_numpy(values), dim=2, norm="ortho").transpose(1, 2)


def cube_of(signal: Tensor) -> np.ndarray:
    """The inverse of `slow_time`."""
    return torch.fft.fft(signal.transpose(1, 2), dim=2, norm="ortho").to(torch.complex64).numpy()


def unit_of(rooms: list[DiffusionRoom], most: int = 48) -> Tensor:
    """Root mean square of each range bin over some training frames, (range,)."""
    frames = torch.cat([one.signal(one.indices[0], np.array([0])) for one in rooms[:: max(1, len(rooms) // most)]])
    return frames.abs().square().mean(dim=(0, 1, 3)).sqrt().clamp(min=1e-30)


def sample_frames(
    rooms: list[DiffusionRoom], unit: Tensor, seed: int, step: int, *, size: int, share: Share
) -> FrameBatch:
    """A batch of frames of `size` sequences, with time and noise; determined by seed and step."""
    signal, motion, picture = [], [], []
    for number in range(share[0], size, share[1]):
        rng = stream(seed, "diffusion batch", step, number)
        one = rooms[int(rng.integers(len(rooms)))]
        index = one.indices[int(rng.integers(len(one.indices)))]
        kept = one.kept_frames(index)
        signal.append(torch.view_as_complex(one.kept_signal(index, unit).float()))
        motion.append(one.motion(index)[kept])
        picture.append(one.picture.expand(len(kept), -1))
    whole = torch.cat(signal)
    rng = stream(seed, "diffusion noise", step, share[0])
    return FrameBatch(
        signal=whole, motion=torch.cat(motion), picture=torch.cat(picture),
        time=torch.from_numpy(rng.random(len(whole))).float(), noise=white(rng, whole.shape),
    )  # fmt: skip


def white(rng: np.random.Generator, shape: Any) -> Tensor:
    """Complex noise of unit variance."""
    return torch.view_as_complex(torch.from_numpy(rng.standard_normal((*shape, 2), np.float32)) / math.sqrt(2))


class DiffusionLearner(Learner):
    """The network with its loss: the squared error of what it restores, over the energy of the signal."""

    def __init__(self, network: SignalDiffusion):
        super().__init__()
        self.network = network

    def terms(self, batch: FrameBatch) -> dict[str, Tensor]:
        noisy = mixed(batch.signal, batch.noise, batch.time)
        error = self.network(noisy, batch.time, batch.motion, batch.picture) - batch.signal
        return {"squared_error": error.abs().square().mean()}

    def figures(self, batch: FrameBatch) -> dict[str, Tensor]:
        return {"zeros": batch.signal.abs().square().mean()}


def train_diffusion(data: Path, out: Path, recipe: DiffusionRecipe) -> Path:
    """Trains on split `train`, or continues from `out`/checkpoint.pt; writes weights and model card to `out`."""
    rooms = read_rooms(data)
    train, unseen = (
        [DiffusionRoom(room, split) for room in rooms if split in room.split] for split in ("train", "validation")
    )
    torch.manual_seed(recipe.seed)
    network = SignalDiffusion(rooms[0].config)
    unit = unit_of(train)
    network.set_unit(unit)
    samplers = [
        partial(_batch, some, unit, recipe.seed + extra, recipe.batch_size)
        for some, extra in ((train, 0), (unseen, 10_000))
    ]
    trainer = Trainer(DiffusionLearner(network), recipe, out, batches=(samplers[0], samplers[1]))
    trainer.run(
        lambda progress: None if progress.validation is None else print(progress.step, progress.validation, flush=True)
    )
    own = {"squared error": trainer.best.value}
    figures = {"this network": own, "zeros": {"squared error": trainer.best.figures["zeros"]}}
    return write_recipe_weights(out, data, trainer, splits=("train",), page=PAGE, figures=figures)


def _batch(rooms: list[DiffusionRoom], unit: Tensor, seed: int, size: int, step: int, share: Share) -> FrameBatch:
    return sample_frames(rooms, unit, seed, step, size=size, share=share)


def load_diffusion(file: Path, network: SignalDiffusion) -> dict[str, Any]:
    """Reads weights into the network; returns what they say of themselves."""
    return load_into(network, file, recipe=RECIPE, made_by="python -m studies run diffusion_scores").__dict__
