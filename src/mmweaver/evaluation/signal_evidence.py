"""One recorded or simulated signal with the quantities behind its features: static cells, movement, noise, body."""

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

MAX_CUBE_BYTES = 256_000_000  # per signal; later frames are ignored
QUARTERS = 4  # recordings of a few frames are measured on quarters of frames
MIN_UNITS = 4  # minimum number of frames for a spread
MIN_LOOPS = 8  # minimum number of loops to separate movement from clutter
PERSON_OVER_NOISE = 20.0  # 13 dB: moving energy of a range bin relative to its noise
NEAREST_BODY_M = 0.25  # excludes leakage and cables
NOISE_BINS = 9  # range bins over which noise is smoothed, since the IF response is smooth


class CannotSeeError(Exception):
    """A feature cannot be measured on a recording; the message states the reason."""


def decibels(ratio: np.ndarray | float) -> np.ndarray:
    """Converts a power ratio to dB; nan if it is not positive."""
    power = np.asarray(ratio, float)
    return np.asarray(10 * np.log10(np.where((power > 0) & np.isfinite(power), power, np.nan)))


@dataclass(frozen=True, kw_only=True)
class ComparedSignal:
    """One signal of a comparison; `adc` covers all range bins, the cube only its range window."""

    name: str
    cube: RadarCube
    adc: AdcCube | None = None
    points: PointCloud | None = None  # None: detect by CFAR
    meta: dict[str, Any] = field(default_factory=dict)


@dataclass(frozen=True)
class SignalEvidence:
    """Quantities from which features are measured, computed at first use.

    Attributes:
        signal: The signal.
        window_m: Range window (near, far) in metres that all compared signals cover.
        points_m: The same for their cubes, from which points are detected; samples may cover more.
    """

    signal: ComparedSignal
    window_m: tuple[float, float] = (0.0, np.inf)
    points_m: tuple[float, float] = (0.0, np.inf)

    @cached_property
    def cube(self) -> RadarCube:
        """Cube of all range bins of the samples, or the stored cube without samples."""
        adc, cube = self.signal.adc, self.signal.cube
        if adc is None:
            return cube.select(slice(_frames_that_fit(cube.grid.shape)))
        config = replace(adc.config, first_range_bin=0, num_range_bins=adc.config.num_unambiguous_range_bins)
        grid = CubeGrid.of(config, len(adc.samples))
        few = adc.samples[: _frames_that_fit(grid.shape)]
        return radar_cube(replace(adc, samples=few, config=config))

    @cached_property
    def range_m(self) -> np.ndarray:
        """Ranges of the cube in metres, (range,)."""
        return self.cube.grid.range_m

    @cached_property
    def in_window(self) -> np.ndarray:
        """Mask of the ranges that all signals cover, (range,)."""
        return (self.range_m >= self.window_m[0] - 1e-9) & (self.range_m <= self.window_m[1] + 1e-9)

    @cached_property
    def power(self) -> np.ndarray:
        """Power averaged over antennas, (frame, range, doppler)."""
        return range_doppler_power(self.cube)

    @cached_property
    def is_lost(self) -> np.ndarray:
        """Mask of frames that are zero (lost packets), (frame,)."""
        return np.logical_not(self.cube.values.any(axis=(1, 2, 3)))

    @cached_property
    def still(self) -> np.ndarray:
        """Values at zero Doppler, complex128 (frame, range, antenna)."""
        return self.cube.values[:, :, self.cube.config.num_loops // 2].astype(np.complex128)

    @cached_property
    def still_power(self) -> np.ndarray:
        """Static power averaged over antennas, (frame, range)."""
        return (np.abs(self.still) ** 2).mean(axis=2)

    @cached_property
    def far_doppler(self) -> np.ndarray:
        """Mask of the outer half of the Doppler bins, where noise is measured."""
        velocity = np.abs(self.cube.grid.radial_velocity_mps)
        return velocity > 0.5 * self.cube.config.max_velocity_mps

    @cached_property
    def mean_still(self) -> np.ndarray:
        """Values at zero Doppler averaged over received frames, complex128 (range, antenna)."""
        return self.still[~self.is_lost].mean(axis=0)

    @property
    def has_doppler(self) -> bool:
        """Whether there are enough loops per frame to separate movement and noise from clutter."""
        return self.cube.config.num_loops >= MIN_LOOPS

    @cached_property
    def noise_of_bin(self) -> np.ndarray:
        """Noise power of a cell, (frame, range): median over the outer Doppler bins.

        Raises:
            CannotSeeError: With too few loops per frame.
        """
        if not self.has_doppler:
            raise CannotSeeError(f"{self.cube.config.num_loops} loops per frame show no noise")
        return np.median(self.power[:, :, self.far_doppler], axis=2)

    @cached_property
    def noise(self) -> np.ndarray:
        """Noise power of a cell, median over range, (frame,).

        Raises:
            CannotSeeError: With too few loops per frame.
        """
        return np.median(self.noise_of_bin, axis=1)

    @property
    def noise_of_band(self) -> np.ndarray:
        """Noise power of all range bins, (frame, range).

        Raises:
            CannotSeeError: If the cube does not contain all range bins, or there are too few loops.
        """
        noise, config = self.noise_of_bin, self.cube.config
        if config.num_range_bins < config.num_unambiguous_range_bins:
            raise CannotSeeError("the range window is cut; it takes raw samples or a cube of all range bins")
        return noise

    @property
    def noise_at_range_0(self) -> np.ndarray:
        """Noise power of a cell, (frame,), for signals that show leakage.

        Raises:
            CannotSeeError: If the range window does not start at 0, samples are real, or there are too few loops.
        """
        config = self.cube.config
        if config.first_range_bin:
            raise CannotSeeError(f"the range window begins at {self.range_m[0]:.2f} m; it takes raw samples")
        if not config.complex_samples:
            raise CannotSeeError("of real samples the bins near range 0 hold the converter's offset")
        return self.noise

    @property
    def noise_share(self) -> float:
        """Noise power of a cell relative to one ADC sample."""
        return noise_share(self.cube.config.num_samples, self.cube.config.num_loops)

    @cached_property
    def moving_profile(self) -> tuple[np.ndarray, np.ndarray]:
        """Moving energy minus noise, and that noise, both (frame, range).

        The mean chirp of each frame is removed and the Doppler bins of movement are summed. Noise is estimated per
        range from the outer Doppler bins: the IF filter shapes it by some decibels, and a single level for all ranges
        would leave apparent movement everywhere (3 dB of the energy 1 to 2 m behind a recorded person).

        Raises:
            CannotSeeError: With too few loops per frame.
        """
        if not self.has_doppler:
            raise CannotSeeError(f"{self.cube.config.num_loops} loops per frame separate no movement from clutter")
        power = range_doppler_power(remove_static(self.cube))
        moving = moving_doppler(self.cube)
        outer = power[:, :, self.far_doppler & moving]
        # the median is robust against fast limbs, and below the mean of the antennas' power by a known factor
        noise = median_filter(np.median(outer, axis=2), size=(1, NOISE_BINS), mode="nearest")
        noise *= moving.sum() / _median_over_mean(self.cube.config.num_antennas)
        return power[:, :, moving].sum(axis=2) - noise, noise

    @cached_property
    def body_bin(self) -> np.ndarray:
        """Range bin with the strongest movement of each frame, (frame,); -1 if nothing moves 13 dB above the noise."""
        if not self.has_doppler:
            return np.full(len(self.still), -1)
        profile, noise = self.moving_profile
        at = np.where(self.range_m >= NEAREST_BODY_M, profile, -np.inf).argmax(axis=1)
        frame = np.arange(len(at))
        return np.where(profile[frame, at] > PERSON_OVER_NOISE * noise[frame, at], at, -1)

    @cached_property
    def points(self) -> PointCloud:
        """Stored points of the signal, or those of CFAR, within the common ranges."""
        cloud = self.signal.points if self.signal.points is not None else point_cloud(self.signal.cube)
        distance = cloud.range_m
        return cloud.select((distance >= self.points_m[0]) & (distance <= self.points_m[1]))

    def quarters(self) -> "SignalEvidence | None":
        """The same signal with each frame divided into four; None without samples or with too few loops."""
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
    """Median / mean of noise power averaged over antennas, a gamma distribution."""
    return float(gammaincinv(num_antennas, 0.5)) / num_antennas


def _frames_that_fit(shape: tuple[int, ...]) -> int:
    return max(1, MAX_CUBE_BYTES // (8 * int(np.prod(shape[1:]))))
