"""General compressors of arrays of floats: SZ3, SPERR, ZFP, and blosc2 on quantised numbers."""

import math

import numpy as np

from mmweaver.core.records import RadarCube
from mmweaver.core.shapes import CubeValues
from studies.baselines.codec_interface import KnobCodec, library, merged, split


class Sz3(KnobCodec):
    """SZ3 with an absolute error bound; the best of three layouts (its predictors follow the axes)."""

    name = "sz3"
    coarse, fine = 1.0, 1e-5

    def encoded(self, cube: RadarCube, num_bytes: int) -> bytes | None:
        best, least = None, math.inf
        for self.layout in SZ3_LAYOUTS:
            data = super().encoded(cube, num_bytes)
            if data is not None:
                error = float(np.sum(np.abs(self.decoded(data, cube) - cube.values) ** 2))
                best, least = (data, error) if error < least else (best, least)
        return best

    def at(self, values: CubeValues, knob: float, cube: RadarCube) -> bytes:
        imagecodecs = library("imagecodecs")

        planes = _laid(split(values), self.layout)
        return bytes([self.layout]) + bytes(imagecodecs.sz3_encode(planes, mode="abs", abs=knob))

    def back(self, data: bytes, like: RadarCube) -> np.ndarray:
        imagecodecs = library("imagecodecs")

        frames, num_range, num_doppler, antennas = like.grid.shape
        shape = (2 * antennas, frames, num_range, num_doppler)
        laid = _laid(np.zeros(shape, np.float32), data[0]).shape
        planes = np.asarray(imagecodecs.sz3_decode(data[1:], shape=laid, dtype=np.float32)).reshape(laid)
        return merged(planes.transpose(3, 2, 0, 1) if data[0] == 2 else planes.reshape(shape))


SZ3_LAYOUTS = (0, 1, 2)  # one line; pictures; range and Doppler first


def _laid(planes: np.ndarray, layout: int) -> np.ndarray:
    if layout == 2:
        return np.ascontiguousarray(planes.transpose(2, 3, 1, 0))
    return planes.ravel() if layout == 0 else planes.reshape(-1, *planes.shape[2:])


class Sperr(KnobCodec):
    """SPERR at a given number of bits a point, on (part, antenna and frame, range, doppler)."""

    name = "sperr"
    coarse, fine = 1e-3, 16.0

    def at(self, values: CubeValues, knob: float, cube: RadarCube) -> bytes:
        imagecodecs = library("imagecodecs")

        planes = split(values)
        return bytes(imagecodecs.sperr_encode(planes.reshape(-1, *planes.shape[2:]), knob, "bpp", numthreads=1))

    def back(self, data: bytes, like: RadarCube) -> np.ndarray:
        imagecodecs = library("imagecodecs")

        frames, num_range, num_doppler, antennas = like.grid.shape
        planes = np.asarray(imagecodecs.sperr_decode(data, numthreads=1))
        return merged(planes.reshape(2 * antennas, frames, num_range, num_doppler))


class Zfp(KnobCodec):
    """ZFP with an absolute error bound, four-dimensional."""

    name = "zfp"
    coarse, fine = 8.0, 1e-6

    def at(self, values: CubeValues, knob: float, cube: RadarCube) -> bytes:
        imagecodecs = library("imagecodecs")

        return bytes(imagecodecs.zfp_encode(split(values), knob, mode="a", numthreads=1))

    def back(self, data: bytes, like: RadarCube) -> np.ndarray:
        imagecodecs = library("imagecodecs")

        return merged(np.asarray(imagecodecs.zfp_decode(data)))


class Blosc2(KnobCodec):
    """Values rounded to a step, as int16, bit-shuffled and compressed by zstd."""

    name = "blosc2"
    coarse, fine = 1.0, 1 / 32000

    def at(self, values: CubeValues, knob: float, cube: RadarCube) -> bytes:
        blosc2 = library("blosc2")

        levels = np.rint(split(values) / knob).astype(np.int16)
        packed = blosc2.compress2(
            levels.tobytes(), codec=blosc2.Codec.ZSTD, clevel=9, typesize=2, filters=[blosc2.Filter.BITSHUFFLE],
            nthreads=1, blocksize=1 << 20,
        )  # fmt: skip
        return np.float32(knob).tobytes() + bytes(packed)

    def back(self, data: bytes, like: RadarCube) -> np.ndarray:
        blosc2 = library("blosc2")

        frames, num_range, num_doppler, antennas = like.grid.shape
        step = np.frombuffer(data[:4], np.float32)[0]
        levels = np.frombuffer(blosc2.decompress2(data[4:]), np.int16)
        return merged(levels.reshape(2 * antennas, frames, num_range, num_doppler) * step)
