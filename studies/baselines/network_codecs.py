"""The paper's INR, its weights in 8 bits."""

import struct
import zlib

import numpy as np
import torch
from torch.nn.utils import parameters_to_vector, vector_to_parameters

from mmweaver.core.records import RadarCube
from mmweaver.core.shapes import CubeValues
from mmweaver.inr import InrField, ModulatedINR
from mmweaver.inr.fitting import NUM_VALUES, layers_network
from studies.baselines.codec_interface import Codec
from studies.fields.inr_variants import INRS, fit_inr

ROW = 64  # so many weights share a scale
LEVELS = (127, 100, 80, 63)  # the finest that fits: scales take a little of the 8 bits a weight


class InrInBytes(Codec):
    """A modulated INR, fitted once per cube; only sizes that hold its 10,018 weights in 8 bits are possible."""

    def __init__(self, name: str):
        _, self.options = INRS[name]
        self.inr, self.name = name, f"inr_{name}"
        self._last: tuple[int, InrField] | None = None

    def encoded(self, cube: RadarCube, num_bytes: int) -> bytes | None:
        key = id(cube)
        if self._last is None or self._last[0] != key:
            self._last = key, fit_inr(cube, self.inr)[0]
        field = self._last[1]
        weights = (parameters_to_vector(field.network.parameters()) - self._identity(cube)).numpy()
        if num_bytes >= 2 * len(weights) + 8:
            words = b"\x02" + weights.astype("<f2").tobytes()
        else:
            words = next((w for w in map(_packed, (weights,) * len(LEVELS), LEVELS) if len(w) + 4 <= num_bytes), b"")
        return struct.pack("<f", field.amplitude) + words if words else None

    def decoded(self, data: bytes, like: RadarCube) -> CubeValues:
        (amplitude,) = struct.unpack_from("<f", data)
        weights = (
            np.frombuffer(data[5:], "<f2").astype(np.float32) if data[4] == 2 else _whole(zlib.decompress(data[5:]))
        )
        network = layers_network("modulated", like.grid.shape, NUM_VALUES, self.options).requires_grad_(False)
        vector_to_parameters(torch.from_numpy(weights.copy()) + self._identity(like), network.parameters())
        field = InrField(
            network, config=like.config, grid=like.grid, scale=like.scale, amplitude=amplitude,
            is_centred=self.options.is_centred,
        )  # fmt: skip
        return field.cube(like.grid).values

    def _identity(self, cube: RadarCube) -> torch.Tensor:
        """What a network has before training where it does not learn: ones for gamma, zeros elsewhere."""
        network = layers_network("modulated", cube.grid.shape, NUM_VALUES, self.options).requires_grad_(False)
        assert isinstance(network, ModulatedINR)
        network.theta.zero_()
        return parameters_to_vector(network.parameters())


def _packed(weights: np.ndarray, levels: int) -> bytes:
    return b"\x01" + zlib.compress(_rounded(weights, levels), 9)


def _rounded(weights: np.ndarray, most: int) -> bytes:
    """Integers of magnitude at most `most`, each ROW of them with one scale."""
    rows = np.pad(weights, (0, -len(weights) % ROW)).reshape(-1, ROW)
    scale = (np.abs(rows).max(axis=1) / most + 1e-12).astype("<f2")
    levels = np.clip(np.rint(rows / np.maximum(scale.astype(np.float32), 1e-7)[:, None]), -most, most).astype(np.int8)
    return struct.pack("<I", len(weights)) + scale.tobytes() + levels.tobytes()


def _whole(data: bytes) -> np.ndarray:
    (count,) = struct.unpack_from("<I", data)
    rows = -(-count // ROW)
    scale = np.maximum(np.frombuffer(data, "<f2", rows, 4).astype(np.float32), 1e-7)
    levels = np.frombuffer(data, np.int8, rows * ROW, 4 + 2 * rows).reshape(rows, ROW)
    return (levels * scale[:, None]).astype(np.float32).ravel()[:count]
