"""Views of signals that pages treat differently: somebody who breathes, noise alone, a single frame."""

from dataclasses import replace

import numpy as np

from mmweaver.core.boards import AWR1843
from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.records import CubeGrid, PointCloud, RadarCube
from mmweaver.core.seeding import stream
from mmweaver.signal.cube import doppler_weight, tdm_compensation
from mmweaver.viz.figure_data import FigureData

BREATHING_M = 1.5
FRAMES = 40


def noise_cube(config: RadarConfig, frames: int) -> RadarCube:
    """Noise of a power of 1 a cell, in the units of a recording."""
    grid = CubeGrid.of(config, frames)
    rng = stream(2, "noise")
    chirps = (rng.normal(size=grid.shape) + 1j * rng.normal(size=grid.shape)) / np.sqrt(2)
    weight = doppler_weight(config.num_loops)
    values = np.fft.fft(chirps * weight[:, None], axis=2) / np.linalg.norm(weight)
    return RadarCube(values=values.astype(np.complex64), grid=grid, config=config, scale=float("nan"))


def noise_view(config: RadarConfig = AWR1843, frames: int = 12) -> FigureData:
    """A recording of nothing."""
    none = np.zeros(0)
    points = PointCloud(frame=np.zeros(0, int), x_m=none, y_m=none, z_m=none, radial_velocity_mps=none, snr_db=none)
    return FigureData(title=f"{config.name}: noise", cube=noise_cube(config, frames), points=points)


def breathing_view(view: FigureData, amplitude: float = 100.0) -> FigureData:
    """A chest that moves by 2 mm, slower than the frame's loops can see."""
    cube = noise_cube(AWR1843, FRAMES)
    grid = cube.grid
    displacement_m = 1e-3 * np.sin(2 * np.pi * 0.3 * grid.frame_time_s)
    still = np.fft.fft(doppler_weight(AWR1843.num_loops))[:, None] * tdm_compensation(AWR1843)
    in_range = np.sinc((grid.range_m - BREATHING_M) / (2 * AWR1843.range_resolution_m))
    echo = amplitude * np.exp(4j * np.pi / grid.wavelength_m * displacement_m)
    values = cube.values + echo[:, None, None, None] * in_range[:, None, None] * still
    points = view.points.select(np.zeros(0, int))
    return FigureData(title="breathing", cube=replace(cube, values=values.astype(np.complex64)), points=points)
