"""Pages of what a recording shows over time: slow-time Doppler and displacement, micro-Doppler, people's paths."""

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from mmweaver.core.records import RadarCube
from mmweaver.dsp.doppler_spectrogram import MicroDoppler
from mmweaver.dsp.slow_time import SlowTimeCell
from mmweaver.dsp.tracking import PersonTrack
from mmweaver.dsp.vital_signs import Rate
from mmweaver.figures.power_map import draw_power_map, scale_bar
from mmweaver.figures.power_scale import PowerScale
from mmweaver.figures.theme import INK, PEOPLE_ON_WHITE, STYLE, label_axes, legend, shortened

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

DPI = 100
NARROWEST_MPS = 0.02  # half width of the velocity axis over frames
FAINTEST_DB = -60.0  # of a displacement's spectrum, relative to 1 mm
FASTEST_SHOWN_HZ = 3.0  # of the displacement's spectrum
MOVING_DB = 50.0  # velocities whose power is so far below the strongest are not shown
MOST_COLUMNS = 1200  # of a spectrogram


def draw_slow_time(
    path: Path, title: str, cube: RadarCube, doppler: np.ndarray, velocity_mps: np.ndarray,
    cells: Sequence[SlowTimeCell], rates: dict[str, Rate | None],
) -> None:  # fmt: skip
    """Range over slow-time velocity, displacement of the cells that move most over time, and its spectrum."""
    with styled():
        figure = _slow_time_figure(title, cube, doppler, velocity_mps, cells, rates)
        write_figure(figure, path)


def _slow_time_figure(
    title: str, cube: RadarCube, doppler: np.ndarray, velocity_mps: np.ndarray, cells: Sequence[SlowTimeCell],
    rates: dict[str, Rate | None],
) -> "Figure":  # fmt: skip
    figure, axes = _page(title, 3, 15.0)
    time_s, scale = cube.grid.frame_time_s, PowerScale.of(float(doppler.max()), float(np.median(doppler)), cube.scale)
    _slow_doppler(axes[0], cube.grid.range_m, doppler, velocity_mps, scale)
    entries, spectra = [], []
    for index, cell in enumerate(cells):
        colour = PEOPLE_ON_WHITE[index % len(PEOPLE_ON_WHITE)]
        entries.append((f"at {cell.range_m:.2f} m", colour))
        axes[1].plot(time_s, 1e3 * cell.displacement_m, color=colour, linewidth=1.0)
        frequency_hz, level_db = _spectrum(cell.displacement_m, float(np.median(np.diff(time_s))))
        shown = frequency_hz <= FASTEST_SHOWN_HZ
        spectra.append(level_db[shown])
        axes[2].plot(frequency_hz[shown], level_db[shown], color=colour, linewidth=1.0)
    axes[1].set_xlim(float(time_s[0]), float(time_s[-1]))
    label_axes(axes[1], "Cells that move most", "time (s)", "displacement (mm), away +", grid=True)
    top_db = 10.0 * np.ceil((max(float(level.max()) for level in spectra) + 5.0) / 10.0) if spectra else 0.0
    axes[2].set(xlim=(0.0, FASTEST_SHOWN_HZ), ylim=(min(FAINTEST_DB, top_db - 10.0), top_db))
    label_axes(axes[2], "Spectrum of their displacement", "frequency (Hz)", "dB relative to 1 mm", grid=True)
    for name, rate in rates.items():
        if rate is not None and rate.is_clear:
            style = ":" if name == "breathing" else "--"
            axes[2].axvline(rate.frequency_hz, color=INK, linestyle=style, linewidth=1.0)
            entries.append((f"{name}: {rate.per_minute:.1f} a minute", INK))
    legend(axes[2], entries)
    return figure


def draw_micro_doppler(path: Path, title: str, spectrogram: MicroDoppler, amplitude_scale: float) -> None:
    """Radial velocity over time, static clutter removed; `amplitude_scale` as `RadarCube.scale`."""
    with styled():
        write_figure(_micro_doppler_figure(title, spectrogram, amplitude_scale), path)


def _micro_doppler_figure(title: str, spectrogram: MicroDoppler, amplitude_scale: float) -> "Figure":
    near_m, far_m = spectrogram.range_m
    figure, (axes,) = _page(title, 1, 12.0)
    power = spectrogram.power
    time_s = spectrogram.time_s
    # columns of equal time: pauses between frames are held
    edges_s = np.linspace(time_s[0], time_s[-1], min(MOST_COLUMNS, 4 * len(time_s)))
    nearest = np.clip(np.searchsorted(time_s, edges_s), 0, len(time_s) - 1)
    velocity = spectrogram.radial_velocity_mps
    extent = float(edges_s[0]), float(edges_s[-1]), float(velocity[0]), float(velocity[-1])
    scale = PowerScale.of(float(power.max()), float(np.median(power)), amplitude_scale)
    draw_power_map(axes, scale, scale.decibels(power[nearest].T), extent)
    scale_bar(axes, scale)
    label_axes(
        axes, f"Micro-Doppler by STFT over chirps, {near_m:.2f} to {far_m:.2f} m, clutter removed", "time (s)",
        "radial velocity (m/s), away +",
    )  # fmt: skip
    return figure


def draw_people(path: Path, title: str, people: Sequence[PersonTrack], far_m: float) -> None:
    """The paths of tracked people from above, and their distance over time."""
    with styled():
        write_figure(_people_figure(title, people, far_m), path)


def _people_figure(title: str, people: Sequence[PersonTrack], far_m: float) -> "Figure":
    figure, axes = _page(title, 2, 12.0)
    entries: list[tuple[str, str]] = []
    for index, person in enumerate(people):
        colour = PEOPLE_ON_WHITE[index % len(PEOPLE_ON_WHITE)]
        entries.append((f"{index + 1}: {person.mean_speed_mps:.2f} m/s", colour))
        axes[0].plot(*person.place_m.T, color=colour, linewidth=1.2)
        axes[0].plot(*person.place_m[0], "o", color=colour, markersize=5)
        axes[1].plot(person.time_s, np.linalg.norm(person.place_m, axis=1), color=colour, linewidth=1.2)
    axes[0].plot(0, 0, "^", color=INK, markersize=7)
    reach = max([1.0, *(float(np.abs(one.place_m[:, 0]).max()) for one in people)]) * 1.2
    far = max([1.0, *(float(one.place_m[:, 1].max()) for one in people)]) * 1.2
    axes[0].set(xlim=(-reach, reach), ylim=(0, min(far, far_m)), aspect="equal")
    label_axes(axes[0], "Tracked people from above (dot: first seen)", "right of the radar (m)", "away (m)")
    label_axes(axes[1], "Range over time", "time (s)", "range (m)")
    legend(axes[0], entries)
    return figure


def _slow_doppler(
    axes: "Axes", range_m: np.ndarray, power: np.ndarray, velocity_mps: np.ndarray, scale: PowerScale
) -> None:  # fmt: skip
    """The middle of the velocity axis that holds the movement."""
    along = power.max(axis=0)
    moving = np.flatnonzero(along >= along.max() * 10 ** (-MOVING_DB / 10))
    reach = max(NARROWEST_MPS, 1.3 * float(np.abs(velocity_mps[moving]).max(initial=0.0)))
    shown = np.abs(velocity_mps) <= reach
    edges = velocity_mps[shown]
    extent = 1e3 * float(edges[0]), 1e3 * float(edges[-1]), float(range_m[0]), float(range_m[-1])
    draw_power_map(axes, scale, scale.decibels(power[:, shown]), extent)
    scale_bar(axes, scale)
    label_axes(axes, "Doppler over frames, mean removed", "radial velocity (mm/s), away +", "range (m)")


def _spectrum(displacement_m: np.ndarray, period_s: float) -> tuple[np.ndarray, np.ndarray]:
    """Amplitude in decibels relative to 1 mm of each frequency in Hz."""
    count = len(displacement_m)
    trend = np.polyval(np.polyfit(np.arange(count), displacement_m, 1), np.arange(count))
    window = np.hanning(count)
    spectrum = np.abs(np.fft.rfft((displacement_m - trend) * window, 4 * count)) * 2 / window.sum()
    return np.fft.rfftfreq(4 * count, period_s), 20 * np.log10(np.maximum(1e3 * spectrum, 1e-6))


def _page(title: str, panels: int, width: float) -> "tuple[Figure, list[Axes]]":
    from matplotlib.figure import Figure

    figure = Figure(figsize=(width, 4.6), dpi=DPI, facecolor="white")
    figure.suptitle(shortened(title, 140), x=0.04, y=0.98, ha="left", va="top", fontsize=13, fontweight="bold")
    places = figure.add_gridspec(1, panels, left=0.06, right=0.91, bottom=0.13, top=0.84, wspace=0.36)
    return figure, [figure.add_subplot(places[0, at]) for at in range(panels)]


def write_figure(figure: "Figure", path: Path) -> None:
    """Writes a figure as PNG."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg

    FigureCanvasAgg(figure).print_png(path, metadata={"Software": "mmWeaver"}, pil_kwargs={"compress_level": 2})


@contextmanager
def styled() -> Iterator[None]:
    """Within it, figures have the common style."""
    import matplotlib

    with matplotlib.rc_context(STYLE):
        yield
