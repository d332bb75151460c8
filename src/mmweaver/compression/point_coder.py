"""Scatterers as whole numbers, each parameter as fine as its scatterer is strong, and their bits.

An error of one step of any parameter leaves about the same energy in the cube as an error of one step of a residual
cell, so one step serves all: a scatterer of size k (amplitude in steps) gets 2 pi k phases and about k places a bin.
"""

import math
from dataclasses import dataclass

import numpy as np
import torch
from jaxtyping import Float, Int

from mmweaver.compression.entropy import BitModel, BitStream, Mixture, NumberModel
from mmweaver.dsp.point_response import Axes, PointResponse, Points

Whole = Int[np.ndarray, "_"]
Counts = Int[np.ndarray, "frame range doppler"]

COARSE = 16  # cells of a direction cosine that have chances of their own
OCTAVES = 24
NUM_AROUND, NUM_NEAR = 8, 6
AROUND_BOUNDS = np.array([1, 2, 3, 4, 6, 8, 12])
SIXTEENTHS = 16


@dataclass(frozen=True, kw_only=True)
class PointSteps:
    """How fine the parameters of a scatterer are: amplitude of one size step, and places a bin for size 1.

    The last three are in sixteenths, whole, so that every machine counts the same.
    """

    amplitude: float
    range_sixteenths: int
    doppler_sixteenths: int
    direction_sixteenths: tuple[int, int]

    @classmethod
    def of(cls, step: float, response: PointResponse, axes: Axes) -> "PointSteps":
        """Steps that leave as much error as a step `step` in every cell of the cube."""
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
class CodedPoints:
    """Scatterers in whole numbers, one row a scatterer, in the order of frame, range cell, Doppler cell."""

    frame: Whole
    range_cell: Whole
    doppler_cell: Whole
    size: Whole  # from 1
    phase: Whole
    range_part: Whole  # place within the cell
    doppler_part: Whole
    direction: Int[np.ndarray, "_ 2"]

    def __len__(self) -> int:
        return len(self.frame)


def quantised(points: Points, steps: PointSteps, axes: Axes, num_directions: int, least_size: int) -> CodedPoints:
    """Scatterers in whole numbers; those smaller than `least_size` steps are left out."""
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
        cells.append((cell, np.clip(np.floor((place - cell) * parts).astype(np.int64), 0, parts - 1)))
    phases = _phases(size)
    phase = np.rint(np.angle(value) / (2 * np.pi) * phases).astype(np.int64) % phases
    direction = np.zeros((len(size), 2), np.int64)
    for side in range(num_directions):
        parts = _direction_parts(size, steps.direction_sixteenths[side])
        cosine = points.direction.numpy()[frame, slot, side].astype(np.float64)
        direction[:, side] = np.clip(np.floor((cosine + 1) / 2 * parts).astype(np.int64), 0, parts - 1)
    order = np.lexsort((cells[1][0], cells[0][0], frame))
    return CodedPoints(
        frame=frame[order], range_cell=cells[0][0][order], doppler_cell=cells[1][0][order], size=size[order],
        phase=phase[order], range_part=cells[0][1][order], doppler_part=cells[1][1][order],
        direction=direction[order],
    )  # fmt: skip


def points_of(coded: CodedPoints, num_frames: int, steps: PointSteps, axes: Axes, num_directions: int) -> Points:
    """The scatterers that the whole numbers stand for, (frame, point), padded."""
    counts = np.bincount(coded.frame, minlength=num_frames)
    slot = np.arange(len(coded)) - np.repeat(np.cumsum(counts) - counts, counts)
    shape = (num_frames, int(counts.max(initial=0)))

    def placed(values: np.ndarray, start: float = 0.0) -> torch.Tensor:
        out = np.full(shape, start, values.dtype)
        out[coded.frame, slot] = values
        return torch.from_numpy(out)

    def bins(cell: Whole, part: Whole, first: float, sharpness: int) -> Float[np.ndarray, "_"]:
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
    """How strong a scatterer is near each cell: 0 none, then by every second octave, at most 5."""
    out = np.zeros(shape, np.int64)
    level = 1 + _octave(coded.size) // 2
    for off_range in (-1, 0, 1):
        for off_doppler in (-1, 0, 1):
            r = np.clip(coded.range_cell + off_range, 0, shape[1] - 1)
            d = np.clip(coded.doppler_cell + off_doppler, 0, shape[2] - 1)
            np.maximum.at(out, (coded.frame, r, d), np.minimum(level, NUM_NEAR - 1))
    return out


class PointCoder:
    """The models of one cube's scatterers. `moves`: range cells that a Doppler cell moves on a frame, times 256."""

    def __init__(self, shape: tuple[int, int, int], steps: PointSteps, num_directions: int, moves: int):
        self.shape, self.steps, self.num_directions, self.moves = shape, steps, num_directions, moves
        a = NUM_AROUND
        self.more = [
            Mixture([BitModel(a * a * 2, 0.03, 0.5), BitModel(a * a, 0.03, 0.5), BitModel(shape[2], 0.03, 0.5)])
            for _ in range(4)
        ]
        self.octave = NumberModel(OCTAVES, OCTAVES, 0.7)
        self.coarse = [[BitModel(COARSE, 0.5, 2.0) for _ in range(4)] for _ in range(2)]

    def code(self, stream: BitStream, coded: CodedPoints | None) -> CodedPoints:
        """Writes `coded`, or reads it where it is None."""
        frames, num_range, num_doppler = self.shape
        wanted = np.zeros(self.shape, np.int64)
        if coded is not None:
            np.add.at(wanted, (coded.frame, coded.range_cell, coded.doppler_cell), 1)
        counts = np.zeros(self.shape, np.int64)
        for frame in range(frames):
            before = self._carried_on(counts[frame - 1]) if frame else np.zeros((num_range, num_doppler), np.int64)
            for row in range(num_range):
                self._code_row(stream, wanted[frame, row], counts[frame], row, before)
        cells = np.repeat(np.stack(np.nonzero(counts)), counts[counts > 0], axis=1)
        return self._details(stream, cells, coded)

    def _carried_on(self, counts: np.ndarray) -> np.ndarray:
        """Where the scatterers of the frame before should be now, and around."""
        num_range, num_doppler = counts.shape
        still = num_doppler // 2
        out = np.zeros((num_range + 2, num_doppler + 2), np.int64)
        r, d = np.nonzero(counts)
        to = np.clip(r + ((d - still) * self.moves + 128) // 256, 0, num_range - 1)
        np.add.at(out, (to + 1, d + 1), 2 * counts[r, d])
        near = out.copy()
        near[1:] += out[:-1] // 2
        near[:-1] += out[1:] // 2
        near[:, 1:] += out[:, :-1] // 2
        near[:, :-1] += out[:, 1:] // 2
        return near[1:-1, 1:-1]

    def _code_row(self, stream, wanted, counts, row, before) -> None:
        num_doppler = counts.shape[1]
        padded = np.zeros((3, num_doppler + 2), np.int64)
        if row:
            padded[0, 1:-1] = counts[row - 1]
        if row > 1:
            padded[1, 1:-1] = counts[row - 2]
        for first in (0, 1):
            d = np.arange(first, num_doppler, 2)
            around = 2 * padded[0, d + 1] + padded[0, d] + padded[0, d + 2] + padded[1, d + 1]
            if first:
                around = around + 2 * (padded[2, d] + padded[2, d + 2])
            around = np.searchsorted(AROUND_BOUNDS, around, side="right")
            earlier = np.searchsorted(AROUND_BOUNDS, before[row, d], side="right")
            total = np.searchsorted(AROUND_BOUNDS, around + before[row, d], side="right")
            contexts = [(around * NUM_AROUND + earlier) * 2 + first, total * NUM_AROUND + earlier, d]
            value = np.zeros(len(d), np.int64)
            open_ = np.arange(len(d))
            step = 0
            while len(open_):
                model = self.more[min(step, len(self.more) - 1)]
                chosen = [context[open_] for context in contexts]
                more = model.code(stream, chosen, (wanted[d[open_]] > step).astype(np.int64))
                open_ = open_[more > 0]
                value[open_] += 1
                step += 1
                if step > 10_000:
                    raise ValueError("too many scatterers in one cell: the stream is damaged")
            counts[row, d] = value
            padded[2, d + 1] = value

    def _details(self, stream: BitStream, cells: np.ndarray, coded: CodedPoints | None) -> CodedPoints:
        num = cells.shape[1]
        nothing = np.zeros(num, np.int64)
        given = {name: getattr(coded, name) if coded is not None else nothing for name in ("size", "phase")}
        size = self._sizes(stream, cells, given["size"])
        phase = stream.even(_phases(size), given["phase"])
        parts = []
        for name, sharpness in (
            ("range_part", self.steps.range_sixteenths), ("doppler_part", self.steps.doppler_sixteenths)
        ):  # fmt: skip
            values = getattr(coded, name) if coded is not None else nothing
            parts.append(stream.even(_parts(size, sharpness), values))
        direction = np.zeros((num, 2), np.int64)
        for side in range(self.num_directions):
            values = coded.direction[:, side] if coded is not None else nothing
            direction[:, side] = self._direction(stream, side, size, values)
        return CodedPoints(
            frame=cells[0], range_cell=cells[1], doppler_cell=cells[2], size=size, phase=phase,
            range_part=parts[0], doppler_part=parts[1], direction=direction,
        )  # fmt: skip

    def _sizes(self, stream: BitStream, cells: np.ndarray, wanted: Whole) -> Whole:
        """Octave by octave of the scatterers, frame by frame, then what is within an octave."""
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
        return within + stream.even(within, wanted - within)

    def _strongest(self, r: np.ndarray, d: np.ndarray, octave: np.ndarray, before: np.ndarray) -> np.ndarray:
        """Octave to expect in the next frame: the strongest of a block of cells, carried on where there was none."""
        block = 4
        shape = (-(-self.shape[1] // block), -(-self.shape[2] // block))
        coarse = np.full(shape, -1, np.int64)
        np.maximum.at(coarse, (r // block, d // block), octave)
        full = np.repeat(np.repeat(coarse, block, 0), block, 1)[: self.shape[1], : self.shape[2]]
        return np.minimum(np.where(full >= 0, full, before), OCTAVES - 1)

    def _direction(self, stream: BitStream, side: int, size: Whole, wanted: Whole) -> Whole:
        parts = _direction_parts(size, self.steps.direction_sixteenths[side])
        cell = wanted * COARSE // parts
        found = np.zeros(len(size), np.int64)
        for bit, model in enumerate(self.coarse[side]):
            context = found + 2**bit - 1
            chance = np.clip(model.chance(context)[0], 0.02, 0.98)
            bits = stream.bits(chance, (cell >> (3 - bit)) & 1)
            model.learn(context, bits)
            found = found * 2 + bits
        first = -(-found * parts // COARSE)
        count = -(-(found + 1) * parts // COARSE) - first
        return first + stream.even(np.maximum(count, 1), wanted - first)


def _octave(size: Whole) -> Whole:
    """floor(log2(size)), exactly."""
    return (np.frexp(np.maximum(size, 1).astype(np.float64))[1] - 1).astype(np.int64)


def _phases(size: Whole) -> Whole:
    return np.maximum((size * 201 + 31) // 32, 4)


def _parts(size: Whole, sixteenths: int) -> Whole:
    return np.maximum((size * sixteenths + SIXTEENTHS - 1) // SIXTEENTHS, 1)


def _direction_parts(size: Whole, sixteenths: int) -> Whole:
    return np.maximum((2 * size * sixteenths + SIXTEENTHS - 1) // SIXTEENTHS, COARSE)
