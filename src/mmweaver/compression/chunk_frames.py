"""Working frames of a chunk: centred phase, and every chirp once where the frames overlap."""

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import torch
from jaxtyping import Complex

from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.records import RadarCube
from mmweaver.core.shapes import CubeValues
from mmweaver.fields.scatterers.fit_window import FitWindow, overlap_hop

LEAST_LOOPS = 3  # of a point response: below, a window has no Doppler spectrum to speak of

Working = Complex[np.ndarray, "_ range _ antenna"]


@dataclass(frozen=True, kw_only=True)
class ChunkFrames:
    """Frames `hop` loops apart, or separate frames where hop is 0.

    Separate frames work for any window; scatterers and overlapping frames require one with a `FitWindow`.
    """

    config: RadarConfig
    num_frames: int
    hop: int

    @classmethod
    def of(cls, config: RadarConfig, num_frames: int, hop: int) -> "ChunkFrames":
        """Raises ValueError for a hop that the window does not allow."""
        frames = cls(config=config, num_frames=num_frames, hop=hop)
        if hop and not (hop < config.num_loops and frames.can_have_points):
            raise ValueError("impossible hop")
        return frames

    @classmethod
    def of_cube(cls, cube: RadarCube) -> "ChunkFrames":
        """The frames of a cube."""
        frames = cls(config=cube.config, num_frames=len(cube.values), hop=0)
        hop = overlap_hop(cube) if frames.can_have_points else 0
        return cls(config=cube.config, num_frames=len(cube.values), hop=hop)

    @property
    def can_have_points(self) -> bool:
        """Whether the window of the frames has a point response: it is symmetric about its middle."""
        return self._window is not None

    @cached_property
    def _window(self) -> FitWindow | None:
        if self.config.num_loops < LEAST_LOOPS:
            return None
        try:
            return FitWindow.of(self.config, self.num_frames, self.hop)
        except ValueError:  # the window is not symmetric
            return None

    def fit_window(self) -> FitWindow:
        """The fit window of the frames. Raises ValueError where there is none."""
        if self._window is None:
            raise ValueError("the window of these frames has no point response")
        return self._window

    @property
    def working_shape(self) -> tuple[int, int, int, int]:
        """Shape (frame, range, doppler, antenna) of the working frames."""
        config = self.config
        loops = config.num_loops + self.hop * (self.num_frames - 1)
        return (1 if self.hop else self.num_frames, config.num_range_bins, loops, config.num_antennas)

    def working(self, values: CubeValues) -> Working:
        """Values of a cube -> working frames in centred phase."""
        if self.hop:
            return self.fit_window().working(values).numpy()
        return (values * self.phasor.conj()).astype(np.complex64)

    def cube_values(self, working: Working) -> CubeValues:
        """The inverse: working frames -> values of the cube, complex64."""
        if self.hop:
            return self.fit_window().cube_values(torch.from_numpy(working.astype(np.complex64)))
        return (working * self.phasor).astype(np.complex64)

    @cached_property
    def phasor(self) -> np.ndarray:
        """(range, doppler, antenna) from centred phase to that of the cube; as `PointResponse.phasor`."""
        config = self.config
        range_bin = config.first_range_bin + np.arange(config.num_range_bins)
        doppler_bin = np.arange(config.num_loops) - config.num_loops // 2
        delay = np.repeat(config.tx_delay_s, config.num_rx) / (config.num_loops * config.loop_period_s)
        turns = -0.5 * (range_bin[:, None] + doppler_bin)[..., None] - doppler_bin[None, :, None] * delay
        return np.exp(2j * math.pi * (turns - np.round(turns))).astype(np.complex64)
