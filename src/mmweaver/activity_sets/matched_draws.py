"""Matched draws: each place, heading, person and seed is used once for every label, so that none of them tells it.

A draw that one label cannot be carried out with is replaced for all labels. Who knows where and by whom a sequence is
done then knows nothing of what is done. Where a room has no place that serves all labels, those that it
does not serve start elsewhere, with the same person and seed, and the leak report says so. No two draws start at
exactly the same point: a stance that moves the hips by centimetres (boxing: 6 cm) would else tell the label at a place
that was seen before.
"""

from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from jaxtyping import Float

from mmweaver.core.errors import InputError
from mmweaver.core.records import Scene
from mmweaver.core.seeding import stream
from mmweaver.core.shapes import Array
from mmweaver.geometry.body_capsules import REFERENCE_HEIGHT_M
from mmweaver.motion.planning.floor_map import FloorMap

MOST_ATTEMPTS = 60  # places and headings that are tried for a draw of all labels
MOST_OWN_ATTEMPTS = 300  # and for a label that the best of these does not serve
SAME_PLACE_ATTEMPTS = 20  # of which are at the place of the others
AROUND_PLACE_M = 0.25  # either way: how far from a place its draws start
MOST_SUBJECTS = 10_000  # people that the motion library has


@dataclass(frozen=True, kw_only=True)
class StartPlace:
    """A place of a room: the free floor around its centre, where its draws start."""

    centre_m: tuple[float, float]
    free_m: Float[Array, "cell 2"]  # centres (x, y) of the floor's free cells
    cell_m: float  # side of a cell

    def sampled_m(self, rng: np.random.Generator) -> tuple[float, float]:
        """A position (x, y) on the free floor, uniformly distributed, in millimetres of resolution."""
        within_cell_m = rng.uniform(-0.49, 0.49, 2) * self.cell_m
        x_m, y_m = self.free_m[int(rng.integers(len(self.free_m)))] + within_cell_m
        return round(float(x_m), 3), round(float(y_m), 3)


@dataclass(frozen=True, kw_only=True)
class Draw:
    """Where, how and by whom a sequence is done; all labels of a draw share it where the room allows."""

    index: int
    room: int
    place: int  # index into the places of the room
    start_m: tuple[float, float]
    heading_rad: float
    subject: int
    seed: int
    is_shared: bool = True  # False: a start and heading of one label alone


@dataclass(frozen=True, kw_only=True)
class PlannedSequence:
    """One sequence of a set."""

    draw: Draw
    label: int
    sentence: int  # index into the sentences of the label
    text: str


def places_of(scene: Scene, range_window_m: tuple[float, float], number: int, seed: int) -> list[StartPlace]:
    """At most `number` places where a person can stand in view, far from each other (farthest-point sampling).

    Raises InputError where there is none.
    """
    floor = FloorMap(scene, range_window_m, REFERENCE_HEIGHT_M)
    cells_m = floor.walkable_m
    if not len(cells_m):
        raise InputError("nobody can stand in this room within the radar's range; use another room or range window")
    rng = stream(seed, "activity set", "places")
    chosen = [int(rng.integers(len(cells_m)))]
    while len(chosen) < min(number, len(cells_m)):
        distance_m = np.linalg.norm(cells_m[:, None] - cells_m[chosen][None], axis=-1).min(axis=1)
        chosen.append(int(distance_m.argmax()))
    places = []
    for x_m, y_m in cells_m[chosen]:
        near = (np.abs(cells_m - (x_m, y_m)) <= AROUND_PLACE_M).all(axis=1)
        places.append(StartPlace(centre_m=(float(x_m), float(y_m)), free_m=cells_m[near], cell_m=floor.cell_m))
    return places


def matched_draws(
    places: list[list[StartPlace]],
    number: int,
    subjects: int,
    seed: int,
    labels: int,
    obstacle: Callable[[Draw, int], str],
) -> Iterator[list[Draw]]:
    """`number` times the draw of each label, over rooms and people in turn; one draw serves all labels if any does.

    `places`: of every room. `obstacle` says why a draw does not serve a label ("": it does). Raises InputError where
    nothing serves a label.
    """  # fmt: skip
    people = stream(seed, "activity set", "subjects").permutation(MOST_SUBJECTS)[:subjects]
    failures: Counter[int] = Counter()  # labels that failed most often are tried first: others are then not tried
    for index in range(number):
        room = index % len(places)
        rng = stream(seed, "activity set", "draw", index)
        subject = int(people[(index // len(places)) % len(people)])
        best, unserved = None, dict.fromkeys(range(labels), "")
        for _ in range(MOST_ATTEMPTS):
            draw = _drawn(places[room], rng, index=index, room=room, subject=subject)
            failed: dict[int, str] = {}
            for label in sorted(range(labels), key=lambda one: -failures[one]):
                if why := obstacle(draw, label):
                    failures[label] += 1
                    failed[label] = why
                if best is not None and len(failed) >= len(unserved):
                    break
            else:
                best, unserved = draw, failed
            if not unserved:
                break
        assert best is not None
        yield [_own(best, label, places[room], rng, obstacle) if label in unserved else best for label in range(labels)]


def _drawn(places: list[StartPlace], rng: np.random.Generator, *, index: int, room: int, subject: int) -> Draw:
    placing = _placing(places, int(rng.integers(len(places))), rng)
    return Draw(index=index, room=room, subject=subject, **placing, seed=int(rng.integers(2**31)))


def _placing(places: list[StartPlace], place: int, rng: np.random.Generator) -> dict[str, Any]:
    """A start and a heading at a place."""
    start_m = places[place].sampled_m(rng)
    return {"place": place, "start_m": start_m, "heading_rad": round(float(rng.uniform(-np.pi, np.pi)), 4)}


def _own(
    shared: Draw, label: int, places: list[StartPlace], rng: np.random.Generator, obstacle: Callable[[Draw, int], str]
) -> Draw:
    """The draw of a label that `shared` does not serve, near it if possible. Raises InputError where none serves."""
    why = ""
    for attempt in range(MOST_OWN_ATTEMPTS):
        place = shared.place if attempt < SAME_PLACE_ATTEMPTS else int(rng.integers(len(places)))
        draw = replace(shared, is_shared=False, **_placing(places, place, rng))
        why = obstacle(draw, label)
        if not why:
            return draw
    raise InputError(
        f"no place in room {shared.room} serves {why} ({MOST_OWN_ATTEMPTS} places and headings were tried); leave that"
        " sentence out or word it otherwise, make sequences shorter, or use a room with more free floor"
    )


def obstacle_of(sentence: str, error: InputError) -> str:
    """Why a draw does not serve a sentence, without the advice: that is on a single start, not on a set.

    >>> obstacle_of("she falls", InputError("the start is not free; the nearest free place is 0,2"))
    "'she falls': the start is not free"
    """
    return f"{sentence!r}: {str(error).partition('; ')[0]}"


def why_placed_apart(draws: Sequence[Draw], label: Sequence[int], label_names: Sequence[str]) -> dict[str, str]:
    """Why start place and heading are not those of the other labels, by circumstance; empty where all are shared."""
    own = Counter(label_names[one] for draw, one in zip(draws, label, strict=True) if not draw.is_shared)
    if not own:
        return {}
    times = ", ".join(f"{name!r} starts elsewhere {count} times" for name, count in own.most_common())
    reason = f"no place and heading of the room served every activity in all draws: {times}"
    return {"start_place": reason, "heading": reason}


def shuffled(sequences: list[PlannedSequence], seed: int) -> list[PlannedSequence]:
    """In random order, so that a sequence's number says nothing of its label."""
    order = stream(seed, "activity set", "order").permutation(len(sequences))
    return [sequences[int(place)] for place in order]
