"""Room to z_env: the front of an EfficientNet-B0 over colour, depth and class mask.

Batch norms become group norms: a step sees two to four rooms, whose statistics are not representative. Blocks are
implemented here, since importing those of transformers takes longer than generating a signal; tensors have the names
of transformers, so that weights of either load into the other, and a test compares their outputs.

References: Tan and Le, EfficientNet, ICML 2019, table 1; Sandler et al., MobileNetV2, 2018; paper, "Generalization
via Hypernetworks", Environment Encoder (2.1 M parameters).
"""

import math
from collections import OrderedDict
from collections.abc import Callable
from functools import partial

from torch import Tensor, nn

from mmweaver.core.registry import Registry
from mmweaver.models.scene_tensors import IMAGE_CHANNELS

STEM_CHANNELS = 32
SQUEEZE = 4  # of a block's input channels, for squeeze and excitation
MAX_DROPOUT = 0.2  # of the last block
make_norm = partial(nn.BatchNorm2d, eps=1e-3, momentum=0.99)
# per stage: expansion, channels, blocks, stride of the first, kernel
STAGES = (
    (1, 16, 1, 1, 3),
    (6, 24, 2, 2, 3),
    (6, 40, 2, 2, 5),
    (6, 80, 3, 2, 3),
    (6, 112, 3, 1, 5),
    (6, 192, 4, 2, 5),
    (6, 320, 1, 1, 3),
)


def make_blocks(count: int) -> list["Block"]:
    """The first `count` of B0's sixteen blocks."""
    total = sum(stage[2] for stage in STAGES)
    rows = [(*stage, number) for stage in STAGES for number in range(stage[2])]
    blocks: list[Block] = []
    channels_in = STEM_CHANNELS
    for index, (expansion, channels, _, stride, kernel, number) in enumerate(rows[:count]):
        stride = stride if number == 0 else 1
        blocks.append(Block(channels_in, channels, expansion, kernel, stride, MAX_DROPOUT * index / total))
        channels_in = channels
    return blocks


class Stem(nn.Module):
    """Pictures (room, channel, row, column) to 32 channels at half the resolution."""

    def __init__(self, channels_in: int) -> None:
        super().__init__()
        self.padding = nn.ZeroPad2d((0, 1, 0, 1))
        self.convolution = nn.Conv2d(channels_in, STEM_CHANNELS, 3, stride=2, bias=False)
        self.batchnorm = make_norm(STEM_CHANNELS)

    def forward(self, image: Tensor) -> Tensor:
        return nn.functional.silu(self.batchnorm(self.convolution(self.padding(image))))


class Block(nn.Module):
    """A mobile inverted bottleneck with squeeze and excitation."""

    def __init__(
        self, channels_in: int, channels_out: int, expansion: int, kernel: int, stride: int, dropout: float
    ) -> None:
        super().__init__()
        wide, half = channels_in * expansion, kernel // 2
        self.expansion = nn.Identity()
        if expansion > 1:
            self.expansion = _layers(
                expand_conv=nn.Conv2d(channels_in, wide, 1, bias=False),
                expand_bn=make_norm(wide),
                act=nn.SiLU(),
            )
        # at stride 2 there is less padding above and to the left, so an even number of rows is halved exactly
        before = half - 1 if stride == 2 else half
        self.depthwise_conv = _layers(
            padding=nn.ZeroPad2d((before, half, before, half)),
            depthwise_conv=nn.Conv2d(wide, wide, kernel, stride=stride, groups=wide, bias=False),
            depthwise_norm=make_norm(wide),
            act=nn.SiLU(),
        )
        self.squeeze_excite = _layers(
            reduce=nn.Conv2d(wide, channels_in // SQUEEZE, 1),
            act=nn.SiLU(),
            expand=nn.Conv2d(channels_in // SQUEEZE, wide, 1),
            gate=nn.Sigmoid(),
        )
        self.projection = _layers(
            project_conv=nn.Conv2d(wide, channels_out, 1, bias=False),
            project_bn=make_norm(channels_out),
        )
        self.dropout = nn.Dropout(dropout)
        self.is_residual = stride == 1 and channels_in == channels_out

    def forward(self, x: Tensor) -> Tensor:
        wide = self.depthwise_conv(self.expansion(x))
        out = self.projection(wide * self.squeeze_excite(wide.mean(dim=(2, 3), keepdim=True)))
        return x + self.dropout(out) if self.is_residual else out


def _layers(**layers: nn.Module) -> nn.Sequential:
    return nn.Sequential(OrderedDict(layers))


Z_ENV = 512
BLOCKS, ENCODED_CHANNELS = 13, 192  # of EfficientNet-B0's 16: with the projection 2.1 M parameters, as in the paper
MAP_BLOCK, MAP_CHANNELS = 5, 40  # after it the map has an eighth of the picture's rows and columns


class EnvironmentEncoder(nn.Module):
    """Encodes rooms by their pictures."""

    def __init__(self, *, batch_norm: bool = False) -> None:
        """Builds the encoder.

        Args:
            batch_norm: Whether batch norms are kept, as in transformers.
        """
        super().__init__()
        self.stem = Stem(IMAGE_CHANNELS)
        self.blocks = nn.ModuleList(make_blocks(BLOCKS))
        if not batch_norm:
            _group_norms(self)
        self.project = nn.Sequential(nn.Linear(ENCODED_CHANNELS, Z_ENV), nn.SiLU(), nn.Linear(Z_ENV, Z_ENV))

    def forward(self, image: Tensor) -> tuple[Tensor, Tensor]:
        """Encodes pictures.

        Args:
            image: Pictures (room, 5, row, column).

        Returns:
            z_env (room, 512), and a map (room, 40, row / 8, column / 8) of local features.
        """
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
