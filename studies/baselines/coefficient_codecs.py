"""Codecs that keep coefficients of the antennas' KLT: the largest, or all with an arithmetic coder."""

import zlib

import numpy as np

from mmweaver.compression.cell_coder import FINE
from mmweaver.compression.entropy import BitStream, Decoder, Encoder
from mmweaver.compression.legacy_chunk import LegacyLevelCoder
from mmweaver.compression.transforms import ChunkTransform, TransformChoice
from mmweaver.core.records import RadarCube
from mmweaver.core.shapes import CubeValues
from studies.baselines.codec_interface import KnobCodec

MAGNITUDE_BITS, PHASE_BITS = 8, 6
LOUDEST_DB, DB_A_STEP = 0.0, 0.25


def packed_top(values: np.ndarray, count: int) -> bytes:
    """The `count` largest numbers of an array of at most 1 in magnitude."""
    flat = values.ravel()
    count = min(count, flat.size)
    at = np.sort(np.argpartition(-np.abs(flat), count - 1)[:count])
    loud = 20 * np.log10(np.maximum(np.abs(flat[at]), 1e-12))
    magnitude = np.clip(np.rint((LOUDEST_DB - loud) / DB_A_STEP), 0, 2**MAGNITUDE_BITS - 1).astype(np.uint8)
    turns = np.rint(np.angle(flat[at]) / (2 * np.pi) * 2**PHASE_BITS).astype(int) % 2**PHASE_BITS
    gaps = np.diff(at, prepend=-1).astype("<u4").view(np.uint8).reshape(-1, 4).T
    bits = ((turns[:, None] >> np.arange(PHASE_BITS)) & 1).astype(np.uint8)
    parts = [zlib.compress(gaps.tobytes(), 9), zlib.compress(magnitude.tobytes(), 9), np.packbits(bits).tobytes()]
    sizes = np.array([count, len(parts[0]), len(parts[1])], "<u4").tobytes()
    return sizes + b"".join(parts)


def unpacked_top(data: bytes, shape: tuple[int, ...]) -> np.ndarray:
    """The inverse of `packed_top`; zeros elsewhere."""
    count, gap_bytes, magnitude_bytes = np.frombuffer(data[:12], "<u4").tolist()
    rest = data[12:]
    gaps = np.frombuffer(zlib.decompress(rest[:gap_bytes]), np.uint8).reshape(4, -1).T.copy().view("<u4")[:, 0]
    magnitude = np.frombuffer(zlib.decompress(rest[gap_bytes : gap_bytes + magnitude_bytes]), np.uint8)
    bits = np.unpackbits(np.frombuffer(rest[gap_bytes + magnitude_bytes :], np.uint8))[: count * PHASE_BITS]
    turns = bits.reshape(count, PHASE_BITS) @ (1 << np.arange(PHASE_BITS))
    flat = np.zeros(int(np.prod(shape)), np.complex64)
    loud = 10 ** ((LOUDEST_DB - magnitude.astype(float) * DB_A_STEP) / 20)
    flat[np.cumsum(gaps.astype(np.int64)) - 1] = loud * np.exp(2j * np.pi * turns / 2**PHASE_BITS)
    return flat.reshape(shape)


class TopCoefficients(KnobCodec):
    """The largest coefficients after the KLT of the antennas and a cosine transform over frames of static cells."""

    name = "top_klt"
    coarse, fine = 8.0, 60_000.0

    def at(self, values: CubeValues, knob: float, cube: RadarCube) -> bytes:
        basis, packed = antenna_klt(values)
        coefficients = _transform(basis).forward(values.astype(np.complex128))
        largest = np.float32(np.abs(coefficients).max())
        return packed + largest.tobytes() + packed_top(coefficients / largest, int(knob))

    def back(self, data: bytes, like: RadarCube) -> np.ndarray:
        frames, num_range, num_doppler, antennas = like.grid.shape
        basis, data = unpacked_klt(data, antennas)
        largest = np.frombuffer(data[:4], np.float32)[0]
        coefficients = unpacked_top(data[4:], (antennas, frames, num_range, num_doppler)) * largest
        return _transform(basis).inverse(coefficients.astype(np.complex128))


class KltContext(KnobCodec):
    """KLT of the antennas, cosine transform over frames of static cells, rounding, and a context-adaptive coder."""

    name = "klt_context"
    coarse, fine = 1.0, 1e-5

    def at(self, values: CubeValues, knob: float, cube: RadarCube) -> bytes:
        basis, packed = antenna_klt(values)
        coefficients = _transform(basis).forward(values.astype(np.complex128)) / knob
        parts = np.stack([np.real(coefficients), np.imag(coefficients)])
        levels = (np.sign(parts) * np.floor(np.abs(parts) + 0.35)).astype(np.int64)
        stream = Encoder()
        _code_levels(stream, levels)
        return packed + np.float32(knob).tobytes() + stream.to_bytes()

    def back(self, data: bytes, like: RadarCube) -> np.ndarray:
        frames, num_range, num_doppler, antennas = like.grid.shape
        basis, data = unpacked_klt(data, antennas)
        step = np.frombuffer(data[:4], np.float32)[0]
        levels = np.zeros((2, antennas, frames, num_range, num_doppler), np.int64)
        _code_levels(Decoder(data[4:]), levels)
        restored = levels - 0.05 * np.sign(levels)  # rounded towards zero a little more often than away
        return _transform(basis).inverse((restored[0] + 1j * restored[1]) * float(step))


def _code_levels(stream: BitStream, levels: np.ndarray) -> None:
    """Encodes levels (part, beam, frame, range, doppler) of all cells, or fills them in when decoding."""
    classes = np.full(levels.shape[2:], FINE)
    LegacyLevelCoder(levels.shape[1:], is_dense=True).code(stream, levels, classes, np.zeros_like(classes))


def _transform(basis: np.ndarray) -> ChunkTransform:
    """Directions of the antennas, and a cosine transform over frames of static cells."""
    return ChunkTransform(choice=TransformChoice(), antennas=basis, doppler=None, signs=(False, False), words=b"")


def antenna_klt(values: CubeValues) -> tuple[np.ndarray, bytes]:
    """Principal directions of the antennas (direction, antenna), strongest first, as the decoder gets them; their
    bytes."""
    flat = values.reshape(-1, values.shape[-1]).astype(np.complex128)
    _, vectors = np.linalg.eigh(flat.T @ flat.conj())
    rows = vectors[:, ::-1].T.conj()
    words = np.rint(np.stack([np.real(rows), np.imag(rows)]) * 127).astype(np.int8)
    return _orthonormal(words), words.tobytes()


def unpacked_klt(data: bytes, antennas: int) -> tuple[np.ndarray, bytes]:
    """Directions of a stream, and the rest of it."""
    size = 2 * antennas**2
    words = np.frombuffer(data[:size], np.int8).reshape(2, antennas, antennas)
    return _orthonormal(words), data[size:]


def _orthonormal(words: np.ndarray) -> np.ndarray:
    """The unitary matrix nearest to rounded directions."""
    left, _, right = np.linalg.svd((words[0] + 1j * words[1]) / 127)
    return left @ right
