"""Several people in one room: composed one after the other, each clear of those who are already there.

Who has a given place goes first, the others follow in the order of their sentences; where one finds no place all
are drawn anew, and that one goes first.

Clear means at all times: pelvises at least 0.5 m apart, and no part of one body within 2 cm of the other.
"""

from collections.abc import Callable, Sequence
from dataclasses import replace

from mmweaver.core.errors import InputError
from mmweaver.core.records import PoseSequence, Scene
from mmweaver.core.seeding import stream
from mmweaver.motion.compose import Motion, compose
from mmweaver.motion.planning.separation import PELVISES_APART_M, are_apart

Place = tuple[float, float]
MOST_PEOPLE = 8
TRIES_EACH, TRIES_ALL = 6, 6


def compose_people(
    texts: Sequence[str],
    scene: Scene,
    *,
    duration_s: float,
    seed: int,
    range_window_m: tuple[float, float],
    starts_m: Sequence[Place | None] | None = None,
    heights_m: Sequence[float | None] | None = None,
    first: Motion | None = None,
) -> tuple[Motion, ...]:
    """One motion for each sentence, in their order; the first is what it would be alone, wherever that leaves room.

    `starts_m`: where each starts, `heights_m`: how tall each is, None = chosen. Each person has a body of their own:
    subjects 0, 1, 2 ... `first` is the first person's motion where it is there already (a recorded one); it stays as
    it is. Raises InputError as `compose` does, and where the people cannot be kept apart.
    """
    starts = [None] * len(texts) if starts_m is None else list(starts_m)
    heights = [None] * len(texts) if heights_m is None else list(heights_m)

    def alone(index: int, draw: int, others: tuple[PoseSequence, ...]) -> Motion:
        return compose(
            texts[index], scene, duration_s=duration_s, seed=draw, range_window_m=range_window_m,
            start_m=starts[index], height_m=heights[index], others=others,
        )  # fmt: skip

    if len(texts) == 1:
        return (alone(0, seed, ()) if first is None else first,)
    there = {} if first is None else {0: first}
    order = sorted(set(range(len(texts))) - set(there), key=lambda index: starts[index] is None)
    crowded = order[0]
    for attempt in range(TRIES_ALL):
        people = dict(there)
        for index in order:
            try:
                people[index] = _join(list(people.values()), alone, texts[index], (seed, index, attempt))
            except InputError:
                if attempt == 0:  # what is wrong even alone is said as such
                    alone(index, _seed_of(seed, index, 0, 0), ())
                crowded = index
                order.sort(key=lambda one: (starts[one] is None, one != crowded))  # it goes first the next time
                break
        if len(people) == len(texts):
            return tuple(people[index] for index in range(len(texts)))
    raise InputError(
        f"there is no room for {len(texts)} people who keep {PELVISES_APART_M:g} m apart: person {crowded + 1},"
        f" {texts[crowded]!r}, finds no place beside the others; try fewer people, fewer frames or other places"
        " (--at for each)"
    )


def _join(
    people: list[Motion], alone: Callable[[int, int, tuple[PoseSequence, ...]], Motion], text: str,
    draw: tuple[int, int, int],
) -> Motion:  # fmt: skip
    """One more person, clear of the others."""
    seed, index, attempt = draw
    others = tuple(one.pose for one in people)
    for again in range(TRIES_EACH):
        motion = alone(index, _seed_of(seed, index, attempt, again), others)
        motion = replace(motion, pose=replace(motion.pose, subject=index))
        if all(are_apart(motion.pose, other) for other in others):
            return motion
    raise InputError(f"{text!r} comes too near to somebody else; try another place")


def _seed_of(seed: int, index: int, attempt: int, again: int) -> int:
    """The first person's first draw is that of a person alone."""
    if (index, attempt, again) == (0, 0, 0):
        return seed
    return int(stream(seed, "company", index, attempt, again).integers(2**31))
