"""Micro-motion of a body that stands still: postural sway, wavering and tremor of limbs, breathing and heartbeat.

Millimetres, but all that a radar observes of a standing person: clutter removal suppresses only what is truly static.
Sway is that of relaxed standing, twice that of subjects instructed to stand quietly (centre of mass 3 to 5 mm rms fore
and aft, 4 to 6 mm/s); unconstrained, people also fidget every minute and shift by 2 cm (Duarte and Zatsiorsky,
"Patterns of Center of Pressure Migration during Prolonged Unconstrained Standing", 1999). The trunk moves over the hips
as much as the legs over the ankles: angular accelerations in a ratio of 3.1 +- 1.2 (Aramaki et al., "Reciprocal Angular
Acceleration of the Ankle and Hip Joints during Quiet Standing in Humans", 2001; here 2.8). Tremor is physiological (8
to 12 Hz, about 0.1 mm at an outstretched hand); so is the motion of the chest wall (4 to 12 mm at 0.2 to 0.33 Hz for
breathing, 0.2 to 0.5 mm for the heartbeat). Reference: docs/radar_primer.md, section 4.
"""

from dataclasses import dataclass

import numpy as np

from mmweaver.core.seeding import stream
from mmweaver.core.skeleton import JOINT_NAMES, NUM_JOINTS, PARENTS, joint

CENTRE_OF_MASS = 0.55  # of the height; sway amplitudes refer to this point
SEATED, STANDING = 0.36, 0.48  # pelvis above the feet, of the height: a seated body sways about the pelvis
# Amplitudes relative to a standing body: a seated one rests on the seat, its hands on the thighs.
SEATED_SWAY, SEATED_WAVER, SEATED_TREMOR = 0.5, 0.5, 0.25
# Wavering of each joint relative to its parent, as a share of `waver_m`. Standing feet do not waver.
WAVER = {"knee": 0.2, "spine1": 0.6, "spine3": 0.6, "head": 0.5, "shoulder": 0.3, "elbow": 0.3, "wrist": 0.4}
WEIGHT = np.array([WAVER.get(name.split("_")[-1], 0.0) for name in JOINT_NAMES])


@dataclass(frozen=True, kw_only=True)
class MicroMotionSettings:
    """Amplitudes for a typical person; those of each person and sequence are sampled around these.

    Attributes:
        sway_m: Sway of the centre of mass, rms over minutes, metres.
        waver_m: Wavering of the joints, rms over minutes, metres.
        tremor_m: Tremor at the hand, rms, metres.
        breath_m: Breathing at the front of the chest, peak to peak, metres.
        heart_m: Heartbeat at the front of the chest, peak to peak, metres.
    """

    sway_m: float = 8.0e-3
    waver_m: float = 2.0e-3
    tremor_m: float = 0.08e-3
    breath_m: float = 7.0e-3
    heart_m: float = 0.35e-3


STILL = MicroMotionSettings(sway_m=0.0, waver_m=0.0, tremor_m=0.0, breath_m=0.0, heart_m=0.0)


class Waves:
    """Smooth random functions of time with rms 1: sums of sines, evenly distributed over octaves.

    Args:
        rng: Random stream of frequencies and phases.
        shape: Shape of the values at one time.
        low: Lowest frequency in Hz.
        high: Highest frequency in Hz.
        steepness: Amplitudes fall as f^-steepness; with 1 every octave has the same velocity.
    """

    def __init__(self, rng: np.random.Generator, shape: tuple[int, ...], low: float, high: float, steepness: float):
        count = 8
        edges = np.geomspace(low, high, count + 1)
        share = rng.random((*shape, count))
        self.frequency_hz = edges[:-1] ** (1 - share) * edges[1:] ** share
        amplitude = self.frequency_hz**-steepness
        self.amplitude = amplitude * np.sqrt(2 / (amplitude**2).sum(axis=-1, keepdims=True))
        self.phase_cycles = rng.random((*shape, count))

    def at(self, time_s: np.ndarray) -> np.ndarray:
        """Evaluates the functions.

        Args:
            time_s: Times (time,) in seconds.

        Returns:
            Values (time, *shape).
        """
        time = time_s.reshape(-1, *(1,) * self.phase_cycles.ndim)
        return (self.amplitude * np.sin(2 * np.pi * (self.frequency_hz * time + self.phase_cycles))).sum(axis=-1)


class MicroMotion:
    """Micro-motion of one person in one sequence.

    Args:
        subject: Number of the person, which determines rates and relative amplitudes.
        seed: Seed of the sequence, which determines the phases.
        settings: Typical amplitudes.
    """

    def __init__(self, subject: int, seed: int, settings: MicroMotionSettings):
        self.settings = settings
        person = stream(subject, "small motions")
        self.size = np.exp(0.25 * person.standard_normal(4))  # sway, waver and tremor, breath, heart
        self.breath_hz, self.heart_hz = person.uniform(0.2, 0.33), person.uniform(0.95, 1.35)
        phases = stream(seed, "small motions", subject)
        self.breath_cycles, self.heart_cycles = phases.random(2)
        self.sway = Waves(phases, (2,), 0.08, 1.2, 1.0)
        self.waver = Waves(phases, (NUM_JOINTS, 3), 0.15, 3.0, 1.0)
        self.tremor = Waves(phases, (NUM_JOINTS, 3), 8.0, 12.0, 0.0)

    def moved(self, joints_m: np.ndarray, time_s: np.ndarray, height_m: float) -> np.ndarray:
        """Adds sway, wavering and tremor to joints.

        Args:
            joints_m: Joints (time, 22, 3) in metres, z up.
            time_s: Times (time,) in seconds.
            height_m: Height of the body in metres.

        Returns:
            Joints (time, 22, 3) in metres; `joints_m` itself if these amplitudes are zero.
        """
        if not (self.settings.sway_m or self.settings.waver_m or self.settings.tremor_m):
            return joints_m
        stands = _stands(joints_m, height_m)
        lever = _height_over_support(joints_m, stands) / (CENTRE_OF_MASS * height_m)
        right = joints_m[:, joint("right_hip")] - joints_m[:, joint("left_hip")]
        right = right[:, :2] / np.maximum(np.linalg.norm(right[:, :2], axis=1, keepdims=True), 1e-6)
        front = np.stack([-right[:, 1], right[:, 0]], axis=1)
        sway = _share(SEATED_SWAY, stands) * self.settings.sway_m * self.size[0] * self.sway.at(time_s)
        level = sway[:, :1] * front + 0.6 * sway[:, 1:] * right
        moved = joints_m.astype(float)
        moved[..., :2] += lever[..., None] * level[:, None]
        waver_m, tremor_m = (
            amplitude * _share(seated, stands)[..., None]
            for amplitude, seated in ((self.settings.waver_m, SEATED_WAVER), (self.settings.tremor_m, SEATED_TREMOR))
        )
        own = waver_m * self.waver.at(time_s) + tremor_m * self.tremor.at(time_s)
        return moved + self.size[1] * _along_limbs(own)

    def chest_m(self, time_s: np.ndarray) -> np.ndarray:
        """Displacement of the front of the chest by breathing and heartbeat; inhaling is faster than exhaling.

        Args:
            time_s: Times (time,) in seconds.

        Returns:
            Metres outward, (time,).
        """
        breath = 2 * np.pi * (self.breath_hz * time_s + self.breath_cycles)
        heart = 2 * np.pi * (self.heart_hz * time_s + self.heart_cycles)
        out = self.settings.breath_m * self.size[2] / 2 * (np.sin(breath) + 0.2 * np.sin(2 * breath))
        return out + self.settings.heart_m * self.size[3] / 2 * (np.sin(heart) + 0.5 * np.sin(2 * heart + 1.0))


def _lower_foot_m(joints_m: np.ndarray) -> np.ndarray:
    """Height (time, 1) of the lower foot."""
    return np.minimum(joints_m[:, joint("left_foot"), 2], joints_m[:, joint("right_foot"), 2])[:, None]


def _stands(joints_m: np.ndarray, height_m: float) -> np.ndarray:
    """Degree of standing (time, 1): 1 upright, 0 where the pelvis is as low as that of a seated body."""
    pelvis = joints_m[:, [joint("pelvis")], 2] - _lower_foot_m(joints_m)
    share = np.clip((pelvis / height_m - SEATED) / (STANDING - SEATED), 0, 1)
    return share**2 * (3 - 2 * share)


def _share(seated: float, stands: np.ndarray) -> np.ndarray:
    """Amplitude (time, 1) relative to a standing body, from `seated` to 1."""
    return seated + (1 - seated) * stands


def _height_over_support(joints_m: np.ndarray, stands: np.ndarray) -> np.ndarray:
    """Height (time, 22) in metres above the lower foot, of a seated body above the pelvis; never below 0."""
    z, foot, pelvis = joints_m[..., 2], _lower_foot_m(joints_m), joints_m[:, [joint("pelvis")], 2]
    return stands * np.maximum(z - foot, 0) + (1 - stands) * np.maximum(z - pelvis, 0)


def _along_limbs(own: np.ndarray) -> np.ndarray:
    """Wavering (time, 22, 3) accumulated along the limbs."""
    total = np.zeros_like(own)
    for index, parent in enumerate(PARENTS):
        if parent >= 0:
            total[:, index] = total[:, parent] + own[:, index] * WEIGHT[index]
    for side in ("left", "right"):  # feet stay planted; only the knees waver
        for name in ("ankle", "foot"):
            total[:, joint(f"{side}_{name}")] = 0.0
    return total
