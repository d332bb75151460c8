"""Compressors of libraries: SPERR on floats, blosc2 on rounded numbers, JPEG 2000 and JPEG XL on a mosaic of planes."""

import numpy as np

from mmweaver.core.records import RadarCube
from mmweaver.core.shapes import CubeValues
from studies.baselines.codec_interface import KnobCodec, library, merged, split


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


ZERO, SPAN = 32768, 32000


def mosaic(values: CubeValues) -> np.ndarray:
    """uint16 (frame and range, part and antenna and doppler), zero in the middle of the numbers."""
    planes = split(values)  # part and antenna, frame, range, doppler
    rows = planes.transpose(1, 2, 0, 3)
    rows = rows.reshape(rows.shape[0] * rows.shape[1], -1)
    return (np.rint(rows * SPAN) + ZERO).astype(np.uint16)


def values_of(picture: np.ndarray, like: RadarCube) -> np.ndarray:
    """The inverse of `mosaic`."""
    frames, num_range, num_doppler, antennas = like.grid.shape
    rows = (picture.astype(np.float32) - ZERO) / SPAN
    return merged(rows.reshape(frames, num_range, 2 * antennas, num_doppler).transpose(2, 0, 1, 3))


class Jpeg2000(KnobCodec):
    """JPEG 2000 (irreversible wavelet) to a given PSNR."""

    name = "jpeg2000"
    coarse, fine = 8.0, 140.0

    def at(self, values: CubeValues, knob: float, cube: RadarCube) -> bytes:
        imagecodecs = library("imagecodecs")

        return bytes(imagecodecs.jpeg2k_encode(mosaic(values), level=knob, codecformat="j2k", reversible=False))

    def back(self, data: bytes, like: RadarCube) -> np.ndarray:
        imagecodecs = library("imagecodecs")

        return values_of(np.asarray(imagecodecs.jpeg2k_decode(data)), like)


class JpegXl(KnobCodec):
    """JPEG XL at a given distance (25 is its coarsest)."""

    name = "jpegxl"
    coarse, fine = 1 / 25.0, 100.0

    def at(self, values: CubeValues, knob: float, cube: RadarCube) -> bytes:
        imagecodecs = library("imagecodecs")

        return bytes(imagecodecs.jpegxl_encode(mosaic(values), distance=1 / knob, effort=5, numthreads=1))

    def back(self, data: bytes, like: RadarCube) -> np.ndarray:
        imagecodecs = library("imagecodecs")

        return values_of(np.asarray(imagecodecs.jpegxl_decode(data, numthreads=1)).reshape(_size(like)), like)


def _size(like: RadarCube) -> tuple[int, int]:
    frames, num_range, num_doppler, antennas = like.grid.shape
    return frames * num_range, 2 * antennas * num_doppler
