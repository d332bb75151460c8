"""Entropy coding of a small number for each cell (time, range, doppler): closed, coarse or fine; how many points."""

import numpy as np

from mmweaver.compression.entropy import BitStream
from mmweaver.compression.lattice import PHASES, Phase, known_neighbours
from mmweaver.compression.symbol_model import Batches, MixedModel

Classes = np.ndarray  # (time, range, doppler) int64

CLOSED, COARSE, FINE = 0, 1, 2
STRIDES = (4, 2, 1)  # of the lattices, one after the other
MARGIN = 4
OPEN_BOUNDS = np.array([1, 3, 6, 9, 13])  # sixteenths of the known neighbours
FINE_BOUNDS = np.array([1, 6, 12])
BYTE = 255
SEEN = np.array([0, 1, 1 + (1 << 8)], np.int16)  # what a class adds to the sums of open and of fine neighbours
NUM_OPEN, NUM_FINE, NUM_NEAR = len(OPEN_BOUNDS) + 2, len(FINE_BOUNDS) + 1, 4


class ClassMapCoder:
    """`code` encodes classes, or fills them in when decoding. `prior`: probabilities of the classes to begin with."""

    def __init__(self, num_doppler: int, prior: tuple[float, ...] = (0.94, 0.03, 0.03)):
        contexts = (NUM_OPEN * NUM_FINE * len(STRIDES), NUM_OPEN * NUM_FINE * NUM_NEAR, NUM_OPEN * num_doppler)
        self.model = MixedModel([np.tile(prior, (num, 1)) for num in contexts])

    def code(self, stream: BitStream, classes: Classes, near: Classes) -> None:
        """`near` (time, range, doppler): strength of the nearest scatterer, 0 for none."""
        batches = Batches(stream)
        seen = np.zeros([size + 2 * MARGIN for size in classes.shape], np.int16)
        inside = seen[(slice(MARGIN, -MARGIN),) * 3]
        for stride in STRIDES:
            for phase in PHASES if stride == STRIDES[0] else PHASES[1:]:
                own = tuple(slice(stride * odd, None, 2 * stride) for odd in phase)
                if classes[own].size:
                    contexts = self._contexts(seen, phase, stride, near[own])
                    wanted = classes[own].ravel()
                    parts = [
                        self.model.code(stream, [context[batch] for context in contexts], wanted[batch])
                        for batch in batches.of(len(wanted))
                    ]
                    values = np.concatenate(parts)
                    classes[own] = values.reshape(classes[own].shape)
                    inside[own] = SEEN.take(classes[own])

    def _contexts(self, seen: np.ndarray, phase: Phase, stride: int, near: Classes) -> list[np.ndarray]:
        found, total = np.zeros(near.shape, np.int16), 0  # sums of open cells, and of fine ones in the upper byte
        for offset, weight in known_neighbours(phase):
            first = [MARGIN + stride * (odd + step) for odd, step in zip(phase, offset, strict=True)]
            at = tuple(
                slice(start, start + 2 * stride * (num - 1) + 1, 2 * stride)
                for start, num in zip(first, near.shape, strict=True)
            )
            found += weight * seen[at]
            total += weight
        by_open = np.full(near.shape, NUM_OPEN - 1)
        by_fine = np.zeros(near.shape, np.int64)
        if total:
            sums = np.arange(total + 1) * 16 // total
            by_open = OPEN_BOUNDS.searchsorted(sums, "right").take(found & BYTE)
            by_fine = FINE_BOUNDS.searchsorted(sums, "right").take(found >> 8)
        both = by_open * NUM_FINE + by_fine
        column = np.broadcast_to(phase[2] * stride + 2 * stride * np.arange(near.shape[2]), near.shape)
        contexts = (
            both * len(STRIDES) + STRIDES.index(stride),
            both * NUM_NEAR + np.minimum(near, NUM_NEAR - 1),
            column * NUM_OPEN + by_open,
        )
        return [context.ravel() for context in contexts]
