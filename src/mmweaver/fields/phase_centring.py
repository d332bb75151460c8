"""Phase-centring: a turn of each range and Doppler bin that makes a cube smooth along both axes.

The DFT of a window that is centred on sample N/2 turns by -pi from one bin to the next: along range and Doppler a raw
cube sits at the highest frequency its grid can hold, where nothing learns and nothing interpolates. Counted from the
middle of the window instead, the response of a scatterer is real, and the cube is smooth.

`dsp.cube` windows with the *periodic* Hann, which is symmetric about sample N/2 exactly, so the turn is
exp(+j pi r) exp(+j pi (d - M/2)). A symmetric window has its middle at (N - 1)/2, which gives the paper's issue text
(N - 1)/N; with a periodic window that would leave a slope of 180/N degrees a bin. r counts range bins of the radar,
not of the kept part, and d from zero Doppler, so cubes of radars with one centre frequency agree after centring.
"""

from dataclasses import replace

import numpy as np
from jaxtyping import Complex

from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.records import CubeGrid, RadarCube
from mmweaver.fields.sampling import Coordinates


def centring_turn(config: RadarConfig, grid: CubeGrid) -> Complex[np.ndarray, "range doppler"]:
    """exp(+j pi r) exp(+j pi d) at the cells of a grid, r and d in bins of the radar's own transforms, zero at zero."""
    range_bin = grid.range_m / config.range_resolution_m
    doppler_bin = grid.radial_velocity_mps / config.velocity_resolution_mps
    return np.exp(1j * np.pi * (range_bin[:, None] + doppler_bin[None, :])).astype(np.complex64)


def centring_turn_at(config: RadarConfig, grid: CubeGrid, coordinates: Coordinates) -> Complex[np.ndarray, " point"]:
    """The same at coordinates that count cells of `grid`, the radar's own."""
    range_bin = grid.range_m[0] / config.range_resolution_m + coordinates[:, 1]
    doppler_bin = grid.radial_velocity_mps[0] / config.velocity_resolution_mps + coordinates[:, 2]
    return np.exp(1j * np.pi * (range_bin + doppler_bin)).astype(np.complex64)


def centred(cube: RadarCube) -> RadarCube:
    """The cube with its phase counted from the middle of the chirp and of the frame; unitary, so nothing is lost."""
    turn = centring_turn(cube.config, cube.grid)
    return replace(cube, values=cube.values * turn[None, :, :, None])


def uncentred(cube: RadarCube) -> RadarCube:
    """The inverse of `centred`."""
    turn = centring_turn(cube.config, cube.grid).conj()
    return replace(cube, values=cube.values * turn[None, :, :, None])
