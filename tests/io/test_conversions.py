"""Conversions of what has no people and no samples."""

import numpy as np
import pytest

from mmweaver.core.boards import BGT60
from mmweaver.core.records import CubeGrid, PointCloud, RadarCube
from mmweaver.io.conversions import to_dataset, to_tensors

META = {"text": "silence", "seed": 0, "method": "none", "version": "0", "radar": {"name": "bgt60"}}


def silence() -> tuple[RadarCube, PointCloud]:
    grid = CubeGrid.of(BGT60, 2)
    none = np.zeros(0)
    points = PointCloud(frame=np.zeros(0, int), x_m=none, y_m=none, z_m=none, radial_velocity_mps=none, snr_db=none)
    return RadarCube(values=np.zeros(grid.shape, np.complex64), grid=grid, config=BGT60, scale=float("nan")), points


def test_nobody_and_no_samples():
    cube, points = silence()
    tensors = to_tensors(cube, points, (), None)
    assert "joints_m" not in tensors
    assert "adc" not in tensors
    assert tensors["points"].shape == (0, 6)
    pytest.importorskip("xarray")
    found = to_dataset(cube, points, (), None, META)
    assert "joints" not in found
    assert found.cube.shape == cube.values.shape
    assert repr(points) == "PointCloud(points: 0, frames: 0, x: none, y: none, z: none, velocity: none, SNR: none)"
