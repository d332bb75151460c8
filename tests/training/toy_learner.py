"""A learner that takes no time: a small network fits a line. Run by torchrun, it is one of several processes.

toy_learner.py OUT [STEP]     the first process kills itself after STEP
"""

import os
import sys
from pathlib import Path

import numpy as np
import torch
from torch import Tensor, nn

from mmweaver.core.seeding import stream
from mmweaver.training.device import ComputeDevice, Share
from mmweaver.training.trainer import BatchSampler, Learner, LoopRecipe, Progress, Trainer

RECIPE = LoopRecipe(
    name="toy", steps=8, batch_size=4, learning_rate=0.05, warm_up_steps=2, validate_every=4, validation_batches=3
)


class ToyLearner(Learner):
    def __init__(self) -> None:
        super().__init__()
        torch.manual_seed(0)
        self.layers = nn.Sequential(nn.Linear(3, 16), nn.GELU(), nn.Linear(16, 1))
        self.offset = nn.Parameter(torch.zeros(()))

    def terms(self, batch: tuple[Tensor, Tensor]) -> dict[str, Tensor]:
        x, y = batch
        error = self.layers(x)[:, 0] + self.offset - y
        return {"square": error.square().mean(), "absolute": error.abs().mean()}

    def picture(self) -> np.ndarray:
        return np.full((4, 6, 3), 100, np.uint8)


def draw(step: int, share: Share) -> tuple[Tensor, Tensor]:
    x = torch.from_numpy(stream(0, "toy", step).normal(size=(RECIPE.batch_size, 3)).astype(np.float32))
    x = x[share[0] :: share[1]]
    return x, x[:, 0] - 2 * x[:, 1]


def trainer(out: Path, recipe: LoopRecipe = RECIPE, train: BatchSampler = draw, **options) -> Trainer:
    batches = (train, lambda index, share: draw(1000 + index, share))
    return Trainer(ToyLearner(), recipe, out, batches=batches, **options)


if __name__ == "__main__":
    torch.set_num_threads(1)
    made = trainer(Path(sys.argv[1]), compute=ComputeDevice.chosen("cpu"), save_every_s=0.0)

    def killing(progress: Progress) -> None:
        if made.compute.is_first and sys.argv[2:] == [str(progress.step)]:
            os._exit(9)  # with no chance to tidy up

    made.run(killing)
