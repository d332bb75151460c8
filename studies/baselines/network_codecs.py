"""The paper's INR, its weights in 8 bits."""

import struct
import zlib

import numpy as np
import torch

from mmweaver.core.records import RadarCube
from mmweaver.core.shapes import CubeValues
from studies.baselines.codec_interface import Codec
from studies.paper.paper_inr import InrField
from studies.paper.single_signal import RECIPES, fit, inr_shape

ROW = 64  # so many weights share a scale
LEVELS = (127, 100, 80, 63)  # the finest that fits: scales take a little of the 8 bits a weight


class InrInBytes(Codec):
    """The INR of a recipe, fitted once a cube; only sizes that hold its 10,018 weights in 8 bits are possible."""

    def __init__(self, recipe: str):
        self.recipe = RECIPES[recipe]
        self.name = f"inr_{recipe}"
        self._last: tuple[int, InrField] | None = None

    def encoded(self, cube: RadarCube, num_bytes: int) -> bytes | None:
        key = id(cube)
        if self._last is None or self._last[0] != key:
            field = fit(cube, self.recipe).field
            assert isinstance(field, InrField)
            self._last = key, field
        field = self._last[1]
        parts = [field.theta.flatten(), field.gamma.flatten() - 1, field.beta.flatten()]
        weights = torch.cat(parts).numpy()
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
        shape = inr_shape(self.recipe, like.grid.shape)
        frames = len(like.grid.frame_time_s)
        theta, rest = np.split(weights, [shape.num_weights])
        gamma, beta = np.split(rest, 2)
        field = InrField(
            config=like.config, grid=like.grid, scale=like.scale, shape=shape, theta=torch.from_numpy(theta.copy()),
            gamma=torch.from_numpy(gamma.copy()).reshape(frames, 4, -1) + 1,
            beta=torch.from_numpy(beta.copy()).reshape(frames, 4, -1),
            amplitude=amplitude, is_centred=self.recipe.is_centred,
        )  # fmt: skip
        return field.on_grid(like.grid)


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
