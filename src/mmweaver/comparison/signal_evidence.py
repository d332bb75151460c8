"""One recorded or simulated signal, and what its features are measured on: static cells, movement, noise, the body."""

from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any

import numpy as np
from scipy.ndimage import median_filter
from scipy.special import gammaincinv

from mmweaver.core.records import AdcCube, CubeGrid, PointCloud, RadarCube
from mmweaver.dsp.cube import radar_cube, remove_static
from mmweaver.dsp.points import point_cloud
from mmweaver.dsp.spectra import moving_doppler, range_doppler_power
from mmweaver.dsp.windows import noise_share

LARGEST_CUBE_BYTES = 256_000_000  # of a signal; the rest of a longer one is left out
QUARTERS = 4  # a recording of one or two frames is measured on quarters of them
FEWEST_UNITS = 4  # frames that show a spread
FEWEST_LOOPS = 8  # of a Doppler axis that separates movement from clutter
PERSON_OVER_NOISE = 20.0  # 13 dB: moving energy of a range bin over the noise in it
NEAREST_BODY_M = 0.25  # leakage and cables lie nearer
FEWEST_SLOW_FRAMES = 32
NOISE_BINS = 9  # range bins over which noise is smoothed: an IF response is smooth


@dataclass(frozen=True, kw_only=True)
class ComparedSignal:
    """A signal as `compare` takes it; `adc` shows all range bins, the cube only those that were kept."""

    name: str
    cube: RadarCube
    adc: AdcCube | None = None
    points: PointCloud | None = None  # None: detected by CFAR
    meta: dict[str, Any] = field(default_factory=dict)


@dataclass(frozen=True)
class SignalEvidence:
    """What features are measured on; `window_m` are the ranges that all signals show, `points_m` those of their cubes.

    They differ where samples show more than the cube whose points were detected.
    """

    signal: ComparedSignal
    window_m: tuple[float, float] = (0.0, np.inf)
    points_m: tuple[float, float] = (0.0, np.inf)

    @cached_property
    def cube(self) -> RadarCube:
        """All range bins of the samples where there are samples, else the bins that were kept."""
        adc, cube = self.signal.adc, self.signal.cube
        if adc is None:
            return _first_frames(cube, _frames_that_fit(cube.grid.shape))
        config = replace(adc.config, first_range_bin=0, num_range_bins=adc.config.num_unambiguous_range_bins)
        grid = CubeGrid.of(config, len(adc.samples))
        few = adc.samples[: _frames_that_fit(grid.shape)]
        return radar_cube(replace(adc, samples=few, config=config))

    @cached_property
    def range_m(self) -> np.ndarray:
        return self.cube.grid.range_m

    @cached_property
    def in_window(self) -> np.ndarray:
        """Mask (range,) of the ranges that both sides show."""
        return (self.range_m >= self.window_m[0] - 1e-9) & (self.range_m <= self.window_m[1] + 1e-9)

    @cached_property
    def power(self) -> np.ndarray:
        """Mean of the antennas (frame, range, doppler)."""
        return range_doppler_power(self.cube)

    @cached_property
    def is_lost(self) -> np.ndarray:
        """Mask (frame,) of frames that hold nothing but zeros: lost packets."""
        return np.logical_not(self.cube.values.reshape(len(self.cube.values), -1).any(axis=1))

    @cached_property
    def still(self) -> np.ndarray:
        """Values at zero Doppler, complex128 (frame, range, antenna)."""
        return self.cube.values[:, :, self.cube.config.num_loops // 2].astype(np.complex128)

    @cached_property
    def still_power(self) -> np.ndarray:
        """Static power, mean of the antennas, (frame, range)."""
        return (np.abs(self.still) ** 2).mean(axis=2)

    @cached_property
    def far_doppler(self) -> np.ndarray:
        """Mask of the outer half of the Doppler bins, where noise is measured."""
        velocity = np.abs(self.cube.grid.radial_velocity_mps)
        return velocity > 0.5 * self.cube.config.max_velocity_mps

    @cached_property
    def noise_of_bin(self) -> np.ndarray | None:
        """Noise power of a cell, (frame, range): median over the outer Doppler bins; None for few loops."""
        if self.cube.config.num_loops < FEWEST_LOOPS:
            return None
        return np.median(self.power[:, :, self.far_doppler], axis=2)

    @cached_property
    def noise(self) -> np.ndarray | None:
        """Noise power of a cell, (frame,); None for few loops."""
        return None if self.noise_of_bin is None else np.median(self.noise_of_bin, axis=1)

    @property
    def noise_share(self) -> float:
        """Noise power of a cell over that of one ADC sample."""
        return noise_share(self.cube.config.num_samples, self.cube.config.num_loops)

    @cached_property
    def moving_profile(self) -> tuple[np.ndarray, np.ndarray] | None:
        """Moving energy without noise, and the noise that was taken away, both (frame, range); None for few loops.

        The mean chirp of each frame is removed and the Doppler bins of movement are added up. Noise is that of each
        range, from the outer Doppler bins: an IF filter makes it slope by some decibels, and one level for all ranges
        leaves what looks like faint movement everywhere (3 dB of the energy 1 to 2 m behind a recorded person).
        """
        if self.cube.config.num_loops < FEWEST_LOOPS:
            return None
        power = range_doppler_power(remove_static(self.cube))
        moving = moving_doppler(self.cube)
        outer = power[:, :, self.far_doppler & moving]
        # a median is deaf to limbs that are fast, and below the mean of antennas' powers by a known factor
        noise = median_filter(np.median(outer, axis=2), size=(1, NOISE_BINS), mode="nearest")
        noise *= moving.sum() / _median_over_mean(self.cube.config.num_antennas)
        return power[:, :, moving].sum(axis=2) - noise, noise

    @cached_property
    def slow_profile(self) -> np.ndarray | None:
        """Movement over the frames, (range,): power of zero Doppler without its mean; None for few frames."""
        if len(self.still) < FEWEST_SLOW_FRAMES:
            return None
        return (np.abs(self.still - self.still.mean(axis=0)) ** 2).mean(axis=(0, 2))

    @cached_property
    def body_bin(self) -> np.ndarray:
        """Range bin of the strongest movement of each frame, (frame,); -1 where nothing moves 13 dB above the noise."""
        if self.moving_profile is None:
            return np.full(len(self.still), -1)
        profile, noise = self.moving_profile
        allowed = np.where(self.range_m >= NEAREST_BODY_M, profile, -np.inf)
        at = allowed.argmax(axis=1)
        frame = np.arange(len(at))
        return np.where(profile[frame, at] > PERSON_OVER_NOISE * noise[frame, at], at, -1)

    @cached_property
    def points(self) -> PointCloud:
        """The signal's points, or those of CFAR, within the common ranges."""
        cloud = self.signal.points if self.signal.points is not None else point_cloud(self.signal.cube)
        distance = cloud.range_m
        return cloud.select((distance >= self.points_m[0]) & (distance <= self.points_m[1]))

    @property
    def num_point_frames(self) -> int:
        return len(self.signal.cube.values)

    def quarters(self) -> "SignalEvidence | None":
        """The same signal with each frame divided into four shorter ones; None where that cannot be."""
        adc = self.signal.adc
        if adc is None or adc.config.num_loops < QUARTERS * FEWEST_LOOPS:
            return None
        loops = adc.config.num_loops // QUARTERS
        period_s = loops * adc.config.loop_period_s
        config = replace(adc.config, num_loops=loops, frame_period_s=period_s * (1 + 1e-9))
        samples = adc.samples[:, : QUARTERS * loops].reshape(-1, loops, *adc.samples.shape[2:])
        parts = replace(adc, samples=samples, config=config)
        return SignalEvidence(ComparedSignal(name=self.signal.name, cube=radar_cube(parts), adc=parts), self.window_m)


def _median_over_mean(num_antennas: int) -> float:
    """Of noise power averaged over antennas: a gamma distribution of as many degrees of freedom."""
    return float(gammaincinv(num_antennas, 0.5)) / num_antennas


def _frames_that_fit(shape: tuple[int, ...]) -> int:
    return max(1, LARGEST_CUBE_BYTES // (8 * int(np.prod(shape[1:]))))


def _first_frames(cube: RadarCube, frames: int) -> RadarCube:
    if len(cube.values) <= frames:
        return cube
    grid = replace(cube.grid, frame_time_s=cube.grid.frame_time_s[:frames])
    return replace(cube, values=cube.values[:frames], grid=grid)
