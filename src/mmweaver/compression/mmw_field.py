"""A .mmw file as a signal field; its chunks are decoded when their frames are sampled."""

from dataclasses import replace
from functools import lru_cache
from pathlib import Path

import numpy as np
from jaxtyping import Complex

from mmweaver.compression.chunk import ChunkFrames, DecodedChunk
from mmweaver.compression.mmw_codec import grid_of_file, read_chunk
from mmweaver.compression.mmw_container import MmwFile
from mmweaver.core.records import CubeGrid
from mmweaver.core.shapes import CubeValues
from mmweaver.dsp.point_response import PointResponse
from mmweaver.fields.field import SignalField
from mmweaver.fields.sampling import Coordinates, coordinates_on
from mmweaver.fields.scatterers.scatterer_field import ScattererField

CHUNKS_KEPT = 4


class MmwField(SignalField):
    """Scatterers and static layer as in ScattererField, plus the residual, interpolated linearly between cells.

    Raises InputError where the file, or a chunk when it is read, is damaged.
    """

    def __init__(self, path: Path | str):
        self.file = MmwFile(path)
        header = self.file.header
        self.config, self.grid, self.scale = header.config, grid_of_file(self.file), header.scale
        self._starts = np.concatenate([[0], np.cumsum([record.num_frames for record in self.file.records])])
        self._part = lru_cache(maxsize=CHUNKS_KEPT)(self._read)

    @property
    def num_values(self) -> int:
        """Real numbers of the layers plus non-zero residual values; decodes the whole file."""
        total = 0
        for index in range(len(self._starts) - 1):
            chunk = read_chunk(self.file, index)
            total += chunk.num_residual_values
            if chunk.layers is not None:
                total += chunk.layers.num_values(chunk.frames.fit_window().response)
        return total

    def sample(self, coordinates: Coordinates) -> Complex[np.ndarray, " point"]:
        """Values at any coordinates (point, 4), complex64; see `SignalField`."""
        from scipy.ndimage import map_coordinates

        out = np.empty(len(coordinates), np.complex64)
        for index, chosen in self._by_chunk(coordinates[:, 0]):
            field, residual = self._part(index)
            local = coordinates[chosen] - np.array([self._starts[index], 0, 0, 0])
            values = np.zeros(len(local), np.complex64) if field is None else field.sample(local)
            if residual is not None:
                place = local.copy()
                place[:, 0] = np.clip(np.rint(place[:, 0]), 0, len(residual) - 1)
                parts = [map_coordinates(part, place.T, order=1) for part in (np.real(residual), np.imag(residual))]
                values = values + (parts[0] + 1j * parts[1]) * self._phasor_at(local)
            out[chosen] = values
        return out

    def on_grid(self, grid: CubeGrid) -> CubeValues:
        """Values at the cells of any grid of this radar; see `SignalField.on_grid`."""
        out = np.empty(grid.shape, np.complex64)
        axes = coordinates_on(self.grid, grid)
        response = PointResponse(self.config)
        phasor = response.phasor(response.axes(grid)).numpy()
        for index, chosen in self._by_chunk(axes[0]):
            field, residual = self._part(index)
            own = replace(grid, frame_time_s=grid.frame_time_s[chosen])
            values = np.zeros(own.shape, np.complex64) if field is None else field.on_grid(own)
            if residual is not None:
                nearest = np.clip(np.rint(axes[0][chosen]).astype(int) - self._starts[index], 0, len(residual) - 1)
                part = residual[nearest]
                for axis in (1, 2, 3):
                    part = np.moveaxis(np.tensordot(_lines(axes[axis], part.shape[axis]), part, (1, axis)), 0, axis)
                values = values + part * phasor
            out[chosen] = values
        return out

    def _by_chunk(self, frame: np.ndarray) -> list[tuple[int, np.ndarray]]:
        """Pairs of a chunk and the indices of the given frames that belong to it."""
        last = self._starts[-1] - 1
        index = np.searchsorted(self._starts, np.clip(np.rint(frame), 0, last), side="right") - 1
        return [(int(chunk), np.flatnonzero(index == chunk)) for chunk in np.unique(index)]

    def _read(self, index: int) -> tuple[ScattererField | None, np.ndarray | None]:
        """A chunk's scatterers, and its residual at the cells of the cube in centred phase; None where it has none."""
        chunk = read_chunk(self.file, index)
        field = None
        if chunk.layers is not None:
            frames = slice(self._starts[index], self._starts[index + 1])
            grid = replace(self.grid, frame_time_s=self.grid.frame_time_s[frames])
            field = ScattererField(chunk.layers, chunk.frames.fit_window(), grid, self.scale, chunk.peak)
        return field, _centred_residual(chunk)

    def _phasor_at(self, coordinates: Coordinates) -> np.ndarray:
        """Phasor (point,) from centred phase to the cube's phase at each coordinate."""
        response = PointResponse(self.config)
        axes = response.axes()
        range_bin = float(axes.range_bin[0]) + coordinates[:, 1]
        doppler_bin = float(axes.doppler_bin[0]) + coordinates[:, 2]
        delay = response.delay[np.clip(np.rint(coordinates[:, 3]).astype(int), 0, len(response.delay) - 1)]
        return np.exp(-1j * np.pi * (range_bin + doppler_bin) - 2j * np.pi * doppler_bin * delay)


def _centred_residual(chunk: DecodedChunk) -> np.ndarray | None:
    if chunk.exact is not None:
        values = chunk.exact
    elif chunk.residual is None:
        return None
    else:
        values = chunk.frames.cube_values(chunk.residual * np.float32(chunk.peak))
    return values * ChunkFrames.of(chunk.frames.config, len(values), 0).phasor.conj()


def _lines(cell: np.ndarray, num: int) -> np.ndarray:
    """Weights (sample, cell) of linear interpolation, clamped at the ends."""
    inside = np.clip(cell, 0, num - 1)
    return np.maximum(1 - np.abs(inside[:, None] - np.arange(num)), 0)


def open_mmw(path: Path | str) -> MmwField:
    """Opens a .mmw file as a field. Raises InputError where it is unreadable or damaged."""
    return MmwField(path)
