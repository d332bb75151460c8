"""The paper's kind of recogniser: convolutions on range-angle images of 32 x 32 of each frame, an LSTM over frames.

    DRAI (frame, 1, 32, 32) --three convolutions--> (frame, 32, 4, 4) --linear--> (frame, 64) --LSTM--> activity

The paper gives the size of the maps alone and its repository no code, so widths are ours.
Reference: Li et al., Towards Domain-Independent and Real-Time Gesture Recognition Using mmWave Signal (TMC 2023).
"""

from collections.abc import Callable

import numpy as np
import torch
from torch import Tensor, nn

from mmweaver.core.seeding import stream
from mmweaver.models.frame_motion import MIDDLE_DB, SPREAD_DB

MOVING = 1  # of the two range-azimuth maps: what is left without static clutter
WIDTHS, FRAME_WIDTH, DROPPED = (8, 16, 32), 64, 0.4
RATE = 2e-3


class CnnLstm(nn.Module):
    """Images (sequence, frame, 1, 32, 32) -> (sequence, label)."""

    def __init__(self, num_labels: int):
        super().__init__()
        blocks: list[nn.Module] = []
        before = 1
        for width in WIDTHS:
            blocks += [nn.Conv2d(before, width, 3, stride=2, padding=1), nn.GroupNorm(4, width), nn.ReLU()]
            before = width
        self.convolutions = nn.Sequential(*blocks, nn.Flatten(), nn.LazyLinear(FRAME_WIDTH), nn.ReLU())
        self.over_time = nn.LSTM(FRAME_WIDTH, FRAME_WIDTH, batch_first=True)
        self.last = nn.Sequential(nn.Dropout(DROPPED), nn.Linear(FRAME_WIDTH, num_labels))

    def forward(self, images: Tensor) -> Tensor:
        each = self.convolutions(images.flatten(0, 1)).unflatten(0, images.shape[:2])
        return self.last(self.over_time(each)[0].mean(dim=1))


def range_angle_images(angle: Tensor, bins: int = 2) -> Tensor:
    """Log maps (sequence, frame, 2, 64, 32) of the activity network -> DRAI (sequence, frame, 1, 64 / bins, 32).

    The moving echoes' power, averaged over so many range bins; in the same units of 15 dB about 20 dB over the noise.
    """
    power = 10 ** ((angle[:, :, MOVING].float() * SPREAD_DB + MIDDLE_DB) / 10)
    pairs = power.unflatten(2, (-1, bins)).mean(dim=3)
    return ((10 * torch.log10(pairs) - MIDDLE_DB) / SPREAD_DB)[:, :, None]


def trained(
    network: nn.Module, draw: Callable[[np.random.Generator], tuple[Tensor, ...]], steps: int, seed: int
) -> None:
    """Trains on batches of inputs and labels, with a falling learning rate."""
    network.train()
    adam = torch.optim.AdamW(network.parameters(), lr=RATE, weight_decay=1e-2)
    fall = torch.optim.lr_scheduler.CosineAnnealingLR(adam, steps)
    for step in range(steps):
        *inputs, label = draw(stream(seed, "recogniser", step))
        loss = nn.functional.cross_entropy(network(*inputs), label, label_smoothing=0.1)
        adam.zero_grad()
        loss.backward()
        adam.step()
        fall.step()
    network.eval()
