"""Raw ADC samples of some frames, coded without loss or with a bounded error.

Each sample is predicted from preceding loops, the preceding antenna and preceding samples, with weights fitted
to the block; the residual is entropy-coded in contexts of its typical size. Samples are visited along diagonals of
(loop, antenna, sample), so that all samples of a diagonal are predicted at once. Weights and predictions are integers,
so a block decodes to the same samples on every machine.
"""

import struct
from dataclasses import dataclass

import numpy as np
from jaxtyping import Int

from mmweaver.compression.entropy import BitStream, Decoder, Encoder
from mmweaver.compression.symbol_model import MAX_BITS, MixedModel, code_far

Array = np.ndarray
Samples = Int[np.ndarray, "loop antenna sample part"]

# inputs of the prediction: (loops before, antennas before, samples before); both parts of each
INPUTS = (
    (1, 0, 0),
    (2, 0, 0),
    (3, 0, 0),
    (4, 0, 0),
    (1, 0, -1),
    (0, 1, 0),
    (1, 1, 0),
    (2, 1, 0),
    (0, 0, 1),
    (0, 0, 2),
    (1, 0, 1),
    (1, 0, 2),
    (0, 1, 1),
    (1, 1, 1),
)
BEFORE, AFTER = 4, 1  # margins around loops and samples
SKEW = 2  # diagonals: delay of a loop behind the preceding one, in samples
FRACTION = 14  # fractional bits of a weight
MAX_WEIGHT = 2**15 - 1
OWN_WEIGHTS = 16384  # samples per antenna from which on each antenna has its own weights
FITTED_ROWS = 6000
RIDGE = 1e-4
HEADER = struct.Struct("<IHHBHH")
GROUP = 16384  # samples whose sizes are learned together
HALF = 24  # residuals from -HALF to HALF have a symbol each
CLASSES_AN_OCTAVE = 4
CLASS_BOUNDS = 2.0 ** (np.arange(-3 * CLASSES_AN_OCTAVE, 16 * CLASSES_AN_OCTAVE) / CLASSES_AN_OCTAVE)
SCALED = 256  # sizes are integers in this fraction of a count
FORGET = 8  # groups over which sizes are averaged
SUDDEN = 4  # a size that drops by this factor is adopted immediately
LARGEST = 2**15
MAX_SAMPLES = 2**27
SMALL_SAMPLES, MAX_SAMPLES_A_BYTE = 2**23, 10_000  # limits of what a block may unpack to, against hostile headers


@dataclass(frozen=True, kw_only=True)
class BlockShape:
    """Shape of a block of samples."""

    loops: int
    antennas: int
    samples: int
    parts: int

    @property
    def size(self) -> int:
        """Number of integers."""
        return self.loops * self.antennas * self.samples * self.parts


def encode_block(samples: Samples, max_error: int = 0) -> bytes:
    """Encodes samples.

    Args:
        samples: Samples (loop, antenna, sample, part) in the range of int16.
        max_error: Maximum error of decoded samples in counts; 0 is lossless.

    Returns:
        The bytes that `decode_block` reads.
    """
    shape = BlockShape(**dict(zip(("loops", "antennas", "samples", "parts"), samples.shape, strict=True)))
    weights = _fitted(samples.astype(np.int64), shape)
    residual = np.zeros(samples.shape, np.int64)
    _walk(samples.astype(np.int64), residual, weights, max_error, encodes=True)
    stream = Encoder()
    _code_residual(stream, residual)
    front = HEADER.pack(shape.loops, shape.antennas, shape.samples, shape.parts, max_error, len(weights))
    return front + weights.astype("<i2").tobytes() + stream.to_bytes()


def decode_block(data: bytes, expected: BlockShape) -> Samples:
    """Decodes samples.

    Args:
        data: Bytes of `encode_block`.
        expected: Shape of the block.

    Returns:
        Samples (loop, antenna, sample, part), int16.

    Raises:
        ValueError: For bytes that no encoder writes.
    """
    loops, antennas, samples, parts, max_error, sets = HEADER.unpack_from(data)
    shape = BlockShape(loops=loops, antennas=antennas, samples=samples, parts=parts)
    if shape != expected or shape.size > MAX_SAMPLES:
        raise ValueError("a block of another shape")
    if shape.size > max(SMALL_SAMPLES, MAX_SAMPLES_A_BYTE * len(data)):
        raise ValueError("more samples than its bytes can hold")
    if sets not in (1, antennas):
        raise ValueError("impossible weights")
    count = sets * parts * (len(INPUTS) * parts + parts - 1)
    weights = np.frombuffer(data, "<i2", count, HEADER.size).astype(np.int64).reshape(sets, parts, -1)
    residual = np.zeros((loops, antennas, samples, parts), np.int64)
    _code_residual(Decoder(data[HEADER.size + 2 * count :]), residual)
    out = np.zeros(residual.shape, np.int64)
    _walk(out, residual, weights, max_error, encodes=False)
    return np.clip(out, -LARGEST, LARGEST - 1).astype(np.int16)


def _padded(shape: tuple[int, ...]) -> Array:
    loops, antennas, samples, parts = shape
    return np.zeros((loops + BEFORE, antennas + 1, samples + BEFORE + AFTER, parts), np.int64)


def _walk(samples: Array, residual: Array, weights: Array, max_error: int, *, encodes: bool) -> None:
    """Computes the residual of samples, or the samples of a residual, diagonal by diagonal.

    With `max_error` the residual is in steps of 2 max_error + 1 around the prediction, which uses decoded samples.
    """
    loops, antennas, num, parts = samples.shape
    known = _padded(samples.shape)
    flat = known.reshape(-1, parts)
    strides = (known.shape[1] * known.shape[2], known.shape[2], 1)
    offsets = np.array([-(back[0] * strides[0] + back[1] * strides[1] + back[2]) for back in INPUTS])
    loop, antenna = (index.ravel() for index in np.meshgrid(np.arange(loops), np.arange(antennas), indexing="ij"))
    delay = SKEW * loop + antenna
    order = np.argsort(delay, kind="stable")
    loop, antenna, delay = loop[order], antenna[order], delay[order]
    base = (loop + BEFORE) * strides[0] + (antenna + 1) * strides[1] + BEFORE
    own_weights = weights[antenna % len(weights)]  # (line, part, input)
    step = 2 * max_error + 1
    for time in range(num + int(delay[-1])):
        first = int(np.searchsorted(delay, time - num, side="right"))
        last = int(np.searchsorted(delay, time, side="right"))
        if first >= last:
            continue
        line = slice(first, last)
        at = time - delay[line]
        place = base[line] + at
        inputs = flat[place[:, None] + offsets].reshape(last - first, -1)
        index = (loop[line], antenna[line], at)
        for part in range(parts):
            weight = own_weights[line, part]
            total = np.einsum("li,li->l", inputs, weight[:, : inputs.shape[1]])
            if part:
                total += flat[place, 0] * weight[:, -1]
            predicted = (total + (1 << (FRACTION - 1))) >> FRACTION
            if encodes:
                # floor division of a shifted error rounds to the nearest step
                rest = (samples[(*index, part)] - predicted + max_error) // step
                residual[(*index, part)] = rest
            else:
                rest = residual[(*index, part)]
            value = np.clip(predicted + rest * step, -LARGEST, LARGEST - 1)
            flat[place, part] = value
            # the loops before the first one are assumed equal to it
            start = place[loop[line] == 0]
            for back in range(1, BEFORE + 1):
                flat[start - back * strides[0], part] = flat[start, part]
            if not encodes:
                samples[(*index, part)] = value


def _fitted(samples: Array, shape: BlockShape) -> Array:
    """Least-squares weights (set, part, input) in fractions of 2^FRACTION, fitted to some loops of the block.

    One set per antenna, or one for all where an antenna has few samples.
    """
    known = _padded(samples.shape)
    known[BEFORE:, 1:, BEFORE : BEFORE + shape.samples] = samples
    rows = max(1, FITTED_ROWS // shape.samples)
    loops = np.unique(np.linspace(min(BEFORE, shape.loops - 1), shape.loops - 1, rows).astype(int))
    at = BEFORE + np.arange(shape.samples)
    tables = []
    for antenna in range(shape.antennas):
        columns = [known[loops + BEFORE - back[0]][:, antenna + 1 - back[1], at - back[2]] for back in INPUTS]
        columns.append(known[loops + BEFORE][:, antenna + 1, at])
        tables.append(np.concatenate(columns, axis=2).reshape(-1, (len(INPUTS) + 1) * shape.parts))
    if shape.loops * shape.samples < OWN_WEIGHTS:
        tables = [np.concatenate(tables)]
    return np.stack([_least_squares(table.astype(np.float64), shape.parts) for table in tables])


def _least_squares(table: Array, parts: int) -> Array:
    """Weights (part, input) that predict the last columns of a table from the others, one part after the other."""
    width = len(INPUTS) * parts
    out = np.zeros((parts, width + parts - 1), np.int64)
    for part in range(parts):
        columns = table[:, : width + part]
        normal = columns.T @ columns
        ridge = RIDGE * np.trace(normal) / len(normal) * len(columns) ** -0.5 + 1e-9
        solved = np.linalg.solve(normal + ridge * np.eye(len(normal)), columns.T @ table[:, width + part])
        out[part, : width + part] = np.clip(np.rint(solved * 2**FRACTION), -MAX_WEIGHT, MAX_WEIGHT)
    return out


def _code_residual(stream: BitStream, residual: Array) -> None:
    """Encodes residuals (loop, antenna, sample, part), or fills them in when decoding."""
    loops = len(residual)
    together = max(1, GROUP // residual[0].size)
    symbols = _symbol_models()
    escapes = MixedModel([np.ones((1, MAX_BITS))])
    size = np.full(residual.shape[1:], 8 * SCALED, np.int64)
    first = count = 0
    while first < loops:
        # the first loops are coded separately, since their residual is larger
        part = residual[first : first + min(together, max(1, first // 4))]
        by_class = np.searchsorted(CLASS_BOUNDS * SCALED, _smoothed(size), side="right")
        by_class = np.broadcast_to(by_class, part.shape).ravel()
        values = _code_numbers(stream, symbols, escapes, by_class, part.ravel()).reshape(part.shape)
        residual[first : first + len(part)] = values
        mean = np.abs(values).sum(axis=0) * SCALED // len(values)
        first, count = first + len(part), min(count + 1, FORGET)
        slow = (size * (count - 1) + mean) // count
        size = np.where(size > SUDDEN * _smoothed(mean) + SCALED, mean, slow)


def _smoothed(size: Array) -> Array:
    """Sizes averaged over neighbouring samples and parts."""
    around = 2 * size
    around[:, 1:] += size[:, :-1]
    around[:, :-1] += size[:, 1:]
    return around.sum(axis=2, keepdims=True) // (4 * size.shape[2]) + 0 * size


def _symbol_models() -> Array:
    """Counts (class, symbol): roughly a Gaussian of the scale of the class."""
    classes = np.arange(len(CLASS_BOUNDS) + 1)
    scale = np.append(CLASS_BOUNDS, 2 * CLASS_BOUNDS[-1]) / (1 << _shifts(classes))
    distance = np.abs(np.arange(2 * HALF + 2) - HALF) / np.maximum(scale, 0.2)[:, None]
    square = distance * distance
    counts = 1 / (1 + square * (0.4 + square * (0.1 + square * 0.02)))
    counts[:, -1] = 1e-4
    return counts * (40 / counts.sum(axis=1, keepdims=True))


def _shifts(classes: Array) -> Array:
    """Low bits of a residual that are coded as uniform, so that the remainder has few symbols."""
    octave = classes // CLASSES_AN_OCTAVE - 3
    return np.maximum(octave - 2, 0)


def _code_numbers(stream: BitStream, counts: Array, escapes: MixedModel, by_class: Array, values: Array) -> Array:
    order = np.argsort(by_class, kind="stable")
    classes, wanted = by_class[order], values[order]
    shift = _shifts(classes)
    half = (1 << shift) >> 1
    high = (wanted + half) >> shift
    low = wanted + half - (high << shift)
    symbol = np.where(np.abs(high) <= HALF, high + HALF, 2 * HALF + 1)
    starts = np.flatnonzero(np.diff(classes, prepend=-1)).tolist()
    for start, end in zip(starts, [*starts[1:], len(order)], strict=True):
        row = counts[classes[start]]
        symbol[start:end] = stream.symbols(row / row.sum(), symbol[start:end])
        row += np.bincount(symbol[start:end], minlength=len(row))
    is_near = symbol <= 2 * HALF
    out = (symbol - HALF << shift) - half
    if shift.any():
        out += stream.uniform(np.where(is_near, 1 << shift, 1), np.where(is_near, low, 0))
    far = np.flatnonzero(~is_near)
    if len(far):
        out[far] = code_far(stream, escapes, wanted[far])
    found = np.empty_like(out)
    found[order] = out
    return found
