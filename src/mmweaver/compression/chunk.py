"""A chunk of frames on the decoder side: static layer, scatterers, noise and residual in one stream.

All are quantised with one step: an error of one step in any value leaves about the same energy in the cube. Files of
older versions, and older files of version 5, may also contain a low-rank layer and an enhancement layer.

Read-only: the low-rank layer that files of versions 3 to 5 may contain. Encoders no longer write it.
"""

import functools
import math
import struct
import zlib
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import torch
from jaxtyping import Complex
from torch import Tensor

from mmweaver.compression.cell_coder import LevelCoder
from mmweaver.compression.entropy import BitStream, Decoder
from mmweaver.compression.noise_layer import NoiseLayer
from mmweaver.compression.quantised_cells import QuantisedCells, beams_of, code_cells
from mmweaver.compression.scatterer_coder import (
    PointCoder,
    PointSteps,
    code_static,
    dequantize,
    nearness,
    static_of,
    unpack_gains,
)
from mmweaver.compression.scatterers.fit_window import FitWindow, overlap_hop
from mmweaver.compression.scatterers.layers import Layers, no_points, rendered
from mmweaver.compression.transforms import ChunkTransform, TransformChoice
from mmweaver.core.errors import InputError
from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.records import RadarCube
from mmweaver.core.shapes import CubeValues
from mmweaver.signal.point_response import PointResponse

CORRELATED = True, False  # neighbouring rows of a factor predict each other's sign


def decode_low_rank(
    stream: BitStream, rank: int, shape: tuple[int, ...], step: float
) -> Complex[np.ndarray, "frame range doppler antenna"]:
    """Decodes a low-rank matrix (frame and range, Doppler and antenna) as values of a chunk.

    Columns of the left factor have the strength of their component and the step of the chunk; rows of the right one
    have unit norm, and that step divided by the strength of the decoded column.

    Args:
        stream: The decoder.
        rank: Number of components.
        shape: Shape (frame, range, doppler, antenna) of the chunk.
        step: Quantisation step.

    Returns:
        Values of that shape, complex64.

    Raises:
        ValueError: For an impossible rank.
    """
    frames, num_range, doppler, antennas = shape
    if rank > min(frames * num_range, doppler * antennas):
        raise ValueError("impossible rank")
    left, right = (_factor(stream, (rank, *axes)) for axes in ((frames * num_range, 1), (doppler, antennas)))
    strength = np.maximum(np.sqrt(np.sum(np.square(np.abs(left)), axis=1)), 1.0)
    return ((left * step).T @ (right / strength[:, None])).reshape(shape).astype(np.complex64)


def _factor(stream: BitStream, shape: tuple[int, int, int]) -> np.ndarray:
    """Levels of a factor, complex (rank, place)."""
    levels = np.zeros((2, 1, int(np.prod(shape))), np.int64)
    LevelCoder((1, *shape), CORRELATED).code(stream, levels, np.ones(shape, np.int64))
    real, imaginary = levels.reshape(2, shape[0], -1)
    return real + 1j * imaginary


# frames, hop, peak, step, centroids of 1 and of more, noise, which of COARSE_STEPS and FINER_STEPS, rank, flags
PREFIX = struct.Struct("<HHffBBBBBB")
HAS_STATIC, HAS_POINTS, HAS_CELLS, HAS_GAINS, HAS_RANK, IS_EXACT, HAS_NOISE, IS_NEW = 1, 2, 4, 8, 16, 32, 64, 128
COARSE_STEPS = (1, 2, 4, 8, 16, 32, 3)  # step of cells without signal in fine steps
FINER_STEPS = (1, 2, 4, 8)  # the step over that of the enhancement layer
FINER, IS_VERSION_5 = 8, 64  # in the byte of the steps: a factor and a flag
NO_OFFSET = (128, 128)  # centroids
PLAIN, DEFLATED = b"\0", b"\1"
MIN_LOOPS = 3  # of a point response; a shorter window has no useful Doppler spectrum
# limits against hostile headers: complex numbers in a chunk of several frames, and in one of a single frame
MAX_VALUES, MAX_CELLS = 2**21, 2**26

Working = Complex[np.ndarray, "_ range _ antenna"]


@dataclass(frozen=True, kw_only=True)
class ChunkFrames:
    """Frames that are `hop` loops apart, or separate frames where hop is 0.

    Separate frames work for any window; scatterers and overlapping frames require one with a `FitWindow`.
    """

    config: RadarConfig
    num_frames: int
    hop: int

    @classmethod
    def of(cls, config: RadarConfig, num_frames: int, hop: int) -> "ChunkFrames":
        """Frames of a chunk.

        Args:
            config: The radar.
            num_frames: Number of frames.
            hop: Loops from one frame to the next, 0 for separate frames.

        Raises:
            ValueError: For a hop that the window does not allow.
        """
        frames = cls(config=config, num_frames=num_frames, hop=hop)
        if hop and not (hop < config.num_loops and frames.can_have_points):
            raise ValueError("impossible hop")
        return frames

    @classmethod
    def from_cube(cls, cube: RadarCube) -> "ChunkFrames":
        """The frames of a cube."""
        frames = cls(config=cube.config, num_frames=len(cube.values), hop=0)
        hop = overlap_hop(cube) if frames.can_have_points else 0
        return cls(config=cube.config, num_frames=len(cube.values), hop=hop)

    @property
    def can_have_points(self) -> bool:
        """Whether the window of the frames has a point response, which requires symmetry about its middle."""
        return self._window is not None

    @cached_property
    def _window(self) -> FitWindow | None:
        if self.config.num_loops < MIN_LOOPS:
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
        """Working frames of a cube.

        Args:
            values: Cube (frame, range, doppler, antenna).

        Returns:
            Working frames (frame, range, doppler, antenna) in centred phase, complex64.
        """
        if self.hop:
            return self.fit_window().working(values).numpy()
        return (values * self.phasor.conj()).astype(np.complex64)

    def cube_values(self, working: Working) -> CubeValues:
        """The inverse of `working`: cube values (frame, range, doppler, antenna), complex64."""
        if self.hop:
            return self.fit_window().cube_values(torch.from_numpy(working.astype(np.complex64)))
        return (working * self.phasor).astype(np.complex64)

    @cached_property
    def phasor(self) -> np.ndarray:
        """Phase of the cube relative to centred phase (range, doppler, antenna), as `PointResponse.phasor`."""
        config = self.config
        range_bin = config.first_range_bin + np.arange(config.num_range_bins)
        doppler_bin = np.arange(config.num_loops) - config.num_loops // 2
        delay = np.repeat(config.tx_delay_s, config.num_rx) / (config.num_loops * config.loop_period_s)
        turns = -0.5 * (range_bin[:, None] + doppler_bin)[..., None] - doppler_bin[None, :, None] * delay
        return np.exp(2j * math.pi * (turns - np.round(turns))).astype(np.complex64)


@dataclass(frozen=True, kw_only=True)
class DecodedChunk:
    """Contents of a chunk. `residual` are working frames (frame, range, doppler, antenna) in centred phase.

    `layers` are None where a chunk has neither scatterers nor a static layer.
    """

    frames: ChunkFrames
    layers: Layers | None
    residual: np.ndarray | None
    peak: float
    noise_power: float
    num_residual_values: int = 0  # non-zero residual values
    rank: int = 0
    has_noise: bool = False
    exact: CubeValues | None = None
    step: float = 0.0  # relative to the peak
    transform: TransformChoice | None = None

    def mode_name(self) -> str:
        """Description of how the chunk is coded, for display."""
        if self.exact is not None:
            return "exact"
        parts = ["scatterers"] * (self.layers is not None) + ["low rank"] * bool(self.rank)
        parts += ["noise"] * self.has_noise
        parts += [self.transform.name()] if self.transform else []
        return " + ".join(parts) or "nothing"

    def cube_values(self) -> CubeValues:
        """The frames of the cube (frame, range, doppler, antenna), complex64.

        Raises:
            InputError: If values are not finite.
        """
        if self.exact is not None:
            return finite(self.exact)
        working = np.zeros(self.frames.working_shape, np.complex64)
        if self.layers is not None:
            with torch.inference_mode():
                window = self.frames.fit_window()
                working = working + rendered(self.layers, window.response, window.axes).numpy()
        if self.residual is not None:
            working = working + self.residual
        return finite(self.frames.cube_values(working * np.float32(self.peak)))


def one_line_errors(decode: Callable[..., DecodedChunk]) -> Callable[..., DecodedChunk]:
    """Decorator that reports any error of a malformed chunk as InputError."""

    @functools.wraps(decode)
    def decoded(*arguments, **options) -> DecodedChunk:
        try:
            return decode(*arguments, **options)
        except (ValueError, IndexError, struct.error, AssertionError, OverflowError, np.linalg.LinAlgError) as error:
            if isinstance(error, InputError):
                raise
            raise InputError(f"a chunk of the .mmw file is malformed ({error}); compress the recording again") from None

    return decoded


@one_line_errors
def decode_chunk(data: bytes, config: RadarConfig, *, with_residual: bool = True) -> DecodedChunk:
    """Decodes a chunk of version 3, 4 or 5.

    Args:
        data: The chunk.
        config: Radar of the file.
        with_residual: Whether the residual is decoded; otherwise static layer and scatterers alone.

    Raises:
        InputError: For a malformed chunk.
    """
    num_frames, hop, peak, step, one, more, noise_level, steps, rank, flags = PREFIX.unpack_from(data)
    coarser, finer, version = unpack_steps(steps, is_version_3=not flags & IS_NEW)
    if not (num_frames and step > 0 and math.isfinite(step) and math.isfinite(peak)):
        raise ValueError("impossible prefix")
    if bool(flags & HAS_RANK) != bool(rank):
        raise ValueError("impossible flags")
    cells = config.num_range_bins * config.num_loops * config.num_antennas
    if (num_frames > 1 and num_frames * cells > MAX_VALUES) or cells > MAX_CELLS:
        raise ValueError("more values than any chunk has")
    frames, noise_power = ChunkFrames.of(config, num_frames, hop), 10 ** (-noise_level / 20)
    if flags & IS_EXACT:
        shape = (num_frames, config.num_range_bins, config.num_loops, config.num_antennas)
        values = unpack_exact(data[PREFIX.size :], shape)
        return DecodedChunk(frames=frames, layers=None, residual=None, peak=peak, noise_power=noise_power, exact=values)
    at, beams, shape = PREFIX.size, beams_of(config), frames.working_shape
    gains: Tensor | None = None
    noise: NoiseLayer | None = None
    transform: ChunkTransform | None = None
    if flags & HAS_GAINS:
        gains = unpack_gains(data[at : at + 2 * config.num_antennas])
        at += 2 * config.num_antennas
    if flags & HAS_NOISE:
        noise = NoiseLayer.unpack(data[at:], shape, beams, version)
        at += len(noise.packed)
    if flags & HAS_CELLS:
        transform = ChunkTransform.unpack(data[at:], beams, shape[2])
        at += len(transform.packed)
    stream = Decoder(data[at:], version=version)
    layers, near = decode_layers(stream, frames, step, flags, gains, noise_power)
    parts: list[np.ndarray] = []
    num_values = 0
    if rank:
        parts.append(decode_low_rank(stream, rank, shape, step))
    if noise is not None and with_residual:
        parts.append(noise.values)
    if transform is not None and with_residual:
        classes = np.zeros(shape[:3], np.int64)
        levels = code_cells(stream, None, classes, near, transform.correlated, coarser, shape[3])
        num_values = int(np.count_nonzero(levels))
        cells = QuantisedCells(levels=levels, classes=classes, centroids=(one, more))
        parts.append(transform.inverse(cells.values(step, coarser)))
    if finer > 1 and with_residual:
        parts.append(_decode_enhancement(stream, shape, beams, step / finer))
    return DecodedChunk(
        frames=frames,
        layers=layers,
        residual=finite(functools.reduce(np.add, parts)) if parts else None,
        peak=peak,
        noise_power=noise_power,
        num_residual_values=num_values,
        rank=rank,
        has_noise=noise is not None,
        step=step,
        transform=None if transform is None else transform.choice,
    )


def point_coder_of(frames: ChunkFrames, steps: PointSteps, response: PointResponse) -> PointCoder:
    """The coder of the scatterers of a chunk."""
    return PointCoder(frames.working_shape[:3], steps, response.num_directions)


def decode_layers(
    stream: BitStream,
    frames: ChunkFrames,
    step: float,
    flags: int,
    gains: Tensor | None,
    noise_power: float,
    *,
    code_static: Callable[[BitStream, np.ndarray], None] = code_static,
    point_coder: Callable[[ChunkFrames, PointSteps, PointResponse], PointCoder] = point_coder_of,
) -> tuple[Layers | None, np.ndarray]:
    """Decodes static layer and scatterers.

    Args:
        stream: The decoder.
        frames: Frames of the chunk.
        step: Quantisation step, relative to the peak.
        flags: Flags of the layers that are present.
        gains: Antenna gains (antenna,), None for 1.
        noise_power: Noise power per cell.
        code_static: Decodes the levels of a static layer.
        point_coder: Creates the coder of the scatterers.

    Returns:
        The layers, None where there are none, and the strength of the nearest scatterer to each cell.
    """
    near = np.zeros(frames.working_shape[:3], np.int64)
    if not flags & (HAS_STATIC | HAS_POINTS):
        return None, near
    window, config = frames.fit_window(), frames.config
    response, axes = window.response, window.axes
    static = np.zeros((2, config.num_antennas, 1, config.num_range_bins, 1), np.int64)
    if flags & HAS_STATIC:
        code_static(stream, static)
    points = no_points(window.num_working_frames)
    if flags & HAS_POINTS:
        steps = PointSteps.of(step, response, axes)
        coded = point_coder(frames, steps, response).code(stream, None)
        points = dequantize(coded, window.num_working_frames, steps, axes, response.num_directions)
        near = nearness(coded, near.shape)
    layers = Layers(
        points=points,
        static=static_of(static, window, beams_of(config), step),
        noise_power=noise_power,
        calibration=torch.ones(config.num_antennas, dtype=torch.complex64) if gains is None else gains,
    )
    return layers, near


def finite(values: np.ndarray) -> np.ndarray:
    """Checks the values of a chunk.

    Raises:
        InputError: If step or peak were so large that some values are not finite.
    """
    if not np.isfinite(values).all():
        raise InputError("a chunk of the .mmw file holds values that are not finite; compress the recording again")
    return values


def pack_steps(coarser: int) -> int:
    """The byte for the step of cells without signal and the version."""
    return IS_VERSION_5 + COARSE_STEPS.index(coarser)


def unpack_steps(byte: int, *, is_version_3: bool) -> tuple[int, int, int]:
    """The inverse of `pack_steps`.

    Args:
        byte: The byte of steps.
        is_version_3: Whether the chunk is of version 3.

    Returns:
        Coarse step, finer step and version.

    Raises:
        ValueError: For values that no encoder writes.
    """
    version, finer = 3 if is_version_3 else 4, 1
    if byte & IS_VERSION_5 and not is_version_3:
        version, finer, byte = 5, FINER_STEPS[byte // FINER % 4], byte & ~(IS_VERSION_5 + 3 * FINER)
    if byte >= len(COARSE_STEPS):
        raise ValueError("impossible prefix")
    return COARSE_STEPS[byte], finer, version


def _decode_enhancement(
    stream: BitStream, shape: tuple[int, ...], beams: Complex[np.ndarray, "beam antenna"], step: float
) -> Complex[np.ndarray, "frame range doppler antenna"]:
    """Read-only: residual of moving cells, coded again with a finer step; complex64."""
    classes = np.zeros(shape[:3], np.int64)
    levels = code_cells(stream, None, classes, num_beams=shape[3])
    cells = QuantisedCells(levels=levels, classes=classes, centroids=NO_OFFSET)
    values = np.tensordot(beams.conj(), cells.values(step, 1), axes=(0, 0))
    return np.moveaxis(values, 0, 3).astype(np.complex64)


def pack_exact(values: CubeValues) -> bytes:
    """Lossless complex64 values: float32 words grouped by byte significance, deflated where that is shorter."""
    words = np.ascontiguousarray(values, np.complex64).view("<f4").ravel()
    planes = words.view(np.uint8).reshape(-1, 4).T.tobytes()
    smaller = zlib.compress(planes, 9)
    return DEFLATED + smaller if len(smaller) < len(planes) else PLAIN + planes


def unpack_exact(data: bytes, shape: tuple[int, ...]) -> CubeValues:
    """The inverse of `pack_exact`. Raises ValueError where the bytes are not those of this shape."""
    size = 8 * int(np.prod(shape))
    planes = data[1:]
    if data[:1] == DEFLATED:
        try:
            planes = zlib.decompressobj().decompress(planes, size + 1)
        except zlib.error as error:
            raise ValueError(str(error)) from None
    if len(planes) != size:
        raise ValueError("wrong size")
    words = np.frombuffer(planes, np.uint8).reshape(4, -1).T.copy().view("<f4")
    return words.ravel().view(np.complex64).reshape(shape).astype(np.complex64)
