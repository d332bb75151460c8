"""Performance of an activity by a person: place, tempo, amplitude, sway and pauses, in a room.

Tempo, amplitude and sway belong to the person, and vary less between performances of one person than between people.
The same person stands in the same place in front of the same radar for every activity, so none of these reveals the
label.
"""

from dataclasses import dataclass, replace

import numpy as np

from mmweaver.core.errors import InputError
from mmweaver.core.records import PoseSequence
from mmweaver.core.seeding import stream
from mmweaver.core.shapes import Joints
from mmweaver.core.skeleton import joint
from mmweaver.motion.animation.profiles import rise
from mmweaver.motion.compose import compose
from mmweaver.motion.language.plan import MotionPlan
from mmweaver.motion.language.sentence import parse_sentence
from mmweaver.motion.language.timing import LONGEST_S, is_elastic, natural_s, repeated, schedule
from mmweaver.motion.people import MOST_SUBJECTS, person_of
from mmweaver.recognition.random_scene import (
    Span,
    Variation,
    VariationSample,
    hung_high,
    random_scene,
    sample_variation,
)
from mmweaver.recognition.task_file import Mount

SLOWEST_MPS = 0.06  # below this speed, locomotion has ended
ROAM_HZ = (0.1, 0.6)  # frequencies of the sway of stationary people
HURRY_HZ = (0.1, 0.5)  # frequencies of tempo changes along a path
LEAD_S, LATEST_S = 0.75, 6.0  # a sequence is any part of what a person does, but its beginning
NOISE_DB = (-8.0, 6.0)  # of the noise figure; copies of windows have less sensitive radars
ARMS_DB = (-3.0, 14.0)  # relative to the trunk: a flat hand may face the radar or be turned away
AROUND_M = (0.9, 1.2)  # range towards and away from the radar within which people move on the spot
HIGH_SHARE = 0.25  # share of high mounts where the mount is unknown
HEIGHT_SPREAD_M, TILT_SPREAD_DEG = 0.05, 2.0  # around a known mount
HELD = ("stand", "sit", "kneel", "lie", "lie_on_seat", "recline")  # postures in which people do not shift their feet
REST_S = (0.2, 0.8)  # before and after a single performance
LATEST_EVENT = 0.7  # latest start of an event, as a share of the spare time of the sequence
CLOSE_M, FAR_APART_M = 0.2, 0.5  # distance of the ankles when standing, and when standing with the legs apart
LIFTED_M, MIN_MOVED_M = 0.06, 0.03


@dataclass(frozen=True, kw_only=True)
class PerformancePrior:
    """Variation between people, and between performances of one person; spreads of relative quantities are logarithmic.

    Attributes:
        tempo_of_person: Spread of tempo between people.
        tempo_of_performance: Spread of tempo between performances.
        amplitude_of_person: Spread of amplitude between people.
        amplitude_of_performance: Spread of amplitude between performances.
        on_spot: Typical tempo of activities in place, relative to the motion library.
        on_way: Tempo of walks and runs in a room, log-uniform over people.
        single: Tempo of a single performance, which people do briskly and widely.
        usual_amplitude: Typical amplitude, relative to the motion library.
        single_amplitude: Amplitude of a single performance.
        sway_mps: Speed of slow shifts of the whole body, log-uniform.
        calm_sway_mps: The same of people who hold still except for one gesture.
        held_sway_mps: The same of people who hold a posture.
        heading_deg: Standard deviation from facing the radar.
        heading_of_performance_deg: Standard deviation of a performance from the person's typical heading.
        wider_m: Additional distance of the feet in place, relative to the motion library, uniform.
        linger: Additional time at the beginning of a movement, relative to the movement, uniform.
        at_turns: Additional time that walkers and runners take to turn, relative to the library, uniform.
    """

    tempo_of_person: float = 0.2
    tempo_of_performance: float = 0.1
    amplitude_of_person: float = 0.2
    amplitude_of_performance: float = 0.1
    on_spot: float = 1.05
    on_way: Span = (0.7, 1.35)
    single: float = 1.4
    usual_amplitude: float = 0.9
    single_amplitude: float = 1.05
    sway_mps: Span = (0.01, 0.25)
    calm_sway_mps: Span = (0.003, 0.04)
    held_sway_mps: Span = (0.003, 0.08)
    heading_deg: float = 15.0
    heading_of_performance_deg: float = 5.7
    wider_m: Span = (0.0, 0.0)
    linger: Span = (0.0, 0.0)
    at_turns: Span = (0.0, 2.0)


@dataclass(frozen=True, kw_only=True)
class Performer:
    """One person, with the radar and the room."""

    subject: int
    surroundings: VariationSample
    tempo: float
    amplitude: float
    heading_rad: float
    wider_m: float
    linger: float
    on_way: float  # tempo of walks and runs
    at_turns: float


def task_variation(mount: Mount) -> Variation:
    """Ranges of places, rooms and radars: wide, except for known properties of the mount."""
    near, far = mount.distance_m or (1.0, 3.2)
    known = Variation(
        distance_m=(near, far),
        near_m=(max(near - 0.4, 0.5), near + 0.3),
        far_m=(max(far - 0.5, near + 0.6), far + 0.8),
        radar_height_m=(0.7, 1.6),
        wall_m=(far + 0.6, far + 3.0),
        noise_db=NOISE_DB,
        arms_db=ARMS_DB,
    )
    if mount.height_m is not None:
        known = replace(known, radar_height_m=(mount.height_m - HEIGHT_SPREAD_M, mount.height_m + HEIGHT_SPREAD_M))
    if mount.height_m is None and mount.tilt_deg is None:
        known = replace(known, high_share=HIGH_SHARE)
    if mount.tilt_deg is not None:
        # clouds are in the board's axes: a board tilted down reports people higher
        known = replace(known, tilt_deg=(mount.tilt_deg - TILT_SPREAD_DEG, mount.tilt_deg + TILT_SPREAD_DEG))
    return known


def performer(prior: PerformancePrior, variation: Variation, index: int, seed: int) -> Performer:
    """The index-th person, the same for all activities.

    Args:
        prior: How people differ.
        variation: Ranges of places, rooms and radars.
        index: Number of the person.
        seed: Seed of everything that is sampled.
    """
    rng = stream(seed, "performer", index)
    tempo, amplitude, heading = rng.normal(size=3).clip(-2, 2)
    return Performer(
        subject=int(rng.integers(MOST_SUBJECTS)),
        surroundings=hung_high(sample_variation(variation, rng), variation, stream(seed, "mount", index)),
        tempo=float(np.exp(prior.tempo_of_person * tempo)),
        amplitude=float(np.exp(prior.amplitude_of_person * amplitude)),
        heading_rad=float(np.radians(prior.heading_deg) * heading),
        wider_m=rng.uniform(*prior.wider_m),
        linger=rng.uniform(*prior.linger),
        on_way=float(np.exp(rng.uniform(*np.log(prior.on_way)))),
        at_turns=rng.uniform(*prior.at_turns),
    )


@dataclass(frozen=True, kw_only=True)
class Performance:
    """A motion from its first frame on, and its surroundings."""

    pose: PoseSequence
    lasts_s: float
    surroundings: VariationSample


def perform(
    who: Performer, prior: PerformancePrior, sentence: str, *, seconds: float, once: bool, rng: np.random.Generator
) -> Performance:
    """A person's performance of a sentence, single or for a given time.

    Args:
        who: The person, with radar and room.
        prior: How performances differ.
        sentence: The activity.
        seconds: Duration; an event that cannot be repeated (a fall) happens at some time within it.
        once: Whether it is a single performance of natural duration, with a short rest before and after.
        rng: Random stream of this performance.

    Returns:
        The motion from the first frame on, in the radar's level axes.

    Raises:
        InputError: If the sentence cannot be carried out in these surroundings.
    """
    plan = parse_sentence(sentence) if once else lasting(parse_sentence(sentence))
    is_event = not once and happens_once(plan)
    moves = any(step.moves for step in plan.steps)
    now, person = who.surroundings, person_of(who.subject, plan.person)
    tempo_own, amplitude_own = rng.normal(size=2).clip(-2, 2)
    usual = who.on_way if moves else prior.single if once else prior.on_spot
    tempo = float(who.tempo * usual * np.exp(prior.tempo_of_performance * tempo_own))
    usual = prior.single_amplitude if once else prior.usual_amplitude
    amplitude = float(usual * who.amplitude * np.exp(prior.amplitude_of_performance * amplitude_own))
    late_s = 0.0 if once else rng.uniform(0.0, LATEST_S)
    lead_s = 0.0 if once or is_event else LEAD_S + late_s
    needed_s = natural_s(plan) if once or is_event else lead_s + (seconds + 0.3) * tempo * 1.1
    scheduled = schedule(plan if once or is_event else repeated(plan, needed_s), needed_s)
    scene = random_scene(floor_z_m=-now.radar_height_m, wall_y_m=None)
    x, y = now.start_m
    distance = float(np.hypot(x, y))
    turned_rad = np.radians(prior.heading_of_performance_deg)
    window = now.reach_m if moves else (max(distance - AROUND_M[0], 0.3), distance + AROUND_M[1])
    pose = compose(
        scheduled,
        scene,
        seed=int(rng.integers(2**31)),
        range_window_m=window,
        start_m=None if moves and rng.random() < 0.5 else now.start_m,
        person=person,
        may_touch=False,
        heading_rad=None if moves else float(np.arctan2(-y, -x) + who.heading_rad + turned_rad * rng.normal()),
    ).pose
    if is_event:
        spare_s = max(seconds * tempo - needed_s, 0.0)
        before_s = max(late_s / LATEST_S * LATEST_EVENT * spare_s, REST_S[0])
        pose = _rested(pose, before_s, (seconds + 0.3) * tempo * 1.1)
    if moves and not is_event and tempo * pelvis_speed_mps(pose, lead_s, needed_s) < SLOWEST_MPS:
        raise InputError("the path ends before the recording does")
    joints_m = scaled_excursion(pose.joints_m, amplitude)
    if not moves and who.wider_m:
        joints_m = spread_feet(joints_m, who.wider_m)
    is_held = all(step.lower in HELD and not step.upper for step in plan.steps)
    usual_sway = prior.calm_sway_mps if once or is_event else prior.held_sway_mps if is_held else prior.sway_mps
    sway = float(np.exp(rng.uniform(*np.log(usual_sway))))
    joints_m = joints_m + sway_m(pose.time_s, sway, rng)
    even_s = pose.time_s
    if moves and not is_event:
        even_s = slow_at_turns(pose.time_s, joints_m, who.at_turns)
    elif not (once or is_event):
        even_s = lingering(pose.time_s, joints_m, who.linger)
    even_s = even_s - np.interp(lead_s, pose.time_s, even_s)
    time_s = time_warped(even_s, tempo, now.hurry if moves else 0.0, rng)
    pose = replace(pose, time_s=time_s, joints_m=joints_m)
    if not once:
        return Performance(pose=pose, lasts_s=seconds, surroundings=now)
    before_s, after_s = rng.uniform(*REST_S, size=2)
    return Performance(
        pose=_rested(pose, float(before_s), float(after_s)),
        lasts_s=float(before_s + time_s[-1] + after_s),
        surroundings=now,
    )


def lasting(plan: MotionPlan) -> MotionPlan:
    """The plan as a continuing activity: actions in place are repeated as time allows, not three times."""
    return replace(plan, steps=tuple(step if step.moves else replace(step, count=0) for step in plan.steps))


def happens_once(plan: MotionPlan) -> bool:
    """Whether a plan ends and cannot be repeated, since its end does not lead back to its beginning."""
    return repeated(plan, LONGEST_S) is plan and not all(is_elastic(step) for step in plan.steps)


def time_warped(time_s: np.ndarray, tempo: float, hurry: float, rng: np.random.Generator) -> np.ndarray:
    """Times warped by a varying tempo; 0 stays 0.

    Args:
        time_s: Times (time,) in seconds.
        tempo: Mean tempo.
        hurry: RMS variation of its logarithm.
        rng: Random stream.
    """
    omega, phase = 2 * np.pi * rng.uniform(*HURRY_HZ, (2, 1)), rng.uniform(0, 2 * np.pi, (2, 1))
    slower = np.exp(-hurry * np.sin(omega * time_s + phase).sum(axis=0)) / tempo
    reached = _integral(slower, time_s)
    return reached - np.interp(0.0, time_s, reached)


def _integral(slowness: np.ndarray, time_s: np.ndarray) -> np.ndarray:
    """Times (time,) at which a motion of this slowness reaches its state at `time_s`, from 0."""
    return np.concatenate([[0.0], np.cumsum((slowness[1:] + slowness[:-1]) / 2 * np.diff(time_s))])


def pelvis_speed_mps(pose: PoseSequence, start_s: float, end_s: float) -> float:
    """Mean horizontal speed of the pelvis in m/s.

    Args:
        pose: The motion.
        start_s: Start of the interval in seconds.
        end_s: End of the interval in seconds.
    """
    inside = (pose.time_s >= start_s) & (pose.time_s <= end_s)
    path_m = np.linalg.norm(np.diff(pose.joints_m[inside, joint("pelvis"), :2], axis=0), axis=1).sum()
    return float(path_m / (end_s - start_s))


def scaled_excursion(joints_m: np.ndarray, vigour: float) -> np.ndarray:
    """Scales the excursion of joints from their mean, relative to the pelvis.

    Args:
        joints_m: Joints (time, 22, 3).
        vigour: Factor of the excursion.
    """
    root = joints_m[:, :1].copy()
    root[..., 2] = 0.0
    local = joints_m - root
    mean = local.mean(axis=0, keepdims=True)
    return root + mean + vigour * (local - mean)


def sway_m(time_s: np.ndarray, speed_mps: float, rng: np.random.Generator) -> np.ndarray:
    """Slow displacement (time, 1, 3) in metres of a stationary person, at this rms speed."""
    frequency_hz, phase = rng.uniform(*ROAM_HZ, (2, 3, 1)), rng.uniform(0, 2 * np.pi, (2, 3, 1))
    omega = 2 * np.pi * frequency_hz
    shift_m = (np.sin(omega * time_s + phase) / omega).sum(axis=1) * speed_mps * np.sqrt(2 / 3)
    return np.stack([shift_m[0], shift_m[1], np.zeros_like(time_s)], axis=1)[:, None, :]


def spread_feet(joints_m: Joints, wider_m: float) -> Joints:
    """Joints with the feet farther apart, and the knees half as much.

    Feet that are apart already are moved less. While one foot is in the air, the body moves over the other one.

    Args:
        joints_m: Joints (frame, joint, 3) in metres.
        wider_m: Maximum additional distance of the feet in metres.
    """
    across = joints_m[:, joint("left_hip")] - joints_m[:, joint("right_hip")]
    across = across * (1.0, 1.0, 0.0)
    across = across / np.maximum(np.linalg.norm(across, axis=-1, keepdims=True), 1e-6)
    feet = joints_m[:, [joint("left_ankle"), joint("right_ankle")]]
    apart_m = float(np.median(((feet[:, 0] - feet[:, 1]) * across).sum(axis=-1)))
    half_m = 0.5 * wider_m * float(np.clip((FAR_APART_M - apart_m) / (FAR_APART_M - CLOSE_M), 0.0, 1.0))
    height_m = feet[..., 2] - feet[..., 2].min(axis=0)
    lifted = rise(height_m / LIFTED_M)  # (frame, side)
    over_m = (half_m * (lifted[:, 1] - lifted[:, 0]))[:, None] * across  # of the body over the foot that stands
    moved = joints_m + over_m[:, None]
    for side, sign in (("left", 1.0), ("right", -1.0)):
        for part, share in (("knee", 0.5), ("ankle", 1.0), ("foot", 1.0)):
            own = joint(f"{side}_{part}")
            moved[:, own] = joints_m[:, own] + sign * share * half_m * across + (1 - share) * over_m
    return moved


def lingering(time_s: np.ndarray, joints_m: Joints, linger: float) -> np.ndarray:
    """Warps the times of a movement in place: slow near its initial pose, faster far from it.

    The tempo at the far end is 1 + `linger` times that at the near end; the duration is unchanged. Movements of less
    than 3 cm (rms over joints) keep their times.

    Args:
        time_s: Times (time,) in seconds.
        joints_m: Joints (time, 22, 3) in metres.
        linger: Additional relative tempo at the far end.

    Returns:
        Warped times (time,) in seconds.
    """
    local = joints_m - joints_m[:, :1] * (1.0, 1.0, 0.0)
    far_m = np.sqrt(((local - local[0]) ** 2).sum(axis=-1).mean(axis=-1))
    near, most = np.percentile(far_m[time_s >= LEAD_S], (5, 95))
    if most - near < MIN_MOVED_M:
        return time_s
    slower = 1 / (1 + linger * ((far_m - near) / (most - near)).clip(0, 1))
    gone = _integral(slower, time_s)
    return time_s[0] + gone * (time_s[-1] - time_s[0]) / gone[-1]


def slow_at_turns(time_s: np.ndarray, joints_m: Joints, slower: float) -> np.ndarray:
    """Warps the times of a walk: standing takes 1 + `slower` times as long, walking as long as before.

    In between the factor depends on the speed of the pelvis relative to its upper quartile.

    Args:
        time_s: Times (time,) in seconds.
        joints_m: Joints (time, 22, 3) in metres.
        slower: Additional relative duration of standing.

    Returns:
        Warped times (time,) in seconds.
    """
    step_m = np.linalg.norm(np.gradient(joints_m[:, joint("pelvis"), :2], axis=0), axis=-1)
    speed_mps = step_m / np.gradient(time_s)
    usual_mps = max(float(np.quantile(speed_mps[time_s >= LEAD_S], 0.75)), SLOWEST_MPS)
    longer = 1 + slower * (1 - speed_mps / usual_mps).clip(0, 1)
    return time_s[0] + _integral(longer, time_s)


def _rested(pose: PoseSequence, before_s: float, after_s: float) -> PoseSequence:
    """The motion with a rest before and after: time 0 is the rest's beginning."""
    step_s = 0.05
    before = np.arange(-step_s, before_s - 0.02, step_s)
    started = pose.time_s >= 0.0
    time_s, joints_m = pose.time_s[started] + before_s, pose.joints_m[started]
    after = time_s[-1] + step_s * np.arange(1, int(after_s / step_s) + 4)
    held_m = np.pad(joints_m, ((len(before), len(after)), (0, 0), (0, 0)), mode="edge")
    return replace(pose, time_s=np.concatenate([before, time_s, after]), joints_m=held_m)
