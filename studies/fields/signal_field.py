"""The interface of all fields: a radar sequence as a function of continuous coordinates."""

from abc import ABC, abstractmethod

from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.records import CubeGrid, RadarCube
from mmweaver.core.shapes import CubeValues
from studies.fields.sampling import finer_grid


class SignalField(ABC):
    """One radar sequence, f(frame, range, doppler, antenna) -> I + jQ, in the phase and scale of a RadarCube.

    Coordinates are in cells of the native grid (`grid`), fractions included: (frame, range bin, Doppler bin, antenna),
    the first cell of each axis at 0. `grid`, `config` and `scale` are those of the represented cube. Between bins, a
    field approximates the same radar's Fourier transforms there, windows and TDM compensation included; phase-centring
    is internal to a field.
    """

    config: RadarConfig
    grid: CubeGrid
    scale: float

    @property
    @abstractmethod
    def num_values(self) -> int:
        """Number of real parameters stored for this sequence (a complex number counts twice)."""

    @abstractmethod
    def on_grid(self, grid: CubeGrid) -> CubeValues:
        """Values at the cells of any grid, complex64 (frame, range, doppler, antenna).

        Raises InputError where an antenna of the grid lies off the line through the field's antennas.
        """

    def cube(self, grid: CubeGrid | None = None) -> RadarCube:
        """The field as a RadarCube, on its native grid or on another."""
        grid = self.grid if grid is None else grid
        return RadarCube(values=self.on_grid(grid), grid=grid, config=self.config, scale=self.scale)

    def finer(self, n_r: float = 1.0, n_d: float = 1.0, n_a: float = 1.0) -> RadarCube:
        """The field sampled n_r, n_d, n_a times finer along range, Doppler and antennas; see `finer_grid`."""
        return self.cube(finer_grid(self.grid, n_r=n_r, n_d=n_d, n_a=n_a))
