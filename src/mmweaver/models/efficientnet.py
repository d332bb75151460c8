"""The front of EfficientNet-B0: a stem and blocks that widen, look about, weigh channels and narrow again.

Its own file rather than transformers' model, whose import takes longer than a signal; tensors bear transformers' names,
so that weights of either load into the other. A test holds both to the same numbers.

Reference: Tan and Le, EfficientNet, ICML 2019, table 1; Sandler et al., MobileNetV2, 2018; Hu et al., 2018.
"""

from dataclasses import dataclass

from torch import Tensor, nn

STEM_CHANNELS = 32
NARROWING = 4  # channels that weigh channels: a quarter of the block's input
DROPPED = 0.2  # of a block's own words, at the last of them, in training
BATCH_NORM_EPS, BATCH_NORM_MOMENTUM = 1e-3, 0.99


@dataclass(frozen=True, kw_only=True)
class Shape:
    """What a block is made of."""

    channels_in: int
    channels_out: int
    widens: int
    kernel: int
    stride: int
    drops: float


# of each stage: how much it widens, channels, blocks, stride of the first, kernel
_STAGES = ((1, 16, 1, 1, 3), (6, 24, 2, 2, 3), (6, 40, 2, 2, 5), (6, 80, 3, 2, 3), (6, 112, 3, 1, 5), (6, 192, 4, 2, 5),
           (6, 320, 1, 1, 3))  # fmt: skip


def shapes() -> list[Shape]:
    """Those of B0's sixteen blocks."""
    total = sum(stage[2] for stage in _STAGES)
    out: list[Shape] = []
    channels_in = STEM_CHANNELS
    for widens, channels, repeats, stride, kernel in _STAGES:
        for number in range(repeats):
            out.append(
                Shape(
                    channels_in=channels_in, channels_out=channels, widens=widens, kernel=kernel,
                    stride=stride if number == 0 else 1, drops=DROPPED * len(out) / total,
                )
            )  # fmt: skip
            channels_in = channels
    return out


class Stem(nn.Module):
    """Pictures (room, channel, row, column) -> 32 channels at half the rows and columns."""

    def __init__(self, channels_in: int) -> None:
        super().__init__()
        self.padding = nn.ZeroPad2d((0, 1, 0, 1))
        self.convolution = nn.Conv2d(channels_in, STEM_CHANNELS, 3, stride=2, bias=False)
        self.batchnorm = _norm(STEM_CHANNELS)

    def forward(self, image: Tensor) -> Tensor:
        return nn.functional.silu(self.batchnorm(self.convolution(self.padding(image))))


class Block(nn.Module):
    """A mobile inverted bottleneck with squeeze and excitation."""

    def __init__(self, shape: Shape) -> None:
        super().__init__()
        wide = shape.channels_in * shape.widens
        self.expansion = _Expansion(shape.channels_in, wide) if shape.widens > 1 else nn.Identity()
        self.depthwise_conv = _Depthwise(wide, shape.kernel, shape.stride)
        self.squeeze_excite = _SqueezeExcite(wide, shape.channels_in // NARROWING)
        self.projection = _Projection(wide, shape.channels_out)
        self.dropout = nn.Dropout(shape.drops)
        self.adds = shape.stride == 1 and shape.channels_in == shape.channels_out

    def forward(self, x: Tensor) -> Tensor:
        said = self.projection(self.squeeze_excite(self.depthwise_conv(self.expansion(x))))
        return x + self.dropout(said) if self.adds else said


class _Expansion(nn.Module):
    def __init__(self, channels_in: int, channels_out: int) -> None:
        super().__init__()
        self.expand_conv = nn.Conv2d(channels_in, channels_out, 1, bias=False)
        self.expand_bn = _norm(channels_out)

    def forward(self, x: Tensor) -> Tensor:
        return nn.functional.silu(self.expand_bn(self.expand_conv(x)))


class _Depthwise(nn.Module):
    def __init__(self, channels: int, kernel: int, stride: int) -> None:
        super().__init__()
        half = kernel // 2
        # of an even number of rows, half of them are left: what is missing is added below and to the right
        before = half - 1 if stride == 2 else half
        self.padding = nn.ZeroPad2d((before, half, before, half))
        self.depthwise_conv = nn.Conv2d(channels, channels, kernel, stride=stride, groups=channels, bias=False)
        self.depthwise_norm = _norm(channels)

    def forward(self, x: Tensor) -> Tensor:
        return nn.functional.silu(self.depthwise_norm(self.depthwise_conv(self.padding(x))))


class _SqueezeExcite(nn.Module):
    def __init__(self, channels: int, narrow: int) -> None:
        super().__init__()
        self.reduce = nn.Conv2d(channels, narrow, 1)
        self.expand = nn.Conv2d(narrow, channels, 1)

    def forward(self, x: Tensor) -> Tensor:
        mean = x.mean(dim=(2, 3), keepdim=True)
        return x * self.expand(nn.functional.silu(self.reduce(mean))).sigmoid()


class _Projection(nn.Module):
    def __init__(self, channels_in: int, channels_out: int) -> None:
        super().__init__()
        self.project_conv = nn.Conv2d(channels_in, channels_out, 1, bias=False)
        self.project_bn = _norm(channels_out)

    def forward(self, x: Tensor) -> Tensor:
        return self.project_bn(self.project_conv(x))


def _norm(channels: int) -> nn.BatchNorm2d:
    return nn.BatchNorm2d(channels, eps=BATCH_NORM_EPS, momentum=BATCH_NORM_MOMENTUM)
