"""The page exists, has its size, and shows something in every panel."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from mmweaver.core.presets import BGT60
from mmweaver.core.records import CubeGrid, PointCloud, RadarCube
from mmweaver.figures.figure_data import FigureData
from mmweaver.figures.preview import draw_preview


def pixels(path: Path) -> np.ndarray:
    return np.asarray(Image.open(path).convert("RGB")).astype(int)


def test_the_page_with_photo(view: FigureData, tmp_path: Path):
    draw_preview(view, tmp_path / "a.png")
    page = pixels(tmp_path / "a.png")
    assert page.shape == (900, 1600, 3)
    colourful = np.ptp(page, axis=2) > 40
    for rows, columns in ((slice(0, 650), slice(0, 800)), (slice(0, 360), slice(800, 1200)),
                          (slice(0, 360), slice(1200, 1600)), (slice(360, 640), slice(800, 1200)),
                          (slice(360, 640), slice(1200, 1600)), (slice(640, 900), slice(0, 400)),
                          (slice(640, 900), slice(400, 800)), (slice(640, 900), slice(800, 1200)),
                          (slice(640, 900), slice(1200, 1600))):  # fmt: skip
        assert colourful[rows, columns].mean() > 0.002, (rows, columns)


def test_the_photo_is_in_the_page(view: FigureData, tmp_path: Path):
    draw_preview(view, tmp_path / "a.png")
    grey = (pixels(tmp_path / "a.png")[:, :800] == 120).all(axis=2)
    assert grey.sum() > 100_000


def test_the_page_of_a_recording_has_no_photo(view: FigureData, tmp_path: Path):
    draw_preview(replace(view, aligned=None, poses=(), motions=()), tmp_path / "a.png")
    page = pixels(tmp_path / "a.png")
    assert page.shape == (700, 1600, 3)
    assert not (page == 120).all(axis=2).sum() > 1000


@pytest.mark.parametrize("frames", [1, 2])
def test_a_zero_cube_of_another_radar_is_drawn(frames: int, tmp_path: Path):
    grid = CubeGrid.of(BGT60, frames)
    cube = RadarCube(values=np.zeros(grid.shape, np.complex64), grid=grid, config=BGT60, scale=float("nan"))
    none = np.zeros(0)
    points = PointCloud(frame=np.zeros(0, int), x_m=none, y_m=none, z_m=none, radial_velocity_mps=none, snr_db=none)
    draw_preview(FigureData(title="silence", cube=cube, points=points), tmp_path / "a.png")
    assert pixels(tmp_path / "a.png").std() > 5


def test_the_same_view_gives_the_same_bytes(view: FigureData, tmp_path: Path):
    draw_preview(view, tmp_path / "a.png")
    draw_preview(view, tmp_path / "b.png")
    assert (tmp_path / "a.png").read_bytes() == (tmp_path / "b.png").read_bytes()
