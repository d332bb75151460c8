"""One recorded or simulated signal, and what features are measured on: static cells, movement, noise, the body."""

from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any

import numpy as np
from scipy.ndimage import median_filter
from scipy.special import gammaincinv

from mmweaver.core.records import AdcCube, CubeGrid, PointCloud, RadarCube
from mmweaver.signal.cube import radar_cube, remove_static
from mmweaver.signal.points import point_cloud
from mmweaver.signal.spectra import moving_doppler, range_doppler_power
from mmweaver.signal.windows import noise_share

MAX_CUBE_BYTES = 256_000_000  # of a signal; the rest of a longer one is left out
QUARTERS = 4  # a recording of one or two frames is measured on quarters of them
MIN_UNITS = 4  # frames that show a spread
MIN_LOOPS = 8  # of a Doppler axis that separates movement from clutter
PERSON_OVER_NOISE = 20.0  # 13 dB: moving energy of a range bin over the noise in it
NEAREST_BODY_M = 0.25  # leakage and cables lie nearer
NOISE_BINS = 9  # range bins over which noise is smoothed: an IF response is smooth


class CannotSeeError(Exception):
    """A feature that a recording does not show; the message gives the reason."""


def decibels(ratio: np.ndarray | float) -> np.ndarray:
    """10 log10 of a ratio of powers; nan where it is not positive."""
    power = np.asarray(ratio, float)
    return np.asarray(10 * np.log10(np.where((power > 0) & np.isfinite(power), power, np.nan)))


@dataclass(frozen=True, kw_only=True)
class ComparedSignal:
    """One side of a comparison; `adc` shows all range bins, the cube only those that were kept."""

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
            return cube.select(slice(_frames_that_fit(cube.grid.shape)))
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
        return np.logical_not(self.cube.values.any(axis=(1, 2, 3)))

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
    def mean_still(self) -> np.ndarray:
        """Zero Doppler, mean over the frames that were not lost, complex128 (range, antenna)."""
        return self.still[~self.is_lost].mean(axis=0)

    @property
    def has_doppler(self) -> bool:
        """Whether a frame has enough loops to separate movement and noise from clutter."""
        return self.cube.config.num_loops >= MIN_LOOPS

    @cached_property
    def noise_of_bin(self) -> np.ndarray:
        """Noise power of a cell, (frame, range): median over the outer Doppler bins. Raises CannotSeeError."""
        if not self.has_doppler:
            raise CannotSeeError(f"{self.cube.config.num_loops} loops per frame show no noise")
        return np.median(self.power[:, :, self.far_doppler], axis=2)

    @cached_property
    def noise(self) -> np.ndarray:
        """Noise power of a cell, (frame,). Raises CannotSeeError for few loops."""
        return np.median(self.noise_of_bin, axis=1)

    @property
    def noise_of_band(self) -> np.ndarray:
        """Noise power (frame, range) of all range bins. Raises CannotSeeError where the cube was cut."""
        noise, config = self.noise_of_bin, self.cube.config
        if config.num_range_bins < config.num_unambiguous_range_bins:
            raise CannotSeeError("the range window is cut; it takes raw samples or a cube of all range bins")
        return noise

    @property
    def noise_at_range_0(self) -> np.ndarray:
        """Noise power of a cell, (frame,), of a signal that shows leakage. Raises CannotSeeError for any other."""
        config = self.cube.config
        if config.first_range_bin:
            raise CannotSeeError(f"the range window begins at {self.range_m[0]:.2f} m; it takes raw samples")
        if not config.complex_samples:
            raise CannotSeeError("of real samples the bins near range 0 hold the converter's offset")
        return self.noise

    @property
    def noise_share(self) -> float:
        """Noise power of a cell over that of one ADC sample."""
        return noise_share(self.cube.config.num_samples, self.cube.config.num_loops)

    @cached_property
    def moving_profile(self) -> tuple[np.ndarray, np.ndarray]:
        """Moving energy minus noise, and that noise, both (frame, range). Raises CannotSeeError for few loops.

        The mean chirp of each frame is removed and the Doppler bins of movement are summed. Noise is that of each
        range, from the outer Doppler bins: an IF filter makes it slope by some decibels, and one level for all ranges
        leaves what looks like faint movement everywhere (3 dB of the energy 1 to 2 m behind a recorded person).
        """
        if not self.has_doppler:
            raise CannotSeeError(f"{self.cube.config.num_loops} loops per frame separate no movement from clutter")
        power = range_doppler_power(remove_static(self.cube))
        moving = moving_doppler(self.cube)
        outer = power[:, :, self.far_doppler & moving]
        # a median ignores fast limbs, and is below the mean of the antennas' powers by a known factor
        noise = median_filter(np.median(outer, axis=2), size=(1, NOISE_BINS), mode="nearest")
        noise *= moving.sum() / _median_over_mean(self.cube.config.num_antennas)
        return power[:, :, moving].sum(axis=2) - noise, noise

    @cached_property
    def body_bin(self) -> np.ndarray:
        """Range bin of the strongest movement of each frame, (frame,); -1 where nothing moves 13 dB above the noise."""
        if not self.has_doppler:
            return np.full(len(self.still), -1)
        profile, noise = self.moving_profile
        at = np.where(self.range_m >= NEAREST_BODY_M, profile, -np.inf).argmax(axis=1)
        frame = np.arange(len(at))
        return np.where(profile[frame, at] > PERSON_OVER_NOISE * noise[frame, at], at, -1)

    @cached_property
    def points(self) -> PointCloud:
        """The signal's points, or those of CFAR, within the common ranges."""
        cloud = self.signal.points if self.signal.points is not None else point_cloud(self.signal.cube)
        distance = cloud.range_m
        return cloud.select((distance >= self.points_m[0]) & (distance <= self.points_m[1]))

    def quarters(self) -> "SignalEvidence | None":
        """The same signal with each frame divided into four shorter ones; None where that cannot be."""
        adc = self.signal.adc
        if adc is None or adc.config.num_loops < QUARTERS * MIN_LOOPS:
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
    return max(1, MAX_CUBE_BYTES // (8 * int(np.prod(shape[1:]))))
