"""Pages of a recording over time: slow-time Doppler and displacement, micro-Doppler, people's paths."""

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from mmweaver.core.records import RadarCube
from mmweaver.signal.doppler_spectrogram import MicroDoppler
from mmweaver.signal.slow_time import SlowTimeCell
from mmweaver.signal.tracking import PersonTrack
from mmweaver.signal.vital_signs import Rate
from mmweaver.viz.panels import VELOCITY, draw_displacement, draw_slow_doppler, draw_spectrogram
from mmweaver.viz.power_scale import PowerScale
from mmweaver.viz.theme import INK, PEOPLE_ON_WHITE, label_axes, page

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
