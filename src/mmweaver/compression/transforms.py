"""Unitary transforms of a chunk that compact its energy, and the choice among them.

Antennas: beams of the array, or the principal directions (KLT) of the chunk. Time: none, or a DCT over the frames in
the static Doppler bins or in all. Doppler, where there are few bins: none, or their KLT, since short windows make
them linearly dependent (two loops under a Hann window are one). Range: none, or a DCT, which collects what FFT
windows spread over neighbouring cells, including noise, and pays off where most cells have levels.
"""

import math
import struct
from dataclasses import dataclass

import numpy as np
from jaxtyping import Complex

Array = np.ndarray
STATIC_BINS = 1  # Doppler bins on either side of zero that static clutter covers
NO_DCT, STATIC_DCT, FULL_DCT = 0, 1, 2
MAX_DOPPLER = 16  # bins up to which their KLT is worth its bytes
WORD = 2**15 - 1
ANTENNA_WORD = 127
CORRELATED = 0.3  # minimum correlation at which neighbouring cells predict each other's sign
MAX_MATRIX = 64  # length up to which a matrix product is faster than a fast transform
HEADER = struct.Struct("<B")


@dataclass(frozen=True, kw_only=True)
class TransformChoice:
    """Which transforms a chunk uses."""

    time: int = STATIC_DCT
    antenna_klt: bool = False
    doppler_klt: bool = False
    range_dct: bool = False

    def name(self) -> str:
        """Name for display, such as "beams, DCT of static bins"."""
        parts = ["KLT of antennas" if self.antenna_klt else "beams"]
        parts += [("", "DCT of static bins", "DCT of all bins")[self.time]] if self.time else []
        parts += ["KLT of Doppler bins"] * self.doppler_klt + ["DCT of ranges"] * self.range_dct
        return ", ".join(parts)


@dataclass(frozen=True, kw_only=True)
class ChunkTransform:
    """Matrices of a choice, as the decoder knows them.

    `signs` tells whether neighbouring values along range and along Doppler have the same sign.
    """

    choice: TransformChoice
    antennas: Complex[Array, "beam antenna"]
    doppler: Complex[Array, "index doppler"] | None
    signs: tuple[bool, bool]
    words: bytes  # of the KLTs

    @classmethod
    def of(
        cls,
        choice: TransformChoice,
        values: Complex[Array, "frame range doppler antenna"],
        beams: Complex[Array, "beam antenna"],
    ) -> "ChunkTransform":
        """The transform of a choice, adapted to the values of a chunk.

        Args:
            choice: Which transforms are used.
            values: Working frames (frame, range, doppler, antenna).
            beams: Unitary matrix (beam, antenna).
        """
        antennas, words, doppler = beams, b"", None
        if choice.antenna_klt:
            flat = values.reshape(-1, values.shape[3])
            antennas, words = _klt(flat.T @ flat.conj(), ANTENNA_WORD)
        if choice.doppler_klt:
            flat = np.moveaxis(values, 2, 3).reshape(-1, values.shape[2])
            doppler, more = _klt(flat.T @ flat.conj(), WORD)
            words += more
        signs = _is_correlated(values, 1), _is_correlated(values, 2)
        return cls(choice=choice, antennas=antennas, doppler=doppler, signs=signs, words=words)

    @property
    def correlated(self) -> tuple[bool, bool]:
        """Whether neighbouring coefficients along range and along Doppler predict each other's sign."""
        return self.signs[0] and not self.choice.range_dct, self.signs[1] and self.doppler is None

    @property
    def packed(self) -> bytes:
        """Header byte and the words of the KLTs."""
        choice, (rows, columns) = self.choice, self.correlated
        header = choice.time + 4 * choice.antenna_klt + 8 * choice.doppler_klt + 16 * rows + 32 * columns
        return bytes([header + 64 * choice.range_dct]) + self.words

    @classmethod
    def unpack(cls, data: bytes, beams: Complex[Array, "beam antenna"], num_doppler: int) -> "ChunkTransform":
        """The transform of a stream that begins with `packed`.

        Args:
            data: The bytes.
            beams: Unitary matrix (beam, antenna).
            num_doppler: Number of Doppler bins.

        Raises:
            ValueError: For bytes that no encoder writes.
        """
        (header,) = HEADER.unpack_from(data)
        choice = TransformChoice(
            time=header & 3, antenna_klt=bool(header & 4), doppler_klt=bool(header & 8), range_dct=bool(header & 64)
        )
        if header >= 128 or choice.time > FULL_DCT or (choice.doppler_klt and num_doppler > MAX_DOPPLER):
            raise ValueError("impossible transform")
        at, antennas, doppler = HEADER.size, beams, None
        if choice.antenna_klt:
            antennas, at = _unpack_klt(data, at, len(beams), ANTENNA_WORD)
        if choice.doppler_klt:
            doppler, at = _unpack_klt(data, at, num_doppler, WORD)
        return cls(
            choice=choice,
            antennas=antennas,
            doppler=doppler,
            signs=(bool(header & 16), bool(header & 32)),
            words=data[HEADER.size : at],
        )

    def forward(self, values: Complex[Array, "frame range doppler antenna"]) -> Complex[Array, "beam time range index"]:
        """Coefficients (beam, time, range, index) of values (frame, range, doppler, antenna)."""
        out = np.tensordot(self.antennas.astype(values.dtype), values, axes=(1, 3))
        if self.doppler is not None:
            out = out @ self.doppler.T.astype(values.dtype)
        out = self._time_transform(out, inverse=False)
        return _dct(out, 2, inverse=False) if self.choice.range_dct else out

    def inverse(self, values: Complex[Array, "beam time range index"]) -> Complex[Array, "frame range doppler antenna"]:
        """Values (frame, range, doppler, antenna) of coefficients (beam, time, range, index)."""
        out = _dct(values, 2, inverse=True) if self.choice.range_dct else values
        out = self._time_transform(out, inverse=True)
        if self.doppler is not None:
            out = out @ self.doppler.conj().astype(values.dtype)
        return np.moveaxis(np.tensordot(self.antennas.conj().astype(values.dtype), out, axes=(0, 0)), 0, 3)

    def _time_transform(self, values: Array, *, inverse: bool) -> Array:
        if self.choice.time == NO_DCT or values.shape[1] == 1:
            return values
        chosen = slice(None) if self._is_full else static_bins(values.shape[3])
        out = values.copy()
        out[..., chosen] = _dct(values[..., chosen], 1, inverse=inverse)
        return out

    @property
    def _is_full(self) -> bool:
        return self.choice.time == FULL_DCT or self.doppler is not None

    def spread(self, mask: Array) -> Array:
        """Mask of the coefficients that depend on masked cells (frame, range, doppler)."""
        out = mask.copy()
        if self.doppler is not None:
            out[...] = mask.any(axis=2, keepdims=True)
        if self.choice.time != NO_DCT:
            chosen = slice(None) if self._is_full else static_bins(mask.shape[2])
            out[:, :, chosen] = out[:, :, chosen].any(axis=0)
        if self.choice.range_dct:
            out[...] = out.any(axis=1, keepdims=True)
        return out


def transform_choices(shape: tuple[int, ...]) -> list[TransformChoice]:
    """The transforms that may pay off for a chunk (frame, range, doppler, antenna), the default one first."""
    frames, _, doppler, antennas = shape
    times = [NO_DCT] if frames == 1 else [STATIC_DCT, FULL_DCT] if doppler > 3 else [FULL_DCT]
    found = [TransformChoice(time=time) for time in times]
    if antennas > 1:
        found += [TransformChoice(time=time, antenna_klt=True) for time in times]
    if 1 < doppler <= MAX_DOPPLER:
        found += [TransformChoice(time=times[-1], antenna_klt=klt, doppler_klt=True) for klt in {False, antennas > 1}]
    return found


def dct_matrix(num: int) -> Array:
    """The orthonormal DCT-II (num, num).

    >>> bool(np.allclose(dct_matrix(5) @ dct_matrix(5).T, np.eye(5)))
    True
    """
    index = np.arange(num)
    matrix = np.cos(np.pi * (index[None] + 0.5) * index[:, None] / num) * np.sqrt(2 / num)
    matrix[0] /= np.sqrt(2)
    return matrix


def static_bins(num_doppler: int) -> slice:
    """Doppler bins that static clutter covers."""
    middle = num_doppler // 2
    return slice(max(0, middle - STATIC_BINS), middle + STATIC_BINS + 1)


def _dct(values: Array, axis: int, *, inverse: bool) -> Array:
    """Orthonormal DCT along an axis; complex64 stays complex64."""
    from scipy import fft

    num, after = values.shape[axis], math.prod(values.shape[axis + 1 :])
    if num <= MAX_MATRIX and values.dtype == np.complex64:
        matrix = dct_matrix(num).astype(np.float32)
        flat = np.ascontiguousarray(values).view(np.float32).reshape(-1, num, 2 * after)
        return ((matrix.T if inverse else matrix) @ flat).view(np.complex64).reshape(values.shape)

    transform = fft.idct if inverse else fft.dct
    real, imaginary = (transform(part, axis=axis, norm="ortho") for part in (np.real(values), np.imag(values)))
    return real + values.dtype.type(1j) * imaginary


def _klt(covariance: Array, word: int) -> tuple[Array, bytes]:
    """Principal directions, strongest first, as decoded, and their bytes."""
    _, vectors = np.linalg.eigh(covariance.astype(np.complex128))
    rows = vectors[:, ::-1].T.conj()
    words = np.rint(np.stack([np.real(rows), np.imag(rows)]) * word).astype(_word_type(word))
    return _orthonormal(words, word), words.tobytes()


def _unpack_klt(data: bytes, at: int, num: int, word: int) -> tuple[Array, int]:
    words = np.frombuffer(data, _word_type(word), 2 * num * num, at).reshape(2, num, num)
    return _orthonormal(words, word), at + words.nbytes


def _word_type(word: int) -> str:
    return "<i1" if word == ANTENNA_WORD else "<i2"


def _orthonormal(words: Array, word: int) -> Array:
    """The unitary matrix nearest to rounded directions."""
    left, _, right = np.linalg.svd((words[0] + 1j * words[1]) / word)
    return left @ right


def _is_correlated(values: Array, axis: int) -> bool:
    """Whether neighbours along an axis have the same sign, an effect of the FFT windows in centred phase."""
    if values.shape[axis] < 2:
        return False
    before, num = math.prod(values.shape[:axis]), values.shape[axis]
    flat = np.ascontiguousarray(values)
    flat = flat.view(flat.real.dtype).reshape(before, num, -1)
    first, second = flat[:, :-1], flat[:, 1:]
    # einsum copies nothing, vdot both sides
    product, energy, other = (
        float(np.einsum("nik,nik->", *pair)) for pair in ((first, second), (first, first), (second, second))
    )
    return bool(product > CORRELATED * math.sqrt(energy * other))
