"""Pictures of features: the arrays of `mmweaver.signal.features` with their axes, on one scale of decibels.

Pages of a recording over time: slow-time Doppler and displacement, micro-Doppler, people's paths.
"""

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from mmweaver.core.errors import InputError
from mmweaver.core.records import RadarCube
from mmweaver.core.virtual_array import resolves_elevation
from mmweaver.signal.doppler_spectrogram import MicroDoppler
from mmweaver.signal.features import (
    DRAI_SIZE,
    dynamic_range_angle,
    micro_doppler_db,
    range_azimuth_db,
    range_doppler_db,
    range_elevation_db,
)
from mmweaver.signal.slow_time import SlowTimeCell
from mmweaver.signal.spectra import azimuth_axis_rad, elevation_axis_rad
from mmweaver.signal.tracking import PersonTrack
from mmweaver.signal.vital_signs import Rate
from mmweaver.viz.figure_data import Fan, FigureData
from mmweaver.viz.panels import (
    VELOCITY,
    draw_displacement,
    draw_points_top,
    draw_slow_doppler,
    draw_spectrogram,
    velocity_bar,
)
from mmweaver.viz.theme import INK, PEOPLE_ON_WHITE, PowerScale, evenly_spaced, label_axes, page

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


FAINTEST_DB = -60.0  # of a displacement's spectrum, relative to 1 mm
MAX_SHOWN_HZ = 3.0  # of the displacement's spectrum
HEIGHT_INCH = 4.6


def draw_slow_time(
    path: Path,
    title: str,
    cube: RadarCube,
    slow_doppler: tuple[np.ndarray, np.ndarray],
    cells: Sequence[SlowTimeCell],
    rates: dict[str, Rate | None],
) -> None:
    """Writes slow-time Doppler over range, displacement over time of the strongest cells, and its spectrum.

    Args:
        path: The PNG.
        title: Title of the page.
        cube: The recording.
        slow_doppler: Power (range, doppler) of all frames, and its velocities (doppler,) in m/s.
        cells: The range bins with the strongest motion.
        rates: Breathing and heart rate, where found.
    """
    doppler, velocity_mps = slow_doppler
    half_m = cube.config.range_resolution_m / 2
    edges_m = (float(cube.grid.range_m[0]) - half_m, float(cube.grid.range_m[-1]) + half_m)
    scale = PowerScale.of(float(doppler.max()), float(np.median(doppler)), cube.scale)
    with page(path, title, 15.0, HEIGHT_INCH) as figure:
        axes = _panels(figure, 3)
        draw_slow_doppler(axes[0], scale, doppler, velocity_mps, edges_m)
        scale.bar(axes[0])
        draw_displacement(axes[1], cube.grid.frame_time_s, cells)
        _draw_spectrum(axes[2], float(np.median(np.diff(cube.grid.frame_time_s))), cells, rates)


def _draw_spectrum(axes: "Axes", period_s: float, cells: Sequence[SlowTimeCell], rates: dict[str, Rate | None]) -> None:
    """Amplitude spectrum of the displacement of some cells, with the reliable rates."""
    from scipy.signal import detrend

    top_db = FAINTEST_DB
    for cell, colour in zip(cells, PEOPLE_ON_WHITE, strict=False):
        window = np.hanning(len(cell.displacement_m))
        size = 4 * len(window)
        amplitude_m = np.abs(np.fft.rfft(detrend(cell.displacement_m) * window, size)) * 2 / window.sum()
        frequency_hz, level_db = np.fft.rfftfreq(size, period_s), 20 * np.log10(np.maximum(1e3 * amplitude_m, 1e-6))
        shown = frequency_hz <= MAX_SHOWN_HZ
        top_db = max(top_db, float(level_db[shown].max()))
        axes.plot(frequency_hz[shown], level_db[shown], color=colour, linewidth=1.0)
    for name, rate in rates.items():
        if rate is not None and rate.is_clear:
            label = f"{name}: {rate.per_minute:.1f} per minute"
            axes.axvline(rate.frequency_hz, color=INK, linestyle=":" if name == "breathing" else "--", label=label)
    if axes.get_legend_handles_labels()[1]:
        axes.legend()
    top_db = 10.0 * np.ceil((top_db + 5.0) / 10.0)
    axes.set(xlim=(0.0, MAX_SHOWN_HZ), ylim=(min(FAINTEST_DB, top_db - 10.0), top_db))
    label_axes(axes, "Spectrum of their displacement", "frequency (Hz)", "dB relative to 1 mm", grid=True)


def draw_micro_doppler(path: Path, title: str, spectrogram: MicroDoppler, amplitude_scale: float) -> None:
    """Writes radial velocity over time without static clutter.

    Args:
        path: The PNG.
        title: Title of the page.
        spectrogram: The spectrogram.
        amplitude_scale: Sqrt(mW) per unit, as `RadarCube.scale`.
    """
    (near_m, far_m), power, time_s = spectrogram.range_m, spectrogram.power, spectrogram.time_s
    scale = PowerScale.of(float(power.max()), float(np.median(power)), amplitude_scale)
    with page(path, title, 12.0, HEIGHT_INCH) as figure:
        (axes,) = _panels(figure, 1)
        draw_spectrogram(axes, scale, spectrogram, (float(time_s[0]), float(time_s[-1])))
        scale.bar(axes, share=0.4)
        what = f"Micro-Doppler by STFT over chirps, {near_m:.2f} to {far_m:.2f} m, clutter removed"
        label_axes(axes, what, "time (s)", VELOCITY)


def draw_people(path: Path, title: str, people: Sequence[PersonTrack], far_m: float) -> None:
    """Writes the paths of tracked people from above, and their distance over time.

    Args:
        path: The PNG.
        title: Title of the page.
        people: The tracks.
        far_m: Farthest range in metres.
    """
    with page(path, title, 12.0, HEIGHT_INCH) as figure:
        above, over_time = _panels(figure, 2)
        places_m = np.abs(np.concatenate([np.ones((1, 2)), *(person.place_m for person in people)]))
        reach, far = 1.2 * places_m.max(axis=0)
        for index, person in enumerate(people):
            colour = PEOPLE_ON_WHITE[index % len(PEOPLE_ON_WHITE)]
            label = f"{index + 1}: {person.mean_speed_mps:.2f} m/s"
            above.plot(*person.place_m.T, "o-", markevery=[0], color=colour, linewidth=1.2, markersize=5, label=label)
            over_time.plot(person.time_s, np.linalg.norm(person.place_m, axis=1), color=colour, linewidth=1.2)
        above.plot(0, 0, "^", color=INK, markersize=7)
        above.set(xlim=(-reach, reach), ylim=(0, min(far, far_m)), aspect="equal")
        above.legend(markerscale=0)
        label_axes(above, "Tracked people from above (dot: first seen)", "right of the radar (m)", "away (m)")
        label_axes(over_time, "Range over time", "time (s)", "range (m)")


def _panels(figure: "Figure", count: int) -> "list[Axes]":
    places = figure.add_gridspec(1, count, left=0.06, right=0.91, bottom=0.13, top=0.84, wspace=0.42)
    return [figure.add_subplot(place) for place in places]


FEATURES = ("rd", "ra", "re", "drai", "micro_doppler", "points")  # named as in `RadarDataset`
OVER_TIME = "micro_doppler"  # one panel of all frames
HEIGHT = {"ra": 0.58, "points": 0.56, "re": 1.28}  # of a panel relative to its width, where axes are in equal metres
MAX_FRAMES = 8
PANEL_INCH, LEFT_INCH, RIGHT_INCH, TOP_INCH, GAP_INCH = 2.9, 0.64, 1.1, 0.9, 0.8


def features_of(cube: RadarCube, names: Sequence[str] | None) -> list[str]:
    """The features to draw.

    Args:
        cube: The cube.
        names: Requested features; by default all that the array resolves.

    Raises:
        InputError: For unknown names.
    """
    if names is None:
        return [name for name in FEATURES if name != "re" or resolves_elevation(cube.config)]
    for name in names:
        if name not in FEATURES:
            raise InputError(f"unknown feature {name!r}; known: {', '.join(FEATURES)}")
    return list(names)


def frames_of(cube: RadarCube, frames: Sequence[int] | None) -> list[int]:
    """The frames to draw.

    Args:
        cube: The cube.
        frames: Requested frames; by default four, evenly spaced.

    Raises:
        InputError: For too many frames, or frames that do not exist.
    """
    if frames is None:
        return evenly_spaced(len(cube.values), 4).tolist()
    if not 1 <= len(frames) <= MAX_FRAMES:
        raise InputError(f"give 1 to {MAX_FRAMES} frames, not {len(frames)}")
    for frame in frames:
        if not 0 <= frame < len(cube.values):
            raise InputError(f"there is no frame {frame}; the frames are 0 to {len(cube.values) - 1}")
    return list(frames)


def draw_features(
    path: Path, view: FigureData, features: Sequence[str], frames: Sequence[int], *, moving: bool = False
) -> None:
    """Writes a PNG with a row per feature and a column per frame.

    Args:
        path: The PNG.
        view: The data to show.
        features: Names of the features.
        frames: Frame numbers.
        moving: Whether the mean chirp of each frame is removed.
    """
    step = PANEL_INCH + GAP_INCH
    tall = [PANEL_INCH * HEIGHT.get(name, 1.0) for name in features]
    width, height = LEFT_INCH + len(frames) * step + RIGHT_INCH, TOP_INCH + sum(tall) + GAP_INCH * len(tall)
    grid = replace(view.cube.grid, frame_time_s=view.cube.grid.frame_time_s[list(frames)])
    chosen = replace(view, poses=(), cube=replace(view.cube, values=view.cube.values[list(frames)], grid=grid))
    when = [f"frame {frame} ({time_s:.2f} s)" for frame, time_s in zip(frames, grid.frame_time_s, strict=True)]
    clutter = "no clutter" if moving else "with clutter"
    with page(path, view.title, width, height) as figure:
        for row, name in enumerate(features):
            bottom = (height - TOP_INCH - sum(tall[: row + 1]) - row * GAP_INCH) / height
            wide = len(frames) * step - GAP_INCH if name == OVER_TIME else PANEL_INCH
            scale, left = view.scale, LEFT_INCH
            if name == OVER_TIME:
                scale = _summed(scale, len(grid.range_m))
            elif name != "points":
                maps = _maps(name, chosen, moving)
            for column in range(1 if name == OVER_TIME else len(frames)):
                axes = figure.add_axes(((left + column * step) / width, bottom, wide / width, tall[row] / height))
                if name == OVER_TIME:
                    scale.draw(axes, micro_doppler_db(view.cube).T, (*view.time_edges_s, *view.velocity_edges_mps))
                    label_axes(axes, "Micro-Doppler, clutter removed", "time (s)", VELOCITY)
                elif name == "points":
                    own = view.points.select(view.points.frame == frames[column])
                    draw_points_top(axes, replace(view, points=own))
                    axes.set_title(f"Points from above, {when[column]}")
                else:
                    _draw_map(axes, name, maps[column], chosen, (clutter, when[column]))
            if name == "points":
                velocity_bar(axes, view)
            else:
                scale.bar(axes, share=PANEL_INCH / wide)


def _summed(scale: PowerScale, cells: int) -> PowerScale:
    """The scale of a sum over cells: the noise of all of them."""
    if scale.noise_db is None:
        return scale
    more_db = 10 * float(np.log10(cells))
    return replace(scale, low_db=scale.low_db + more_db, high_db=scale.high_db + 5, noise_db=scale.noise_db + more_db)


def _maps(name: str, chosen: FigureData, moving: bool) -> np.ndarray:
    """A feature in decibels, for each selected frame."""
    if name == "drai":
        return 10 * np.log10(np.maximum(dynamic_range_angle(chosen.cube) * chosen.scale.factor, 1e-30))
    feature = {"rd": range_doppler_db, "ra": range_azimuth_db, "re": range_elevation_db}[name]
    return feature(chosen.cube, moving=moving)


def _draw_map(axes: "Axes", name: str, power_db: np.ndarray, view: FigureData, words: tuple[str, str]) -> None:
    """The map of a feature in one frame; `words` say whether it shows clutter, and when it is."""
    scale, (clutter, when) = view.scale, words
    if name == "rd":
        scale.draw(axes, power_db, (*view.velocity_edges_mps, *view.range_edges_m))
        return label_axes(axes, f"Range-Doppler, {clutter}, {when}", VELOCITY, "range (m)")
    if name == "drai":
        edge = float(np.degrees(azimuth_axis_rad(DRAI_SIZE)[-1]))
        scale.draw(axes, power_db, (-edge, edge, *view.range_edges_m))
        return label_axes(axes, f"Dynamic range-angle, {when}", "azimuth (degrees), right +", "range (m)")
    fan = Fan.over(view.cube.grid.range_m, azimuth_axis_rad(91) if name == "ra" else elevation_axis_rad(61))
    low, high, near, far = fan.extent
    if name == "ra":
        scale.draw(axes, fan.lay(power_db), fan.extent)
        label_axes(axes, f"Range-azimuth, {clutter}, {when}", "right (m)", "ahead (m)")
    else:
        scale.draw(axes, fan.lay(power_db).T, (near, far, low, high))
        label_axes(axes, f"Range-elevation, {clutter}, {when}", "ahead (m)", "up (m)")
    axes.set_aspect("equal", anchor="NW")
