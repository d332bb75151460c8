"""Low-rank tensors with factors in 8 bits (CP in 16): truncated SVD, Tucker and CP."""

import zlib

import numpy as np

from mmweaver.core.records import RadarCube
from mmweaver.core.shapes import CubeValues
from studies.baselines.codec_interface import PEAK, Codec, KnobCodec, library

CP_STEPS = 300
TUCKER_STEPS = 3


class TruncatedSvd(KnobCodec):
    """Rank-k matrix of (frame and range) x (doppler and antenna). The parameter is the rank."""

    name = "svd"
    coarse, fine = 1.0, 300.0

    def at(self, values: CubeValues, knob: float, cube: RadarCube) -> bytes:
        left, size, right = _svd(values.reshape(values.shape[0] * values.shape[1], -1))
        rank = int(knob)
        return packed([left[:, :rank] * np.sqrt(size[:rank]), right[:rank] * np.sqrt(size[:rank])[:, None]])

    def back(self, data: bytes, like: RadarCube) -> np.ndarray:
        frames, num_range, num_doppler, antennas = like.grid.shape
        left, right = unpacked(data)
        return (left.reshape(frames * num_range, -1) @ right.reshape(-1, num_doppler * antennas)).reshape(
            like.grid.shape
        )


_cache: dict[int, tuple[np.ndarray, ...]] = {}


def _svd(matrix: np.ndarray) -> tuple[np.ndarray, ...]:
    """Cached for the last matrix: the bisection asks for the same one many times."""
    key = hash(matrix.tobytes())
    if key not in _cache:
        _cache.clear()
        _cache[key] = np.linalg.svd(matrix, full_matrices=False)
    return _cache[key]


class Tucker(KnobCodec):
    """Tucker (higher-order orthogonal iteration) in 8 bits; each axis keeps singular values above 1 / parameter."""

    name = "tucker"
    coarse, fine = 1.0, 1e4

    def at(self, values: CubeValues, knob: float, cube: RadarCube) -> bytes:
        least = np.linalg.norm(values) / knob
        ranks = [max(1, int((_strengths(values, axis) > least).sum())) for axis in range(values.ndim)]
        factors = [_leading(values, axis, rank) for axis, rank in enumerate(ranks)]
        for _ in range(TUCKER_STEPS):
            for axis, rank in enumerate(ranks):
                factors[axis] = _leading(_projected(values, factors, skip=axis), axis, rank)
        return packed([_projected(values, factors), *factors])

    def back(self, data: bytes, like: RadarCube) -> np.ndarray:
        core, *factors = unpacked(data)
        for axis, factor in enumerate(factors):
            core = np.moveaxis(np.tensordot(factor, core, (1, axis)), 0, axis)
        return core


class Cp(Codec):
    """CP by alternating least squares (tensorly), factors as float16; the rank is the largest that fits."""

    name = "cp"

    def encoded(self, cube: RadarCube, num_bytes: int) -> bytes | None:
        parafac = library("tensorly.decomposition").parafac

        rank = (num_bytes - PEAK.size) // (4 * sum(cube.values.shape))
        if rank < 1:
            return None
        peak = np.float32(np.abs(cube.values).max())
        start = "svd" if rank <= min(cube.values.shape) else "random"
        found = parafac(
            (cube.values / peak).astype(np.complex64), rank, n_iter_max=CP_STEPS, init=start, random_state=0, tol=1e-7
        )
        weight = np.asarray(found.weights) ** 0.25
        parts = [np.asarray(factor) * weight for factor in found.factors]
        parts = _balanced(parts)
        words = np.concatenate([np.ascontiguousarray(part, np.complex64).ravel() for part in parts]).view(np.float32)
        return PEAK.pack(float(peak)) + words.astype("<f2").tobytes()

    def decoded(self, data: bytes, like: RadarCube) -> CubeValues:
        (peak,) = PEAK.unpack_from(data)
        words = np.frombuffer(data[PEAK.size :], "<f2").astype(np.float32).view(np.complex64)
        rank = len(words) // sum(like.grid.shape)
        ends = np.cumsum([size * rank for size in like.grid.shape])[:-1]
        factors = [part.reshape(-1, rank) for part in np.split(words, ends)]
        return (np.einsum("tk,rk,dk,ak->trda", *factors, optimize=True) * peak).astype(np.complex64)


def _balanced(factors: list[np.ndarray]) -> list[np.ndarray]:
    """Each term's strength shared evenly by its factors, so that float16 holds them."""
    norms = [np.maximum(np.linalg.norm(factor, axis=0), 1e-30) for factor in factors]
    total = np.prod(norms, axis=0) ** (1 / len(factors))
    return [factor / norm * total for factor, norm in zip(factors, norms, strict=True)]


def _strengths(values: np.ndarray, axis: int) -> np.ndarray:
    flat = np.moveaxis(values, axis, 0).reshape(values.shape[axis], -1)
    return np.sqrt(np.maximum(np.linalg.eigvalsh(flat @ flat.conj().T), 0))


def _leading(values: np.ndarray, axis: int, rank: int) -> np.ndarray:
    flat = np.moveaxis(values, axis, 0).reshape(values.shape[axis], -1)
    _, vectors = np.linalg.eigh(flat @ flat.conj().T)
    return vectors[:, ::-1][:, :rank]


def _projected(values: np.ndarray, factors: list[np.ndarray], skip: int = -1) -> np.ndarray:
    for axis, factor in enumerate(factors):
        if axis != skip:
            values = np.moveaxis(np.tensordot(factor.conj(), values, (0, axis)), 0, axis)
    return values


def packed(parts: list[np.ndarray]) -> bytes:
    """Complex arrays in 8 bits a real number, each column of the last axis by its own scale, deflated."""
    blobs = [bytes([len(parts)])]
    for part in parts:
        flat = part.reshape(-1, part.shape[-1])
        scale = np.maximum(np.maximum(np.abs(np.real(flat)), np.abs(np.imag(flat))).max(axis=0), 1e-30)
        words = np.rint(np.stack([np.real(flat), np.imag(flat)]) / scale * 127).astype(np.int8)
        blobs += [bytes([part.ndim]), np.array(part.shape, "<u4").tobytes(), scale.astype("<f4").tobytes()]
        blobs.append(words.tobytes())
    return zlib.compress(b"".join(blobs), 9)


def unpacked(data: bytes) -> list[np.ndarray]:
    """The inverse of `packed`."""
    data = zlib.decompress(data)
    parts, at = [], 1
    for _ in range(data[0]):
        ndim = data[at]
        shape = np.frombuffer(data, "<u4", ndim, at + 1).tolist()
        at += 1 + 4 * ndim
        scale = np.frombuffer(data, "<f4", shape[-1], at)
        at += 4 * shape[-1]
        size = int(np.prod(shape))
        words = np.frombuffer(data, np.int8, 2 * size, at).reshape(2, -1, shape[-1]) * (scale / 127)
        at += 2 * size
        parts.append((words[0] + 1j * words[1]).astype(np.complex64).reshape(shape))
    return parts
