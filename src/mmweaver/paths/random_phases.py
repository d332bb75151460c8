"""Mean echoes -> one signal: the phases that nobody can know are drawn, the rest follows from geometry.

A moving echo stands for several spots of skin that ride on one part of the body; their sum glitters as the part turns,
as real skin does. Spots belong to the person, resting phases to the room, so that the same seed, person and room give
the same signal, and a person's frames belong together. Reference: decisions 4 and 91.
"""

import math
from dataclasses import dataclass, replace
from functools import lru_cache

import torch
from torch import Tensor

from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.records import CubeGrid
from mmweaver.core.seeding import stream
from mmweaver.core.tensor_record import TensorRecord
from mmweaver.dsp.point_response import PointResponse, Points
from mmweaver.fields.scatterers.fit_window import FitWindow
from mmweaver.fields.scatterers.layers import Layers
from mmweaver.fields.scatterers.scatterer_field import ScattererField
from mmweaver.paths.mean_paths import Echoes
from mmweaver.paths.radar_equation import carrier, points_of

SPOTS = 6  # of skin, for each echo
SPOT_SPREAD_M = 0.04
HEARD, MISSED = 1e-4, 4e-3  # of the strongest resting echo's amplitude: in the layer; in a shadow


@dataclass(frozen=True, kw_only=True)
class SampledStaticClutter(TensorRecord):
    """Resting echoes with their phases: what the room returns, and what of it somebody hides."""

    heard: Tensor  # (row,) which echoes have rows, the strongest first
    num_strong: int  # rows that a shadow is noticed of
    at_range: Tensor  # (row, range)
    echo: Tensor  # (row, antenna) complex
    recorded: Tensor | None = None  # (range, antenna): where the empty room was recorded, its layer

    def layer(self) -> Tensor:
        """(range, antenna), complex."""
        return self.at_range.T @ self.echo if self.recorded is None else self.recorded

    @property
    def strong(self) -> Tensor:
        """Those echoes that a shadow is noticed of."""
        return self.heard[: self.num_strong]

    def hidden(self, is_hidden: Tensor) -> Tensor:
        """What the hidden ones of the strong echoes (frame, echo) would have added to the layer."""
        at_range, echo = self.at_range[: self.num_strong], self.echo[: self.num_strong]
        return torch.stack([at_range[row].T @ echo[row] for row in is_hidden])


def sample_static(resting: Echoes, response: PointResponse, room_seed: int) -> SampledStaticClutter:
    """Draws the phases of resting echoes (echo,)."""
    rng = stream(room_seed, "weaver", "room")
    count = resting.range_m.shape[-1]
    points = points_of(resting, response)
    turns = torch.from_numpy(2 * math.pi * rng.random(count)).to(torch.float32)
    points = replace(points, amplitude=torch.polar(points.amplitude, turns))
    size = points.amplitude.abs() / points.amplitude.abs().max()
    heard = size.argsort(descending=True)[: int((size > HEARD).sum())]
    points = points[heard]
    at_range, _, _, _, steer = response.factors(points, response.axes())
    return SampledStaticClutter(
        heard=heard, num_strong=int((size > MISSED).sum()), at_range=at_range.to(steer.dtype),
        echo=points.amplitude[:, None] * steer,
    )  # fmt: skip


def sample_moving(moving: Echoes, aspect: Tensor, response: PointResponse, subject: int) -> Points:
    """Moving echoes (frame, echo) -> points with phases. `aspect` (frame, 3): the line of sight seen by the body."""
    rng = stream(subject, "weaver", "skin")
    count = moving.range_m.shape[-1]
    offset = torch.from_numpy(rng.standard_normal((count, SPOTS, 3)) * SPOT_SPREAD_M).to(torch.float32)
    spot = torch.from_numpy(rng.standard_normal((count, SPOTS, 2)) / math.sqrt(2 * SPOTS)).to(torch.float32)
    points = points_of(moving, response)
    along = torch.einsum("fc,esc->fes", aspect, offset)
    glitter = (carrier(along, response.config) * torch.complex(spot[..., 0], spot[..., 1])).sum(dim=-1)
    return replace(points, amplitude=points.amplitude * glitter * carrier(moving.range_m, response.config))


def field_of(
    static: Tensor, points: Points, config: RadarConfig, num_frames: int, noise_power: float
) -> ScattererField:
    """The field of drawn layers; its values are in sqrt(mW)."""
    layers = Layers(
        points=points, static=static, calibration=torch.ones(config.num_antennas, dtype=torch.complex64),
        noise_power=noise_power,
    )  # fmt: skip
    return ScattererField(layers, *_cells(config, num_frames), 1.0, 1.0)


@lru_cache(maxsize=8)
def _cells(config: RadarConfig, num_frames: int) -> tuple[FitWindow, CubeGrid]:
    return FitWindow.of(config, num_frames, 0), CubeGrid.of(config, num_frames)
