"""A cube as the fitter sees it: centred phase, and every chirp once.

Windows of loops that overlap (a recording cut into windows with a small hop) hold each chirp several times. Then the
whole stretch of chirps is one long working frame, whose window is the root of the sum of all squared windows, so that
an error there has the very energy it has in the cube. Without overlap a working frame is a frame of the cube.
"""

from dataclasses import dataclass

import numpy as np
import torch
from torch import Tensor

from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.records import RadarCube
from mmweaver.core.shapes import CubeValues
from mmweaver.dsp.cube import tdm_compensation
from mmweaver.dsp.point_response import Axes, PointResponse
from mmweaver.dsp.windows import hann

WHOLE = 1e-3  # of a loop: hops so close to a whole number of loops count as whole
CONSISTENT = 1e-4  # overlapping windows may disagree about their chirps by this share of the energy


@dataclass(frozen=True, kw_only=True)
class FitWindow:
    """Where the working frames of a cube's frames lie, and how they answer to a point."""

    config: RadarConfig
    num_frames: int
    hop: int  # loops from a frame to the next where frames overlap, else 0
    response: PointResponse
    axes: Axes
    turn: Tensor  # centred -> the working frame's phase

    @classmethod
    def of(cls, config: RadarConfig, num_frames: int, hop: int) -> "FitWindow":
        """Frames `hop` loops apart, or whole frames each on its own where hop is 0."""
        window = _long_window(config.num_loops, num_frames, hop) if hop else None
        response = PointResponse(config, window)
        axes = response.axes()
        return cls(
            config=config, num_frames=num_frames, hop=hop, response=response, axes=axes, turn=response.turn(axes)
        )

    @property
    def num_working_frames(self) -> int:
        return 1 if self.hop else self.num_frames

    @property
    def long_window(self) -> np.ndarray:
        """Window over the loops of a working frame."""
        return (
            _long_window(self.config.num_loops, self.num_frames, self.hop) if self.hop else hann(self.config.num_loops)
        )

    def working(self, values: CubeValues) -> Tensor:
        """A cube's values -> working frames in centred phase."""
        frames = _joined(values, self.config, self.hop) if self.hop else values
        return torch.from_numpy(np.ascontiguousarray(frames, np.complex64)) * self.turn.conj()

    def cube_values(self, working: Tensor) -> CubeValues:
        """The inverse: working frames -> the cube's values, complex64."""
        frames = (working * self.turn).numpy()
        return _cut(frames[0], self.config, self.num_frames, self.hop) if self.hop else frames


def overlap_hop(cube: RadarCube) -> int:
    """Loops from one frame to the next where the frames overlap and agree about the chirps they share, else 0."""
    config, time_s = cube.config, cube.grid.frame_time_s
    if len(time_s) < 2:
        return 0
    hops = np.diff(time_s) / config.loop_period_s
    hop = int(np.rint(hops[0]))
    if not 0 < hop < config.num_loops or np.abs(hops - hop).max() > WHOLE:
        return 0
    again = _cut(_joined(cube.values, config, hop)[0], config, len(time_s), hop)
    error = np.sum(np.abs(again - cube.values) ** 2)
    return hop if error <= CONSISTENT * np.sum(np.abs(cube.values) ** 2) else 0


def _long_window(num_loops: int, num_frames: int, hop: int) -> np.ndarray:
    square = np.zeros(num_loops + hop * (num_frames - 1))
    for frame in range(num_frames):
        square[frame * hop :][:num_loops] += hann(num_loops) ** 2
    return np.sqrt(square)


def _joined(values: np.ndarray, config: RadarConfig, hop: int) -> np.ndarray:
    """Least-squares chirps of overlapping frames, as one long frame (1, range, doppler, antenna)."""
    num_frames, _, num_loops, _ = values.shape
    window = hann(num_loops)
    still = values.astype(np.complex128) * tdm_compensation(config).conj()
    windowed = np.fft.ifft(still, axis=2) * window.sum() * _doppler_turn(num_loops).conj()[:, None]
    long = _long_window(num_loops, num_frames, hop)
    total = np.zeros((values.shape[1], len(long), values.shape[3]), complex)
    for frame in range(num_frames):
        total[:, frame * hop :][:, :num_loops] += window[:, None] * windowed[frame]
    weighted = total * _reciprocal(long)[:, None] * _doppler_turn(len(long))[:, None]
    return (np.fft.fft(weighted, axis=1) / long.sum() * _compensation(config, len(long)))[None]


def _cut(frame: np.ndarray, config: RadarConfig, num_frames: int, hop: int) -> np.ndarray:
    """One long frame (range, doppler, antenna) -> overlapping frames, complex64."""
    num_loops = config.num_loops
    window, long = hann(num_loops), _long_window(num_loops, num_frames, hop)
    still = frame * _compensation(config, len(long)).conj()
    weighted = np.fft.ifft(still, axis=1) * long.sum() * _doppler_turn(len(long)).conj()[:, None]
    chirps = weighted * _reciprocal(long)[:, None]
    share = (window / window.sum() * _doppler_turn(num_loops))[:, None]
    frames = np.stack([chirps[:, at * hop :][:, :num_loops] * share for at in range(num_frames)])
    return (np.fft.fft(frames, axis=2) * tdm_compensation(config)).astype(np.complex64)


def _reciprocal(window: np.ndarray) -> np.ndarray:
    return np.divide(1.0, window, out=np.zeros_like(window), where=window > 1e-6 * window.max())


def _doppler_turn(num_loops: int) -> np.ndarray:
    """Moves zero Doppler to bin num_loops // 2."""
    return np.exp(2j * np.pi * (np.arange(num_loops) * (num_loops // 2) % num_loops) / num_loops)


def _compensation(config: RadarConfig, num_loops: int) -> np.ndarray:
    """TDM compensation (doppler, antenna) of a frame of so many loops."""
    doppler_hz = (np.arange(num_loops) - num_loops // 2) / (num_loops * config.loop_period_s)
    return np.exp(-2j * np.pi * doppler_hz[:, None] * np.repeat(config.tx_delay_s, config.num_rx))
