"""Panels of pages: one function per kind of picture. Panels of power share the scale of the whole page."""

from collections.abc import Callable, Iterable, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from mmweaver.core.aligned_photo import AlignedPhoto
from mmweaver.core.records import PoseSequence
from mmweaver.core.skeleton import joint
from mmweaver.core.virtual_array import has_elevation
from mmweaver.signal.doppler_spectrogram import MicroDoppler
from mmweaver.signal.slow_time import SlowTimeCell
from mmweaver.viz.body_in_photo import BodyPainter
from mmweaver.viz.body_rasteriser import bodies_of
from mmweaver.viz.figure_data import Fan, FigureData
from mmweaver.viz.theme import (
    INK,
    PAPER,
    PEOPLE_ON_WHITE,
    TIME_MAP,
    VELOCITY_MAP,
    PowerScale,
    colour_bar,
    evenly_spaced,
    label_axes,
    note,
    person_colour,
)

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.cm import ScalarMappable

SHOWN_POSES = 7  # poses whose joints are drawn from the side, and bodies of one person in the photo
SHOWN_POSES_OF_MANY = 3  # bodies per person of several people
PHOTO_WIDTH_PX = 720  # about the width of the photo on the page
STATIC_COLOUR, MOVING_COLOUR = "#8a5a00", "#0b7da3"
MAX_BODY_SHARE, APART_M = 0.9, 0.25  # of the picture's height, and least distance between two bodies of a person
NARROWEST_MPS, MOVING_DB = 0.02, 50.0  # minimum half width of a slow-time velocity axis, and shown range below a peak
DISPLACEMENT_SPAN, DISPLACEMENT_NAME = 1.15, 0.22
LEGEND_SHARE = 0.3  # space above the scale for the legend, so that no curve crosses it
MIN_SPEED_MPS = 0.1  # minimum span of the colours of points
VELOCITY = "radial velocity (m/s), away +"
Curves = Iterable[tuple[np.ndarray, np.ndarray]]


def power_bar(axes: "Axes", view: FigureData) -> None:
    """The colour bar of all power panels, with the noise marked."""
    view.scale.bar(axes)


def moving_words(view: FigureData) -> str:
    """Description of panels of motion."""
    return "change over frames" if view.is_slow else "clutter removed"


def _truth(
    axes: "Axes",
    people: Sequence[PoseSequence],
    curves: Callable[[PoseSequence], Curves],
    text: str,
    corner: str = "lower right",
    style: str = "-",
    on_white: bool = False,
) -> None:
    """Draws the ground truth of each person in their colour, with a note."""
    for index, person in enumerate(people):
        colour = person_colour(index, len(people), on_white=on_white)
        for x, y in curves(person):
            is_path = style == "->"  # with a mark at the end
            axes.plot(
                x,
                y,
                style,
                color=colour,
                linewidth=0.9,
                markersize=4 if is_path else 2.5,
                markevery=[-1] if is_path else None,
            )
    if people:
        note(axes, text, corner)


# over time ----------------------------------------------------------------------------------------------------------
def draw_range_time(axes: "Axes", view: FigureData) -> None:
    """Power of motion over time and range, with the ground-truth extent of the joints."""
    power = view.range_doppler_moving.max(axis=2).T
    view.scale.draw(axes, view.scale.decibels(power), (*view.time_edges_s, *view.range_edges_m))
    middle_s = view.time_s + view.frame_step_s / 2

    def curves(person: PoseSequence) -> Curves:
        distance_m = np.linalg.norm(person.joints_m, axis=2)
        return [(middle_s, distance_m.min(axis=1)), (middle_s, distance_m.max(axis=1))]

    _truth(axes, view.shown_poses, curves, "lines: nearest and farthest joint")
    label_axes(axes, f"Range over time, {moving_words(view)}", "time (s)", "range (m)")


def draw_micro_doppler(axes: "Axes", view: FigureData) -> None:
    """Spectrogram over chirps: the strongest range at each time and radial velocity, with the pelvis' ground truth."""
    draw_spectrogram(axes, view.scale, view.micro_doppler, view.time_edges_s)

    def curves(motion: PoseSequence) -> Curves:
        distance_m = np.linalg.norm(motion.joints_m[:, joint("pelvis")], axis=1)
        if len(distance_m) > 1:
            velocity_mps = np.interp(view.time_s, motion.time_s, np.gradient(distance_m, motion.time_s))
            yield view.time_s + view.frame_step_s / 2, velocity_mps

    _truth(axes, view.motions, curves, "line: pelvis")
    label_axes(axes, "Micro-Doppler (STFT over chirps)", "time (s)", VELOCITY)


def draw_spectrogram(axes: "Axes", scale: PowerScale, found: MicroDoppler, time_edges_s: tuple[float, float]) -> None:
    """Draws a spectrogram in columns of equal time; each spectrum is held until the next, across pauses between frames.

    Args:
        axes: Where to draw.
        scale: Scale of the power.
        found: The spectrogram.
        time_edges_s: Start and end of the time axis.
    """
    column_s = np.linspace(*time_edges_s, min(max(2 * len(found.time_s), 200), 1200), endpoint=False)
    half_s = (found.time_s[0] - time_edges_s[0]) if len(found.time_s) else 0.0
    shown = np.clip(np.searchsorted(found.time_s - half_s, column_s, side="right") - 1, 0, len(found.time_s) - 1)
    velocity = found.radial_velocity_mps
    half_mps = float(velocity[1] - velocity[0]) / 2
    extent = (*time_edges_s, float(velocity[0]) - half_mps, float(velocity[-1]) + half_mps)
    scale.draw(axes, scale.decibels(found.power[shown].T), extent)


def draw_displacement(axes: "Axes", time_s: np.ndarray, cells: Sequence[SlowTimeCell]) -> None:
    """Displacement over time of the range bins with the strongest motion across frames.

    Args:
        axes: Where to draw.
        time_s: Times (frame,) in seconds.
        cells: The range bins.
    """
    reach_mm = max([1e-3, *(1e3 * float(np.abs(cell.displacement_m).max()) for cell in cells)]) * DISPLACEMENT_SPAN
    for cell, colour in zip(cells, PEOPLE_ON_WHITE, strict=False):
        label = f"at {cell.range_m:.2f} m"
        axes.plot(time_s, 1e3 * cell.displacement_m, color=colour, linewidth=1.0, label=label)
    for_names = 1 + DISPLACEMENT_NAME * len(cells)  # no curve runs through the names
    last_s = float(time_s[-1]) if len(time_s) > 1 else float(time_s[0]) + 1.0
    axes.set(xlim=(float(time_s[0]), last_s), ylim=(-reach_mm, reach_mm * for_names))
    if cells:
        axes.legend()
    label_axes(axes, "Displacement where most changes", "time (s)", "displacement (mm), away +", grid=True)


# maps ---------------------------------------------------------------------------------------------------------------
def draw_range_doppler(axes: "Axes", view: FigureData) -> None:
    """Power over range and radial velocity in the most active frame, with static clutter."""
    at = view.most_active_frame
    power_db = view.scale.decibels(view.range_doppler[at])
    view.scale.draw(axes, power_db, (*view.velocity_edges_mps, *view.range_edges_m))

    def curves(motion: PoseSequence) -> Curves:
        if len(motion.time_s) > 1:
            here = int(np.clip(np.searchsorted(motion.time_s, view.time_s[at]), 1, len(motion.time_s) - 1))
            distance_m = np.linalg.norm(motion.joints_m[here - 1 : here + 1], axis=2)
            yield np.diff(distance_m, axis=0)[0] / np.diff(motion.time_s)[here - 1], distance_m.mean(axis=0)

    _truth(axes, view.motions, curves, "dots: joints", style=".")
    label_axes(axes, f"Range-Doppler, frame {view.frames[at]} ({view.time_s[at]:.1f} s)", VELOCITY, "range (m)")


def draw_slow_doppler(
    axes: "Axes", scale: PowerScale, power: np.ndarray, velocity_mps: np.ndarray, range_edges_m: tuple[float, float]
) -> None:
    """Power over range and slow-time velocity of all frames; the velocity axis is cropped to the motion.

    Args:
        axes: Where to draw.
        scale: Scale of the power.
        power: Power (range, doppler) in squared units of the cube.
        velocity_mps: Velocities (doppler,) in m/s.
        range_edges_m: Outer edges of the first and the last range bin in metres.
    """
    along_db = scale.decibels(power.max(axis=0))
    noise_db = scale.low_db if scale.noise_db is None else scale.noise_db
    fast = np.abs(velocity_mps[along_db > max(noise_db, float(along_db.max()) - MOVING_DB)])
    shown = np.abs(velocity_mps) <= max(NARROWEST_MPS, 1.3 * float(fast.max(initial=0.0)))
    half_mps, edges = float(velocity_mps[1] - velocity_mps[0]) / 2, velocity_mps[shown]
    extent = 1e3 * (float(edges[0]) - half_mps), 1e3 * (float(edges[-1]) + half_mps)
    scale.draw(axes, scale.decibels(power[:, shown]), (*extent, *range_edges_m))
    label_axes(axes, "Doppler over all frames", "radial velocity (mm/s), away +", "range (m)")


def draw_elevation(axes: "Axes", view: FigureData) -> None:
    """Power of motion from the side, maximum over frames, for arrays that resolve elevation."""
    fan = Fan.over(view.cube.grid.range_m, view.elevation_rad)
    low, high, _, far = fan.extent
    power = fan.lay(view.range_elevation_moving.max(axis=0)).T
    view.scale.draw(axes, view.scale.decibels(power), (0.0, far, low, high))
    axes.set_aspect("equal", anchor="NW")

    def curves(person: PoseSequence) -> Curves:
        x, y, z = person.joints_m[:: max(len(person.time_s) // SHOWN_POSES, 1)].reshape(-1, 3).T
        return [(np.hypot(x, y), z)]

    _truth(axes, view.shown_poses, curves, "dots: joints", "upper left", ".")
    label_axes(axes, f"Range-elevation, {moving_words(view)}", "ahead (m)", "up (m)")


def draw_azimuth_with_clutter(axes: "Axes", view: FigureData) -> None:
    """Power from above with static clutter, mean over frames."""
    _draw_azimuth(axes, view, view.range_azimuth.mean(axis=0), "static clutter included")


def draw_azimuth_moving(axes: "Axes", view: FigureData) -> None:
    """Power of motion from above, maximum over frames, with the path of the pelvis."""
    _draw_azimuth(axes, view, view.range_azimuth_moving.max(axis=0), moving_words(view))


def _draw_azimuth(axes: "Axes", view: FigureData, power: np.ndarray, what: str) -> None:
    fan = Fan.over(view.cube.grid.range_m, view.azimuth_rad)
    view.scale.draw(axes, view.scale.decibels(fan.lay(power)), fan.extent)
    axes.set_aspect("equal", anchor="NW")
    _truth(axes, view.shown_poses, _path, "line: pelvis", "upper right", "->")
    label_axes(axes, f"Range-azimuth, {what}", "right (m)", "ahead (m)")


def _path(person: PoseSequence) -> list[tuple[np.ndarray, np.ndarray]]:
    """Path of the pelvis from above."""
    x, y, _ = person.joints_m[:, joint("pelvis")].T
    return [(x, y)]


# profiles -----------------------------------------------------------------------------------------------------------
def draw_range_profile(axes: "Axes", view: FigureData) -> None:
    """Power over range, maximum over radial velocity, with and without static clutter, and the noise."""
    whole, moving = (power.max(axis=(0, 2)) for power in (view.range_doppler, view.range_doppler_moving))
    _draw_profiles(axes, view, view.cube.grid.range_m, moving, whole)
    label_axes(axes, "Range profile, strongest velocity", "range (m)", view.scale.unit, grid=True)


def draw_velocity_profile(axes: "Axes", view: FigureData) -> None:
    """Power over radial velocity, maximum over range, without clutter."""
    _draw_profiles(axes, view, view.cube.grid.radial_velocity_mps, view.range_doppler_moving.max(axis=(0, 1)))
    label_axes(axes, "Doppler profile, strongest range", VELOCITY, view.scale.unit, grid=True)


def draw_azimuth_profile(axes: "Axes", view: FigureData) -> None:
    """Power over azimuth, maximum over range."""
    whole, moving = (power.max(axis=(0, 1)) for power in (view.range_azimuth, view.range_azimuth_moving))
    _draw_profiles(axes, view, np.degrees(view.azimuth_rad), moving, whole)
    label_axes(axes, "Azimuth profile, strongest range", "azimuth (degrees), right +", view.scale.unit, grid=True)


def _draw_profiles(
    axes: "Axes", view: FigureData, along: np.ndarray, moving: np.ndarray, whole: np.ndarray | None = None
) -> None:
    scale, peak_db = view.scale, view.scale.high_db
    for name, power, colour in (("all", whole, STATIC_COLOUR), (moving_words(view), moving, MOVING_COLOUR)):
        if power is not None:
            axes.plot(along, scale.decibels(power), color=colour, linewidth=1.1, label=name)
            peak_db = max(peak_db, float(np.max(scale.decibels(power), initial=scale.low_db)))
    if scale.noise_db is not None:
        axes.axhline(scale.noise_db, color=INK, linewidth=0.8, linestyle=":", label="noise")
    half = float(along[1] - along[0]) / 2 if len(along) > 1 else 0.5
    top_db = peak_db + LEGEND_SHARE * (scale.high_db - scale.low_db)
    axes.set(xlim=(float(along[0]) - half, float(along[-1]) + half), ylim=(scale.low_db, top_db))
    axes.legend()


# points: those that move, coloured by radial velocity; static ones are furniture and walls ----------------------------
def draw_points_top(axes: "Axes", view: FigureData) -> None:
    """Moving detections from above."""
    reach_m = view.range_edges_m[1]
    points = view.moving_points
    _scatter(axes, view, points.x_m, points.y_m)
    _truth(axes, view.shown_poses, _path, "line: pelvis", "upper right", on_white=True)
    axes.set(xlim=(-0.9 * reach_m, 0.9 * reach_m), ylim=(0, reach_m))
    axes.set_aspect("equal", anchor="NW")
    label_axes(
        axes,
        f"Moving points ({len(points.frame)} of {len(view.shown_points.frame)})",
        "right (m)",
        "ahead (m)",
        grid=True,
    )


def draw_points_side(axes: "Axes", view: FigureData) -> None:
    """Moving detections from the side; over time or velocity if the array has no elevation."""
    points, reach_m = view.moving_points, view.range_edges_m[1]
    if not has_elevation(view.cube.config):
        if view.is_single:
            across, limits, words = points.radial_velocity_mps, view.velocity_edges_mps, ("by velocity", VELOCITY)
        else:
            across = view.cube.grid.frame_time_s[points.frame] + view.cube.config.frame_period_s / 2
            limits, words = view.time_edges_s, ("over time", "time (s)")
        _scatter(axes, view, across, points.range_m)
        axes.set(xlim=limits, ylim=(0, reach_m))
        label_axes(axes, f"Moving points {words[0]}", words[1], "range (m)", grid=True)
        return
    _scatter(axes, view, points.y_m, points.z_m)

    def curves(person: PoseSequence) -> Curves:
        return [tuple(person.joints_m[:, joint(name), 1:].T) for name in ("head", "left_foot")]

    _truth(axes, view.shown_poses, curves, "lines: head, left foot", "upper right", on_white=True)
    if view.aligned is not None:
        axes.axhline(view.aligned.floor_z_m, color=INK, linewidth=0.7, linestyle=":")
    highest_m = float(np.max(np.abs(points.z_m), initial=0.0))
    half_m = float(np.clip(1.1 * highest_m, 0.32 * reach_m, 0.45 * reach_m))
    axes.set(xlim=(0, reach_m), ylim=(-half_m, half_m))
    axes.set_aspect("equal", anchor="NW")
    label_axes(axes, "Moving points, side", "ahead (m)", "up (m)", grid=True)


def velocity_bar(axes: "Axes", view: FigureData) -> None:
    """The colour bar of the points."""
    colour_bar(axes, _velocities(view), VELOCITY)


def _velocities(view: FigureData) -> "ScalarMappable":
    """Colours span the speeds of moving points except for the fastest 5 %, which are mostly noise."""
    from matplotlib.cm import ScalarMappable
    from matplotlib.colors import Normalize

    speed_mps = np.abs(view.moving_points.radial_velocity_mps)
    moving_mps = speed_mps[speed_mps > MIN_SPEED_MPS]
    top_mps = float(np.percentile(moving_mps, 95)) if len(moving_mps) else MIN_SPEED_MPS
    return ScalarMappable(Normalize(-top_mps, top_mps), VELOCITY_MAP)


def _scatter(axes: "Axes", view: FigureData, across_m: np.ndarray, up_m: np.ndarray) -> None:
    """Weak detections are pale."""
    from matplotlib.colors import to_rgb

    snr_db = view.moving_points.snr_db
    rising = np.argsort(snr_db, kind="stable")
    face: Any = _velocities(view).to_rgba(view.moving_points.radial_velocity_mps[rising])
    face[:, 3] = np.clip((snr_db[rising] - 10) / 20, 0.2, 1.0)
    edge: Any = np.column_stack([np.tile(to_rgb(INK), (len(face), 1)), face[:, 3]])
    axes.scatter(across_m[rising], up_m[rising], s=12, linewidths=0.3, facecolors=face, edgecolors=edge)


def _poses_in_photo(person: PoseSequence, aligned: AlignedPhoto, most: int) -> np.ndarray:
    """Frames whose bodies fit the picture and do not cover each other; at least the one farthest away."""
    places_m = person.joints_m[:, joint("pelvis")]
    _, depth_m = aligned.project(places_m)
    tallest_px = MAX_BODY_SHARE * aligned.photo.rgb.shape[0]
    fits = depth_m * tallest_px >= aligned.photo.intrinsics.fy * person.height_m
    chosen: list[int] = []
    for frame in evenly_spaced(len(places_m), most):
        if fits[frame] and all(np.linalg.norm(places_m[frame] - places_m[other]) > APART_M for other in chosen):
            chosen.append(int(frame))
    return np.array(chosen or [int(np.argmax(depth_m))])


# photo --------------------------------------------------------------------------------------------------------------
def draw_photo(axes: "Axes", view: FigureData) -> None:
    """The photo with the bodies at several times; parts occluded by furniture are faint."""
    import matplotlib
    from matplotlib.cm import ScalarMappable
    from matplotlib.colors import ListedColormap, Normalize, to_rgb
    from PIL import Image

    aligned, people = view.aligned, view.shown_poses
    assert aligned is not None
    # the dark end of the map is invisible on a photo
    times = ListedColormap(matplotlib.colormaps[TIME_MAP](np.linspace(0.25, 1, 128)))
    bodies = []
    for index, person in enumerate(people):
        shown = _poses_in_photo(person, aligned, SHOWN_POSES if len(people) == 1 else SHOWN_POSES_OF_MANY)
        for body, share in zip(bodies_of(person, shown), shown / max(len(person.time_s) - 1, 1), strict=True):
            own = [
                part * (0.5 + 0.5 * share) for part in to_rgb(person_colour(index, len(people)))
            ]  # brighter with time
            bodies.append((body, times(share)[:3] if len(people) == 1 else own))
    height, width = aligned.photo.rgb.shape[:2]
    size = (max(round(height * PHOTO_WIDTH_PX / width), 1), PHOTO_WIDTH_PX)
    picture = np.array(Image.fromarray(aligned.photo.rgb).resize(size[::-1], Image.Resampling.BILINEAR))
    BodyPainter(aligned, size).paint(picture, bodies)
    axes.imshow(picture, interpolation="antialiased")
    axes.set(xticks=[], yticks=[])
    axes.set_anchor("NW")
    who = ("with nobody in it", "and the person at several times")
    axes.set_title(
        f"The room, {who[len(people)]}"
        if len(people) < 2
        else "The room, and the people at several times, the last the brightest"
    )
    if len(people) == 1 and len(people[0].time_s) > 1:
        from_s, to_s = float(people[0].time_s[0]), float(people[0].time_s[-1])
        bar = axes.inset_axes((0.02, 0.035, 0.2, 0.02))
        ground = {"facecolor": PAPER, "edgecolor": "none", "alpha": 0.75, "pad": 1.5}
        bar.set_title(f"{from_s:.1f} to {to_s:.1f} s", fontsize=8, pad=4.0, bbox=ground)
        axes.figure.colorbar(
            ScalarMappable(Normalize(from_s, to_s), times), cax=bar, orientation="horizontal", ticks=[]
        )
