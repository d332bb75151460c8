"""Room -> z_env: the front of an EfficientNet-B0 over colour, depth and class mask.

Its batch norms become group norms: a step sees two to four rooms, whose statistics are no one else's.

Reference: paper, section "Generalization via Hypernetworks", Environment Encoder (2.1 M parameters).
"""

import math
from collections.abc import Callable

from torch import Tensor, nn

from mmweaver.core.registry import Registry
from mmweaver.models.efficientnet import Stem, make_blocks
from mmweaver.models.scene_tensors import IMAGE_CHANNELS

Z_ENV = 512
BLOCKS, ENCODED_CHANNELS = 13, 192  # of EfficientNet-B0's 16: with the projection 2.1 M parameters, as the paper counts
MAP_BLOCK, MAP_CHANNELS = 5, 40  # after it the map has an eighth of the picture's rows and columns


class EnvironmentEncoder(nn.Module):
    """Pictures (room, 5, row, column) -> z_env (room, 512), and a map (room, 40, row / 8, column / 8) of the places."""

    def __init__(self, *, batch_norm: bool = False) -> None:
        super().__init__()
        self.stem = Stem(IMAGE_CHANNELS)
        self.blocks = nn.ModuleList(make_blocks(BLOCKS))
        if not batch_norm:
            _group_norms(self)
        self.project = nn.Sequential(nn.Linear(ENCODED_CHANNELS, Z_ENV), nn.SiLU(), nn.Linear(Z_ENV, Z_ENV))

    def forward(self, image: Tensor) -> tuple[Tensor, Tensor]:
        x = self.stem(image)
        places = x
        for index, block in enumerate(self.blocks):
            x = block(x)
            if index + 1 == MAP_BLOCK:
                places = x
        return self.project(x.mean(dim=(2, 3))), places


def _group_norms(module: nn.Module) -> None:
    for name, child in module.named_children():
        if isinstance(child, nn.BatchNorm2d):
            setattr(module, name, nn.GroupNorm(math.gcd(child.num_features, 8), child.num_features))
        else:
            _group_norms(child)


DEFAULT_ENCODER = "efficientnet"
ENCODERS: Registry[Callable[[], nn.Module]] = Registry(
    "environment encoder", [(DEFAULT_ENCODER, EnvironmentEncoder)], entry_points="mmweaver.encoders"
)
