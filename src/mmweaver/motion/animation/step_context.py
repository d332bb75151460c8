"""The step to animate: the input of its function, and the building blocks by which it changes the Controls."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from jaxtyping import Float

from mmweaver.core.registry import Registry
from mmweaver.core.skeleton import joint
from mmweaver.motion.animation.arm_reach import reach
from mmweaver.motion.animation.controls import CHANNELS, LEFT, OUTWARD, RIGHT, Controls, Habits, mix_arm
from mmweaver.motion.animation.kinematics import rotated, rotation_y, rotation_z
from mmweaver.motion.animation.profiles import (
    MOVEMENTS,
    Curve,
    Number,
    PerTime,
    Span,
    plateau,
    rise,
    spline_through,
    wander,
)
from mmweaver.motion.animation.root_path import Move, RootPath
from mmweaver.motion.animation.skeleton_proportions import SkeletonProportions
from mmweaver.motion.animation.standing import STAND_STRETCH, upright
from mmweaver.motion.language.plan import Step

BOTH = (LEFT, RIGHT)
Place = Sequence[Curve] | Float[np.ndarray, "n 3"]  # ahead, outward, up
STOOL_HEIGHT_M = 0.45  # of an assumed seat


@dataclass(frozen=True, kw_only=True)
class PlacedStep:
    """A step of a plan as placed in the room.

    Attributes:
        step: The scheduled step.
        moves: Its moves over the floor.
        seat_height_m: Height in metres of the seat that it uses.
    """

    step: Step
    moves: tuple[Move, ...] = ()
    seat_height_m: float = STOOL_HEIGHT_M


@dataclass(kw_only=True)
class StepContext:
    """One step of the motion, with the controls that its function changes.

    Attributes:
        time_s: Times (n,) of the whole motion in seconds, so that neighbouring steps can be blended.
        step: The scheduled step.
        body: Bone lengths.
        path: Path of the root over the whole motion.
        rng: Random stream of this step.
        moves: Moves of the path that belong to this step.
        seat_height_m: Height of the seat above the floor in metres.
        first: Whether no step precedes: the motion is already under way at its start.
        habits: Habits of the person.
        last: Whether no step follows: the motion continues at its end.
        arms_before: Whether the previous step holds the arms alike.
        arms_after: Whether the next step holds the arms alike.
    """

    time_s: PerTime
    step: Step
    body: SkeletonProportions
    path: RootPath
    rng: np.random.Generator
    moves: tuple[Move, ...] = ()
    seat_height_m: float = STOOL_HEIGHT_M
    first: bool = True
    habits: Habits = field(default_factory=Habits)
    last: bool = True
    arms_before: bool = False
    arms_after: bool = False

    def __post_init__(self) -> None:
        step = self.step
        self.start_s, self.end_s, self.duration_s = step.start_s, step.end_s, step.end_s - step.start_s
        self.hand, self.foot, self.direction, self.facing = step.hand, step.foot, step.direction, step.facing
        self.style, self.count, self.speed = step.style, step.count, step.speed
        self.height_m = self.body.height_m

    @cached_property
    def controls(self) -> Controls:
        """The pose parameters that the activity changes: initially upright; for a gesture those of the posture."""
        return upright(self)

    def stand(self) -> Controls:
        """Initializes the controls of an upright body before other random numbers are sampled."""
        return self.controls

    # ---- decided by the sentence and the seed

    @property
    def fewest(self) -> int:
        """Minimum number of repetitions if the sentence names none: 2 for "several times"."""
        return 2 if self.step.several else 1

    def by_speed(self, slow: float, usual: float, fast: float) -> float:
        """One of three values, by the speed in the sentence.

        Args:
            slow: Value for 'slowly'.
            usual: Value by default.
            fast: Value for 'quickly'.
        """
        return (usual, fast, slow)[self.speed]

    def tempo(self, slow: float, usual: float, fast: float, spread: float = 0.1) -> float:
        """Samples a rate, log-normal with `spread` and scaled by the person's pace.

        Args:
            slow: Rate for 'slowly'.
            usual: Rate by default.
            fast: Rate for 'quickly'.
            spread: Twice the standard deviation of its logarithm.
        """
        return self.by_speed(slow, usual, fast) * self.step.pace * float(np.exp(self.rng.normal(0.0, spread / 2)))

    def uniform(self, low: float, high: float) -> float:
        """Samples a number between two limits."""
        return float(self.rng.uniform(low, high))

    def sign(self) -> float:
        """Samples -1 or 1."""
        return float(self.rng.choice([-1.0, 1.0]))

    def vary(self, value: float, spread: float = 0.12) -> float:
        """Varies a size log-normally, clipped at twice the spread, and scales it by the person's habitual amplitude.

        Args:
            value: Usual size.
            spread: Standard deviation of its logarithm.
        """
        size = float(np.exp(np.clip(self.rng.normal(0, spread), -2 * spread, 2 * spread)))
        return value * self.habits.amplitude * size

    def wander(self, slow_hz: float, fast_hz: float) -> PerTime:
        """`profiles.wander` at the times of the motion.

        Args:
            slow_hz: Lowest frequency in Hz.
            fast_hz: Highest frequency in Hz.
        """
        return wander(self.time_s, self.rng, slow_hz=slow_hz, fast_hz=fast_hz)

    def sides(self) -> tuple[int, ...]:
        """The arms that move: as stated, else with probability 5/6 the preferred one."""
        usual = self.step.usual_hand or "right"
        chosen = self.hand or (usual if self.rng.random() < 5 / 6 else {"right": "left"}.get(usual, "right"))
        return {"left": (LEFT,), "right": (RIGHT,), "both": BOTH}[chosen]

    def one_side(self) -> int:
        """The single arm that moves; the right one of both."""
        return self.sides()[-1]

    @property
    def named_side(self) -> int:
        """The left arm if the sentence names it, else the right one."""
        return LEFT if self.hand == "left" else RIGHT

    @property
    def named_arms(self) -> tuple[int, ...]:
        """The arms that the sentence names, else both."""
        return self.sides() if self.hand else BOTH

    def leg_side(self) -> int:
        """The leg that moves: as stated, else sampled, the right one with probability 5/6."""
        chosen = self.foot or ("right" if self.rng.random() < 5 / 6 else "left")
        return LEFT if chosen == "left" else RIGHT

    def standing_path(self) -> RootPath:
        """The path of a body that stays where the step begins, with its heading then."""
        before_s = np.array([self.start_s - 0.001])
        x, y = self.path.position_m(before_s)[0]
        return RootPath(start_m=(float(x), float(y)), heading_rad=float(self.path.facing_rad(before_s)[0]))

    # ---- functions of time

    def repeats(self, natural_s: float, min_s: float, max_s: float, usual: int = 1) -> list[Span]:
        """Repetitions of a movement: the stated number, else the usual one.

        Several without a number are two, or more if time permits.

        Args:
            natural_s: Natural duration of one repetition in seconds.
            min_s: Minimum duration.
            max_s: Maximum duration.
            usual: Number of repetitions by default.
        """
        whole_body = self.step.several and not self.step.upper
        count = self.count or (max(2, int(self.duration_s / natural_s)) if whole_body else usual)
        wanted = natural_s / self.step.pace * self.by_speed(1.35, 1.0, 0.8) * float(np.exp(self.rng.normal(0, 0.07)))
        each = float(np.clip(min(wanted, self.duration_s / count), min_s, max_s))
        spare = 0.0 if count > 1 else max(self.duration_s - each, 0.0)
        begin = self.start_s + min(0.1, 0.3 * spare)
        return [Span(self.time_s, begin + k * each, each) for k in range(count)]

    def in_turn(
        self, usual_s: float, min_s: float, max_s: float, *, fewest: int = 1, lag: float = 0.0, more: float = 0.0
    ) -> list[Span]:
        """Repetitions that fill the step: the stated number, else as many as time permits.

        Args:
            usual_s: Usual duration of one repetition in seconds.
            min_s: Minimum duration.
            max_s: Maximum duration.
            fewest: Minimum number of repetitions.
            lag: Delay of each repetition as a share of its duration.
            more: If not 0, added to the number that fits before it is rounded down; 0 rounds to the nearest.
        """
        fits = self.duration_s / usual_s
        count = self.count or max(fewest, int(fits + more) if more else round(fits))
        each = float(np.clip(self.duration_s / count, min_s, max_s))
        return [Span(self.time_s, self.start_s + (k + lag) * each, each) for k in range(count)]

    def cycles(self, slow: float, usual: float, fast: float, low_hz: float, high_hz: float) -> tuple[float, float]:
        """Rate and end of a periodic movement; a count in the sentence sets the rate within limits.

        Args:
            slow: Rate in Hz for 'slowly'.
            usual: Rate by default.
            fast: Rate for 'quickly'.
            low_hz: Minimum rate with a count.
            high_hz: Maximum rate with a count.

        Returns:
            Rate in Hz, and end in seconds.
        """
        rate_hz = self.tempo(slow, usual, fast)
        if not self.count:
            return rate_hz, self.end_s
        rate = float(np.clip(self.count / max(self.duration_s - 0.2, 0.1), low_hz, high_hz))
        return rate, self.start_s + self.count / rate

    def phase(self, rate_hz: float) -> PerTime:
        """Phase (n,) in radians of a periodic movement that begins with the step."""
        return 2 * np.pi * rate_hz * (self.time_s - self.start_s)

    def plateau(self, begin_s: float, end_s: float, up_s: float, down_s: float) -> PerTime:
        """`profiles.plateau` at the times of the motion.

        Args:
            begin_s: Time at which the rise begins, seconds.
            end_s: Time at which the fall ends, seconds.
            up_s: Duration of the rise in seconds.
            down_s: Duration of the fall in seconds.
        """
        return plateau(self.time_s, begin_s, end_s, up_s, down_s)

    def since_start(self, low: float, slow: float, usual: float, fast: float, share: float) -> PerTime:
        """Progress (n,) from 0 at the start to 1 after a share of the step, not limited to 0 to 1.

        Args:
            low: Minimum duration in seconds.
            slow: Maximum duration for 'slowly'.
            usual: Maximum duration by default.
            fast: Maximum duration for 'quickly'.
            share: Duration as a share of the step.
        """
        return (self.time_s - self.start_s) / np.clip(share * self.duration_s, low, self.by_speed(slow, usual, fast))

    def edges(self, up_s: float, down_s: float, after_s: float = 0.0) -> PerTime:
        """Window (n,): 1 within the step, rising at its start and falling at its end, unless the motion extends beyond.

        Args:
            up_s: Duration of the rise in seconds.
            down_s: Duration of the fall in seconds.
            after_s: Delay of the fall after the step's end.
        """
        ones = np.ones_like(self.time_s)
        begin = ones if self.first else rise((self.time_s - self.start_s) / up_s)
        return begin if self.last else begin * rise((self.end_s + after_s - self.time_s) / down_s)

    # ---- changes of the controls

    def add(self, curve: Curve, side: int | None = None, /, **gains: Curve) -> None:
        """Adds a curve times a gain to channels of the controls.

        Args:
            curve: Function of time (n,), or a constant.
            side: LEFT or RIGHT; None for both if a channel has two.
            **gains: Gain by channel, see `controls.CHANNELS`.
        """
        for name, gain in gains.items():
            array, index = CHANNELS[name]
            values = getattr(self.controls, array)
            values = values if index is None else values[..., index]
            change = np.asarray(gain * curve)
            if values.ndim == 2 and side is None:
                change = change[..., None]
            elif values.ndim == 2:
                values = values[:, side]
            values += change

    def keyed(self, u: PerTime, movement: str, part: str, gain: Number = 1, side: int | None = None) -> None:
        """Adds the keyframes of a part of a movement to channels.

        Args:
            u: Progress (n,).
            movement: Name in `movements.toml`.
            part: Table of the part.
            gain: Factor of the keyframes.
            side: LEFT or RIGHT; None for both.
        """
        for channel, values in MOVEMENTS[movement][part].items():
            self.add(spline_through(u, MOVEMENTS[movement]["at"], values), side, **{channel: gain})

    def pelvis(self, ahead: Curve = 0.0, left: Curve = 0.0, up: Curve = 0.0) -> None:
        """Moves the pelvis in the body's own frame.

        Args:
            ahead: Metres ahead, (n,) or constant.
            left: Metres to the body's left.
            up: Metres up.
        """
        cos, sin = np.cos(self.controls.heading_rad), np.sin(self.controls.heading_rad)
        self.controls.pelvis_m[:, 0] += ahead * cos - left * sin
        self.controls.pelvis_m[:, 1] += ahead * sin + left * cos
        self.controls.pelvis_m[:, 2] += up

    def move_foot(self, side: int, ahead: Curve = 0.0, out: Curve = 0.0, up: Curve = 0.0) -> None:
        """Moves a foot in the body's own frame.

        Args:
            side: LEFT or RIGHT.
            ahead: Metres ahead, (n,) or constant.
            out: Metres outward.
            up: Metres up.
        """
        cos, sin = np.cos(self.controls.heading_rad), np.sin(self.controls.heading_rad)
        left = OUTWARD[side] * out
        self.controls.foot_m[:, side, 0] += ahead * cos - left * sin
        self.controls.foot_m[:, side, 1] += ahead * sin + left * cos
        self.controls.foot_m[:, side, 2] += up

    def bend_knees(self, room: Curve) -> None:
        """Ensures a minimum of room for bent knees, 0 to 1, (n,) or constant."""
        self.controls.knee_room[:] = np.maximum(self.controls.knee_room, room)

    def lift_weight(self, side: int, air: PerTime) -> None:
        """Unloads a foot; both knees bend slightly.

        Args:
            side: LEFT or RIGHT.
            air: 0 to 1 (n,): 1 unloads it completely.
        """
        self.add(air, side, contact=-1)
        self.bend_knees(0.8 * air)

    def lean_over(self, side: int, share: PerTime) -> None:
        """Shifts the body over one foot; the trunk stays upright.

        Args:
            side: LEFT or RIGHT.
            share: 0 to 1 (n,): 1 is over the foot.
        """
        self.pelvis(left=OUTWARD[side] * 0.043 * self.height_m * share)
        self.add(share, spine_roll=-OUTWARD[side] * 0.05)

    def crouch(self, depth: PerTime, lean_rad: float) -> None:
        """Lowers the body: hips back, trunk forward, knees over the feet.

        Args:
            depth: Share (n,) of the deepest squat.
            lean_rad: Forward lean of the trunk at full depth, radians.
        """
        body, knee, back = self.body, np.radians(118.0), 0.12 * self.height_m
        leg = np.sqrt(body.thigh_m**2 + body.shank_m**2 + 2 * body.thigh_m * body.shank_m * np.cos(knee))
        low = body.ankle_height_m + np.sqrt(leg**2 - back**2) + 0.95 * body.hip_below_pelvis_m
        self.pelvis(-back * depth, 0.0, -depth * (body.pelvis_height_m(STAND_STRETCH) - low))
        self.add(
            depth, pelvis_pitch=0.6 * lean_rad, spine_pitch=0.7 * lean_rad, head_pitch=-0.5 * lean_rad, knee_out=0.2
        )

    def arm(self, angles: Sequence[Number] | Float[np.ndarray, "n 4"], weight: Curve = 1.0, *sides: int) -> None:
        """Blends arms to given angles.

        Args:
            angles: Flexion, abduction, twist and elbow flexion in radians, (4,) or (n, 4).
            weight: 0 keeps the arms, 1 replaces their angles; (n,) or constant.
            *sides: LEFT or RIGHT; none for both.
        """
        for side in sides or BOTH:
            mix_arm(self.controls, side, np.asarray(angles), weight)

    def hand_to(
        self, side: int | tuple[int, ...], target: Place, weight: Curve = 1.0, elbow: Sequence[float] | None = None
    ) -> None:
        """As `hand_to_m`, with the target in body heights.

        Args:
            side: LEFT, RIGHT, or several.
            target: Ahead, outward and up of spine3 in the chest's frame, body heights; curves, or (n, 3).
            weight: As in `hand_to_m`.
            elbow: As in `hand_to_m`.
        """
        self.hand_to_m(side, self._points(target) * self.height_m, weight, elbow)

    def hand_to_m(
        self, side: int | tuple[int, ...], target: Place, weight: Curve = 1.0, elbow: Sequence[float] | None = None
    ) -> None:
        """Brings wrists to a position by inverse kinematics.

        Args:
            side: LEFT, RIGHT, or several.
            target: Ahead, outward and up of spine3 in the chest's frame, metres; curves, or (n, 3).
            weight: 0 keeps the arms, 1 reaches the target; (n,) or constant.
            elbow: Direction of the elbow in the same axes; None takes the gesture's record in `movements.toml`.
        """
        elbow = elbow or MOVEMENTS.get(self.step.upper, {}).get("elbow", (-0.3, 0.5, -1.0))
        self.arm(reach(self.body, self._points(target), elbow), weight, *(side if isinstance(side, tuple) else (side,)))

    def _points(self, target: Place) -> Float[np.ndarray, "n 3"]:
        if isinstance(target, np.ndarray):
            return target
        return np.stack([np.broadcast_to(np.asarray(part, float), self.time_s.shape) for part in target], axis=1)

    def mouth_m(self, side: int) -> Float[np.ndarray, "n 3"]:
        """Position of the mouth for an arm.

        Args:
            side: LEFT or RIGHT.

        Returns:
            Ahead, outward and up of spine3 in the chest's frame, metres, (n, 3).
        """
        head_rad = self.controls.head_rad
        half = rotation_z(head_rad[:, 1] / 2) @ rotation_y(head_rad[:, 0] / 2)
        head = self.body.offset_m[joint("neck")] + rotated(half, self.body.offset_m[joint("head")])
        return (head + rotated(half @ half, self.body.mouth_m)) * [1.0, OUTWARD[side], 1.0]


POSTURES: Registry[Callable[[StepContext], Controls]] = Registry("movement", [])
GESTURES: Registry[Callable[[StepContext, Controls], Controls]] = Registry("gesture", [])
Animate = Callable[[StepContext], None]


def posture(key: str, *, stands: bool = True) -> Callable[[Animate], Animate]:
    """Registers the function of a body activity.

    Args:
        key: Key of the activity.
        stands: Whether the upright controls are sampled before the function runs.
    """

    def register(animate: Animate) -> Animate:
        def perform(act: StepContext) -> Controls:
            if stands:
                act.stand()
            animate(act)
            return act.controls

        POSTURES.register(key, perform)
        return animate

    return register


def gesture(key: str) -> Callable[[Animate], Animate]:
    """Registers the function of a hand activity, which changes arms, trunk and head of the posture's `controls`.

    Args:
        key: Key of the activity.
    """

    def register(animate: Animate) -> Animate:
        def perform(act: StepContext, controls: Controls) -> Controls:
            act.controls = controls
            act.add(1, **MOVEMENTS.get(key, {}).get("hold", {}))
            animate(act)
            return controls

        GESTURES.register(key, perform)
        return animate

    return register
