"""preview.gif: photo, range-Doppler and range-azimuth over time. Only moving parts are redrawn."""

from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from mmweaver.viz.body_in_photo import BodyPainter
from mmweaver.viz.body_rasteriser import bodies_of
from mmweaver.viz.figure_data import Fan, FigureData
from mmweaver.viz.theme import STYLE, Extent, label_axes, person_colour, shortened

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from PIL.Image import Image

Update = Callable[[int], list[Any]]  # returns the artists to draw at a frame
BODY_COLOUR = (0.99, 0.80, 0.30)
MIN_MS, MAX_MS = 40, 1000  # duration of one picture


def draw_animation(view: FigureData, path: Path) -> None:
    """Writes a looping GIF in real time (within 0.04 to 1 s per picture), 900 pixels wide.

    Args:
        view: The data to show.
        path: The GIF.
    """
    pictures = render_pictures(view)
    step_s = (view.time_edges_s[1] - view.time_edges_s[0]) / len(pictures)
    duration_ms = int(np.clip(round(step_s * 1000), MIN_MS, MAX_MS))
    first, *others = _share_palette(pictures)
    first.save(path, format="GIF", save_all=True, append_images=others, duration=duration_ms, loop=0, optimize=False)


def render_pictures(view: FigureData) -> list[np.ndarray]:
    """All frames of the animation, (height, width, 3) uint8 each."""
    import matplotlib
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    pictures = []
    with matplotlib.rc_context(STYLE):
        figure = Figure(figsize=(9.0, 3.7))
        canvas = FigureCanvasAgg(figure)
        updates = _lay_out(figure, view)
        canvas.draw()
        background = canvas.copy_from_bbox(figure.bbox)
        for index in range(len(view.frames)):
            canvas.restore_region(background)
            for artist in (artist for update in updates for artist in update(index)):
                (artist.axes or figure).draw_artist(artist)
            pictures.append(np.asarray(canvas.buffer_rgba())[:, :, :3].copy())
    return pictures


def _lay_out(figure: "Figure", view: FigureData) -> list[Update]:
    panels = [_range_doppler, _range_azimuth]
    shape: Any = {"left": 0.07, "right": 0.975, "wspace": 0.22}
    if view.aligned is not None:
        panels.insert(0, _people)
        shape = {"left": 0.012, "right": 0.985, "wspace": 0.2, "width_ratios": (1.6, 0.8, 1.6)}
    places = figure.add_gridspec(1, len(panels), bottom=0.13, top=0.83, **shape)
    figure.text(0.012, 0.965, shortened(view.heading, 105), ha="left", va="top", fontsize=10, fontweight="bold")
    clock = figure.text(0.985, 0.955, "", ha="right", va="top", fontsize=10, animated=True)

    def show_time(index: int) -> list[Any]:
        clock.set_text(f"{view.time_s[index]:.1f} s")
        return [clock]

    return [*(panel(figure.add_subplot(places[0, at]), view) for at, panel in enumerate(panels)), show_time]


def _people(axes: "Axes", view: FigureData) -> Update:
    """The photo with all people at a frame, the nearest painted last."""
    from matplotlib.colors import to_rgb
    from PIL import Image

    aligned, people = view.aligned, view.shown_poses
    assert aligned is not None
    colours = [to_rgb(person_colour(index, len(people))) for index in range(len(people))]
    colours = [BODY_COLOUR] if len(people) == 1 else colours
    bodies = [bodies_of(person, np.arange(len(person.time_s))) for person in people]
    image = axes.imshow(aligned.photo.rgb, animated=True, interpolation="nearest")
    axes.set(xticks=[], yticks=[])

    @cache
    def shown() -> tuple[BodyPainter, np.ndarray]:
        """The photo in the size that the layout gives it."""
        size = (round(axes.bbox.height), round(axes.bbox.width))
        photo = Image.fromarray(aligned.photo.rgb).resize(size[::-1], Image.Resampling.BILINEAR)
        return BodyPainter(aligned, size), np.asarray(photo)

    def update(index: int) -> list[Any]:
        painter, photo = shown()
        picture = photo.copy()
        order = sorted(range(len(people)), key=lambda one: -float(np.linalg.norm(people[one].joints_m[index, 0])))
        painter.paint(picture, [(bodies[one][index], colours[one]) for one in order])
        image.set_data(picture)
        return [image, *axes.spines.values()]

    return update


def _range_doppler(axes: "Axes", view: FigureData) -> Update:
    return _map(
        axes,
        view,
        view.scale.decibels(view.range_doppler),
        (*view.velocity_edges_mps, *view.range_edges_m),
        ("Range-Doppler", "radial velocity (m/s)", "range (m)"),
    )


def _range_azimuth(axes: "Axes", view: FigureData) -> Update:
    fan, people = Fan.over(view.cube.grid.range_m, view.azimuth_rad), view.shown_poses
    power_db = np.array([fan.lay(values) for values in view.scale.decibels(view.range_azimuth_moving)])
    update = _map(axes, view, power_db, fan.extent, ("From above, moving", "right (m)", "ahead (m)"))
    axes.set_aspect("equal")
    dots = [
        axes.plot([], [], ".", color=person_colour(index, len(people)), markersize=2.5, animated=True)[0]
        for index in range(len(people))
    ]

    def update_all(index: int) -> list[Any]:
        for dot, person in zip(dots, people, strict=True):
            dot.set_data(person.joints_m[index, :, 0], person.joints_m[index, :, 1])
        return [*update(index), *dots]

    return update_all


def _map(axes: "Axes", view: FigureData, power_db: np.ndarray, extent: Extent, words: tuple[str, str, str]) -> Update:
    """A map (frame, up, right) in decibels over time."""
    image = view.scale.draw(axes, power_db[0], extent)
    image.set_animated(True)
    label_axes(axes, *words)

    def update(index: int) -> list[Any]:
        image.set_data(power_db[index])
        return [image, *axes.spines.values()]

    return update


def _share_palette(pictures: list[np.ndarray]) -> "list[Image]":
    """All frames in one palette of 256 colours, which avoids flicker."""
    from PIL import Image

    chosen = sorted({0, len(pictures) // 2, len(pictures) - 1})
    montage = Image.fromarray(np.concatenate([pictures[index][::2, ::2] for index in chosen]))
    palette = montage.quantize(256, method=Image.Quantize.MEDIANCUT)
    return [Image.fromarray(picture).quantize(palette=palette, dither=Image.Dither.NONE) for picture in pictures]
