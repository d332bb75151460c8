"""What a step asks of the body, as quantities with tolerances that facts are compared with.

The planner compares the same quantities with the path of a candidate, before any joint is solved: facts that a path has
not are None, and their quantities are skipped.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from typing import Any, Protocol

import numpy as np

from mmweaver.core.records import Scene
from mmweaver.motion.language.activities import BY_KEY, words_in
from mmweaver.motion.language.plan import HOPPING, Shape, Side, Step, Way
from mmweaver.motion.planning.targets import SEATS, faced_landmarks, goes_to_target, kinds_of

LENGTH, SPEED, ANGLE_DEG, DURATION = (0.10, 0.10), (0.15, 0.0), 10.0, (0.10, 0.15)  # share, and at least
LEAST_M = {"tandem": 0.35, "jog": 1.2, "crawl": 0.4, "walking_lunge": 0.5, "hop": 0.3, "hop_one_leg": 0.3, "leap": 0.2}
WALK_M, SIDESTEP_M = 0.7, 0.18  # shortest path that is a walk, and of one sidestep
SLOW_MPS, FAST_MPS = 1.05, 1.15  # a slow walk is slower, a quick one faster than
FALL_TOLERANCE_DEG = 45.0
FALLS = {"back": 180.0, "front": 0.0, "left": 90.0, "right": -90.0}
AT_THING_M, REACHED_M = 1.5, 0.8  # from the middle of a thing that is next to, and from the place before one walked to
FACES_TABLE_DEG = 60.0  # of a sitter at a table
# Too small to be counted on joints, two to a count, or shown by several steps.
UNCOUNTED = words_in(
    "march knock nod shake_head cough count_fingers sit_down stand_up kneel_up get_up kneel_down lie_down"
)
LEGS_UP = ("leg_aside", "knee_extension", "kick", "roundhouse", "side_kick", "stomp", "raise_leg", "one_leg")
POSTURE_OF = {
    "seat": ("seat",),
    "couch": ("floor", "seat"),
    "knees": ("knees", "floor"),
    "floor": ("floor",),
    "ground": ("floor", "seat"),
}
HELD_BY_HABIT = ("carry", "phone", "cradle", "tennis_serve")  # both hands, or either, may be used


class Moved(Protocol):
    """Facts of a path or of joints, of which some may be None."""

    @property
    def path_m(self) -> float: ...
    @property
    def net_m(self) -> tuple[float, float]: ...
    @property
    def place_m(self) -> tuple[float, float]: ...
    @property
    def heading_rad(self) -> float: ...


@dataclass(frozen=True, kw_only=True)
class Quantity:
    """One quantity that a step asks for.

    Attributes:
        what: What it is, after the number: "m away from the radar".
        asked: Value; a bound with `is_least` or `is_most`; a name for a posture or limb.
        shown: Reads it from facts.
        tolerance: Largest deviation that counts as done.
        is_least: Whether more is right, too.
        is_most: Whether less is right, too.
    """

    what: str
    asked: float | str
    shown: Callable[[Any], float | str | None]
    tolerance: float = 0.0
    is_least: bool = False
    is_most: bool = False

    def deviation(self, facts: Any) -> "Deviation | None":
        """How the facts deviate from what is asked; None if they do not, or do not tell.

        Args:
            facts: Facts of joints or of a path.
        """
        shown = self.shown(facts)
        if shown is None or (isinstance(shown, float) and np.isnan(shown)):
            return None
        if isinstance(self.asked, str) or isinstance(shown, str):
            if shown in str(self.asked).split("|"):
                return None
            asked = str(self.asked).split("|")[0]
            return Deviation(f"{asked or 'no'} {self.what} asked, {shown or 'no'} {self.what} shown", 0.5)
        gap = shown - self.asked
        gap = min(gap, 0.0) if self.is_least else max(gap, 0.0) if self.is_most else gap
        if abs(gap) <= self.tolerance + 1e-9:
            return None
        at_least = "at least " * self.is_least + "at most " * self.is_most
        lost = min(abs(gap) / max(abs(self.asked), self.tolerance, 1e-6), 1.0)
        return Deviation(f"{at_least}{_number(self.asked)} {self.what} asked, {_number(shown)} shown", lost)


@dataclass(frozen=True)
class Deviation:
    """A deviation in words, and the share of what is asked that is lost."""

    words: str
    lost: float


def _number(value: float) -> str:
    return f"{value:.0f}" if abs(value) >= 20 or value == int(value) else f"{value:.2f}".rstrip("0").rstrip(".")


def quantities(step: Step, scene: Scene) -> list[Quantity]:
    """All quantities that a step asks for in a room.

    Args:
        step: The step as the sentence asks for it, before the room has changed it.
        scene: The room.
    """
    found = [*_travel(step), *_turn(step), *_facing(step, scene), *_posture(step, scene), *_places(step, scene)]
    return [*found, *_times(step), *_limbs(step)]


def _within(value: float, tolerance: tuple[float, float]) -> float:
    return max(tolerance[0] * abs(value), tolerance[1])


def along(direction: Any) -> tuple[Callable[[Any], float], str]:
    """How far facts go in a direction, and its words; without direction the length of the path."""
    ways: dict[Any, tuple[Callable[[Any], float], str]] = {
        Way.TOWARDS: (lambda facts: facts.towards_m, "m towards the radar"),
        Way.AWAY: (lambda facts: -facts.towards_m, "m away from the radar"),
        Way.FORWARDS: (lambda facts: facts.ahead_m, "m forwards"),
        Way.BACKWARDS: (lambda facts: -facts.ahead_m, "m backwards"),
        Side.LEFT: (lambda facts: -facts.net_m[0], "m to the left"),
        Side.RIGHT: (lambda facts: facts.net_m[0], "m to the right"),
    }
    return ways.get(direction, (lambda facts: facts.path_m, "m of way"))


def _travel(step: Step) -> Iterator[Quantity]:
    if not step.moves or step.lower in ("stumble", "forward_roll"):
        return
    if step.arc_deg and step.lower in ("walk", "jog"):
        shown = (lambda facts: abs(facts.turn_deg)) if step.either_side else (lambda facts: facts.turn_deg)
        asked = abs(step.arc_deg) if step.either_side else step.arc_deg
        sign = -1.0 if step.direction == Way.BACKWARDS else 1.0
        if not step.count and not step.distance_m:
            yield Quantity(what="degrees of bend", asked=sign * asked, shown=shown, tolerance=max(15.0, 0.1 * asked))
    if step.speed_mps:
        yield Quantity(
            what="m/s", asked=step.speed_mps, shown=lambda facts: facts.speed_mps, tolerance=0.15 * step.speed_mps
        )
    if step.steps_hz:
        spm = 60 * step.steps_hz
        yield Quantity(
            what="steps per minute",
            asked=spm,
            shown=lambda facts: getattr(facts, "cadence_spm", None) or None,
            tolerance=0.1 * spm,
        )
    if step.lower == "walk" and step.speed and not step.speed_mps:
        limit, slow = (SLOW_MPS, True) if step.speed < 0 else (FAST_MPS, False)
        speed = Quantity(what="m/s", asked=limit, shown=lambda facts: facts.speed_mps, tolerance=0.05)
        yield replace(speed, is_most=slow, is_least=not slow)
    yield from _way(step)


def _way(step: Step) -> Iterator[Quantity]:
    length, what = along(None if step.arc_deg or step.route_m or goes_to_target(step) else step.direction)
    if step.direction == Shape.PACING or step.direction == Shape.CIRCLE or step.arc_deg or step.route_m:
        length, what = along(None)
    if step.distance_m:
        asked = step.distance_m
        yield Quantity(what=what, asked=asked, shown=length, tolerance=_within(asked, LENGTH))
        return
    if step.lower == "sidestep" and step.count:
        yield Quantity(what=what, asked=SIDESTEP_M * step.count, shown=length, is_least=True, tolerance=0.02)
        return
    if step.count and step.lower in ("walk", "jog") and not step.upper:
        yield Quantity(what="steps", asked=float(step.count), shown=lambda facts: _steps_taken(step.count, facts))
        return
    if step.lower in HOPPING or step.lower == "sidestep" or step.lower == "leap":
        least = LEAST_M.get(step.lower, SIDESTEP_M)
    else:
        least = LEAST_M.get(step.style, LEAST_M.get(step.lower, WALK_M))
    if goes_to_target(step) or step.direction == Way.SEAT:
        least = 0.3
    yield Quantity(what=what, asked=least, shown=length, is_least=True, tolerance=0.05)


def _steps_taken(asked: int, facts: Any) -> float | None:
    """Steps of a walk; bringing the feet together at its end may count as one."""
    steps = getattr(facts, "steps", None)
    return None if steps is None else float(asked if steps - 1 == asked else steps)


def _turn(step: Step) -> Iterator[Quantity]:
    if step.lower != "turn" or step.facing:
        return
    asked = step.turn_deg or {Side.LEFT: 90.0, Side.RIGHT: -90.0}.get(step.direction, 180.0)  # type: ignore[call-overload]
    either = step.either_side or (not step.turn_deg and step.direction not in tuple(Side))
    shown = (lambda facts: abs(facts.turn_deg)) if either else (lambda facts: facts.turn_deg)
    asked = abs(asked) if either else asked
    yield Quantity(what="degrees of turn", asked=asked, shown=shown, tolerance=ANGLE_DEG)


def turns_the_body(step: Step) -> bool:
    """Whether the body turns to the step's facing; pointing aside and looking leave it unchanged."""
    return bool(step.facing) and not (
        step.upper in ("point", "look_around") and step.facing in ("left", "right", "down", "sideways")
    )


def facing_gap_deg(facing: str, facts: Any, scene: Scene, step: Step | None = None) -> float | None:
    """Angle in degrees between the heading and what is faced; None without such a thing in the room."""
    place, heading = np.asarray(facts.place_m), facts.heading_rad
    to_radar = float(np.arctan2(-place[1], -place[0]))
    aims = {"left": [np.pi], "right": [0.0], "towards": [to_radar], "away": [to_radar + np.pi]}.get(facing)
    if facing == "sideways":
        aims = [to_radar + np.pi / 2, to_radar - np.pi / 2]
    if aims is None:
        marks = faced_landmarks(step or Step(facing=facing), scene)
        aims = [float(np.arctan2(mark.position_m[1] - place[1], mark.position_m[0] - place[0])) for mark in marks]
    gaps = [abs((aim - heading + np.pi) % (2 * np.pi) - np.pi) for aim in aims]
    return float(np.degrees(min(gaps))) if gaps else None


def _facing(step: Step, scene: Scene) -> Iterator[Quantity]:
    if not turns_the_body(step) or step.facing == "down":
        return
    what = {"towards": "the radar", "sideways": "a right angle to the radar", "away": "away from the radar"}
    if step.uses_seat and step.facing not in ("left", "right", "towards", "away"):
        tolerance = FACES_TABLE_DEG
    else:
        tolerance = ANGLE_DEG
    name = what.get(step.facing) or ("the " * (step.facing not in ("left", "right")) + step.facing)
    yield Quantity(
        what=f"degrees between the body and {name}",
        asked=0.0,
        shown=lambda facts: facing_gap_deg(step.facing, facts, scene),
        tolerance=tolerance,
    )


def _posture(step: Step, scene: Scene) -> Iterator[Quantity]:
    del scene
    posture = BY_KEY[step.lower].posture
    if posture in POSTURE_OF and step.lower not in ("crawl", "roll_in_bed", "sit_up", "seated_reach"):
        names = {"seat": "seated", "knees": "kneeling", "floor": "lying"}
        asked = "|".join(names[one] for one in POSTURE_OF[posture])

        def lowest(facts: Any) -> str | None:
            low = getattr(facts, "lowest_posture", None)
            return None if low is None else names.get(low, "upright")

        yield Quantity(what="posture", asked=asked, shown=lowest)
    if step.lower == "fall" and step.style in FALLS:
        yield Quantity(
            what="degrees of fall from ahead",
            asked=0.0,
            shown=lambda facts: _fall_gap(step.style, getattr(facts, "fall_deg", None)),
            tolerance=FALL_TOLERANCE_DEG,
        )


def _fall_gap(style: str, fall_deg: float | None) -> float | None:
    if fall_deg is None:
        return None
    return abs((fall_deg - FALLS[style] + 180) % 360 - 180)


def _places(step: Step, scene: Scene) -> Iterator[Quantity]:
    """Distance from the thing that a step is done at, goes to or sits on."""
    if step.place is not None and step.place.landmark and step.place.relation in ("near", "in", "front"):
        yield _distance(step.place.landmark, scene, AT_THING_M)
    elif step.moves and step.target and step.target not in SEATS:
        yield _distance(step.target, scene, AT_THING_M)


def _distance(kind: str, scene: Scene, most_m: float) -> Quantity:
    kinds = kinds_of(kind)
    marks = [mark for mark in scene.landmarks if mark.kind in kinds]

    def shown(facts: Any) -> float | None:
        gaps = [float(np.hypot(*(np.asarray(mark.position_m[:2]) - facts.place_m))) for mark in marks]
        before = [float(np.hypot(*(np.asarray(mark.approach_m) - facts.place_m))) for mark in marks]
        if not gaps:
            return None
        return 0.0 if min(before) < REACHED_M else min(gaps)

    return Quantity(what=f"m from the {kind}", asked=most_m, shown=shown, is_most=True, tolerance=0.1)


def _times(step: Step) -> Iterator[Quantity]:
    if step.seconds:
        yield Quantity(
            what="s",
            asked=step.seconds,
            shown=lambda facts: getattr(facts, "duration_s", None),
            tolerance=_within(step.seconds, DURATION),
        )
    if step.count > 1 and not step.moves and (step.upper or step.lower) not in UNCOUNTED:
        yield Quantity(
            what="times",
            asked=float(step.count),
            shown=lambda facts: _nearest_count(step.count, getattr(facts, "repetitions", None)),
        )


def _nearest_count(asked: int, shown: tuple[int, ...] | None) -> float | None:
    """The count of the strongest signals that is nearest to what is asked."""
    return None if not shown else float(min(shown, key=lambda one: abs(one - asked)))


def _limbs(step: Step) -> Iterator[Quantity]:
    one_hand = step.hand in ("left", "right") and step.upper and step.other_hand is None
    is_plain = step.upper not in HELD_BY_HABIT and not BY_KEY[step.lower].moves and step.posture != "floor"
    if one_hand and is_plain:
        yield Quantity(what="arm", asked=step.hand, shown=lambda facts: getattr(facts, "arm", None))
    if step.foot in ("left", "right") and step.lower in LEGS_UP:
        foot = {"left": "right", "right": "left"}[step.foot] if step.lower == "one_leg" else step.foot
        yield Quantity(what="leg", asked=foot, shown=lambda facts: getattr(facts, "leg", None))
