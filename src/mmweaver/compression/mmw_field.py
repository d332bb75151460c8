"""A .mmw file as a signal field; its chunks are decoded when their frames are sampled."""

from collections.abc import Iterator
from dataclasses import replace
from functools import lru_cache
from pathlib import Path

import numpy as np
from jaxtyping import Complex
from scipy.ndimage import map_coordinates

from mmweaver.compression.mmw_codec import grid_of_file, read_chunk
from mmweaver.compression.mmw_container import MmwFile
from mmweaver.compression.scatterer_field import ScattererField, line_weights
from mmweaver.compression.signal_field import Coordinates, SignalField, cells_at, coordinates_on
from mmweaver.core.records import CubeGrid
from mmweaver.core.shapes import CubeValues
from mmweaver.signal.point_response import PointResponse

CHUNKS_KEPT = 4


def open_mmw(path: Path | str) -> "MmwField":
    """Opens a .mmw file as a field that can be sampled anywhere.

    Args:
        path: of the file; of one that was cut short, the frames of its whole chunks are read.

    Raises:
        InputError: where the file is unreadable or damaged; a damaged chunk is noticed when it is sampled.
    """
    return MmwField(path)


class MmwField(SignalField):
    """Scatterers and static layer as in ScattererField, plus the residual, interpolated linearly between cells."""

    def __init__(self, path: Path | str):
        self.file = MmwFile(path)
        self.config, self.grid, self.scale = self.file.header.config, grid_of_file(self.file), self.file.header.scale
        self.response = PointResponse(self.config)
        self._starts = np.cumsum([0, *(record.num_frames for record in self.file.records)])
        self._part = lru_cache(maxsize=CHUNKS_KEPT)(self._read)

    @property
    def num_values(self) -> int:
        """Real numbers of the layers plus non-zero residual values; decodes the whole file."""
        chunks = [read_chunk(self.file, index) for index in range(len(self.file.records))]
        return sum(chunk.num_residual_values for chunk in chunks) + sum(
            chunk.layers.num_values(chunk.frames.fit_window().response) for chunk in chunks if chunk.layers is not None
        )

    def sample(self, coordinates: Coordinates) -> Complex[np.ndarray, " point"]:
        """Values at any coordinates; see `SignalField.sample`."""
        axes = self.response.axes(cells_at(self.grid, coordinates))
        phasor = self.response.phasor(axes, is_grid=False).numpy()
        out = np.zeros(len(coordinates), np.complex64)
        for chosen, first, field, residual in self._parts(coordinates[:, 0]):
            place = coordinates[chosen] - [first, 0, 0, 0]
            if field is not None:
                out[chosen] = field.sample(place)
            if residual is not None:
                place[:, 0] = np.rint(place[:, 0])
                out[chosen] += map_coordinates(residual, place.T, order=1, mode="nearest") * phasor[chosen]
        return out

    def values_on(self, grid: CubeGrid) -> CubeValues:
        """Values at the cells of any grid of this radar; see `SignalField.values_on`."""
        frame, *cells = coordinates_on(self.grid, grid)
        phasor = self.response.phasor(self.response.axes(grid)).numpy()
        out = np.zeros(grid.shape, np.complex64)
        for chosen, first, field, residual in self._parts(frame):
            if field is not None:
                out[chosen] = field.values_on(replace(grid, frame_time_s=grid.frame_time_s[chosen]))
            if residual is not None:
                part = residual[np.clip(np.rint(frame[chosen]).astype(int) - first, 0, len(residual) - 1)]
                for axis, cell in enumerate(cells, start=1):
                    weights = line_weights(np.clip(cell, 0, part.shape[axis] - 1), part.shape[axis]).numpy()
                    part = np.moveaxis(np.tensordot(weights, part, (1, axis)), 0, axis)
                out[chosen] += part * phasor
        return out

    def _parts(self, frame: np.ndarray) -> Iterator[tuple[np.ndarray, int, ScattererField | None, np.ndarray | None]]:
        """The chunks of the given frames: indices of its frames among them, its first frame, scatterers, residual."""
        index = np.searchsorted(self._starts, np.clip(np.rint(frame), 0, self._starts[-1] - 1), side="right") - 1
        for chunk in np.unique(index):
            yield np.flatnonzero(index == chunk), int(self._starts[chunk]), *self._part(int(chunk))

    def _read(self, index: int) -> tuple[ScattererField | None, np.ndarray | None]:
        """A chunk's scatterers, and its residual at the cells of the cube in centred phase; None where it has none."""
        chunk, field, values = read_chunk(self.file, index), None, None
        if chunk.layers is not None:
            frames = slice(self._starts[index], self._starts[index + 1])
            grid = replace(self.grid, frame_time_s=self.grid.frame_time_s[frames])
            field = ScattererField(chunk.layers, chunk.frames.fit_window(), grid, self.scale, chunk.peak)
        if chunk.exact is not None:
            values = chunk.exact
        elif chunk.residual is not None:
            values = chunk.frames.cube_values(chunk.residual * np.float32(chunk.peak))
        if values is not None:
            values = values * self.response.phasor(self.response.axes()).numpy().conj()
        return field, values
