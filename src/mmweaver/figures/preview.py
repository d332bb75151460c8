"""preview.png: one page of radar maps and points with, where known, the ground truth."""

from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from mmweaver.core.records import PoseSequence
from mmweaver.core.skeleton import joint
from mmweaver.figures.body_in_photo import BodyPainter, Colour, PhotoPixels
from mmweaver.figures.body_rasteriser import Body, bodies_of
from mmweaver.figures.figure_data import Fan, FigureData, decibels
from mmweaver.figures.theme import (
    GROUND_TRUTH,
    INK,
    PAPER,
    POWER_MAP,
    SPAN_DB,
    STYLE,
    TIME_MAP,
    VELOCITY_MAP,
    colour_bar,
    label_axes,
    person_colour,
    shortened,
)
from mmweaver.geometry.aligned_photo import AlignedPhoto

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from matplotlib.image import AxesImage

DPI = 100
PHOTO_WIDTH_PX = 720  # about the width of the photo on the page
SHOWN_POSES = 7  # bodies drawn into the photo
SHOWN_POSES_OF_MANY = 3  # bodies per person of several people
DB_LABEL = "dB relative to peak"


def draw_preview(view: FigureData, path: Path) -> None:
    """Writes the page as a PNG, 1600 pixels wide; 900 high with a photo, 700 without."""
    import matplotlib
    from matplotlib.backends.backend_agg import FigureCanvasAgg

    with matplotlib.rc_context(STYLE):
        canvas = FigureCanvasAgg(preview_figure(view))
        canvas.print_png(path, metadata={"Software": "mmWeaver"}, pil_kwargs={"compress_level": 2})


def preview_figure(view: FigureData) -> "Figure":
    """The page as a figure of matplotlib."""
    import matplotlib
    from matplotlib.figure import Figure

    with matplotlib.rc_context(STYLE):
        photo = view.aligned is not None
        figure = Figure(figsize=(16.0, 9.0 if photo else 7.0), dpi=DPI, facecolor="white")
        figure.suptitle(
            shortened(view.heading, 150), x=0.04, y=0.98, ha="left", va="top", fontsize=13, fontweight="bold"
        )
        for drawer, axes in _layout(figure, photo):
            drawer(axes, view)
    return figure


def _layout(figure: "Figure", photo: bool) -> "list[tuple[Callable[[Axes, FigureData], None], Axes]]":
    rows = 3 if photo else 2
    heights = (1.0, 1.0, 0.78) if photo else (1.0, 0.78)
    places = figure.add_gridspec(
        rows, 4, left=0.04, right=0.955, bottom=0.05, top=0.895 if photo else 0.87, wspace=0.5, hspace=0.38,
        height_ratios=heights,
    )  # fmt: skip
    last = rows - 1
    if photo:
        panels = [
            (draw_photo, places[0:2, 0:2]), (draw_range_time, places[0, 2]), (draw_doppler_time, places[0, 3]),
            (draw_range_doppler, places[1, 2]), (draw_range_elevation, places[1, 3]),
        ]  # fmt: skip
    else:
        panels = [
            (draw_range_time, places[0, 0]), (draw_doppler_time, places[0, 1]),
            (draw_range_doppler, places[0, 2]), (draw_range_elevation, places[0, 3]),
        ]  # fmt: skip
    panels += [
        (draw_azimuth_with_clutter, places[last, 0]), (draw_azimuth_moving, places[last, 1]),
        (draw_points_top, places[last, 2]), (draw_points_side, places[last, 3]),
    ]  # fmt: skip
    return [(drawer, figure.add_subplot(place)) for drawer, place in panels]


# photo --------------------------------------------------------------------------------------------------------------
def draw_photo(axes: "Axes", view: FigureData) -> None:
    """The photo with the bodies at several times; what furniture occludes is hidden but for a hint."""
    import matplotlib
    from matplotlib.cm import ScalarMappable
    from matplotlib.colors import Normalize, to_rgb

    assert view.aligned is not None
    people = view.shown_poses
    if len(people) == 1:
        colours = matplotlib.colormaps[TIME_MAP]
        bodies = _bodies(people[0], SHOWN_POSES, lambda share: _time_colour(colours, share))
        axes.set_title("The room, and the person at several times", y=1.0)
    else:
        bodies = []
        for index, person in enumerate(people):
            bodies += _bodies(
                person, SHOWN_POSES_OF_MANY, partial(_brightened, to_rgb(person_colour(index, len(people))))
            )
        axes.set_title("The room, and the people at several times, the last the brightest", y=1.0)
    _show_photo(axes, view.aligned, bodies)
    if len(people) == 1:
        low_s, high_s = float(people[0].time_s[0]), float(people[0].time_s[-1])
        span = Normalize(low_s, high_s if high_s > low_s else low_s + 1)
        colour_bar(axes, ScalarMappable(norm=span, cmap=_time_map()), "time (s)")


def _show_photo(axes: "Axes", aligned: AlignedPhoto, bodies: list[tuple[Body, Colour]]) -> None:
    """The photo with bodies painted into it, at about the size that the page has for it."""
    from PIL import Image

    height, width = aligned.photo.rgb.shape[:2]
    size = (max(round(height * PHOTO_WIDTH_PX / width), 1), PHOTO_WIDTH_PX)
    picture = np.array(Image.fromarray(aligned.photo.rgb).resize(size[::-1], Image.Resampling.BILINEAR))
    BodyPainter(PhotoPixels.whole(aligned, size)).paint(picture, bodies)
    axes.imshow(picture, extent=(-0.5, width - 0.5, height - 0.5, -0.5), interpolation="antialiased")
    axes.set(xlim=(-0.5, width - 0.5), ylim=(height - 0.5, -0.5), xticks=[], yticks=[])
    axes.set_anchor("NW")


def _bodies(pose: PoseSequence, most: int, colour_at: Callable[[float], Colour]) -> list[tuple[Body, Colour]]:
    """One person at several times, in colours by the share of the time."""
    count = len(pose.time_s)
    chosen = np.unique(np.linspace(0, count - 1, min(count, most)).round().astype(int))
    shares = np.arange(len(chosen)) / max(len(chosen) - 1, 1)
    return [(body, colour_at(float(share))) for body, share in zip(bodies_of(pose, chosen), shares, strict=True)]


def _brightened(colour: Colour, share: float) -> Colour:
    """A person's colour, darker at earlier times."""
    red, green, blue = (one * (0.5 + 0.5 * share) for one in colour)
    return red, green, blue


def _time_colour(colours: "Callable[[float], tuple[float, ...]]", share: float) -> Colour:
    red, green, blue, _ = colours(0.25 + 0.75 * share)  # the dark end of the map is invisible on a photo
    return float(red), float(green), float(blue)


def _time_map():
    import matplotlib
    from matplotlib.colors import ListedColormap

    return ListedColormap(matplotlib.colormaps[TIME_MAP](np.linspace(0.25, 1, 128)))


# strips over time ---------------------------------------------------------------------------------------------------
def draw_range_time(axes: "Axes", view: FigureData) -> None:
    """Clutter-removed power over time and range, with the ground-truth extent of the joints."""
    strip = decibels(view.range_doppler_moving.max(axis=2))
    image = _power(axes, strip.T, (*view.time_edges_s, *view.range_edges_m))
    if view.poses:
        middle_s = view.time_s + view.frame_step_s / 2
        for pose, colour in _with_colours(view.shown_poses):
            distance_m = np.linalg.norm(pose.joints_m, axis=2)
            for edge in (distance_m.min(axis=1), distance_m.max(axis=1)):
                axes.plot(middle_s, edge, color=colour, linewidth=0.9)
        _within(axes, view.time_edges_s, view.range_edges_m)
        _note(axes, "lines: nearest and farthest joint")
    label_axes(axes, "Range over time, clutter removed", "time (s)", "range (m)")
    colour_bar(axes, image, DB_LABEL)


def draw_doppler_time(axes: "Axes", view: FigureData) -> None:
    """Power over time and radial velocity (micro-Doppler), summed over range, with the velocity of the pelvis."""
    strip = decibels(view.range_doppler_moving.sum(axis=1))
    image = _power(axes, strip.T, (*view.time_edges_s, *view.velocity_edges_mps))
    if view.motions:
        for motion, colour in _with_colours(view.motions):
            distance_m = np.linalg.norm(motion.joints_m[:, joint("pelvis")], axis=1)
            if len(distance_m) > 1:
                velocity_mps = np.interp(view.time_s, motion.time_s, np.gradient(distance_m, motion.time_s))
                axes.plot(view.time_s + view.frame_step_s / 2, velocity_mps, color=colour, linewidth=0.9)
        _within(axes, view.time_edges_s, view.velocity_edges_mps)
        _note(axes, "line: pelvis")
    label_axes(axes, "Doppler over time, clutter removed", "time (s)", "radial velocity (m/s), away +")
    colour_bar(axes, image, DB_LABEL)


# maps ---------------------------------------------------------------------------------------------------------------
def draw_range_doppler(axes: "Axes", view: FigureData) -> None:
    """Power over range and radial velocity in the most active frame, static clutter included."""
    at = view.most_active_frame
    image = _power(axes, decibels(view.range_doppler[at]), (*view.velocity_edges_mps, *view.range_edges_m))
    if view.motions:
        for motion, colour in _with_colours(view.motions):
            _mark_joints(axes, motion, float(view.time_s[at]), colour)
        _within(axes, view.velocity_edges_mps, view.range_edges_m)
        _note(axes, "dots: joints")
    title = f"Range-Doppler, frame {view.frames[at]} ({view.time_s[at]:.1f} s)"
    label_axes(axes, title, "radial velocity (m/s), away +", "range (m)")
    colour_bar(axes, image, DB_LABEL)


def draw_range_elevation(axes: "Axes", view: FigureData) -> None:
    """Clutter-removed power from the side, mean over frames; two antenna rows resolve little elevation."""
    if not view.has_elevation:
        axes.set_axis_off()
        axes.text(0.5, 0.5, "this array does not resolve elevation", transform=axes.transAxes, ha="center")
        return
    power = view.range_elevation_moving.mean(axis=0)
    fan = Fan.over(view.cube.grid.range_m, view.elevation_rad)
    low, high, near, far = fan.extent
    image = _power(axes, fan.lay(decibels(power)).T, (near, far, low, high))
    axes.set_aspect("equal", anchor="N")
    if view.poses:
        for pose, colour in _with_colours(view.shown_poses):
            joints_m = pose.joints_m[:: max(len(pose.time_s) // SHOWN_POSES, 1)].reshape(-1, 3)
            axes.plot(np.hypot(joints_m[:, 0], joints_m[:, 1]), joints_m[:, 2], ".", color=colour, markersize=1.2)
        _note(axes, "dots: joints", corner="upper left")
    axes.set(xlim=(0, far), ylim=(low, high))
    label_axes(axes, "Range-elevation, clutter removed", "ahead (m)", "up (m)")
    colour_bar(axes, image, DB_LABEL)


def draw_azimuth_with_clutter(axes: "Axes", view: FigureData) -> None:
    """Power from above with static clutter, mean over frames."""
    _draw_azimuth(axes, view, view.range_azimuth, "Range-azimuth, static clutter included")


def draw_azimuth_moving(axes: "Axes", view: FigureData) -> None:
    """Clutter-removed power from above, mean over frames, with the path of the pelvis."""
    _draw_azimuth(axes, view, view.range_azimuth_moving, "Range-azimuth, clutter removed")


def _draw_azimuth(axes: "Axes", view: FigureData, power: np.ndarray, title: str) -> None:
    fan = Fan.over(view.cube.grid.range_m, view.azimuth_rad)
    image = _power(axes, fan.lay(decibels(power.mean(axis=0))), fan.extent)
    axes.set_aspect("equal", anchor="N")
    if view.poses:
        for pose, colour in _with_colours(view.shown_poses):
            path_m = pose.joints_m[:, joint("pelvis")]
            axes.plot(path_m[:, 0], path_m[:, 1], color=colour, linewidth=1.0)
            axes.plot(*path_m[-1, :2], ">", color=colour, markersize=4)
        _note(axes, "line: pelvis", corner="upper right")
    axes.set(xlim=fan.extent[:2], ylim=fan.extent[2:])
    label_axes(axes, title, "right (m)", "ahead (m)")
    colour_bar(axes, image, DB_LABEL)


# points -------------------------------------------------------------------------------------------------------------
def draw_points_top(axes: "Axes", view: FigureData) -> None:
    """All detections from above, coloured by radial velocity."""
    reach_m = view.range_edges_m[1]
    _scatter(axes, view, view.shown_points.x_m, view.shown_points.y_m)
    if view.poses:
        for pose, colour in _with_colours(view.shown_poses, on_white=True):
            path_m = pose.joints_m[:, joint("pelvis")]
            axes.plot(path_m[:, 0], path_m[:, 1], color=colour, linewidth=1.0)
        _note(axes, "line: pelvis", corner="upper right")
    axes.set(xlim=(-0.9 * reach_m, 0.9 * reach_m), ylim=(0, reach_m))
    axes.set_aspect("equal", anchor="N")
    label_axes(axes, f"Points from above ({len(view.shown_points.frame)})", "right (m)", "ahead (m)", grid=True)


def draw_points_side(axes: "Axes", view: FigureData) -> None:
    """All detections from the side, coloured by radial velocity."""
    reach_m = view.range_edges_m[1]
    _scatter(axes, view, view.shown_points.y_m, view.shown_points.z_m)
    if view.poses:
        for pose, colour in _with_colours(view.shown_poses, on_white=True):
            for name in ("head", "left_foot"):
                trace_m = pose.joints_m[:, joint(name)]
                axes.plot(trace_m[:, 1], trace_m[:, 2], color=colour, linewidth=0.8)
        _note(axes, "lines: head, left foot", corner="upper right")
    highest_m = float(np.max(np.abs(view.shown_points.z_m), initial=0.0))
    half_m = float(np.clip(1.1 * highest_m, 0.32 * reach_m, 0.45 * reach_m))
    axes.set(xlim=(0, reach_m), ylim=(-half_m, half_m))
    axes.set_aspect("equal", anchor="N")
    label_axes(axes, "Points from the side", "ahead (m)", "up (m)", grid=True)


def _scatter(axes: "Axes", view: FigureData, across_m: np.ndarray, up_m: np.ndarray) -> None:
    """Weak detections are pale; colours span all but the fastest 5 %, which are mostly noise."""
    import matplotlib
    from matplotlib.cm import ScalarMappable
    from matplotlib.colors import Normalize, to_rgb

    velocity_mps, snr_db = view.shown_points.radial_velocity_mps, view.shown_points.snr_db
    top_mps = max(float(np.percentile(np.abs(velocity_mps), 95)), 0.1) if len(velocity_mps) else 0.1
    solid = ScalarMappable(norm=Normalize(-top_mps, top_mps), cmap=matplotlib.colormaps[VELOCITY_MAP])
    rising = np.argsort(snr_db, kind="stable")
    face = solid.to_rgba(velocity_mps[rising])
    face[:, 3] = np.clip((snr_db[rising] - 10) / 20, 0.2, 1.0)
    edge = np.column_stack([np.broadcast_to(to_rgb(INK), (len(face), 3)), face[:, 3]])
    dots: Any = {"s": 12, "linewidths": 0.3, "facecolors": face, "edgecolors": edge}
    axes.scatter(across_m[rising], up_m[rising], **dots)
    colour_bar(axes, solid, "m/s, away +")


# pieces -------------------------------------------------------------------------------------------------------------
def _power(axes: "Axes", values_db: np.ndarray, extent: tuple[float, float, float, float]) -> "AxesImage":
    return axes.imshow(
        values_db, origin="lower", aspect="auto", extent=extent, cmap=POWER_MAP, vmin=-SPAN_DB, vmax=0.0,
        interpolation="nearest",
    )  # fmt: skip


def _with_colours(people: tuple[PoseSequence, ...], *, on_white: bool = False) -> list[tuple[PoseSequence, str]]:
    """Each person with the colour of their ground truth."""
    return [(person, person_colour(index, len(people), on_white=on_white)) for index, person in enumerate(people)]


def _mark_joints(axes: "Axes", motion: PoseSequence, time_s: float, colour: str) -> None:
    """Joints as dots at their range and radial velocity at a given time."""
    if len(motion.time_s) < 2:
        return
    at = int(np.clip(np.searchsorted(motion.time_s, time_s), 1, len(motion.time_s) - 1))
    distance_m = np.linalg.norm(motion.joints_m[at - 1 : at + 1], axis=2)
    velocity_mps = (distance_m[1] - distance_m[0]) / (motion.time_s[at] - motion.time_s[at - 1])
    axes.plot(velocity_mps, distance_m.mean(axis=0), ".", color=colour, markersize=3, alpha=0.9)


def _within(axes: "Axes", x: tuple[float, float], y: tuple[float, float]) -> None:
    axes.set(xlim=x, ylim=y)


def _note(axes: "Axes", text: str, *, corner: str = "lower right") -> None:
    """Legend of a line or dot: bright at the lower right of the picture, dark in a corner that a fan leaves white."""
    vertical, horizontal = corner.split()
    x, y = {"left": 0.02, "right": 0.98}[horizontal], {"lower": 0.02, "upper": 0.97}[vertical]
    colour, ground = (GROUND_TRUTH, "black") if corner == "lower right" else (INK, PAPER)
    axes.text(
        x, y, text, transform=axes.transAxes, ha=horizontal, va={"lower": "bottom", "upper": "top"}[vertical],
        fontsize=7.5, color=colour, bbox={"facecolor": ground, "edgecolor": "none", "alpha": 0.6, "pad": 1.0},
    )  # fmt: skip
