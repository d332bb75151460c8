"""The page exists, has its size, and shows something in every panel."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from mmweaver.core.presets import AWR1843, BGT60, PRESETS
from mmweaver.core.records import CubeGrid, PointCloud, RadarCube
from mmweaver.figures.figure_data import FigureData
from mmweaver.figures.preview import draw_preview
from tests.figures.views import breathing_view, noise_view


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
        assert colourful[rows, columns].mean() > 0.001, (rows, columns)


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


def titles(view: FigureData) -> list[str]:
    return [axes.get_title(loc="left") for axes in draw_preview(view, None).axes]


def test_power_has_one_scale_and_a_row_one_colour_bar(view: FigureData):
    figure = draw_preview(view, None)
    limits = {
        image.get_clim()
        for axes in figure.axes for image in axes.images
        if image.get_array().ndim == 2 and axes.get_title(loc="left")
    }  # fmt: skip
    assert limits == {(view.scale.low_db, view.scale.high_db)}
    bars = [child.get_ylabel() for axes in figure.axes for child in axes.child_axes if child.get_ylabel()]
    assert bars == ["dBm", "dBm", "radial velocity (m/s), away +"]


def test_noise_looks_empty(view: FigureData, tmp_path: Path):
    draw_preview(noise_view(), tmp_path / "noise.png")
    draw_preview(replace(view, aligned=None, poses=(), motions=()), tmp_path / "walk.png")
    panels = slice(90, 650), slice(60, 1080)
    page = [pixels(tmp_path / name)[panels] for name in ("noise.png", "walk.png")]
    yellow = [((one[..., 0] > 200) & (one[..., 2] < 120)).sum() for one in page]
    assert yellow[0] == 0
    assert yellow[1] > 500


def test_a_single_frame_has_profiles(view: FigureData):
    grid = replace(view.cube.grid, frame_time_s=view.cube.grid.frame_time_s[:1])
    cube = replace(view.cube, values=view.cube.values[:1], grid=grid)
    shown = titles(replace(view, cube=cube, points=view.points.select(view.points.frame == 0), aligned=None, poses=()))
    assert shown[0].startswith("Range profile")
    assert shown[1].startswith("Doppler profile")
    assert not any("over time" in title for title in shown)


def test_breathing_shows_its_displacement(view: FigureData):
    shown = titles(breathing_view(view))
    assert "change over frames" in shown[0]
    assert shown[1].startswith("Displacement")


@pytest.mark.parametrize(("radar", "has_map"), [("awr1843", False), ("iwr6843aop", True), ("xwr1642boost", False)])
def test_only_arrays_that_resolve_elevation_have_a_map_of_it(radar: str, has_map: bool):
    config = replace(PRESETS[radar], num_loops=8, num_range_bins=16)
    shown = titles(noise_view(config, 2))
    assert any(title.startswith("Range-elevation") for title in shown) == has_map
    assert ("Points over time (no elevation)" in shown) == (radar == "xwr1642boost")


def test_no_label_is_cut_off_or_over_another(view: FigureData):
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.text import Text

    far = replace(AWR1843, first_range_bin=0, num_range_bins=256, num_loops=8)
    aop = replace(PRESETS["iwr6843aop"], num_loops=8)
    for shown in (view, breathing_view(view), noise_view(BGT60, 3), noise_view(far, 1), noise_view(aop, 3)):
        figure = draw_preview(shown, None)
        canvas = FigureCanvasAgg(figure)
        canvas.draw()
        boxes = []
        for axes in (one for whole in figure.axes for one in (whole, *whole.child_axes)):
            titled = [text for text in axes.findobj(Text) if text.get_text() == axes.get_title(loc="left")]
            for text in (*axes.texts, axes.xaxis.label, axes.yaxis.label, *titled):
                if text.get_text():
                    boxes.append((text.get_text(), text.get_window_extent(canvas.get_renderer())))
        for name, box in boxes:
            inside = box.x0 >= 0 and box.y0 >= 0 and box.x1 <= figure.bbox.width and box.y1 <= figure.bbox.height
            assert inside, (shown.title, name, box)
        for at, (name, box) in enumerate(boxes):
            for other, place in boxes[at + 1 :]:
                across = min(box.x1, place.x1) - max(box.x0, place.x0)
                up = min(box.y1, place.y1) - max(box.y0, place.y0)
                assert min(across, up) < 2, (shown.title, name, other)
