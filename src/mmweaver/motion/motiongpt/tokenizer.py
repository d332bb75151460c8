"""The motion tokenizer: a VQ-VAE that encodes HumanML3D features as codes, 4 frames each, and decodes them.

    features (batch, frame, 263)
        | encoder: conv, then `halvings` times (conv of stride 2, residual convs), conv
    (batch, frame / 4, code_width)  --nearest row of the codebook-->  codes (batch, frame / 4)
        | decoder: conv, then `halvings` times (residual convs, doubling, conv), conv, conv
    features (batch, frame, 263)

Names of modules follow the published checkpoint, so that its tensors load without renaming.

Reference: Jiang et al., MotionGPT: Human Motion as a Foreign Language, NeurIPS 2023; Zhang et al., T2M-GPT, CVPR 2023.
"""

from dataclasses import dataclass

import torch
from jaxtyping import Float, Int
from torch import Tensor, nn
from torch.nn import functional


@dataclass(frozen=True, kw_only=True)
class TokenizerConfig:
    """Sizes of the tokenizer; the defaults are the published ones.

    Attributes:
        features: Features per frame.
        codes: Number of codes.
        code_width: Dimension of a code vector.
        width: Channels of the convolutions.
        halvings: Number of downsamplings by two.
        depth: Residual convolutions per level.
        dilation_growth: Ratio of successive dilations.
    """

    features: int = 263
    codes: int = 512
    code_width: int = 512
    width: int = 512
    halvings: int = 2
    depth: int = 3
    dilation_growth: int = 3

    @property
    def frames_per_token(self) -> int:
        return 2**self.halvings


class Residual(nn.Module):
    """x + conv1x1(relu(dilated conv(relu(x))))."""

    def __init__(self, width: int, dilation: int):
        super().__init__()
        self.conv1 = nn.Conv1d(width, width, 3, padding=dilation, dilation=dilation)
        self.conv2 = nn.Conv1d(width, width, 1)

    def forward(self, x: Tensor) -> Tensor:
        """(batch, width, time) -> the same shape."""
        return x + self.conv2(functional.relu(self.conv1(functional.relu(x))))


class ResidualStack(nn.Module):
    """Residual convolutions, the widest dilation first."""

    def __init__(self, config: TokenizerConfig):
        super().__init__()
        dilations = [config.dilation_growth**k for k in range(config.depth)][::-1]
        self.model = nn.Sequential(*(Residual(config.width, dilation) for dilation in dilations))

    def forward(self, x: Tensor) -> Tensor:
        """(batch, width, time) -> the same shape."""
        return self.model(x)


class Coder(nn.Module):
    """Encoder or decoder; all layers under one name, as published."""

    def __init__(self, layers: list[nn.Module]):
        super().__init__()
        self.model = nn.Sequential(*layers)

    def forward(self, x: Tensor) -> Tensor:
        """(batch, channel, time) -> (batch, channel, time)."""
        return self.model(x)


class Codebook(nn.Module):
    """The code vectors; a buffer, because they are updated by running means and not by gradients."""

    codebook: Tensor

    def __init__(self, config: TokenizerConfig):
        super().__init__()
        self.register_buffer("codebook", torch.zeros(config.codes, config.code_width))

    def nearest(self, x: Float[Tensor, "n width"]) -> Int[Tensor, " n"]:
        """Index of the nearest code of each vector (n, width), (n,)."""
        distance = x.square().sum(1, keepdim=True) - 2 * x @ self.codebook.T + self.codebook.square().sum(1)
        return distance.argmin(dim=1)


class MotionTokenizer(nn.Module):
    """Encoder, codebook and decoder; features are normalised outside."""

    def __init__(self, config: TokenizerConfig):
        super().__init__()
        self.config = config
        width = config.width
        down = [
            nn.Sequential(nn.Conv1d(width, width, 4, stride=2, padding=1), ResidualStack(config))
            for _ in range(config.halvings)
        ]
        up = [
            nn.Sequential(ResidualStack(config), nn.Upsample(scale_factor=2), nn.Conv1d(width, width, 3, padding=1))
            for _ in range(config.halvings)
        ]
        first = nn.Conv1d(config.features, width, 3, padding=1)
        self.encoder = Coder([first, nn.ReLU(), *down, nn.Conv1d(width, config.code_width, 3, padding=1)])
        back = nn.Conv1d(config.code_width, width, 3, padding=1)
        last = nn.Conv1d(width, config.features, 3, padding=1)
        self.decoder = Coder([back, nn.ReLU(), *up, nn.Conv1d(width, width, 3, padding=1), nn.ReLU(), last])
        self.quantizer = Codebook(config)

    def encode(self, features: Float[Tensor, "batch frame feature"]) -> Int[Tensor, "batch token"]:
        """Encodes normalised features; frames that do not fill a token are dropped.

        Args:
            features: Normalised features, (batch, frame, 263).

        Returns:
            Codes (batch, token).
        """
        latent = self.encoder(features.transpose(1, 2)).transpose(1, 2)
        return self.quantizer.nearest(latent.reshape(-1, latent.shape[-1])).reshape(latent.shape[:2])

    def decode(self, codes: Int[Tensor, "batch token"]) -> Float[Tensor, "batch frame feature"]:
        """Decodes codes.

        Args:
            codes: Motion codes, (batch, token).

        Returns:
            Normalised features (batch, frame, 263), four frames per token.
        """
        latent = self.quantizer.codebook[codes]
        return self.decoder(latent.transpose(1, 2)).transpose(1, 2)
