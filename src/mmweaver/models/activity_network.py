"""Recognition of the activity in a cube: a small convolutional network on its log maps.

    range-Doppler  (frame, 1, 64, 32) --convolutions--> (frame, 64, 8, 8) --over range--> (frame, 512)--+
    range-azimuth  (frame, 2, 64, 32) --convolutions--> (frame, 64, 8, 8) --over both---> (frame, 64)---+
                                                                                                        |
        activity (12) <--linear-- mean, largest <--convolutions over frames (20, 128) <-----------------+

The convolutional maps also serve as features of the perceptual loss of the paper's recipe ("custom convolution-based
mmWave feature extractor").
"""

import math
from pathlib import Path

import torch
from torch import Tensor, nn

from mmweaver.core.errors import InputError
from mmweaver.core.radar_config import RadarConfig
from mmweaver.models.frame_motion import NUM_ANGLE_MAPS, LogMaps
from mmweaver.models.weights import load_into, read_card

ACTIVITY_NAMES = (
    "walking",
    "jogging",
    "waving",
    "clapping",
    "jumping jacks",
    "left-hand raise",
    "right-hand raise",
    "jumping",
    "drinking seated",
    "sitting down",
    "squatting",
    "punching",
)
WIDTHS = (16, 32, 64)
FRAME_WIDTH = 128
DROPPED = 0.4


class ActivityNetwork(nn.Module):
    """From log maps of a sequence to the scores of its activities."""

    def __init__(self, config: RadarConfig, num_labels: int = len(ACTIVITY_NAMES)):
        """Builds the network.

        Args:
            config: The radar.
            num_labels: Number of activities.
        """
        super().__init__()
        self.config, self.maps = config, LogMaps(config)
        self.doppler = MapFeatures(1)
        self.angle = MapFeatures(NUM_ANGLE_MAPS)
        velocities = math.ceil(config.num_loops / 4)  # two of the three convolutions halve them
        per_frame = WIDTHS[-1] * 2 * velocities + WIDTHS[-1] * 2
        self.head = TimeHead(per_frame, num_labels)

    def forward(self, doppler: Tensor, angle: Tensor) -> Tensor:
        """Scores of the activities.

        Args:
            doppler: Range-Doppler maps (sequence, frame, 1, range, doppler) of `LogMaps`.
            angle: Range-azimuth maps (sequence, frame, 2, range, azimuth) of `LogMaps`.

        Returns:
            Logits (sequence, label).
        """
        return self.head(self.frames(doppler, angle))

    def frames(self, doppler: Tensor, angle: Tensor) -> Tensor:
        """Features of each frame.

        Args:
            doppler: Range-Doppler maps (sequence, frame, 1, range, doppler).
            angle: Range-azimuth maps (sequence, frame, 2, range, azimuth).

        Returns:
            Features (sequence, frame, feature).
        """
        shape = doppler.shape[:2]
        speeds = self.doppler(doppler.flatten(0, 1))[-1]
        places = self.angle(angle.flatten(0, 1))[-1]
        seen = torch.cat([_pooled(speeds, (2,)), _pooled(places, (2, 3))], dim=1)
        return seen.unflatten(0, shape)


class MapFeatures(nn.Module):
    """Three convolutions over maps (map, channel, range, other), with the coordinate along the last axis as input."""

    def __init__(self, channels: int):
        super().__init__()
        strides, before = ((2, 1), (2, 2), (2, 2)), channels + 1
        blocks = []
        for width, stride in zip(WIDTHS, strides, strict=True):
            convolution = nn.Conv2d(before, width, 3, stride=stride, padding=1, bias=False)
            blocks.append(nn.Sequential(convolution, nn.GroupNorm(4, width), nn.SiLU()))
            before = width
        self.blocks = nn.ModuleList(blocks)

    def forward(self, maps: Tensor) -> list[Tensor]:
        """Feature maps after each convolution."""
        along = torch.linspace(-1, 1, maps.shape[-1], device=maps.device).expand(len(maps), 1, maps.shape[-2], -1)
        features, x = [], torch.cat([maps, along], dim=1)
        for block in self.blocks:
            x = block(x)
            features.append(x)
        return features


class TimeHead(nn.Module):
    """Convolutions over frames (sequence, frame, feature), their mean and maximum, and scores (sequence, label)."""

    def __init__(self, features: int, num_labels: int = len(ACTIVITY_NAMES)):
        super().__init__()
        self.first = nn.Linear(features, FRAME_WIDTH)
        self.over_time = nn.Sequential(
            nn.SiLU(),
            nn.Dropout(DROPPED),
            nn.Conv1d(FRAME_WIDTH, FRAME_WIDTH, 3, padding=1),
            nn.SiLU(),
            nn.Conv1d(FRAME_WIDTH, FRAME_WIDTH, 3, padding=2, dilation=2),
            nn.SiLU(),
        )
        self.last = nn.Sequential(nn.Dropout(DROPPED), nn.Linear(2 * FRAME_WIDTH, num_labels))

    def forward(self, frames: Tensor) -> Tensor:
        """Logits (sequence, label) of features (sequence, frame, feature)."""
        return self.last(self.summary(frames))

    def summary(self, frames: Tensor) -> Tensor:
        """Features of the whole sequence, (sequence, 256), from which labels are scored."""
        x = self.over_time(self.first(frames).transpose(1, 2))
        return torch.cat([x.mean(dim=2), x.amax(dim=2)], dim=1)


def _pooled(maps: Tensor, axes: tuple[int, ...]) -> Tensor:
    """Mean and maximum over axes, flattened."""
    return torch.cat([maps.mean(dim=axes).flatten(1), maps.amax(dim=axes).flatten(1)], dim=1)


def load_activity(file: Path, config: RadarConfig) -> ActivityNetwork:
    """Loads weights of recipe `activity`.

    Args:
        file: The weight file.
        config: The radar.

    Raises:
        InputError: For any other file, or one for a radar with maps of other shape.
    """
    network = ActivityNetwork(config, len(label_names_of(file)))
    load_into(network, file, recipe="activity")
    return network


def label_names_of(file: Path) -> tuple[str, ...]:
    """Names of the labels of weights of recipe `activity`, by number.

    Args:
        file: The weight file.

    Raises:
        InputError: If the file cannot be read.
    """
    names = read_card(file).settings.get("label_names", ACTIVITY_NAMES)
    if not isinstance(names, list | tuple) or not names or not all(isinstance(name, str) for name in names):
        raise InputError(f"{file} has a header that cannot be read; fetch or write it again")
    return tuple(names)
