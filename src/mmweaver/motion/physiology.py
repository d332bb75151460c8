"""Physiology: breathing, heartbeat, postural sway and tremor of one person, as functions of continuous time.

One model for both methods and for the exported ground truth. Millimetres, but all that a radar observes of a person who
keeps still: clutter removal suppresses only what is truly static.

Breathing: 12 to 20 per minute at rest, 4 to 12 mm peak to peak at the front of the trunk (Droitcour, "Non-contact
measurement of heart and respiration rates", 2006; De Groote et al., J. Appl. Physiol. 83, 1997); period and depth vary
by some 5 and 15 % (Tobin et al., Chest 84, 1983), a pause follows the exhalation, and lying people breathe with the
belly, standing ones mostly with the chest (Konno and Mead, J. Appl. Physiol. 22, 1967). Heart: 0.1 to 0.5 mm at the
chest, with respiratory sinus arrhythmia and a slower wave of 0.1 Hz (Task Force, Circulation 93, 1996). Sway: 1 mm
rms of the centre of mass, a third of the 3 mm that posturography reports over minutes of quiet standing (Prieto et al.,
IEEE Trans. Biomed. Eng. 43, 1996), since recorded people who keep still move by 4 to 8 mm peak to peak, breath
included; a fraction of that seated, hardly any lying. The trunk moves over the hips as much as the legs over the ankles
(Aramaki et al., 2001). Tremor is physiological: 8 to 12 Hz, about 0.1 mm at an outstretched hand.
Reference: docs/radar_primer.md, section 4.
"""

import re
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from mmweaver.core.errors import InputError
from mmweaver.core.radar_pose import RadarPose
from mmweaver.core.records import Breathing, PoseSequence, VitalTruth
from mmweaver.core.seeding import stream
from mmweaver.core.skeleton import JOINT_NAMES, NUM_JOINTS, PARENTS, joint

CENTRE_OF_MASS = 0.55  # of the height; sway amplitudes refer to this point
SEATED, STANDING = 0.36, 0.48  # pelvis above the feet, of the height: a seated body sways about the pelvis
LYING_COS, UPRIGHT_COS = 0.35, 0.7  # vertical share of the trunk: below the first the body lies, above the second not
# Amplitudes relative to a standing body: a seated one rests on the seat, its hands on the thighs.
SEATED_SWAY, SEATED_WAVER, SEATED_TREMOR = 0.4, 0.5, 0.25
LYING = 0.1  # of sway, wavering and tremor
# Wavering of each joint relative to its parent, as a share of `waver_m`. Standing feet do not waver.
WAVER = {"knee": 0.2, "spine1": 0.6, "spine3": 0.6, "head": 0.5, "shoulder": 0.3, "elbow": 0.3, "wrist": 0.4}
WEIGHT = np.array([WAVER.get(name.split("_")[-1], 0.0) for name in JOINT_NAMES])
# How far joints follow the front of the chest, forwards and half as much upwards: shoulders, neck and head ride on it.
LIFT = {"spine3": 0.25, "neck": 0.25, "head": 0.25, "collar": 0.3, "shoulder": 0.3, "elbow": 0.2, "wrist": 0.1}
LIFTED = np.array([LIFT.get(name.split("_")[-1], 0.0) for name in JOINT_NAMES])
BREATH_HZ, HEART_HZ = (0.2, 0.33), (0.95, 1.35)
CHEST_SHARE = {"lying": 0.45, "seated": 0.85, "standing": 1.0}  # of the depth of a breath
BELLY_SHARE = {"lying": 1.0, "seated": 0.9, "standing": 0.6}
INHALE, EXHALE = 0.40, 0.48  # shares of a breath; the rest is the pause after exhaling
PACED = 0.2  # variation of a stated rate relative to that of spontaneous breathing
HOLD_RAMP_S = 0.6  # in which breathing stops and starts again
# harmonics of a heartbeat's displacement, amplitude and phase: its recoil fills 3 to 5 Hz, as in recordings of sitters
PULSE, PULSE_EXTENT = ((1.0, 0.0), (0.7, 0.6), (0.5, 1.2), (0.35, 2.0), (0.2, 2.8)), 3.82
ARRHYTHMIA, SLOW_HEART = 0.03, 0.03  # relative variation of the heart rate with the breath, and at 0.1 Hz


@dataclass(frozen=True, kw_only=True)
class PhysiologySettings:
    """Amplitudes for a typical person; those of each person and sequence are sampled around these.

    Attributes:
        sway_m: Sway of the centre of mass, rms over minutes, metres.
        waver_m: Wavering of the joints, rms over minutes, metres.
        tremor_m: Tremor at the hand, rms, metres.
        breath_m: Depth of a breath at the front of the trunk, peak to peak, metres.
        heart_m: Heartbeat at the front of the chest, peak to peak, metres.
        breath_variation: Relative variation of the breathing rate, rms.
        depth_variation: Relative variation of the depth, rms.
    """

    sway_m: float = 1.0e-3
    waver_m: float = 0.1e-3
    tremor_m: float = 0.08e-3
    breath_m: float = 5.0e-3
    heart_m: float = 0.35e-3
    breath_variation: float = 0.04
    depth_variation: float = 0.15


STILL = PhysiologySettings(sway_m=0.0, waver_m=0.0, tremor_m=0.0, breath_m=0.0, heart_m=0.0)


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
        """Values (time, *shape) at times (time,) in seconds."""
        time = time_s.reshape(-1, *(1,) * self.phase_cycles.ndim)
        return (self.amplitude * np.sin(2 * np.pi * (self.frequency_hz * time + self.phase_cycles))).sum(axis=-1)

    def integral(self, time_s: np.ndarray) -> np.ndarray:
        """Integrals (time, *shape) from an arbitrary origin to times (time,), in seconds."""
        time = time_s.reshape(-1, *(1,) * self.phase_cycles.ndim)
        rate = 2 * np.pi * self.frequency_hz
        return -(self.amplitude / rate * np.cos(rate * time + 2 * np.pi * self.phase_cycles)).sum(axis=-1)


class Physiology:
    """Physiological motion of one person in one sequence.

    Args:
        subject: Number of the person, which determines rates and relative amplitudes.
        seed: Seed of the sequence, which determines the phases.
        settings: Typical amplitudes.
        breathing: What is asked of the breathing: a rate, held breaths; by default nothing.
    """

    def __init__(
        self,
        subject: int,
        seed: int,
        settings: PhysiologySettings | None = None,
        breathing: Breathing | None = None,
    ):
        self.settings = settings or PhysiologySettings()
        self.breathing = breathing or Breathing()
        person = stream(subject, "small motions")
        self.size = np.exp(
            np.clip(0.25 * person.standard_normal(4), -0.55, 0.55)
        )  # sway, waver and tremor, breath, heart
        breath_hz, self.heart_hz = person.uniform(*BREATH_HZ), person.uniform(*HEART_HZ)
        asked = self.breathing.per_minute
        self.breath_hz = breath_hz if asked is None else asked / 60
        self.variation = self.settings.breath_variation * (1.0 if asked is None else PACED)
        phases = stream(seed, "small motions", subject)
        self.breath_cycles, self.heart_cycles = phases.random(2)
        self.sway = Waves(phases, (2,), 0.02, 1.2, 1.0)
        self.waver = Waves(phases, (NUM_JOINTS, 3), 0.15, 3.0, 1.0)
        self.tremor = Waves(phases, (NUM_JOINTS, 3), 8.0, 12.0, 0.0)
        self.tempo, self.depth = Waves(phases, (), 0.01, 0.08, 0.0), Waves(phases, (), 0.01, 0.08, 0.0)
        self._slow_cycles = phases.random()

    @classmethod
    def of(cls, pose: PoseSequence, seed: int, settings: PhysiologySettings | None = None) -> "Physiology":
        """That of the person of a pose sequence."""
        return cls(pose.subject, seed, settings, pose.breathing)

    def moved(self, joints_m: np.ndarray, time_s: np.ndarray, height_m: float) -> np.ndarray:
        """Adds sway, wavering, tremor and the lift of the shoulders by breathing to joints.

        Args:
            joints_m: Joints (time, 22, 3) in metres, z up.
            time_s: Times (time,) in seconds.
            height_m: Height of the body in metres.

        Returns:
            Joints (time, 22, 3) in metres; `joints_m` itself if these amplitudes are zero.
        """
        settings = self.settings
        if not (settings.sway_m or settings.waver_m or settings.tremor_m or settings.breath_m):
            return joints_m
        stands, rests = _stands(joints_m, height_m), 1 - (1 - LYING) * _lies(joints_m)
        lever = _height_over_support(joints_m, stands) / (CENTRE_OF_MASS * height_m)
        right = joints_m[:, joint("right_hip")] - joints_m[:, joint("left_hip")]
        right = right[:, :2] / np.maximum(np.linalg.norm(right[:, :2], axis=1, keepdims=True), 1e-6)
        front = np.stack([-right[:, 1], right[:, 0]], axis=1)
        sway = rests * _share(SEATED_SWAY, stands) * settings.sway_m * self.size[0] * self.sway.at(time_s)
        level = sway[:, :1] * front + 0.6 * sway[:, 1:] * right
        moved = joints_m.astype(float)
        moved[..., :2] += lever[..., None] * level[:, None]
        lift = (1 - _lies(joints_m)) * self.trunk_m(joints_m, time_s, height_m)[:, :1] * LIFTED
        moved[..., :2] += lift[..., None] * front[:, None]
        moved[..., 2] += lift / 2
        waver_m, tremor_m = (
            (rests * amplitude * _share(seated, stands))[..., None]
            for amplitude, seated in ((settings.waver_m, SEATED_WAVER), (settings.tremor_m, SEATED_TREMOR))
        )
        own = waver_m * self.waver.at(time_s) + tremor_m * self.tremor.at(time_s)
        return moved + self.size[1] * _along_limbs(own)

    def trunk_m(self, joints_m: np.ndarray, time_s: np.ndarray, height_m: float) -> np.ndarray:
        """Outward displacement of the front of chest and belly by breathing and heartbeat.

        Args:
            joints_m: Joints (time, 22, 3) in metres, z up, for the posture.
            time_s: Times (time,) in seconds.
            height_m: Height of the body in metres.

        Returns:
            Metres outward, (time, 2): chest, belly.
        """
        stands, lies = _stands(joints_m, height_m)[:, 0], _lies(joints_m)[:, 0]
        breath, heart = self.breath_m(time_s), self.heart_m(time_s)
        chest, belly = (
            lies * share["lying"] + (1 - lies) * (stands * share["standing"] + (1 - stands) * share["seated"])
            for share in (CHEST_SHARE, BELLY_SHARE)
        )
        return np.stack([chest * breath + heart, belly * breath + 0.3 * heart], axis=-1)

    def breath_m(self, time_s: np.ndarray) -> np.ndarray:
        """Displacement (time,) in metres at the front of the trunk, 0 after exhaling: inhaling, exhaling, a pause."""
        cycles, settings = self.breath_phase(time_s), self.settings
        share = cycles % 1.0
        up, down = share / INHALE, (share - INHALE) / EXHALE
        wave = np.where(
            share < INHALE, 0.5 - 0.5 * np.cos(np.pi * up), 0.5 + 0.5 * np.cos(np.pi * np.minimum(down, 1.0))
        )
        depth = 1 + settings.depth_variation * np.clip(self.depth.at(time_s), -2, 2)
        return settings.breath_m * self.size[2] * depth * wave

    def breath_phase(self, time_s: np.ndarray) -> np.ndarray:
        """Breaths (time,) since an arbitrary start; they do not advance while the breath is held."""
        active_s = self._breathed_s(time_s)
        varied_s = self.tempo.integral(active_s)
        return self.breath_cycles + self.breath_hz * (active_s + self.variation * varied_s)

    def _breathed_s(self, time_s: np.ndarray) -> np.ndarray:
        """Time (time,) spent breathing: `time_s` minus held breaths, each with a smooth stop and start."""
        active_s = np.asarray(time_s, float).copy()
        for begin_s, end_s in self.breathing.held_s:
            ramp_s = min(HOLD_RAMP_S, (end_s - begin_s) / 2)
            active_s -= _ramp(time_s - begin_s, ramp_s) - _ramp(time_s - end_s + ramp_s, ramp_s)
        return active_s

    def heart_phase(self, time_s: np.ndarray) -> np.ndarray:
        """Heartbeats (time,) since an arbitrary start: faster while inhaling, and a slow wave of 0.1 Hz."""
        slow = np.sin(2 * np.pi * (0.1 * time_s + self._slow_cycles)) / (2 * np.pi * 0.1)
        breath = np.sin(2 * np.pi * self.breath_phase(time_s)) / (2 * np.pi * self.breath_hz)
        return self.heart_cycles + self.heart_hz * (time_s + SLOW_HEART * slow + ARRHYTHMIA * breath)

    def heart_m(self, time_s: np.ndarray) -> np.ndarray:
        """Displacement (time,) of the chest by the heartbeat in metres: a pulse with a rebound after each beat."""
        beat = 2 * np.pi * self.heart_phase(time_s)
        wave = sum(size * np.sin(order * beat + turn) for order, (size, turn) in enumerate(PULSE, 1))
        return self.settings.heart_m * self.size[3] / PULSE_EXTENT * np.asarray(wave)

    def truth(self, joints_m: np.ndarray, time_s: np.ndarray, height_m: float, until_s: float) -> VitalTruth:
        """Ground truth over the frames of a signal.

        Args:
            joints_m: Joints (frame, 22, 3) in metres, z up.
            time_s: Times (frame,) in seconds.
            height_m: Height of the body in metres.
            until_s: End of the signal in seconds.
        """
        begin_s = float(time_s[0])
        fine_s = np.linspace(begin_s, until_s, max(int((until_s - begin_s) * 200), 2))
        beats = self.heart_phase(fine_s)
        numbers = np.arange(np.ceil(beats[0]), np.floor(beats[-1]) + 1)
        trunk = self.trunk_m(joints_m, time_s, height_m)
        cycles, active_s = (np.ptp(part(fine_s[[0, -1]])) for part in (self.breath_phase, self._breathed_s))
        return VitalTruth(
            breathing_hz=float(cycles / active_s) if active_s > 0.1 else float("nan"),
            heart_hz=float((beats[-1] - beats[0]) / max(until_s - begin_s, 1e-9)),
            chest_m=trunk[:, 0],
            belly_m=trunk[:, 1],
            beat_s=np.interp(numbers, beats, fine_s),
            held_s=np.array(self.breathing.held_s, float).reshape(-1, 2),
        )


def living(pose: PoseSequence, seed: int, radar_pose: RadarPose, until_s: float) -> PoseSequence:
    """The pose of a result: with sway, wavering and tremor, and the ground truth of breathing and heartbeat.

    Args:
        pose: Motion at the radar's frames, in the radar's frame.
        seed: Seed of the sequence.
        radar_pose: Pose of the radar, for what is up.
        until_s: End of the signal in seconds.
    """
    own, level_m = Physiology.of(pose, seed), radar_pose.in_level_frame(pose.joints_m)
    moved = radar_pose.seen(own.moved(level_m, pose.time_s, pose.height_m))
    return replace(pose, joints_m=moved, vitals=own.truth(level_m, pose.time_s, pose.height_m, until_s))


HOLDING = re.compile(r"\bhold(?:s|ing)? (?:(?:his|her|their|its|the|one's) )?breath\b")
RATE = re.compile(
    r",?\s*(?:\b(?:and|while|then)\s+)?\b(?:breath(?:es|ing|e)|with) (?:at )?(\d+(?:\.\d+)?) "
    r"(?:times|breaths?) (?:per|a|each|every) minute\b"
)
RATE_LIMITS = (4.0, 60.0)


# Two-way loss of what covers a sleeper, in dB; estimates: 1 to 2 dB per pass through cotton and filling.
COVERS_DB = {"sheet": 1.0, "blanket": 3.0, "covers": 3.0, "quilt": 4.0, "duvet": 5.0}
COVER = re.compile(rf",?\s*\bunder (?:an?|the|his|her|their) (?:thin |thick |warm )?({'|'.join(COVERS_DB)})\b")


def cover_of(text: str) -> tuple[str, float]:
    """Takes a blanket out of a sentence.

    Args:
        text: "a person lies on the floor under a blanket".

    Returns:
        The rest of the sentence, and the two-way loss of the cover in dB, 0 without one.

    >>> cover_of("a person lies on the floor under a blanket")
    ('a person lies on the floor', 3.0)
    """
    found = COVER.search(text)
    if found is None:
        return text, 0.0
    return (text[: found.start()] + text[found.end() :]).strip(" ,"), COVERS_DB[found[1]]


def breathing_rate_of(text: str) -> tuple[str, float | None]:
    """Takes a breathing rate out of a sentence.

    Args:
        text: "a person sits and breathes 20 times per minute".

    Returns:
        The rest of the sentence, and breaths per minute; None where no rate is stated.

    Raises:
        InputError: For a rate outside 4 to 60 per minute.

    >>> breathing_rate_of("a person sits and breathes 20 times per minute")
    ('a person sits', 20.0)
    """
    found = RATE.search(text)
    if found is None:
        return text, None
    rate = float(found[1])
    if not RATE_LIMITS[0] <= rate <= RATE_LIMITS[1]:
        raise InputError(f"people breathe {RATE_LIMITS[0]:g} to {RATE_LIMITS[1]:g} times per minute, not {rate:g}")
    rest = (text[: found.start()] + text[found.end() :]).strip(" ,")
    return rest, rate


def held_breaths(steps: Sequence[Any]) -> tuple[tuple[float, float], ...]:
    """Intervals in seconds of the steps of a plan in whose clause the breath is held."""
    return tuple((float(one.start_s), float(one.end_s)) for one in steps if HOLDING.search(one.clause or ""))


def _ramp(time_s: np.ndarray, ramp_s: float) -> np.ndarray:
    """Integral of a smooth step of the given duration that begins at 0."""
    share = np.clip(time_s / ramp_s, 0.0, 1.0)
    return ramp_s * (share**3 - share**4 / 2) + np.maximum(time_s - ramp_s, 0.0)


def _lower_foot_m(joints_m: np.ndarray) -> np.ndarray:
    """Height (time, 1) of the lower foot."""
    return np.minimum(joints_m[:, joint("left_foot"), 2], joints_m[:, joint("right_foot"), 2])[:, None]


def _smooth(share: np.ndarray) -> np.ndarray:
    clipped = np.clip(share, 0, 1)
    return clipped**2 * (3 - 2 * clipped)


def _stands(joints_m: np.ndarray, height_m: float) -> np.ndarray:
    """Degree of standing (time, 1): 1 upright, 0 where the pelvis is as low as that of a seated body."""
    pelvis = joints_m[:, [joint("pelvis")], 2] - _lower_foot_m(joints_m)
    return _smooth((pelvis / height_m - SEATED) / (STANDING - SEATED))


def _lies(joints_m: np.ndarray) -> np.ndarray:
    """Degree of lying (time, 1), from the inclination of the trunk."""
    trunk = joints_m[:, joint("neck")] - joints_m[:, joint("pelvis")]
    upright = np.abs(trunk[:, 2:]) / np.maximum(np.linalg.norm(trunk, axis=1, keepdims=True), 1e-6)
    return _smooth((UPRIGHT_COS - upright) / (UPRIGHT_COS - LYING_COS))


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
