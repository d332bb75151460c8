"""Several people in one room: composed one after the other, each clear of those already there.

People with a given start go first, the others follow in the order of their sentences. If one finds no place, all are
composed again with other random numbers, and that person goes first.
Clear means at all times: pelvises at least 0.5 m apart, and at least 2 cm between the surfaces of two bodies.
"""

from collections.abc import Callable, Sequence
from typing import Any

from mmweaver.core.errors import InputError
from mmweaver.core.records import PoseSequence, Scene
from mmweaver.core.seeding import stream
from mmweaver.motion.compose import Motion, compose
from mmweaver.motion.language.plan import MotionPlan
from mmweaver.motion.people import MOST_SUBJECTS, check_subject, subject_of
from mmweaver.motion.planning.separation import MIN_PELVIS_DISTANCE_M, are_separate

Place = tuple[float, float]
MOST_PEOPLE = 8
TRIES_PER_PERSON, TRIES_FOR_ALL = 6, 6


def compose_people(
    plans: Sequence[MotionPlan | None],
    scene: Scene,
    *,
    seed: int,
    starts_m: Sequence[Place | None] | None = None,
    heights_m: Sequence[float | None] | None = None,
    subjects: Sequence[int | None] | None = None,
    first: Motion | None = None,
    heading_rad: float | None = None,
    **window: Any,
) -> tuple[Motion, ...]:
    """Composes one motion per scheduled plan, each of another subject.

    `starts_m`, `heights_m` and `subjects` hold each person's start (x, y), height and number, None where it is chosen.
    `heading_rad` is where the first faces first. `first` is the first
    person's motion where it exists already (a recorded one); it stays as it is, and `plans[0]` is not used. Otherwise
    the first person moves as they would alone, wherever that leaves room for the others. `window`: `range_window_m` and
    `farthest_m` as for `compose`. Raises InputError as
    `compose` does, and where the people cannot be kept separate.
    """
    starts = [None] * len(plans) if starts_m is None else list(starts_m)
    heights = [None] * len(plans) if heights_m is None else list(heights_m)
    who = [None] * len(plans) if subjects is None else list(subjects)
    if first is not None:
        who[0] = first.pose.subject
    numbers = _subjects(seed, who)

    def alone(index: int, own_seed: int, others: tuple[PoseSequence, ...], *, may_touch: bool = True) -> Motion:
        plan = plans[index]
        assert plan is not None
        return compose(
            plan,
            scene,
            seed=own_seed,
            start_m=starts[index],
            height_m=heights[index],
            subject=numbers[index],
            others=others,
            heading_rad=None if index or first is not None else heading_rad,
            may_touch=may_touch,
            **window,
        )

    if len(plans) == 1:
        return (alone(0, seed, ()) if first is None else first,)
    given = {} if first is None else {0: first}
    order = sorted(set(range(len(plans))) - set(given), key=lambda index: starts[index] is None)
    crowded = order[0]
    for attempt in range(TRIES_FOR_ALL):
        people = dict(given)
        for index in order:
            try:
                people[index] = _join(list(people.values()), alone, (seed, index, attempt))
            except InputError:
                if attempt == 0:  # an error that also occurs without the others is reported as such
                    alone(index, _seed_of(seed, index, 0, 0), ())
                crowded = index
                order.sort(key=lambda one: (starts[one] is None, one != crowded))  # first in the next attempt
                break
        if len(people) == len(plans):
            return tuple(people[index] for index in range(len(plans)))
    refused = plans[crowded]
    raise InputError(
        f"there is no room for {len(plans)} people who keep {MIN_PELVIS_DISTANCE_M:g} m apart: person {crowded + 1},"
        f" {refused.text if refused else ''!r}, finds no place next to the others; try fewer people or other places"
        " (--at for each)"
    )


def _join(people: list[Motion], alone: Callable[..., Motion], numbers: tuple[int, int, int]) -> Motion:
    """Adds one person, clear of the others; `numbers` are seed, index of the person and attempt."""
    seed, index, attempt = numbers
    others = tuple(one.pose for one in people)
    for retry in range(TRIES_PER_PERSON):
        may_touch = not others or attempt == TRIES_FOR_ALL - 1  # only after other orders of the people
        motion = alone(index, _seed_of(seed, index, attempt, retry), others, may_touch=may_touch)
        if all(are_separate(motion.pose, other) for other in others):
            return motion
    raise InputError(f"person {index + 1} comes too near to somebody else; try another place")


def _subjects(seed: int, given: list[int | None]) -> list[int]:
    """Number of each person, as given or sampled, all different. Raises InputError for duplicates."""
    fixed = [check_subject(subject) for subject in given if subject is not None]
    if len(set(fixed)) < len(fixed):
        raise InputError(f"nobody is there twice; the subjects {', '.join(map(str, fixed))} must differ")
    numbers: list[int] = []
    for index, subject in enumerate(given):
        number = subject_of(seed, index) if subject is None else subject
        while subject is None and (number in numbers or number in fixed):
            number = (number + 1) % MOST_SUBJECTS
        numbers.append(number)
    return numbers


def _seed_of(seed: int, index: int, attempt: int, retry: int) -> int:
    """Seed of an attempt; that of the first person's first attempt is the seed of a person alone."""
    if (index, attempt, retry) == (0, 0, 0):
        return seed
    return int(stream(seed, "company", index, attempt, retry).integers(2**31))
