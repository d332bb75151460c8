"""The interface of every codec, ours and the baselines: a cube becomes at most so many bytes, and a cube again."""

import importlib
import struct
from abc import ABC, abstractmethod
from typing import Any

import numpy as np

from mmweaver.core.optional_packages import need
from mmweaver.core.records import RadarCube
from mmweaver.core.shapes import CubeValues

TRIALS = 13
CLOSE_ENOUGH = 0.985
PEAK = struct.Struct("<f")


def library(name: str) -> Any:
    """A module of the extra `codecs`. Raises InputError where it is not installed."""
    need("codecs", "this codec", name.partition(".")[0])
    return importlib.import_module(name)


class Codec(ABC):
    """A codec; shared code scores it.

    It decodes from its own bytes alone, given the shape and the radar of the cube as an empty cube (`like`).
    """

    name: str

    @abstractmethod
    def encoded(self, cube: RadarCube, num_bytes: int) -> bytes | None:
        """At most `num_bytes` bytes, the best quality that fits; None where it cannot be so small."""

    @abstractmethod
    def decoded(self, data: bytes, like: RadarCube) -> CubeValues:
        """The values of the cube (frame, range, doppler, antenna), complex64."""


class KnobCodec(Codec):
    """A codec with one quality parameter, set by bisection on a log scale to the largest result that fits.

    It codes the cube divided by its largest magnitude, a float32 that is part of the bytes.
    """

    coarse: float
    fine: float

    @abstractmethod
    def at(self, values: CubeValues, knob: float, cube: RadarCube) -> bytes:
        """Bytes of values (frame, range, doppler, antenna) of magnitude at most 1, at a setting of the parameter."""

    @abstractmethod
    def back(self, data: bytes, like: RadarCube) -> np.ndarray:
        """Values (frame, range, doppler, antenna) decoded from the bytes of `at`."""

    def encoded(self, cube: RadarCube, num_bytes: int) -> bytes | None:
        peak = np.float32(np.abs(cube.values).max())
        values = (cube.values / peak).astype(np.complex64)
        best: bytes | None = None
        low, high = np.log(self.coarse), np.log(self.fine)
        for trial in range(TRIALS):
            knob = low if trial == 0 else (low + high) / 2
            data = self.at(values, float(np.exp(knob)), cube)
            if PEAK.size + len(data) <= num_bytes:
                best, low = data, knob
                if PEAK.size + len(data) >= CLOSE_ENOUGH * num_bytes:
                    break
            elif trial == 0:
                return None
            else:
                high = knob
        return None if best is None else PEAK.pack(float(peak)) + best

    def decoded(self, data: bytes, like: RadarCube) -> CubeValues:
        (peak,) = PEAK.unpack_from(data)
        return (self.back(data[PEAK.size :], like) * peak).astype(np.complex64)


def split(values: CubeValues) -> np.ndarray:
    """Real and imaginary part of each antenna as planes: float32 (2 antenna, frame, range, doppler)."""
    planes = np.moveaxis(values, 3, 0)
    return np.concatenate([np.real(planes), np.imag(planes)]).astype(np.float32)


def merged(planes: np.ndarray) -> np.ndarray:
    """The inverse of `split`."""
    real, imaginary = np.split(planes, 2)
    return np.moveaxis(real + 1j * imaginary, 0, 3)
