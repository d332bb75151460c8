"""What is asked of `Weaver.generate`: checked, parsed and scheduled once, then handed on as one record."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

from mmweaver.core.errors import InputError
from mmweaver.core.radar_config import RadarConfig
from mmweaver.motion.language.plan import MotionPlan
from mmweaver.motion.language.timing import plan_motion
from mmweaver.motion.mocap.clip import MotionClip
from mmweaver.motion.mocap.clip_resampling import check_lasts
from mmweaver.motion.multi_person import MOST_PEOPLE, Place
from mmweaver.motion.register_activity import load_activity_plugins

MAX_FRAMES = 2000
FPS_LIMITS = (0.1, 1000.0)
MAX_SECONDS = 600.0
MAX_BYTES = 2_000_000_000  # of the largest array


@dataclass(frozen=True, kw_only=True)
class PersonRequest:
    """One person of a request. None means chosen: the start by the motion planner, the height by the seed."""

    text: str  # what the person does; for a recorded motion only its name
    plan: MotionPlan | None  # the parsed and scheduled text; None for a recorded motion
    start_m: Place | None = None  # (x, y) on the floor, in the radar's frame
    height_m: float | None = None


@dataclass(frozen=True, kw_only=True)
class Request:
    """A valid request for one sequence; made by `parse_request`."""

    people: tuple[PersonRequest, ...]
    config: RadarConfig  # at the requested frame rate
    frames: int = 20
    seed: int = 0
    motion: MotionClip | None = None  # the first person's recorded motion
    heading_rad: float | None = None  # where the recorded body faces first, from +x towards +y
    as_recorded: bool = False  # the recorded positions are kept
    keep_adc: bool = False

    @property
    def duration_s(self) -> float:
        return self.frames * self.config.frame_period_s

    @property
    def range_window_m(self) -> tuple[float, float]:
        """First and last range bin that the radar keeps."""
        return float(self.config.range_m[0]), float(self.config.range_m[-1])

    @property
    def text(self) -> str | list[str]:
        """The text of one person, or a list of several people's."""
        return _one_or_all([person.text for person in self.people])

    @property
    def at(self) -> Place | list[Place | None] | None:
        """The start of one person, or a list of several people's; None where all are chosen."""
        return _one_or_all([person.start_m for person in self.people])

    @property
    def height_m(self) -> float | list[float | None] | None:
        """The height of one person, or a list of several people's; None where all are chosen."""
        return _one_or_all([person.height_m for person in self.people])


def parse_request(
    radar: RadarConfig,
    text: str | Sequence[str] | None = None,
    *,
    motion: MotionClip | None = None,
    frames: int = 20,
    fps: float | None = None,
    seed: int = 0,
    at: Place | Sequence[Place | None] | None = None,
    heading_rad: float | None = None,
    height_m: float | Sequence[float | None] | None = None,
    as_recorded: bool = False,
    keep_adc: bool = False,
    needs_adc: bool = False,
) -> Request:
    """Checks a request and parses its sentences; takes milliseconds, so it is called before any long work.

    The arguments are those of `Weaver.generate`; `needs_adc` says that ADC samples are held in memory although they
    are not returned. Raises InputError for texts, frames, fps or places outside their limits, for a frame rate that
    the chirps do not fit into, for more samples than memory holds, for a text that is not understood or does not fit
    the time, and for a recorded motion that is too short.
    """
    if not 1 <= frames <= MAX_FRAMES:
        raise InputError(f"frames must be 1 to {MAX_FRAMES}, not {frames}")
    if fps is not None and not FPS_LIMITS[0] <= fps <= FPS_LIMITS[1]:
        raise InputError(f"fps must be {FPS_LIMITS[0]:g} to {FPS_LIMITS[1]:g}, not {fps:g}")
    if seed < 0:
        raise InputError(f"the seed must be 0 or above, not {seed}")
    texts = [text or ""] if text is None or isinstance(text, str) else list(text)
    if not 1 <= len(texts) <= MOST_PEOPLE:
        raise InputError(f"give 1 to {MOST_PEOPLE} texts, one for each person, not {len(texts)}")
    starts = _starts(at, len(texts))
    config = radar if fps is None else replace(radar, frame_period_s=1 / fps)
    _check_size(config, frames, keep_adc or needs_adc)
    if motion is not None:
        check_lasts(motion, frames * config.frame_period_s)
    plans: list[MotionPlan | None] = [
        None if motion is not None and index == 0 else _scheduled(one, config, frames)
        for index, one in enumerate(texts)
    ]
    heights = _heights(height_m, len(texts))
    people = tuple(
        PersonRequest(text=text, plan=plan, start_m=start, height_m=height)
        for text, plan, start, height in zip(texts, plans, starts, heights, strict=True)
    )
    return Request(
        people=people, config=config, frames=frames, seed=seed, motion=motion, heading_rad=heading_rad,
        as_recorded=as_recorded, keep_adc=keep_adc,
    )  # fmt: skip


def _scheduled(text: str, config: RadarConfig, frames: int) -> MotionPlan:
    """The parsed and scheduled sentence; activities of plug-ins are looked up where it is not understood without."""
    duration_s = frames * config.frame_period_s
    try:
        return plan_motion(text, duration_s, 1 / config.frame_period_s)
    except InputError:
        if not load_activity_plugins():
            raise
        return plan_motion(text, duration_s, 1 / config.frame_period_s)


def _check_size(config: RadarConfig, frames: int, has_adc: bool) -> None:
    if frames * config.frame_period_s > MAX_SECONDS:
        raise InputError(
            f"{frames} frames last {frames * config.frame_period_s:g} s; at most {MAX_SECONDS:g} s are made"
        )
    numbers = config.num_loops * config.num_antennas * (config.num_samples if has_adc else config.num_range_bins)
    most = MAX_BYTES // (8 * numbers)
    if frames > most:
        raise InputError(
            f"{frames} frames of radar {config.name!r} fill {frames * 8 * numbers / 1e9:.1f} GB of memory; at most"
            f" {most} are made at a time"
        )


def _starts(at: Place | Sequence[Place | None] | None, people: int) -> list[Place | None]:
    """Where each person starts, None = chosen. Raises InputError for what is no place, or for too many places."""
    is_one = at is not None and all(isinstance(value, int | float) for value in at)
    given: list[Any] = [] if at is None else [at] if is_one else list(at)
    if len(given) > people or (is_one and people > 1):
        raise InputError(f"{people} people need a list of at most {people} places to start, not {at}")
    for place in given:
        if place is not None and not (len(place) == 2 and all(math.isfinite(value) for value in place)):
            raise InputError(f"the place to start must be two numbers, x and y in metres, not {place}")
    return [(float(place[0]), float(place[1])) if place else None for place in given] + [None] * (people - len(given))


def _heights(height_m: float | Sequence[float | None] | None, people: int) -> list[float | None]:
    """Each person's height, None = by the seed. Raises InputError for more heights than people."""
    is_one = isinstance(height_m, int | float)
    given = [height_m] if height_m is None or isinstance(height_m, int | float) else list(height_m)
    if len(given) > people:
        raise InputError(f"{people} people need at most {people} heights, not {len(given)}")
    if is_one and people > 1:
        raise InputError(f"{people} people need a list of heights, one for each (--height for each)")
    return [None if height is None else float(height) for height in given] + [None] * (people - len(given))


def _one_or_all(values: list[Any]) -> Any:
    if len(values) == 1:
        return values[0]
    return None if all(value is None for value in values) else values
