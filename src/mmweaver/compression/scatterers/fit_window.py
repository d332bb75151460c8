"""Working frames of a fit: centred phase, every chirp once.

Overlapping frames (a recording cut into windows with a small hop) contain each chirp several times. All chirps then
form one long working frame whose window is the root of the sum of all squared windows, so that an error in it has the
same energy as in the cube. Without overlap, a working frame is a frame of the cube.
"""

from dataclasses import dataclass

import numpy as np
import torch
from torch import Tensor

from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.records import RadarCube
from mmweaver.core.shapes import CubeValues
from mmweaver.signal.cube import tdm_compensation
from mmweaver.signal.point_response import Axes, PointResponse
from mmweaver.signal.windows import doppler_window

WHOLE = 1e-3  # tolerance in loops for hops of an integer number of loops
CONSISTENT = 1e-4  # share of the energy by which overlapping frames may disagree about shared chirps


@dataclass(frozen=True, kw_only=True)
class FitWindow:
    """Working frames of a cube: their number, overlap and point response."""

    config: RadarConfig
    num_frames: int
    hop: int  # loops from one frame to the next where frames overlap, otherwise 0
    response: PointResponse
    axes: Axes
    phasor: Tensor  # (range, doppler, antenna) phase of the working frame relative to centred phase

    @classmethod
    def of(cls, config: RadarConfig, num_frames: int, hop: int) -> "FitWindow":
        """The working frames of a radar.

        Args:
            config: The radar.
            num_frames: Number of frames of the cube.
            hop: Loops from one frame to the next; 0 for separate frames.
        """
        window = long_window(config.num_loops, num_frames, hop) if hop else None
        response = PointResponse(config, window)
        axes = response.axes()
        return cls(
            config=config, num_frames=num_frames, hop=hop, response=response, axes=axes, phasor=response.phasor(axes)
        )

    @property
    def num_working_frames(self) -> int:
        return 1 if self.hop else self.num_frames

    def working(self, values: CubeValues) -> Tensor:
        """Working frames (frame, range, doppler, antenna) in centred phase, from the values of a cube."""
        frames = _joined(values, self.config, self.hop) if self.hop else values
        return torch.from_numpy(np.ascontiguousarray(frames, np.complex64)) * self.phasor.conj()

    def cube_values(self, working: Tensor) -> CubeValues:
        """The inverse of `working`: values of the cube (frame, range, doppler, antenna), complex64."""
        frames = (working * self.phasor).numpy()
        return _cut(frames[0], self.config, self.num_frames, self.hop) if self.hop else frames


def overlap_hop(cube: RadarCube) -> int:
    """Loops from one frame to the next if frames overlap and agree about their shared chirps, otherwise 0."""
    config, time_s = cube.config, cube.grid.frame_time_s
    if len(time_s) < 2 or config.is_coded:
        return 0
    hops = np.diff(time_s) / config.loop_period_s
    hop = int(np.rint(hops[0]))
    if not 0 < hop < config.num_loops or np.abs(hops - hop).max() > WHOLE:
        return 0
    rebuilt = _cut(_joined(cube.values, config, hop)[0], config, len(time_s), hop)
    error, signal = (np.sum(np.square(np.abs(one), dtype=np.float64)) for one in (rebuilt - cube.values, cube.values))
    return hop if error <= CONSISTENT * signal else 0


def long_window(num_loops: int, num_frames: int, hop: int) -> np.ndarray:
    """Window (loop,) of the working frame of overlapping frames.

    Args:
        num_loops: Loops per frame.
        num_frames: Number of frames.
        hop: Loops from one frame to the next.
    """
    square = np.zeros(num_loops + hop * (num_frames - 1))
    for frame in range(num_frames):
        square[frame * hop :][:num_loops] += doppler_window(num_loops) ** 2
    return np.sqrt(square)


def _joined(values: np.ndarray, config: RadarConfig, hop: int) -> np.ndarray:
    """Least-squares chirps of overlapping frames, as one long frame (1, range, doppler, antenna)."""
    num_frames, _, num_loops, _ = values.shape
    window = doppler_window(num_loops)
    uncompensated = values.astype(np.complex128) * tdm_compensation(config).conj()
    windowed = np.fft.ifft(uncompensated, axis=2) * window.sum() * _doppler_phasor(num_loops).conj()[:, None]
    long = long_window(num_loops, num_frames, hop)
    total = np.zeros((values.shape[1], len(long), values.shape[3]), complex)
    for frame in range(num_frames):
        total[:, frame * hop :][:, :num_loops] += window[:, None] * windowed[frame]
    weighted = total * _reciprocal(long)[:, None] * _doppler_phasor(len(long))[:, None]
    return (np.fft.fft(weighted, axis=1) / long.sum() * _compensation(config, len(long)))[None]


def _cut(frame: np.ndarray, config: RadarConfig, num_frames: int, hop: int) -> np.ndarray:
    """Overlapping frames, complex64, of one long frame (range, doppler, antenna)."""
    num_loops = config.num_loops
    window, long = doppler_window(num_loops), long_window(num_loops, num_frames, hop)
    uncompensated = frame * _compensation(config, len(long)).conj()
    weighted = np.fft.ifft(uncompensated, axis=1) * long.sum() * _doppler_phasor(len(long)).conj()[:, None]
    chirps = weighted * _reciprocal(long)[:, None]
    share = (window / window.sum() * _doppler_phasor(num_loops))[:, None]
    frames = np.stack([chirps[:, at * hop :][:, :num_loops] * share for at in range(num_frames)])
    return (np.fft.fft(frames, axis=2) * tdm_compensation(config)).astype(np.complex64)


def _reciprocal(window: np.ndarray) -> np.ndarray:
    return np.divide(1.0, window, out=np.zeros_like(window), where=window > 1e-6 * window.max())


def _doppler_phasor(num_loops: int) -> np.ndarray:
    """Phasor (loop,) that moves zero Doppler to bin num_loops // 2."""
    return np.exp(2j * np.pi * (np.arange(num_loops) * (num_loops // 2) % num_loops) / num_loops)


def _compensation(config: RadarConfig, num_loops: int) -> np.ndarray:
    """TDM compensation (doppler, antenna) of a frame of `num_loops` loops."""
    doppler_hz = (np.arange(num_loops) - num_loops // 2) / (num_loops * config.loop_period_s)
    return np.exp(-2j * np.pi * doppler_hz[:, None] * config.antenna_delay_s)
