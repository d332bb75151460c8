"""Matched draws: each place, heading, person and seed is used once for every label, so that none of them tells it.

A draw that one label cannot be carried out with is replaced for all labels. Who knows where and by whom a sequence is
done then knows nothing of what is done (decision 210). No two draws start at exactly the same point: a stance that
moves the hips by centimetres (boxing: 6 cm) would else tell the label at a place that was seen before.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np

from mmweaver.core.errors import InputError
from mmweaver.core.records import Scene
from mmweaver.core.seeding import stream
from mmweaver.geometry.body_capsules import REFERENCE_HEIGHT_M
from mmweaver.motion.planning.floor_map import FloorMap

MOST_ATTEMPTS = 60  # places and headings that are tried for a draw
AROUND_PLACE_M = 0.25  # either way: how far from a place its draws start
MOST_SUBJECTS = 10_000  # people that the motion library has


@dataclass(frozen=True, kw_only=True)
class Draw:
    """What all labels of a draw share."""

    index: int
    room: int
    place: int  # index into the places of the room
    start_m: tuple[float, float]
    heading_rad: float
    subject: int
    seed: int


@dataclass(frozen=True, kw_only=True)
class PlannedSequence:
    """One sequence of a set."""

    draw: Draw
    label: int
    sentence: int  # index into the sentences of the label
    text: str


def places_of(scene: Scene, range_window_m: tuple[float, float], number: int, seed: int) -> list[tuple[float, float]]:
    """At most `number` places where a person can stand in view, far from each other (farthest-point sampling).

    Raises InputError where there is none.
    """
    floor = FloorMap(scene, range_window_m, REFERENCE_HEIGHT_M)
    cells_m = floor.cell_centres_m[floor.walkable]
    if not len(cells_m):
        raise InputError("nobody can stand in this room within the radar's range; use another room or range window")
    rng = stream(seed, "activity set", "places")
    chosen = [int(rng.integers(len(cells_m)))]
    while len(chosen) < min(number, len(cells_m)):
        distance_m = np.linalg.norm(cells_m[:, None] - cells_m[chosen][None], axis=-1).min(axis=1)
        chosen.append(int(distance_m.argmax()))
    return [(round(float(x), 3), round(float(y), 3)) for x, y in cells_m[chosen]]


def matched_draws(
    places: list[list[tuple[float, float]]],
    number: int,
    subjects: int,
    seed: int,
    can_do: Callable[[Draw], str],
) -> Iterator[Draw]:
    """`number` draws over rooms and people in turn; `can_do` says why a draw does not serve all labels ("": it does).

    `places`: of every room. Raises InputError where no place of a room serves.
    """
    people = stream(seed, "activity set", "subjects").permutation(MOST_SUBJECTS)[:subjects]
    for index in range(number):
        room = index % len(places)
        rng = stream(seed, "activity set", "draw", index)
        why = ""
        for _ in range(MOST_ATTEMPTS):
            place = int(rng.integers(len(places[room])))
            x_m, y_m = np.array(places[room][place]) + rng.uniform(-AROUND_PLACE_M, AROUND_PLACE_M, 2)
            draw = Draw(
                index=index, room=room, place=place, start_m=(round(float(x_m), 3), round(float(y_m), 3)),
                heading_rad=round(float(rng.uniform(-np.pi, np.pi)), 4),
                subject=int(people[(index // len(places)) % len(people)]), seed=int(rng.integers(2**31)),
            )  # fmt: skip
            why = can_do(draw)
            if not why:
                yield draw
                break
        else:
            raise InputError(
                f"no place in room {room} serves all activities ({why}); use a room with more free floor, shorter"
                " activities, or other sentences"
            )


def shuffled(sequences: list[PlannedSequence], seed: int) -> list[PlannedSequence]:
    """In random order, so that a sequence's number says nothing of its label."""
    order = stream(seed, "activity set", "order").permutation(len(sequences))
    return [sequences[int(place)] for place in order]
