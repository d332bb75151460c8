"""preview.gif: photo, range-Doppler and range-azimuth over time. The layout is drawn once, only moving parts anew."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from mmweaver.figures.body_in_photo import BodyPainter, PhotoPixels
from mmweaver.figures.body_rasteriser import bodies_of
from mmweaver.figures.figure_data import Fan, FigureData
from mmweaver.figures.theme import POWER_MAP, STYLE, label_axes, person_colour, shortened
from mmweaver.geometry.aligned_photo import AlignedPhoto

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from PIL.Image import Image

DPI = 100
BODY_COLOUR = (0.99, 0.80, 0.30)
SHORTEST_MS, LONGEST_MS = 40, 1000  # duration of one picture


def draw_animation(view: FigureData, path: Path) -> None:
    """Writes a looping GIF in real time (within 0.04 to 1 s per picture), 900 pixels wide."""
    import matplotlib

    with matplotlib.rc_context(STYLE):
        pictures = render_pictures(view)
    step_s = (view.time_edges_s[1] - view.time_edges_s[0]) / len(pictures)
    duration_ms = int(np.clip(round(step_s * 1000), SHORTEST_MS, LONGEST_MS))
    first, *others = _share_palette(pictures)
    first.save(path, format="GIF", save_all=True, append_images=others, duration=duration_ms, loop=0, optimize=False)


def render_pictures(view: FigureData) -> list[np.ndarray]:
    """All frames of the animation as (height, width, 3) uint8; under `rc_context(STYLE)` for our own look."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    figure = Figure(figsize=(9.0, 3.7), dpi=DPI, facecolor="white")
    canvas = FigureCanvasAgg(figure)
    movers = _lay_out(figure, view)
    canvas.draw()
    pixels = np.asarray(canvas.buffer_rgba())
    background = pixels.copy()
    maps = [CellsOnScreen.of(mover.axes, mover.cells[0]) for mover in movers if mover.axes and mover.cells is not None]
    pictures = []
    for index in range(len(view.frames)):
        pixels[:] = background
        shown = (mover.cells[index] for mover in movers if mover.cells is not None)
        for place, shares in zip(maps, shown, strict=True):
            place.paint(pixels, shares)
        for mover in movers:
            if mover.paint is not None:
                mover.paint(pixels, index)
            for artist in mover.update(index):
                (mover.axes or figure).draw_artist(artist)
        pictures.append(pixels[:, :, :3].copy())
    return pictures


@dataclass(frozen=True)
class PixelsOnScreen:
    """The pixels inside the frame of an axes, and where each is in the axes."""

    rows: slice
    columns: slice
    across: np.ndarray  # (pixel column,) share of the width, 0 at the left
    up: np.ndarray  # (pixel row,) share of the height, 0 at the bottom

    @classmethod
    def of(cls, axes: "Axes") -> "PixelsOnScreen":
        """Once the figure is laid out."""
        figure = axes.get_figure(root=True)
        assert figure is not None
        height = round(figure.bbox.height)
        left, bottom, right, top = axes.bbox.extents
        columns = np.arange(int(left) + 1, int(right) + 1)
        rows = np.arange(int(height - top) + 1, int(height - bottom) + 1)
        return cls(
            slice(rows[0], rows[-1] + 1), slice(columns[0], columns[-1] + 1),
            (columns + 0.5 - left) / (right - left), (height - rows - 0.5 - bottom) / (top - bottom),
        )  # fmt: skip


@dataclass(frozen=True)
class CellsOnScreen:
    """The pixels of an axes that show a map, and the cell shown by each."""

    rows: slice
    columns: slice
    row_cell: np.ndarray  # (pixel row,)
    column_cell: np.ndarray  # (pixel column,)
    colours: np.ndarray  # (256, 4) uint8

    @classmethod
    def of(cls, axes: "Axes", cells: np.ndarray) -> "CellsOnScreen":
        """For a map (up, right) that fills the axes, once the figure is laid out; the frame around it stays."""
        from matplotlib import colormaps

        place = PixelsOnScreen.of(axes)
        row_cell, column_cell = (
            np.clip((share * count).astype(int), 0, count - 1)
            for share, count in ((place.up, cells.shape[0]), (place.across, cells.shape[1]))
        )
        return cls(place.rows, place.columns, row_cell, column_cell, colormaps[POWER_MAP](np.arange(256), bytes=True))

    def paint(self, pixels: np.ndarray, shares: np.ndarray) -> None:
        """Writes a map (up, right), 0 to 1, into the picture (height, width, 4); nan leaves the picture as it is."""
        power = np.rint(255 * shares)
        is_empty = np.isnan(power)
        level = np.where(is_empty, 0, np.clip(power, 0, 255)).astype(np.uint8)
        place = pixels[self.rows, self.columns]
        painted = self.colours[level[self.row_cell][:, self.column_cell]]
        if is_empty.any():
            np.copyto(place, painted, where=~is_empty[self.row_cell][:, self.column_cell][:, :, None])
        else:
            place[:] = painted


@dataclass(frozen=True)
class Mover:
    """The moving content of an axes, or of the whole figure: a map, and lines or text over it."""

    axes: Any  # Axes or None
    update: Callable[[int], list[Any]]  # the artists to draw at a frame
    cells: np.ndarray | None = None  # (frame, up, right), 0 to 1 on the scale of decibels
    paint: Callable[[np.ndarray, int], None] | None = None  # into the picture (height, width, 4) at a frame


def _lay_out(figure: "Figure", view: FigureData) -> list[Mover]:
    if view.aligned is None:
        places = figure.add_gridspec(1, 2, left=0.07, right=0.975, bottom=0.13, top=0.83, wspace=0.22)
        doppler, azimuth = (figure.add_subplot(place) for place in places)
        photo_movers = []
    else:
        places = figure.add_gridspec(
            1, 3, left=0.012, right=0.985, bottom=0.13, top=0.83, wspace=0.2, width_ratios=(1.6, 0.8, 1.6)
        )
        photo, doppler, azimuth = (figure.add_subplot(place) for place in places)
        photo_movers = [_photo_mover(photo, view)]
    clock = figure.text(0.985, 0.955, "", ha="right", va="top", fontsize=10, animated=True)
    figure.text(0.012, 0.965, shortened(view.heading, 105), ha="left", va="top", fontsize=10, fontweight="bold")

    def show_time(index: int) -> "list[Artist]":
        clock.set_text(f"{view.time_s[index]:.1f} s")
        return [clock]

    return [*photo_movers, _doppler_mover(doppler, view), _azimuth_mover(azimuth, view), Mover(None, show_time)]


def _photo_mover(axes: "Axes", view: FigureData) -> Mover:
    """The photo; people are painted into the pixels that show it."""
    assert view.aligned is not None
    aligned = view.aligned
    height, width = aligned.photo.rgb.shape[:2]
    axes.imshow(aligned.photo.rgb, extent=(-0.5, width - 0.5, height - 0.5, -0.5), interpolation="antialiased")
    axes.set(xlim=(-0.5, width - 0.5), ylim=(height - 0.5, -0.5), xticks=[], yticks=[])
    return Mover(axes, lambda _: [], paint=_people_painter(axes, view, aligned))


def _people_painter(axes: "Axes", view: FigureData, aligned: AlignedPhoto) -> Callable[[np.ndarray, int], None]:
    """Paints all people at a frame into the picture (height, width, 4), the nearest last."""
    from matplotlib.colors import to_rgb

    people = view.shown_poses
    count = len(people)
    colours = [BODY_COLOUR] if count == 1 else [to_rgb(person_colour(index, count)) for index in range(count)]
    bodies = [bodies_of(person, np.arange(len(person.time_s))) for person in people]
    distance_m = np.array([np.linalg.norm(person.joints_m[:, 0], axis=1) for person in people])
    place: PixelsOnScreen | None = None
    painter: BodyPainter | None = None

    def paint(pixels: np.ndarray, index: int) -> None:
        nonlocal place, painter
        if place is None or painter is None:  # the layout is known once the figure is drawn
            place = PixelsOnScreen.of(axes)
            low_x, high_x = axes.get_xlim()
            low_y, high_y = axes.get_ylim()
            column, row = low_x + place.across * (high_x - low_x), low_y + place.up * (high_y - low_y)
            painter = BodyPainter(PhotoPixels(aligned, column, row))
        order = np.argsort(-distance_m[:, index]) if count else []
        shown = np.ascontiguousarray(pixels[place.rows, place.columns, :3])
        painter.paint(shown, [(bodies[one][index], colours[one]) for one in order])
        pixels[place.rows, place.columns, :3] = shown

    return paint


def _doppler_mover(axes: "Axes", view: FigureData) -> Mover:
    axes.set(xlim=view.velocity_edges_mps, ylim=view.range_edges_m)
    label_axes(axes, "Range-Doppler", "radial velocity (m/s)", "range (m)")
    return Mover(axes, lambda _: [], view.scale.shares(view.range_doppler))


def _azimuth_mover(axes: "Axes", view: FigureData) -> Mover:
    shares = view.scale.shares(view.range_azimuth_moving)
    fan = Fan.over(view.cube.grid.range_m, view.azimuth_rad)
    axes.set(xlim=fan.extent[:2], ylim=fan.extent[2:], aspect="equal")
    label_axes(axes, "From above, moving", "right (m)", "ahead (m)", y_label_pt=22.0)
    people = view.shown_poses
    dots = [
        axes.plot([], [], ".", color=person_colour(index, len(people)), markersize=2.5, animated=True)[0]
        for index in range(len(people))
    ]

    def update(index: int) -> "list[Artist]":
        for dot, person in zip(dots, people, strict=True):
            dot.set_data(person.joints_m[index, :, 0], person.joints_m[index, :, 1])
        return [*dots]

    return Mover(axes, update, np.array([fan.lay(values) for values in shares]))


def _share_palette(pictures: list[np.ndarray]) -> "list[Image]":
    """All frames in one palette of 256 colours, which avoids flicker."""
    from PIL import Image

    chosen = sorted({0, len(pictures) // 2, len(pictures) - 1})
    montage = Image.fromarray(np.concatenate([pictures[index][::2, ::2] for index in chosen]))
    palette = montage.quantize(256, method=Image.Quantize.MEDIANCUT)
    return [Image.fromarray(picture).quantize(palette=palette, dither=Image.Dither.NONE) for picture in pictures]
