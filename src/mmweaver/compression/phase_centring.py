"""Phase-centring: a phase rotation of each range and Doppler bin that makes a cube smooth along both axes.

The phase of the DFT of a window centred on sample N/2 rotates by -pi per bin: along range and Doppler a raw cube sits
at its grid's Nyquist frequency, where neither learning nor interpolation works. Referred to the middle of the window
instead, the response of a scatterer is real, and the cube is smooth.

`signal.cube` uses the *periodic* Hann window, which is exactly symmetric about sample N/2, so the phasor is
exp(+j pi r) exp(+j pi (d - M/2)). A symmetric window is centred on (N - 1)/2, which gives a factor (N - 1)/N; with a
periodic window that would leave a slope of 180/N degrees per bin. r counts range bins of the radar's full transform,
and d from zero Doppler, so cubes of radars with the same centre frequency agree after centring.
"""

from dataclasses import replace

import numpy as np
from jaxtyping import Complex

from mmweaver.compression.signal_field import Coordinates
from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.records import CubeGrid, RadarCube


def centring_phasor(config: RadarConfig, grid: CubeGrid) -> Complex[np.ndarray, "range doppler"]:
    """exp(+j pi r) exp(+j pi d) at the cells of a grid, with r and d in bins of the radar's own transforms."""
    range_bin = grid.range_m / config.range_resolution_m
    doppler_bin = grid.radial_velocity_mps / config.velocity_resolution_mps
    return np.exp(1j * np.pi * (range_bin[:, None] + doppler_bin[None, :])).astype(np.complex64)


def centring_phasor_at(config: RadarConfig, grid: CubeGrid, coordinates: Coordinates) -> Complex[np.ndarray, " point"]:
    """The same phasor at coordinates in cells of `grid`, the radar's native grid."""
    range_bin = grid.range_m[0] / config.range_resolution_m + coordinates[:, 1]
    doppler_bin = grid.radial_velocity_mps[0] / config.velocity_resolution_mps + coordinates[:, 2]
    return np.exp(1j * np.pi * (range_bin + doppler_bin)).astype(np.complex64)


def centred(cube: RadarCube) -> RadarCube:
    """The cube with its phase referred to the middle of the chirp and of the frame; lossless."""
    phasor = centring_phasor(cube.config, cube.grid)
    return replace(cube, values=cube.values * phasor[None, :, :, None])
