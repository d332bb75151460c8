"""Room -> z_env: the front of an EfficientNet-B0 over colour, depth and class mask.

Its batch norms become group norms: a step sees two to four rooms, whose statistics are no one else's.

Reference: paper, section "Generalization via Hypernetworks", Environment Encoder (2.1 M parameters).
"""

import math

import torch
from torch import Tensor, nn

from mmweaver.models.room_view import IMAGE_CHANNELS

Z_ENV = 512
BLOCKS = 13  # of EfficientNet-B0's 16: with the projection 2.1 M parameters, as the paper counts
MAP_BLOCK, MAP_CHANNELS = 5, 40  # after it the map has an eighth of the picture's rows and columns


class EnvironmentEncoder(nn.Module):
    """Pictures (room, 5, row, column) -> z_env (room, 512), and a map (room, 40, row / 8, column / 8) of the places."""

    def __init__(self, *, batch_norm: bool = False) -> None:
        super().__init__()
        from transformers import EfficientNetConfig, EfficientNetModel

        b0 = EfficientNetModel(
            EfficientNetConfig(
                width_coefficient=1.0, depth_coefficient=1.0, hidden_dim=1280, num_channels=IMAGE_CHANNELS
            )
        )
        self.stem = b0.embeddings
        self.blocks = nn.ModuleList(list(b0.encoder.blocks)[:BLOCKS])
        if not batch_norm:
            _group_norms(self)
        channels = _channels(self.stem, self.blocks)
        self.project = nn.Sequential(nn.Linear(channels, Z_ENV), nn.SiLU(), nn.Linear(Z_ENV, Z_ENV))

    def forward(self, image: Tensor) -> tuple[Tensor, Tensor]:
        x = self.stem(image)
        places = x
        for index, block in enumerate(self.blocks):
            x = block(x)
            if index + 1 == MAP_BLOCK:
                places = x
        return self.project(x.mean(dim=(2, 3))), places


def _channels(stem: nn.Module, blocks: nn.ModuleList) -> int:
    stem.eval()
    blocks.eval()
    with torch.no_grad():
        x = stem(torch.zeros(1, IMAGE_CHANNELS, 32, 32))
        for block in blocks:
            x = block(x)
    stem.train()
    blocks.train()
    return x.shape[1]


def _group_norms(module: nn.Module) -> None:
    for name, child in module.named_children():
        if isinstance(child, nn.BatchNorm2d):
            setattr(module, name, nn.GroupNorm(math.gcd(child.num_features, 8), child.num_features))
        else:
            _group_norms(child)
