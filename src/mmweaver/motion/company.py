"""Several people in one room: composed one after the other, each clear of those who are already there.

Who has a given place goes first, the others follow in the order of their sentences; where one finds no place all
are drawn anew, and that one goes first.

Clear means at all times: pelvises at least 0.5 m apart, and no part of one body within 2 cm of the other.
"""

from collections.abc import Sequence
from dataclasses import replace

from mmweaver.core.errors import InputError
from mmweaver.core.records import Scene
from mmweaver.core.seeding import stream
from mmweaver.motion.apart import PELVISES_APART_M, are_apart
from mmweaver.motion.compose import Motion, compose

Place = tuple[float, float]
MOST_PEOPLE = 8
TRIES_EACH, TRIES_ALL = 6, 6


def compose_company(
    texts: Sequence[str],
    scene: Scene,
    *,
    duration_s: float,
    seed: int,
    range_window_m: tuple[float, float],
    starts_m: Sequence[Place | None] | None = None,
    height_m: float | None = None,
) -> tuple[Motion, ...]:
    """One motion for each sentence, in their order; the first is what it would be alone, wherever that leaves room.

    `starts_m`: where each starts, None = chosen. Each person has a body of their own: subjects 0, 1, 2 ..., a height
    drawn from the seed. Raises InputError as `compose` does, and where the people cannot be kept apart.
    """
    if len(texts) == 1 or height_m is not None:
        return (_alone(texts, scene, duration_s, seed, range_window_m, starts_m, height_m),)
    starts = [None] * len(texts) if starts_m is None else list(starts_m)
    order = sorted(range(len(texts)), key=lambda index: starts[index] is None)
    crowded = order[0]
    for attempt in range(TRIES_ALL):
        people: dict[int, Motion] = {}
        for index in order:
            try:
                people[index] = _join(
                    list(people.values()), texts[index], scene, duration_s, (seed, index, attempt), range_window_m,
                    starts[index],
                )  # fmt: skip
            except InputError:
                if attempt == 0:  # what is wrong even alone is said as such
                    compose(
                        texts[index], scene, duration_s=duration_s, seed=_seed_of(seed, index, 0, 0),
                        range_window_m=range_window_m, start_m=starts[index],
                    )  # fmt: skip
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


def _alone(
    texts: Sequence[str], scene: Scene, duration_s: float, seed: int, range_window_m: tuple[float, float],
    starts_m: Sequence[Place | None] | None, height_m: float | None,
) -> Motion:  # fmt: skip
    if len(texts) > 1:
        raise InputError("a body height is for one person; leave it out for several, who draw their own")
    start = starts_m[0] if starts_m else None
    return compose(
        texts[0], scene, duration_s=duration_s, seed=seed, range_window_m=range_window_m, start_m=start,
        height_m=height_m,
    )  # fmt: skip


def _join(
    people: list[Motion], text: str, scene: Scene, duration_s: float, draw: tuple[int, int, int],
    range_window_m: tuple[float, float], start_m: Place | None,
) -> Motion:  # fmt: skip
    """One more person, clear of the others."""
    seed, index, attempt = draw
    others = tuple(one.pose for one in people)
    for again in range(TRIES_EACH):
        motion = compose(
            text, scene, duration_s=duration_s, seed=_seed_of(seed, index, attempt, again),
            range_window_m=range_window_m, start_m=start_m, others=others,
        )  # fmt: skip
        motion = replace(motion, pose=replace(motion.pose, subject=index))
        if all(are_apart(motion.pose, other) for other in others):
            return motion
    raise InputError(f"{text!r} comes too near to somebody else; try another place")


def _seed_of(seed: int, index: int, attempt: int, again: int) -> int:
    """The first person's first draw is that of a person alone."""
    if (index, attempt, again) == (0, 0, 0):
        return seed
    return int(stream(seed, "company", index, attempt, again).integers(2**31))
