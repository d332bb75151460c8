"""Quantisation and entropy coding of a chunk's layers: antenna gains, static layer and scatterers.

Stronger scatterers have finer parameters: an error of one step in any parameter leaves about the same energy in the
cube as an error of one step of a residual cell, so one step serves all. A scatterer of amplitude k steps has 2 pi k
phases and about k positions per bin.
"""

import math
from dataclasses import dataclass

import numpy as np
import torch
from jaxtyping import Float, Int

from mmweaver.compression.cell_coder import ClassMapCoder, LevelCoder
from mmweaver.compression.entropy import MAX_UNIFORM, BitModel, BitStream, NumberModel
from mmweaver.compression.scatterers.fit_window import FitWindow
from mmweaver.core.tensor_files import TensorRecord
from mmweaver.signal.point_response import Axes, PointResponse, Points

Integers = Int[np.ndarray, "_"]
Counts = Int[np.ndarray, "frame range doppler"]

COARSE = 16  # cells of a direction cosine with adaptive probabilities
OCTAVES = 24
NUM_NEAR = 6
SIXTEENTHS = 16
STATIC_ROUNDING = 0.4
GAIN_STEPS = 64.0
SEVERAL, COUNT_PRIOR, MAX_POINTS = 2, (0.96, 0.03, 0.01), 2**20


@dataclass(frozen=True, kw_only=True)
class PointSteps:
    """Quantisation steps: the amplitude of one step, and the positions per bin of a scatterer of one step.

    The last three are integers in sixteenths, so that every machine computes the same values.
    """

    amplitude: float
    range_sixteenths: int
    doppler_sixteenths: int
    direction_sixteenths: tuple[int, int]

    @classmethod
    def of(cls, step: float, response: PointResponse, axes: Axes) -> "PointSteps":
        """Steps that leave as much error as a step of `step` in every cell of the cube.

        Args:
            step: Quantisation step of cells.
            response: Point response of the radar.
            axes: Cells of the working frames.
        """
        energy = len(axes.place)
        sharpness = []
        for kernel in (response.range_kernel, response.doppler_kernel):
            value, slope = kernel(torch.arange(-8.0, 8.5, 0.5, dtype=torch.float64))
            energy *= float(value.square().sum()) / 2
            sharpness.append(math.sqrt(float(slope.square().sum() / value.square().sum())))
        spread = 2 * math.pi * axes.place.double().std(dim=0, correction=0)
        return cls(
            amplitude=step / math.sqrt(energy),
            range_sixteenths=round(SIXTEENTHS * sharpness[0]),
            doppler_sixteenths=round(SIXTEENTHS * sharpness[1]),
            direction_sixteenths=(round(SIXTEENTHS * float(spread[0])), round(SIXTEENTHS * float(spread[1]))),
        )


@dataclass(frozen=True, kw_only=True)
class CodedPoints(TensorRecord):
    """Quantised scatterers, one row each, sorted by frame, range cell and Doppler cell."""

    frame: Integers
    range_cell: Integers
    doppler_cell: Integers
    size: Integers  # amplitude in steps, at least 1
    phase: Integers
    range_part: Integers  # position within the cell
    doppler_part: Integers
    direction: Int[np.ndarray, "_ 2"]

    def __len__(self) -> int:
        return len(self.frame)


def quantize(points: Points, steps: PointSteps, axes: Axes, num_directions: int, least_size: int) -> CodedPoints:
    """Quantises scatterers.

    Args:
        points: Scatterers (frame, point).
        steps: Quantisation steps.
        axes: Cells of the working frames.
        num_directions: Number of direction cosines that the array resolves.
        least_size: Amplitude in steps below which scatterers are dropped.
    """
    amplitude = points.amplitude.numpy()
    size = np.rint(np.abs(amplitude) / steps.amplitude).astype(np.int64)
    frame, slot = np.nonzero(size >= max(1, least_size))
    size, value = size[frame, slot], amplitude[frame, slot]
    cells = []
    for bins, first, num, sharpness in (
        (points.range_bin, axes.range_bin, len(axes.range_bin), steps.range_sixteenths),
        (points.doppler_bin, axes.doppler_bin, len(axes.doppler_bin), steps.doppler_sixteenths),
    ):
        place = bins.numpy()[frame, slot].astype(np.float64) - float(first[0]) + 0.5
        cell = np.clip(np.floor(place).astype(np.int64), 0, num - 1)
        parts = _parts(size, sharpness)
        cells.append((cell, np.clip(np.floor((place - cell) * parts).astype(np.int64), 0, _largest(parts))))
    phases = _phases(size)
    phase = np.rint(np.angle(value) / (2 * np.pi) * phases).astype(np.int64) % phases
    phase = np.minimum(phase, _largest(phases))
    direction = np.zeros((len(size), 2), np.int64)
    for side in range(num_directions):
        parts = _direction_parts(size, steps.direction_sixteenths[side])
        cosine = points.direction.numpy()[frame, slot, side].astype(np.float64)
        direction[:, side] = np.clip(np.floor((cosine + 1) / 2 * parts).astype(np.int64), 0, _largest(parts))
    (range_cell, range_part), (doppler_cell, doppler_part) = cells
    coded = CodedPoints(
        frame=frame,
        range_cell=range_cell,
        doppler_cell=doppler_cell,
        size=size,
        phase=phase,
        range_part=range_part,
        doppler_part=doppler_part,
        direction=direction,
    )
    return coded[np.lexsort((doppler_cell, range_cell, frame))]


def dequantize(coded: CodedPoints, num_frames: int, steps: PointSteps, axes: Axes, num_directions: int) -> Points:
    """Scatterers from their quantised form.

    Args:
        coded: Quantised scatterers.
        num_frames: Number of frames of the result.
        steps: Quantisation steps.
        axes: Cells of the working frames.
        num_directions: Number of direction cosines that the array resolves.

    Returns:
        Points (frame, point), padded with amplitude zero.
    """
    counts = np.bincount(coded.frame, minlength=num_frames)
    slot = np.arange(len(coded)) - np.repeat(np.cumsum(counts) - counts, counts)
    shape = (num_frames, int(counts.max(initial=0)))

    def placed(values: np.ndarray, start: float = 0.0) -> torch.Tensor:
        out = np.full(shape, start, values.dtype)
        out[coded.frame, slot] = values
        return torch.from_numpy(out)

    def bins(cell: Integers, part: Integers, first: float, sharpness: int) -> Float[np.ndarray, "_"]:
        within = (part + 0.5) / _parts(coded.size, sharpness)
        return (first + cell - 0.5 + within).astype(np.float32)

    angle = 2 * np.pi * coded.phase / _phases(coded.size)
    direction = np.zeros((*shape, 2), np.float32)
    for side in range(num_directions):
        parts = _direction_parts(coded.size, steps.direction_sixteenths[side])
        direction[coded.frame, slot, side] = (coded.direction[:, side] + 0.5) / parts * 2 - 1
    first_range, first_doppler = float(axes.range_bin[0]), float(axes.doppler_bin[0])
    return Points(
        range_bin=placed(bins(coded.range_cell, coded.range_part, first_range, steps.range_sixteenths), first_range),
        doppler_bin=placed(bins(coded.doppler_cell, coded.doppler_part, first_doppler, steps.doppler_sixteenths)),
        direction=torch.from_numpy(direction),
        amplitude=placed((coded.size * steps.amplitude * np.exp(1j * angle)).astype(np.complex64)),
    )


def nearness(coded: CodedPoints, shape: tuple[int, int, int]) -> Counts:
    """Strength of the strongest scatterer near each cell: 0 for none, then one level per two octaves, at most 5.

    Args:
        coded: Quantised scatterers.
        shape: Shape (frame, range, doppler).
    """
    out = np.zeros(shape, np.int64)
    level = 1 + _octave(coded.size) // 2
    for off_range in (-1, 0, 1):
        for off_doppler in (-1, 0, 1):
            r = np.clip(coded.range_cell + off_range, 0, shape[1] - 1)
            d = np.clip(coded.doppler_cell + off_doppler, 0, shape[2] - 1)
            np.maximum.at(out, (coded.frame, r, d), np.minimum(level, NUM_NEAR - 1))
    return out


class PointCoder:
    """Adaptive models of the scatterers of working frames."""

    def __init__(self, shape: tuple[int, int, int], steps: PointSteps, num_directions: int):
        """Initialises the models.

        Args:
            shape: Shape (frame, range, doppler) of the working frames.
            steps: Quantisation steps.
            num_directions: Number of direction cosines that the array resolves.
        """
        self.shape, self.steps, self.num_directions = shape, steps, num_directions
        self.many = NumberModel(1, 4)
        self.octave = NumberModel(OCTAVES, OCTAVES, 0.7)
        self.coarse = [[BitModel(COARSE, 0.5, 2.0) for _ in range(4)] for _ in range(2)]

    def code(self, stream: BitStream, coded: CodedPoints | None) -> CodedPoints:
        """Encodes scatterers, or decodes them where `coded` is None; returns them."""
        wanted = np.zeros(self.shape, np.int64)
        if coded is not None:
            np.add.at(wanted, (coded.frame, coded.range_cell, coded.doppler_cell), 1)
        counts = self._counts(stream, wanted)
        cells = np.repeat(np.stack(np.nonzero(counts)), counts[counts > 0], axis=1)
        return self._details(stream, cells, coded)

    def _counts(self, stream: BitStream, wanted: np.ndarray) -> np.ndarray:
        """Number of scatterers per cell: none, one, or several, and then how many."""
        counts = np.minimum(wanted, SEVERAL)
        ClassMapCoder(self.shape[2], COUNT_PRIOR).code(stream, counts, np.zeros_like(counts))
        several = np.nonzero(counts == SEVERAL)
        more = self.many.code(stream, np.zeros(len(several[0]), np.int64), wanted[several] - SEVERAL)
        if int(more.sum()) > MAX_POINTS:
            raise ValueError("too many scatterers: the stream is damaged")
        counts[several] += more
        return counts

    def _details(self, stream: BitStream, cells: np.ndarray, coded: CodedPoints | None) -> CodedPoints:
        num = cells.shape[1]
        nothing = np.zeros(num, np.int64)
        given = {name: getattr(coded, name) if coded is not None else nothing for name in ("size", "phase")}
        size = self._sizes(stream, cells, given["size"])
        phase = stream.uniform(_phases(size), given["phase"])
        parts = []
        for name, sharpness in (
            ("range_part", self.steps.range_sixteenths),
            ("doppler_part", self.steps.doppler_sixteenths),
        ):
            values = getattr(coded, name) if coded is not None else nothing
            parts.append(stream.uniform(_parts(size, sharpness), values))
        direction = np.zeros((num, 2), np.int64)
        for side in range(self.num_directions):
            values = coded.direction[:, side] if coded is not None else nothing
            direction[:, side] = self._direction(stream, side, size, values)
        return CodedPoints(
            frame=cells[0],
            range_cell=cells[1],
            doppler_cell=cells[2],
            size=size,
            phase=phase,
            range_part=parts[0],
            doppler_part=parts[1],
            direction=direction,
        )

    def _sizes(self, stream: BitStream, cells: np.ndarray, wanted: Integers) -> Integers:
        """Codes the octave of each amplitude frame by frame, then its position within the octave."""
        num = cells.shape[1]
        octave = np.zeros(num, np.int64)
        expected = np.zeros(num, np.int64)
        starts = np.searchsorted(cells[0], np.arange(self.shape[0] + 1))
        strongest = np.full((self.shape[1], self.shape[2]), 3, np.int64)
        for frame in range(self.shape[0]):
            own = slice(starts[frame], starts[frame + 1])
            r, d = cells[1][own], cells[2][own]
            expected[own] = strongest[r, d]
            octave[own] = self.octave.code(stream, expected[own], _octave(np.maximum(wanted[own], 1)))
            strongest = self._strongest(r, d, octave[own], strongest)
        within = 2**octave
        return within + stream.uniform(within, wanted - within)

    def _strongest(self, r: np.ndarray, d: np.ndarray, octave: np.ndarray, before: np.ndarray) -> np.ndarray:
        """Octave expected in the next frame: the strongest of a block of cells, unchanged where there is none."""
        block = 4
        shape = (-(-self.shape[1] // block), -(-self.shape[2] // block))
        coarse = np.full(shape, -1, np.int64)
        np.maximum.at(coarse, (r // block, d // block), octave)
        full = np.repeat(np.repeat(coarse, block, 0), block, 1)[: self.shape[1], : self.shape[2]]
        return np.minimum(np.where(full >= 0, full, before), OCTAVES - 1)

    def _direction(self, stream: BitStream, side: int, size: Integers, wanted: Integers) -> Integers:
        parts = _direction_parts(size, self.steps.direction_sixteenths[side])
        cell = wanted * COARSE // parts
        found = np.zeros(len(size), np.int64)
        for bit, model in enumerate(self.coarse[side]):
            context = found + 2**bit - 1
            probability = np.clip(model.probability(context)[0], 0.02, 0.98)
            bits = stream.bits(probability, (cell >> (3 - bit)) & 1)
            model.learn(context, bits)
            found = found * 2 + bits
        first = -(-found * parts // COARSE)
        count = -(-(found + 1) * parts // COARSE) - first
        return first + stream.uniform(np.maximum(count, 1), wanted - first)


def _octave(size: Integers) -> Integers:
    """floor(log2(size)), exactly."""
    return (np.frexp(np.maximum(size, 1).astype(np.float64))[1] - 1).astype(np.int64)


def _phases(size: Integers) -> Integers:
    return np.maximum((size * 201 + 31) // 32, 4)


def _parts(size: Integers, sixteenths: int) -> Integers:
    return np.maximum((size * sixteenths + SIXTEENTHS - 1) // SIXTEENTHS, 1)


def _largest(parts: Integers) -> Integers:
    """Largest value that `BitStream.uniform` codes for a number of parts: beyond 2^23 multiples of 2^16 count."""
    return np.where(parts > MAX_UNIFORM, parts >> 16 << 16, parts) - 1


def _direction_parts(size: Integers, sixteenths: int) -> Integers:
    return np.maximum((2 * size * sixteenths + SIXTEENTHS - 1) // SIXTEENTHS, COARSE)


def static_levels(static: torch.Tensor, window: FitWindow, beams: np.ndarray, step: float) -> np.ndarray:
    """Quantises a static layer.

    Args:
        static: Static layer (range, antenna).
        window: Fit window of the frames.
        beams: Unitary matrix (beam, antenna).
        step: Quantisation step of cells.

    Returns:
        Levels (part, beam, 1, range, 1), int64.
    """
    values = np.einsum("ra,ba->br", static.numpy(), beams) / _static_step(window, step)
    parts = np.stack([values.real, values.imag])
    levels = np.sign(parts) * np.floor(np.abs(parts) + STATIC_ROUNDING)
    return levels.astype(np.int64)[:, :, None, :, None]


def code_static(stream: BitStream, levels: np.ndarray) -> None:
    """Encodes levels of a static layer, or fills them in when decoding."""
    every = np.ones(levels.shape[2:], np.int64)
    LevelCoder(levels.shape[1:]).code(stream, levels.reshape(2, len(levels[0]), -1), every)


def static_of(levels: np.ndarray, window: FitWindow, beams: np.ndarray, step: float) -> torch.Tensor:
    """The inverse of `static_levels`.

    Args:
        levels: Levels (part, beam, 1, range, 1).
        window: Fit window of the frames.
        beams: Unitary matrix (beam, antenna).
        step: Quantisation step of cells.

    Returns:
        Static layer (range, antenna), complex64.
    """
    values = (levels[0] + 1j * levels[1])[:, 0, :, 0] * _static_step(window, step)
    return torch.from_numpy(np.einsum("br,ba->ra", values, beams.conj()).astype(np.complex64))


def _static_step(window: FitWindow, step: float) -> float:
    kernel = window.response.doppler_kernel(window.axes.doppler_bin)[0]
    return step / math.sqrt(window.num_working_frames * float(kernel.double().square().sum()))


def pack_gains(gains: torch.Tensor) -> bytes:
    """Complex gains (antenna,) in two bytes each: log2 magnitude in 1/64, angle in 1/256 of a turn."""
    parts = torch.stack([gains.abs().log2() * GAIN_STEPS, gains.angle() / (2 * math.pi) * 256])
    parts[0] = parts[0].round().clamp(-128, 127)
    return (parts.round().to(torch.int16) & 255).to(torch.uint8).numpy().tobytes()


def unpack_gains(data: bytes) -> torch.Tensor:
    """The gains (antenna,) of `pack_gains`."""
    parts = torch.from_numpy(np.frombuffer(data, np.int8).astype(np.float32).reshape(2, -1))
    return torch.polar(2 ** (parts[0] / GAIN_STEPS), parts[1] / 256 * 2 * math.pi)
