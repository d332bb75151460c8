"""The page exists, has its size, shows something in every panel, and no label lies over another."""

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image

from mmweaver.core.boards import AWR1843, BGT60, PRESETS
from mmweaver.core.records import CubeGrid, PointCloud, RadarCube
from mmweaver.viz.figure_data import FigureData
from mmweaver.viz.preview import draw_preview
from tests.viz.views import breathing_view, noise_view


def drawn(view: FigureData, path: Path) -> np.ndarray:
    draw_preview(view, path)
    return np.asarray(Image.open(path).convert("RGB")).astype(int)


def test_the_page_with_photo(view: FigureData, tmp_path: Path):
    page = drawn(view, tmp_path / "a.png")
    assert page.shape == (900, 1600, 3)
    colourful = np.ptp(page, axis=2) > 40
    for rows, columns in ((slice(0, 650), slice(0, 800)), (slice(0, 360), slice(800, 1200)),
                          (slice(0, 360), slice(1200, 1600)), (slice(360, 640), slice(800, 1200)),
                          (slice(360, 640), slice(1200, 1600)), (slice(640, 900), slice(0, 400)),
                          (slice(640, 900), slice(400, 800)), (slice(640, 900), slice(800, 1200)),
                          (slice(640, 900), slice(1200, 1600))):  # fmt: skip
        assert colourful[rows, columns].mean() > 0.001, (rows, columns)
    assert (page[:, :800] == 120).all(axis=2).sum() > 100_000, "the grey photo is in it"
    draw_preview(view, tmp_path / "b.png")
    assert (tmp_path / "a.png").read_bytes() == (tmp_path / "b.png").read_bytes()


def test_the_page_of_a_recording_has_no_photo_and_noise_looks_empty(view: FigureData, tmp_path: Path):
    walk = drawn(replace(view, aligned=None, poses=(), motions=()), tmp_path / "walk.png")
    assert walk.shape == (700, 1600, 3)
    assert not (walk == 120).all(axis=2).sum() > 1000
    panels = slice(90, 650), slice(60, 1080)
    pages = [one[panels] for one in (drawn(noise_view(), tmp_path / "noise.png"), walk)]
    yellow = [((one[..., 0] > 200) & (one[..., 2] < 120)).sum() for one in pages]
    assert yellow[0] == 0
    assert yellow[1] > 500


def test_a_zero_cube_of_another_radar_is_drawn(tmp_path: Path):
    grid = CubeGrid.of(BGT60, 1)
    cube = RadarCube(values=np.zeros(grid.shape, np.complex64), grid=grid, config=BGT60, scale=float("nan"))
    none = np.zeros(0)
    points = PointCloud(frame=np.zeros(0, int), x_m=none, y_m=none, z_m=none, radial_velocity_mps=none, snr_db=none)
    assert drawn(FigureData(title="silence", cube=cube, points=points), tmp_path / "a.png").std() > 5


FAR = replace(AWR1843, first_range_bin=0, num_range_bins=256, num_loops=8)
SMALL = {name: replace(PRESETS[name], num_loops=8, num_range_bins=16) for name in ("iwr6843aop", "xwr1642boost")}
WALK = ("Range over time", "Micro-Doppler", "Range-Doppler", "Range profile", "Moving points, side")


@pytest.mark.parametrize(
    ("kind", "panels"),
    [
        ("walk", WALK),
        ("two people", ("The room, and the people at several times", *WALK)),
        ("breathing", ("Range over time, change over frames", "Displacement", "Doppler over all frames")),
        ("one frame", ("Range profile", "Doppler profile", "Azimuth profile")),
        ("narrow in elevation", ("Range-elevation",)),
        ("a row of antennas", ("Moving points over time",)),
        ("no row", ("Range over time",)),
    ],
)
def test_a_page_has_its_panels_and_no_label_is_cut_off_or_over_another(
    kind: str, panels: tuple[str, ...], view: FigureData
):
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.text import Text

    views = {
        "walk": lambda: view, "two people": lambda: replace(view, poses=view.poses * 2, motions=view.motions * 2),
        "breathing": lambda: breathing_view(view), "one frame": lambda: noise_view(FAR, 1),
        "narrow in elevation": lambda: noise_view(SMALL["iwr6843aop"], 3),
        "a row of antennas": lambda: noise_view(SMALL["xwr1642boost"], 2), "no row": lambda: noise_view(BGT60, 3),
    }  # fmt: skip
    shown = views[kind]()
    figure = draw_preview(shown, None)
    titles = [axes.get_title(loc="left") for axes in figure.axes]
    for panel in panels:
        assert any(title.startswith(panel) for title in titles), panel
    assert any(title.startswith("Range-elevation") for title in titles) == ("Range-elevation" in panels)
    assert any("over time" in title for title in titles) == (kind != "one frame")
    limits = {
        image.get_clim()
        for axes in figure.axes for image in axes.images
        if image.get_array().ndim == 2 and axes.get_title(loc="left")
    }  # fmt: skip
    assert limits == {(shown.scale.low_db, shown.scale.high_db)}, "power has one scale"
    bars = [child.get_ylabel() for axes in figure.axes for child in axes.child_axes if child.get_ylabel()]
    assert bars == [shown.scale.unit] * (len(bars) - 1) + ["radial velocity (m/s), away +"], "one bar per row"

    canvas = FigureCanvasAgg(figure)
    canvas.draw()
    boxes = []
    every: list[Any] = [one for whole in figure.axes for one in (whole, *whole.child_axes)]
    for axes in every:
        titled = [text for text in axes.findobj(Text) if text.get_text() == axes.get_title(loc="left")]
        for text in (*axes.texts, axes.xaxis.label, axes.yaxis.label, *titled):
            if text.get_text():
                boxes.append((text.get_text(), text.get_window_extent(canvas.get_renderer())))
    for at, (name, box) in enumerate(boxes):
        inside = box.x0 >= 0 and box.y0 >= 0 and box.x1 <= figure.bbox.width and box.y1 <= figure.bbox.height
        assert inside, (name, box)
        for other, place in boxes[at + 1 :]:
            across = min(box.x1, place.x1) - max(box.x0, place.x0)
            up = min(box.y1, place.y1) - max(box.y0, place.y0)
            assert min(across, up) < 2, (name, other)
