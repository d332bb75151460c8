"""The front of EfficientNet-B0: a stem and mobile inverted bottlenecks.

Its own file rather than transformers' model, whose import takes longer than a signal; tensors bear transformers' names,
so that weights of either load into the other; a test compares their outputs.

Reference: Tan and Le, EfficientNet, ICML 2019, table 1; Sandler et al., MobileNetV2, 2018; Hu et al., 2018.
"""

from collections import OrderedDict

from torch import Tensor, nn

STEM_CHANNELS = 32
SQUEEZE = 4  # of a block's input channels, for squeeze and excitation
MAX_DROPOUT = 0.2  # of the last block
BATCH_NORM = {"eps": 1e-3, "momentum": 0.99}
# of each stage: expansion, channels, blocks, stride of the first, kernel
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
    """The first of B0's sixteen blocks."""
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
    """Pictures (room, channel, row, column) -> 32 channels at half the rows and columns."""

    def __init__(self, channels_in: int) -> None:
        super().__init__()
        self.padding = nn.ZeroPad2d((0, 1, 0, 1))
        self.convolution = nn.Conv2d(channels_in, STEM_CHANNELS, 3, stride=2, bias=False)
        self.batchnorm = nn.BatchNorm2d(STEM_CHANNELS, **BATCH_NORM)

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
                expand_bn=nn.BatchNorm2d(wide, **BATCH_NORM),
                act=nn.SiLU(),
            )
        # an even number of rows is halved exactly: at stride 2 there is less padding above and to the left
        before = half - 1 if stride == 2 else half
        self.depthwise_conv = _layers(
            padding=nn.ZeroPad2d((before, half, before, half)),
            depthwise_conv=nn.Conv2d(wide, wide, kernel, stride=stride, groups=wide, bias=False),
            depthwise_norm=nn.BatchNorm2d(wide, **BATCH_NORM),
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
            project_bn=nn.BatchNorm2d(channels_out, **BATCH_NORM),
        )
        self.dropout = nn.Dropout(dropout)
        self.is_residual = stride == 1 and channels_in == channels_out

    def forward(self, x: Tensor) -> Tensor:
        wide = self.depthwise_conv(self.expansion(x))
        out = self.projection(wide * self.squeeze_excite(wide.mean(dim=(2, 3), keepdim=True)))
        return x + self.dropout(out) if self.is_residual else out


def _layers(**layers: nn.Module) -> nn.Sequential:
    return nn.Sequential(OrderedDict(layers))
