from dataclasses import replace

import numpy as np
import pytest
import torch

from mmweaver.compression.scatterers.fit_window import FitWindow, overlap_hop
from mmweaver.core.records import AdcCube, CubeGrid, RadarCube
from mmweaver.core.seeding import stream
from mmweaver.signal.cube import radar_cube
from tests.compression.echoes import SMALL, crowd, error_db


def overlapping(hop: int = 3, num_frames: int = 6) -> RadarCube:
    """Windows of 16 loops, `hop` apart, of one long frame of noise."""
    long = replace(SMALL, num_loops=64)
    shape = (64, long.num_tx, long.num_rx, long.num_samples)
    noise = stream(1, "long frame").normal(size=(*shape, 2))
    adc = noise[..., 0] + 1j * noise[..., 1]
    windows = np.stack([adc[hop * at : hop * at + 16] for at in range(num_frames)]).astype(np.complex64)
    cube = radar_cube(AdcCube(samples=windows, config=SMALL, scale=1.0))
    grid = replace(cube.grid, frame_time_s=np.arange(num_frames) * hop * SMALL.loop_period_s)
    return replace(cube, grid=grid)


@pytest.mark.parametrize("hop", [3, 4, 7])
def test_overlapping_windows_form_one_long_frame_and_are_recovered(hop: int):
    cube = overlapping(hop)
    assert overlap_hop(cube) == hop
    fit_window = FitWindow.of(SMALL, 6, hop)
    working = fit_window.working(cube.values)
    assert working.shape == (1, 24, 16 + 5 * hop, 12)
    assert error_db(fit_window.cube_values(working), cube.values) < -100


def test_an_error_in_the_long_frame_has_the_energy_it_has_in_the_cube():
    """So the fitter minimises the cube's own error: the ratio of two errors is the same on both sides."""
    fit_window = FitWindow.of(SMALL, 6, 3)
    rng = stream(2, "errors")
    energy = []
    for _ in range(3):
        parts = rng.normal(size=(2, 1, 24, 31, 12))
        # loops at which the long window is zero hold nothing
        error = fit_window.working(
            fit_window.cube_values(torch.from_numpy(parts[0] + 1j * parts[1]).to(torch.complex64))
        )
        cube = fit_window.cube_values(error)
        energy.append(float(error.abs().square().sum()) / float(np.sum(np.abs(cube) ** 2)))
    assert np.ptp(energy) < 1e-4 * energy[0]


def test_frames_without_shared_chirps_stay_separate():
    assert overlap_hop(crowd(num_frames=2)) == 0
    cube = overlapping()
    lying = replace(cube, values=cube.values[::-1].copy())  # times say overlap, values do not
    assert overlap_hop(lying) == 0
    odd = replace(cube, grid=replace(CubeGrid.of(SMALL, 6), frame_time_s=np.arange(6) * 3.3 * SMALL.loop_period_s))
    assert overlap_hop(odd) == 0
