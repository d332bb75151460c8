"""A request, checked, parsed and scheduled once: the input of the motion planner and the methods."""

import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cache
from typing import Any

from mmweaver.core.board import Board
from mmweaver.core.boards import find_board
from mmweaver.core.errors import InputError
from mmweaver.core.options import Place
from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.radar_pose import RadarPose, check_poses
from mmweaver.core.targets import MAX_TARGETS, Interferer, Reflector, Thing, things_of_text
from mmweaver.io.result_folder import radar_meta
from mmweaver.motion.empty_floor import NOBODY, says_nobody
from mmweaver.motion.language.plan import APPROXIMATED, DONE, MotionPlan
from mmweaver.motion.language.postures import add_shown_text
from mmweaver.motion.language.sentence import SentenceParser, parse_sentence
from mmweaver.motion.language.timing import natural_s, repeated, schedule
from mmweaver.motion.mocap.clip import MotionClip, check_lasts
from mmweaver.motion.multi_person import MOST_PEOPLE
from mmweaver.motion.people import check_subject
from mmweaver.motion.physiology import HOLDING, breathing_rate_of, cover_of
from mmweaver.motion.planning.missing import STAND_IN
from mmweaver.motion.planning.targets import SHORTEST_PATH_M
from mmweaver.motion.register_activity import load_activity_plugins
from mmweaver.weaver.request import Request

MAX_CORNERS = 1000  # of a path
MAX_FRAMES = 2000
NEAREST_PERSON_M = 0.5  # for radars whose range window begins at 0
FPS_LIMITS = (0.1, 1000.0)
MAX_SECONDS = 600.0
LEAST_SECONDS = 2.0  # of a sequence whose duration is determined by the sentence
MAX_BYTES = 2_000_000_000  # of the largest array


@dataclass(frozen=True, kw_only=True)
class PersonRequest:
    """One person of a request. None means sampled: the start by the motion planner, the height by the seed."""

    text: str  # what the person does; for a recorded motion only its name
    plan: MotionPlan | None  # the parsed and scheduled text; None for a recorded motion
    start_m: Place | None = None  # (x, y) on the floor, in the radar's coordinates
    height_m: float | None = None
    subject: int | None = None  # number of the person
    breaths_per_minute: float | None = None
    cover_db: float = 0.0  # two-way loss of a blanket


@dataclass(frozen=True, kw_only=True)
class ParsedRequest:
    """A valid request for one sequence, made by `parse`."""

    people: tuple[PersonRequest, ...]  # none: an empty room
    config: RadarConfig  # at the requested frame rate
    frames: int = 20
    seed: int = 0
    motion: MotionClip | None = None  # the first person's recorded motion
    heading_rad: float | None = None  # initial direction of the first person's body, from +x towards +y
    as_recorded: bool = False  # the recorded positions are kept
    keep_adc: bool = False
    board: Board | None = None  # None: a typical one of this seed, or that of a background recording
    radar_poses: tuple[RadarPose, ...] = ()  # none: one radar at the camera
    reflectors: tuple[Reflector, ...] = ()
    things: tuple[Thing, ...] = ()
    interferers: tuple[Interferer, ...] = ()
    missing: str = STAND_IN  # what is done about things that the room lacks
    strict: bool = False  # whether what is not done is refused
    parser: str | None = None  # the language model that reads sentences; None: the grammar

    @property
    def duration_s(self) -> float:
        return self.frames * self.config.frame_period_s

    @property
    def range_window_m(self) -> tuple[float, float]:
        """Nearest and farthest distance in metres at which a person is placed: within the radar's range bins."""
        near_m, far_m = float(self.config.range_m[0]), float(self.config.range_m[-1])
        return max(near_m, min(NEAREST_PERSON_M, far_m / 2)), far_m

    def meta(self) -> dict[str, Any]:
        """The entries of the request in meta.json."""
        placed = {name: getattr(self, name) for name in ("heading_rad", "height_m", "subject", "as_recorded")}
        return {
            "seed": self.seed,
            "frames": self.frames,
            "fps": 1 / self.config.frame_period_s,
            "at": self.at,
            "placed": placed,
            **radar_meta(self.config),
        }

    @property
    def board_without_background(self) -> Board:
        """The board of a signal in a room without a background recording."""
        return find_board("typical", self.config, self.seed) if self.board is None else self.board

    @property
    def text(self) -> str | list[str]:
        """The text of one person, or a list for several people; NOBODY for an empty room."""
        return NOBODY if not self.people else _one_or_all([person.text for person in self.people])

    @property
    def at(self) -> Place | list[Place | None] | None:
        """The start of one person, or a list for several people; None where all are sampled."""
        return _one_or_all([person.start_m for person in self.people])

    @property
    def subject(self) -> int | list[int | None] | None:
        """The number of one person, or a list for several people; None where all are sampled."""
        return _one_or_all([person.subject for person in self.people])

    @property
    def height_m(self) -> float | list[float | None] | None:
        """The height of one person, or a list for several people; None where all are sampled."""
        return _one_or_all([person.height_m for person in self.people])


def parse(asked: Request, radar: RadarConfig, *, needs_adc: bool = False) -> ParsedRequest:
    """Checks a request and parses its sentences. Takes milliseconds, so it is called before any long computation.

    Args:
        asked: The request.
        radar: The radar at its own frame rate.
        needs_adc: Whether ADC samples are held in memory even if they are not returned.

    Returns:
        The request with its plans, at the requested frame rate.

    Raises:
        InputError: For texts, frames, seconds, fps or places outside their limits, a frame rate that the chirps do
            not fit into, more samples than memory holds, a text that is not understood or of which nothing fits
            the duration, and a recorded motion that is shorter than requested.
    """
    if asked.fps is not None and not FPS_LIMITS[0] <= asked.fps <= FPS_LIMITS[1]:
        raise InputError(f"fps must be {FPS_LIMITS[0]:g} to {FPS_LIMITS[1]:g}, not {asked.fps:g}")
    if asked.seed < 0:
        raise InputError(f"the seed must be 0 or above, not {asked.seed}")
    texts, motion = asked.sentences, asked.motion
    if not 1 <= len(texts) <= MOST_PEOPLE:
        raise InputError(f"give 1 to {MOST_PEOPLE} texts, one for each person, not {len(texts)}")
    acts, named = zip(*map(things_of_text, texts), strict=True)
    things = (*asked.things, *(Thing(kind=kind) for kinds in named for kind in kinds))
    if max(len(things), len(asked.reflectors)) > MAX_TARGETS:
        raise InputError(f"give at most {MAX_TARGETS} things and {MAX_TARGETS} reflectors")
    is_empty = _asks_for_nobody(replace(asked, text=list(acts)))
    starts = _starts(asked.at, len(texts))
    check_poses(tuple(asked.radar_poses))
    config = radar if asked.fps is None else replace(radar, frame_period_s=1 / asked.fps)
    has_adc = asked.keep_adc or needs_adc
    count = _frames_asked_for(asked, config)
    if count is not None:
        _check_size(config, count, has_adc)
    acts, rates = zip(*map(breathing_rate_of, acts), strict=True)
    acts, covers_db = zip(*map(cover_of, acts), strict=True)
    plans: list[MotionPlan | None] = [
        None if is_empty or (motion is not None and index == 0) else parsed_text(one, asked.parser)
        for index, one in enumerate(acts)
    ]
    if asked.path_m is not None:
        plans[0] = _along(plans[0], asked.path_m)
    count = count or min(_frames_needed(plans, motion, config), _most_frames(config, has_adc))
    duration_s = count * config.frame_period_s
    if motion is not None:
        check_lasts(motion, duration_s)
    heights = _one_each(asked.height_m, len(texts), "height")
    subjects = _one_each(asked.subject, len(texts), "subject")
    people = tuple(
        PersonRequest(
            text=text,
            plan=_scheduled(_with_held_breath(plan), duration_s),
            start_m=start,
            height_m=None if height is None else float(height),
            subject=None if who is None else check_subject(who),
            breaths_per_minute=rate,
            cover_db=cover_db,
        )
        for text, plan, start, height, who, rate, cover_db in zip(
            texts, plans, starts, heights, subjects, rates, covers_db, strict=True
        )
    )
    return ParsedRequest(
        people=() if is_empty else people,
        config=config,
        frames=count,
        seed=asked.seed,
        motion=motion,
        heading_rad=asked.heading_rad,
        as_recorded=asked.as_recorded,
        keep_adc=asked.keep_adc,
        board=None if asked.board is None else find_board(asked.board, config, asked.seed),
        radar_poses=tuple(asked.radar_poses),
        reflectors=tuple(asked.reflectors),
        things=things,
        interferers=tuple(asked.interferers),
        missing=asked.missing,
        strict=asked.strict,
        parser=asked.parser,
    )


def _asks_for_nobody(asked: Request) -> bool:
    """Whether an empty room is requested; InputError if the request also describes a person."""
    if asked.motion is not None or not any(says_nobody(one) for one in asked.sentences):
        return False
    if len(asked.sentences) > 1:
        raise InputError(f"{NOBODY!r} is an empty room; leave it out where others are in it, or give it alone")
    if any(one is not None for one in (asked.at, asked.heading_rad, asked.path_m, asked.height_m, asked.subject)):
        raise InputError(
            f"{NOBODY!r} is an empty room: leave out place, heading, path, height and subject, or say what is done"
        )
    return True


def _frames_asked_for(asked: Request, config: RadarConfig) -> int | None:
    """The number of frames if frames or seconds are given; InputError for both, or for values outside the limits."""
    frames, seconds = asked.frames, asked.seconds
    if frames is not None and seconds is not None:
        raise InputError("frames and seconds both say how long it lasts; give one of them")
    if seconds is not None:
        if not (math.isfinite(seconds) and 0 < seconds <= MAX_SECONDS):
            raise InputError(f"seconds must be above 0 and up to {MAX_SECONDS:g}, not {seconds:g}")
        frames = max(1, math.ceil(seconds / config.frame_period_s - 1e-6))
        if frames > MAX_FRAMES:
            raise InputError(
                f"{seconds:g} s are {frames} frames at {1 / config.frame_period_s:.3g} a second; at most"
                f" {MAX_FRAMES} ({MAX_FRAMES * config.frame_period_s:.4g} s) are made"
            )
    if frames is not None and not 1 <= frames <= MAX_FRAMES:
        raise InputError(f"frames must be 1 to {MAX_FRAMES}, not {frames}")
    return frames


def _frames_needed(plans: Sequence[MotionPlan | None], motion: MotionClip | None, config: RadarConfig) -> int:
    """Number of frames of the recorded motion, or of the longest sentence but at least two seconds."""
    if motion is not None:
        return max(1, math.floor(motion.duration_s / config.frame_period_s + 1e-6))
    needed_s = max([LEAST_SECONDS, *(natural_s(plan) for plan in plans if plan is not None)])
    return max(1, math.ceil(needed_s / config.frame_period_s - 1e-6))


def parsed_text(text: str, parser: str | None = None) -> MotionPlan:
    """Parses a sentence; activities of plug-ins are loaded if it is not understood without them.

    Args:
        text: The sentence.
        parser: Name of a language model that reads it (`model_parser.named_parser`); None for the grammar.

    Raises:
        InputError: If less than half of it is understood, or it describes an empty room.
    """
    if says_nobody(text):
        raise InputError(f"{text[:60]!r} is an empty place, a sequence of its own: generate --text {NOBODY}, alone")
    if parser is not None:
        return _named(parser)(text, in_part=True)
    try:
        return parse_sentence(text)
    except InputError:
        load_activity_plugins()
        return parse_sentence(text, in_part=True)


@cache
def _named(parser: str) -> SentenceParser:
    from mmweaver.motion.language.model_parser import named_parser

    load_activity_plugins()
    return named_parser(parser)


def _along(plan: MotionPlan | None, path_m: Sequence[Place]) -> MotionPlan:
    """The plan with its first walk along a path; InputError if it has no walk, or the path is not valid."""
    if len(path_m) > MAX_CORNERS:
        raise InputError(f"a path has at most {MAX_CORNERS} points, not {len(path_m)}")
    points = tuple((float(x), float(y)) for x, y in path_m)
    if len(points) < 2 or not all(math.isfinite(value) for point in points for value in point):
        raise InputError("a path has at least two points, x and y in metres, such as '0,3 0,1.5 0.8,1.5'")
    walks = [] if plan is None else [k for k, step in enumerate(plan.steps) if step.lower in ("walk", "jog")]
    if plan is None or not walks:
        raise InputError("the path is for a sentence in which the person walks or runs; say so, or leave out --path")
    length_m = sum(math.dist(one, other) for one, other in itertools.pairwise(points))
    if length_m < SHORTEST_PATH_M:
        raise InputError(f"the path is {length_m:.2f} m long; a walk takes {SHORTEST_PATH_M:g} m at least")
    steps = list(plan.steps)
    walk = steps[walks[0]]
    steps[walks[0]] = replace(
        walk,
        route_m=points,
        distance_m=round(length_m, 2),
        direction=None,
        target="",
        place=None,
        arc_deg=0.0,
        count=0,
    )
    notes, clauses = [f"the path given is {length_m:.2f} m long"], list(plan.clauses)
    if walk.direction or walk.target or walk.place or walk.arc_deg or walk.count:
        notes.append(f"{walk.clause!r} is shown along the path given, whatever way it names")
        for number in walk.clauses:
            clauses[number] = clauses[number].lowered_to(APPROXIMATED, notes[-1])
    return replace(plan, steps=tuple(steps), notes=(*plan.notes, *notes), clauses=add_shown_text(clauses, steps))


def _with_held_breath(plan: MotionPlan | None) -> MotionPlan | None:
    """The plan without the note that a held breath is not shown: breathing is simulated and stops."""
    if plan is None or not any(HOLDING.search(one.clause) for one in plan.clauses):
        return plan
    held = [one.clause for one in plan.clauses if HOLDING.search(one.clause)]
    clauses = tuple(
        replace(one, status=DONE, how="the breath is held") if one.clause in held else one for one in plan.clauses
    )
    notes = tuple(note for note in plan.notes if not any(repr(clause) in note for clause in held))
    return replace(plan, clauses=clauses, notes=notes)


def _scheduled(plan: MotionPlan | None, duration_s: float) -> MotionPlan | None:
    if plan is None:
        return None
    has_path = any(step.route_m for step in plan.steps)  # a path is walked once
    return schedule(plan if has_path else repeated(plan, duration_s), duration_s)


def _most_frames(config: RadarConfig, has_adc: bool) -> int:
    """The maximum number of frames within limits and memory."""
    return max(1, min(MAX_FRAMES, MAX_BYTES // _frame_bytes(config, has_adc), int(MAX_SECONDS / config.frame_period_s)))


def _frame_bytes(config: RadarConfig, has_adc: bool) -> int:
    """Bytes per frame of the largest array, complex64."""
    return 8 * config.num_loops * config.num_antennas * (config.num_samples if has_adc else config.num_range_bins)


def _check_size(config: RadarConfig, frames: int, has_adc: bool) -> None:
    if frames * config.frame_period_s > MAX_SECONDS:
        raise InputError(
            f"{frames} frames last {frames * config.frame_period_s:g} s; at most {MAX_SECONDS:g} s are made"
        )
    size = _frame_bytes(config, has_adc)
    if frames > MAX_BYTES // size:
        raise InputError(
            f"{frames} frames of radar {config.name!r} fill {frames * size / 1e9:.1f} GB of memory; at most"
            f" {MAX_BYTES // size} are made at a time"
        )


def _starts(at: Place | Sequence[Place | None] | None, people: int) -> list[Place | None]:
    """Start of each person, None for sampled; InputError for invalid places or too many of them."""
    is_one = at is not None and all(isinstance(value, int | float) for value in at)
    given: list[Any] = [] if at is None else [at] if is_one else list(at)
    if len(given) > people or (is_one and people > 1):
        raise InputError(f"{people} people need a list of at most {people} places to start, not {at}")
    for place in given:
        if place is not None and not (len(place) == 2 and all(math.isfinite(value) for value in place)):
            raise InputError(f"the place to start must be two numbers, x and y in metres, not {place}")
    return [(float(place[0]), float(place[1])) if place else None for place in given] + [None] * (people - len(given))


def _one_each(given: Any, people: int, name: str) -> list[Any]:
    """Each person's own value, None for sampled; InputError for more values than people."""
    values = [given] if given is None or isinstance(given, int | float) else list(given)
    if len(values) > people:
        raise InputError(f"{people} people need at most {people} {name}s, not {len(values)}")
    if people > 1 and given is not None and values == [given]:
        raise InputError(f"{people} people need a list of {name}s, one for each (--{name} for each)")
    return values + [None] * (people - len(values))


def _one_or_all(values: list[Any]) -> Any:
    if len(values) == 1:
        return values[0]
    return None if all(value is None for value in values) else values
