"""Gain and CFAR threshold from point clouds of people: those with which a simulated person gives clouds alike.

Someone who does what the recorded people did is simulated at the recorded distances with the radar's physics; the gain
makes the median intensity of points the recorded one, the threshold their number. Both hang together, as the threshold
decides which intensities remain, so they take turns. What the person did is an assumption and is said.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from mmweaver.calibration.finding import Finding
from mmweaver.core.errors import InputError
from mmweaver.core.firmware_settings import FirmwareSettings
from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.records import AdcCube, PointCloud, PoseSequence
from mmweaver.dsp.firmware import FirmwareCloud, check_firmware_radar, firmware_points
from mmweaver.motion.empty_floor import act_out, empty_floor
from mmweaver.paths.ray_traced import Simulator
from mmweaver.paths.receiver import Impairments, Receiver, quantise

DOING = "a person waves with both hands"
SECONDS, PLACES, SEED = 3.0, 2, 0
FEWEST_FRAMES, FEWEST_POINTS = 20, 100
MOST_AHEAD_M = 6.0
LONGEST_GAP_FRAMES = 10  # without points; a longer one is no recording
ROUNDS, BLOCKS = 2, 6
THRESHOLDS, STEP = (50, 4000), 24  # counts: between which it is looked for, and how finely
LARGEST_GAIN_DB = 60.0
GAIN_TITLE, THRESHOLD_TITLE = "gain of echoes, from clouds", "CFAR threshold"


@dataclass(frozen=True, kw_only=True)
class CloudLevels:
    """Level and number of points of clouds."""

    level_db: float  # median of 20 log10 intensity
    points: float  # mean a frame

    @classmethod
    def of(cls, intensity: np.ndarray, frames: int) -> "CloudLevels":
        """Of all points of so many frames."""
        level = float(20 * np.log10(np.median(intensity))) if len(intensity) else -np.inf
        return cls(level_db=level, points=len(intensity) / frames)


def match_levels(
    wanted: CloudLevels, detected: Callable[[float, int], CloudLevels], *, gain_db: float = 0.0, threshold: int = 768,
    thresholds: tuple[int, int] = THRESHOLDS, step: int = STEP, rounds: int = ROUNDS,
) -> tuple[float, int]:  # fmt: skip
    """Gain and threshold at which what is detected has the wanted levels; the threshold by bisection."""
    for _ in range(rounds):
        gain_db += wanted.level_db - detected(gain_db, threshold).level_db
        gain_db = round(float(np.clip(gain_db, -LARGEST_GAIN_DB, LARGEST_GAIN_DB)), 1)
        low, high = thresholds
        while high - low > step:
            middle = (low + high) // 2
            low, high = (middle, high) if detected(gain_db, middle).points > wanted.points else (low, middle)
        threshold = (low + high) // 2
    return gain_db, threshold


def fit_levels(
    clouds: Sequence[PointCloud], config: RadarConfig, settings: FirmwareSettings, doing: str = DOING
) -> list[Finding]:
    """Gain and threshold of a TI board's point clouds. Raises InputError for a sentence that is not understood."""
    try:
        check_firmware_radar(config)
        recorded, place_m = _recorded(clouds)
    except (InputError, ValueError) as error:
        return [Finding(title=title, text=str(error)) for title in (GAIN_TITLE, THRESHOLD_TITLE)]
    if settings.range_cfar is None:
        return [Finding(title=THRESHOLD_TITLE, text="the firmware's settings have no CFAR in range")]
    person = _Reference(config, settings, place_m, doing)
    frames = sum(count for _, count in recorded)
    wanted = CloudLevels.of(np.concatenate([intensity for intensity, _ in recorded]), frames)
    start = settings.range_cfar.threshold
    gain_db, threshold = match_levels(wanted, person.levels, threshold=start)
    # what another stretch of the recording, and another moment of the motion, would have said
    parts = [CloudLevels.of(*one).level_db for one in recorded if len(one[0])]
    error_db = float(np.hypot(np.std(parts) / np.sqrt(len(parts)), person.level_error_db(gain_db, threshold)))
    if abs(gain_db) >= LARGEST_GAIN_DB or not THRESHOLDS[0] + STEP < threshold < THRESHOLDS[1] - STEP:
        text = (
            "no gain and threshold make a simulated person's points like these; is it this radar, with these settings?"
        )
        return [Finding(title=title, text=text) for title in (GAIN_TITLE, THRESHOLD_TITLE)]
    how = f"{frames} frames of {wanted.points:.1f} points at {np.median(place_m[:, 1]):.1f} m"
    how += f", if people did as in {doing!r}"
    return [
        Finding(
            title=GAIN_TITLE, fields={"gain_db": gain_db},
            text=f"{gain_db:+.1f} dB (+-{error_db:.1f}) over the radar's file; {how}",
        ),
        Finding(title=THRESHOLD_TITLE, fields={"cfar_threshold": float(threshold)}, text=f"{threshold} counts; {how}"),
    ]  # fmt: skip


def _recorded(clouds: Sequence[PointCloud]) -> tuple[list[tuple[np.ndarray, int]], np.ndarray]:
    """Intensities and number of frames of stretches, and places (place, 2) where people were, near to far.

    Frames without points count where they lie between others, unless a recording was interrupted there. Raises
    ValueError with a reason.
    """
    stretches, middles = [], []
    for cloud in clouds:
        intensity = getattr(cloud, "intensity", None)
        if intensity is None or not np.isfinite(intensity).all():
            raise ValueError("the clouds have no intensities")
        if not len(cloud.frame):
            continue
        for part in np.array_split(_frames_of(cloud), BLOCKS):
            among = np.isin(cloud.frame, part)
            if len(part):
                stretches.append((np.asarray(intensity)[among & (intensity > 0)], len(part)))
            if among.sum() >= FEWEST_POINTS // BLOCKS:
                middles.append((np.median(cloud.x_m[among]), np.median(cloud.y_m[among])))
    frames, points = sum(count for _, count in stretches), sum(len(one) for one, _ in stretches)
    if frames < FEWEST_FRAMES or points < FEWEST_POINTS or not middles:
        raise ValueError(f"{frames} frames with {points} points; it takes {FEWEST_FRAMES} with {FEWEST_POINTS}")
    place_m = np.array(sorted(middles, key=lambda place: place[1]))
    chosen = place_m[np.linspace(0, len(place_m) - 1, PLACES).round().astype(int)]
    if chosen[:, 1].max() > MOST_AHEAD_M or chosen[:, 1].min() < 0.5:
        raise ValueError(f"people must be 0.5 to {MOST_AHEAD_M:g} m ahead")
    return stretches, chosen


def _frames_of(cloud: PointCloud) -> np.ndarray:
    """Numbers of its frames, those without points too, but for gaps too long for a person to be unseen."""
    there = np.unique(cloud.frame)
    short = np.flatnonzero((np.diff(there) > 1) & (np.diff(there) <= LONGEST_GAP_FRAMES))
    return np.sort(np.concatenate([there, *(np.arange(there[at] + 1, there[at + 1]) for at in short)]))


class _Reference:
    """A simulated person at each place, echoes and noise apart, so that a gain costs no new simulation."""

    def __init__(self, config: RadarConfig, settings: FirmwareSettings, place_m: np.ndarray, doing: str):
        self.config, self.settings = config, settings
        self._frames = max(2, int(SECONDS / config.frame_period_s))
        still = Impairments(thermal_noise=False, quantise=False, leakage_db=None)
        simulator = Simulator(empty_floor(), config, still)
        receiver = Receiver(config, Impairments(), SEED)
        self._echoes, self._noise = [], []
        for index, place in enumerate(place_m):
            motion = act_out(doing, duration_s=SECONDS, seed=SEED + index)
            adc = simulator.run(_moved(motion.pose, place), num_frames=self._frames, seed=SEED + index).adc
            self._echoes.append(adc.samples)
            shape = adc.samples.shape[1:]
            self._noise.append(np.stack([receiver.noise(shape, frame) for frame in range(self._frames)]))

    def levels(self, gain_db: float, threshold: int) -> CloudLevels:
        """Of all places together."""
        each = [cloud.intensity for cloud in self._clouds(gain_db, threshold)]
        return CloudLevels.of(np.concatenate(each), self._frames * len(each))

    def level_error_db(self, gain_db: float, threshold: int) -> float:
        """Of the mean over places and moments."""
        each = [CloudLevels.of(cloud.intensity, 1).level_db for cloud in self._clouds(gain_db, threshold)]
        return float(np.std([one for one in each if np.isfinite(one)]) / np.sqrt(len(each)))

    def _clouds(self, gain_db: float, threshold: int) -> list[FirmwareCloud]:
        import torch

        cfar = self.settings.range_cfar
        assert cfar is not None
        settings = replace(self.settings, range_cfar=replace(cfar, threshold=threshold))
        found = []
        for echoes, noise in zip(self._echoes, self._noise, strict=True):
            samples = echoes * np.float32(10 ** (gain_db / 20)) + noise
            quantise(torch.from_numpy(samples), self.config.adc_count_sqrt_mw)
            found.append(firmware_points(AdcCube(samples=samples, config=self.config, scale=1.0), settings))
        return found


def _moved(pose: PoseSequence, place_m: np.ndarray) -> PoseSequence:
    """A motion whose middle is at a place on the floor (2,)."""
    middle = pose.joints_m[:, 0, :2].mean(axis=0)
    shift = np.array([*(place_m - middle), 0.0])
    return replace(pose, joints_m=pose.joints_m + shift)
