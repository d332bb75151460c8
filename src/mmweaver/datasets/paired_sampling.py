"""Paired sampling: each place, heading, person and seed is used once for every label, so that none predicts it.

A draw that one label cannot use is replaced for all labels. If no place in a room serves all labels, the labels that it
does not serve start elsewhere, with the same person and seed, and the leak report states it. No two draws start at
exactly the same point: a stance that shifts the hips by centimetres (boxing: 6 cm) would otherwise predict the label at
a known place.
"""

import math
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from jaxtyping import Float

from mmweaver.core.body_capsules import REFERENCE_HEIGHT_M
from mmweaver.core.errors import InputError
from mmweaver.core.records import Scene
from mmweaver.core.seeding import stream
from mmweaver.core.shapes import Array
from mmweaver.datasets.confounders import circumstances, leak_report
from mmweaver.io.npz_files import read_poses_npz
from mmweaver.motion.language.described_person import DescribedPerson
from mmweaver.motion.planning.floor_map import FloorMap
from mmweaver.weaver.composition import compose_request, lost_of
from mmweaver.weaver.parsed_request import ParsedRequest

MAX_ATTEMPTS = 60  # places and headings tried for a draw of all labels
MAX_SERVING = 8  # draws that serve all labels, of which the one that loses least of the sentences is taken
MAX_OWN_ATTEMPTS = 300  # further ones for a label that the best draw does not serve
SAME_PLACE_ATTEMPTS = 20  # the first of these keep the place of the other labels
AROUND_PLACE_M = 0.25  # maximum distance of starts from the centre of a place, per axis
NUM_SUBJECTS = 10_000  # people in the motion library
PLACES, SUBJECTS = 12, 10  # for sequences in one room
TRIES = 3  # seeds with which a sentence is tried at any place


@dataclass(frozen=True, kw_only=True)
class StartPlace:
    """A place in a room: free floor around its centre, where draws start."""

    centre_m: tuple[float, float]
    free_m: Float[Array, "cell 2"]  # centres (x, y) of free floor cells
    cell_m: float  # edge length of a cell

    def sampled_m(self, rng: np.random.Generator) -> tuple[float, float]:
        """Samples a position on the free floor uniformly.

        Args:
            rng: Random generator.

        Returns:
            (x, y) in metres, rounded to millimetres.
        """
        within_cell_m = rng.uniform(-0.49, 0.49, 2) * self.cell_m
        x_m, y_m = self.free_m[int(rng.integers(len(self.free_m)))] + within_cell_m
        return round(float(x_m), 3), round(float(y_m), 3)


@dataclass(frozen=True, kw_only=True)
class Draw:
    """Place, heading, person and seed of a sequence, shared by all labels of a draw if the room permits."""

    index: int
    room: int
    place: int  # index into the places of the room
    start_m: tuple[float, float]
    heading_rad: float
    subject: int
    seed: int
    is_shared: bool = True  # False: start and heading are used by one label only


@dataclass(frozen=True, kw_only=True)
class PlannedSequence:
    """One sequence of a set."""

    draw: Draw
    label: int
    sentence: int  # index into the sentences of the label
    text: str


def places_of(scene: Scene, range_window_m: tuple[float, float], number: int, seed: int) -> list[StartPlace]:
    """Selects places where a person can stand in view, far from each other (farthest-point sampling).

    Args:
        scene: The room.
        range_window_m: Range window (near, far) of the radar in metres.
        number: Maximum number of places.
        seed: Seed of the first place.

    Returns:
        At most `number` places.

    Raises:
        InputError: If there is none.
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


def paired_draws(
    places: list[list[StartPlace]],
    number: int,
    subjects: int,
    seed: int,
    labels: int,
    obstacle: Callable[[Draw, int], str],
    lost: Callable[[Draw, int], float] = lambda draw, label: 0.0,
) -> Iterator[list[Draw]]:
    """Samples draws over rooms and people in turn; one draw serves all labels if any does.

    Args:
        places: Places of every room.
        number: Number of draws.
        subjects: Number of people.
        seed: Seed of the draws.
        labels: Number of labels.
        obstacle: Why a draw does not serve a label; "" if it does.
        lost: What a draw that serves a label loses of its sentence; of some draws, the one that loses least is taken.

    Yields:
        The draw of each label.

    Raises:
        InputError: If no draw serves a label.
    """
    people = stream(seed, "activity set", "subjects").permutation(NUM_SUBJECTS)[:subjects]
    failures: Counter[int] = Counter()  # labels that failed most often are tried first, to reject a draw early
    for index in range(number):
        room = index % len(places)
        rng = stream(seed, "activity set", "draw", index)
        subject = int(people[(index // len(places)) % len(people)])
        best, unserved, least, served = None, dict.fromkeys(range(labels), ""), math.inf, 0
        for _ in range(MAX_ATTEMPTS):
            placing = _placing(places[room], int(rng.integers(len(places[room]))), rng)
            draw = Draw(index=index, room=room, subject=subject, **placing, seed=int(rng.integers(2**31)))
            failed: dict[int, str] = {}
            for label in sorted(range(labels), key=lambda one: -failures[one]):
                if why := obstacle(draw, label):
                    failures[label] += 1
                    failed[label] = why
                if best is not None and len(failed) >= max(len(unserved), 1):
                    break
            else:
                best, unserved = draw, failed
            if failed:
                continue
            served, all_lost = served + 1, sum(lost(draw, label) for label in range(labels))
            if all_lost < least:
                best, unserved, least = draw, {}, all_lost
            if least == 0 or served == MAX_SERVING:
                break
        assert best is not None
        yield [_own(best, label, places[room], rng, obstacle) if label in unserved else best for label in range(labels)]


def _placing(places: list[StartPlace], place: int, rng: np.random.Generator) -> dict[str, Any]:
    """Samples start and heading at a place."""
    start_m = places[place].sampled_m(rng)
    return {"place": place, "start_m": start_m, "heading_rad": round(rng.uniform(-np.pi, np.pi), 4)}


def _own(
    shared: Draw, label: int, places: list[StartPlace], rng: np.random.Generator, obstacle: Callable[[Draw, int], str]
) -> Draw:
    """Draw of a label that `shared` does not serve, nearby if possible. Raises InputError if there is none."""
    why = ""
    for attempt in range(MAX_OWN_ATTEMPTS):
        place = shared.place if attempt < SAME_PLACE_ATTEMPTS else int(rng.integers(len(places)))
        draw = replace(shared, is_shared=False, **_placing(places, place, rng))
        why = obstacle(draw, label)
        if not why:
            return draw
    raise InputError(
        f"no place in room {shared.room} serves {why} ({MAX_OWN_ATTEMPTS} places and headings were tried); leave that"
        " sentence out or word it otherwise, make sequences shorter, or use a room with more free floor"
    )


class Trials:
    """Sentences tried with draws: why one cannot be performed, and what a performed one loses of its sentence."""

    def __init__(self) -> None:
        self._lost: dict[tuple[Draw, int], float] = {}

    def obstacle(self, draw: Draw, label: int, request: ParsedRequest, scene: Scene, sentence: str) -> str:
        """Why a sentence cannot be performed with its draw in a scene.

        Args:
            draw: The draw.
            label: Number of the label.
            request: Request with the placement of the draw.
            scene: The room.
            sentence: The sentence.

        Returns:
            The reason without the error's advice, which concerns a single start; "" if there is no obstacle.
        """
        try:
            self._lost[draw, label] = lost_of(compose_request(request, scene))
        except InputError as error:
            return f"{sentence!r}: {str(error).partition('; ')[0]}"
        return ""

    def lost(self, draw: Draw, label: int) -> float:
        """What a draw without obstacle loses of a label's sentence, as measured on the joints."""
        return self._lost.get((draw, label), 0.0)


def unpaired_reasons(draws: Sequence[Draw], label: Sequence[int], label_names: Sequence[str]) -> dict[str, str]:
    """Why start place and heading differ between labels.

    Args:
        draws: Draw of each sequence.
        label: Label number of each sequence.
        label_names: Names of the labels by number.

    Returns:
        Reason by circumstance; empty if all draws are shared.
    """
    own = Counter(label_names[one] for draw, one in zip(draws, label, strict=True) if not draw.is_shared)
    if not own:
        return {}
    times = ", ".join(f"{name!r} starts elsewhere {count} times" for name, count in own.most_common())
    reason = f"no place and heading of the room served every activity in all draws: {times}"
    return {"start_place": reason, "heading": reason}


def shuffled(sequences: list[PlannedSequence], seed: int) -> list[PlannedSequence]:
    """Random order, so that the index of a sequence carries no information on its label."""
    order = stream(seed, "activity set", "order").permutation(len(sequences))
    return [sequences[int(place)] for place in order]


# sentences in one room ----------------------------------------------------------------------------------------------
@dataclass(frozen=True, kw_only=True)
class GivenPlacing:
    """Placement that the user fixed for all sequences; None is sampled."""

    start_m: tuple[float, float] | None = None
    heading_deg: float | None = None  # 0 towards the radar, 90 to the right of the picture
    height_m: float | None = None
    subject: int | None = None

    def applied(self, draw: Draw, seed: int | None = None) -> Draw:
        """Overrides a draw by the fixed placement.

        Args:
            draw: The draw.
            seed: First seed, to which the index of the draw is added. Default: the draw's own seed.

        Returns:
            The draw, with its heading rounded to 0.1 degrees.
        """
        degrees = round(math.degrees(draw.heading_rad) + 90, 1) if self.heading_deg is None else self.heading_deg
        subject = draw.subject if self.subject is None else self.subject
        return replace(
            draw,
            start_m=self.start_m or draw.start_m,
            heading_rad=heading_rad(degrees),
            subject=subject,
            seed=draw.seed if seed is None else seed + draw.index,
        )


def heading_rad(degrees: float) -> float:
    """Converts a heading of the command line to a direction.

    Args:
        degrees: 0 towards the radar, 90 to the right of the picture.

    Returns:
        Direction in radians, from +x towards +y.

    >>> heading_rad(90.0)
    0.0
    """
    return math.radians(degrees) - math.pi / 2


def heading_deg(draw: Draw) -> float:
    """Heading of a draw in degrees, as on the command line.

    >>> ahead = heading_rad(33.3)
    >>> heading_deg(Draw(index=0, room=0, place=0, start_m=(0.0, 2.0), heading_rad=ahead, subject=0, seed=0))
    33.3
    """
    return round(math.degrees(draw.heading_rad) + 90, 1)


def placed(request: ParsedRequest, draw: Draw, height_m: float | None = None) -> ParsedRequest:
    """Applies a draw to the request of one person.

    Args:
        request: The request.
        draw: Place, heading, person and seed.
        height_m: Body height in metres. Default: the person's.

    Returns:
        The request.
    """
    person = replace(request.people[0], start_m=draw.start_m, subject=draw.subject, height_m=height_m)
    return replace(request, people=(person,), heading_rad=draw.heading_rad, seed=draw.seed)


def sentence_draws(
    requests: dict[str, ParsedRequest], scene: Scene, number: int, seed: int, given: GivenPlacing
) -> tuple[list[dict[str, Draw]], dict[str, str]]:
    """Samples draws for sentences in one room.

    Args:
        requests: Request of each sentence.
        scene: The room.
        number: Number of draws.
        seed: Seed of the draws.
        given: Fixed placement.

    Returns:
        For each draw, the placement of each sentence; and the reason for each sentence that fits nowhere.

    Raises:
        InputError: If no draw serves one of the other sentences.
    """
    refused = unplaceable(requests, scene, seed)
    texts = [text for text in requests if text not in refused]
    if not texts:
        return [], refused
    possible = [requests[text] for text in texts]

    trials = Trials()

    def obstacle(draw: Draw, label: int) -> str:
        request = placed(possible[label], given.applied(draw, seed), given.height_m)
        return trials.obstacle(draw, label, request, scene, texts[label])

    places = [places_of(scene, possible[0].range_window_m, PLACES, seed)]
    draws = paired_draws(places, number, SUBJECTS, seed, len(possible), obstacle, trials.lost)
    return [
        {text: given.applied(draw, seed) for text, draw in zip(texts, each, strict=True)} for each in draws
    ], refused


def unplaceable(requests: dict[str, ParsedRequest], scene: Scene, seed: int) -> dict[str, str]:
    """Finds sentences that fit nowhere in a room.

    Args:
        requests: Request of each sentence.
        scene: The room.
        seed: First seed of the attempts.

    Returns:
        Reason by sentence.
    """
    refused: dict[str, str] = {}
    for text, request in requests.items():
        for number in range(TRIES):
            try:
                compose_request(replace(request, seed=seed + number), scene)
            except InputError as error:
                refused[text] = str(error)
            else:
                refused.pop(text, None)
                break
    return refused


def sentence_order(texts: Sequence[str], draw: int, seed: int) -> list[str]:
    """Random order of the sentences of a draw, so that a sequence's index carries no information on its sentence."""
    return [texts[int(place)] for place in stream(seed, "sentence draws", "order", draw).permutation(len(texts))]


def folder_leaks(
    folders: Sequence[Path], texts: Sequence[str], draws: Sequence[Draw], requests: Sequence[ParsedRequest]
) -> dict[str, Any]:
    """Leak report of result folders: what predicts their sentences without the radar signal.

    Args:
        folders: The results.
        texts: Sentence of each result.
        draws: Draw of each result.
        requests: Request of each sentence.

    Returns:
        The report, see `confounders.leak_report`.
    """
    poses = [read_poses_npz(folder / "pose.npz")[0] for folder in folders]
    names = list(dict.fromkeys(texts))
    label = np.asarray([names.index(text) for text in texts])
    more = {
        "person": [draw.subject for draw in draws],
        "height": [pose.height_m for pose in poses],
        "file_size": [(folder / "radar.npz").stat().st_size for folder in folders],
    }
    found = circumstances([pose.joints_m for pose in poses], label, **more)
    index = np.asarray([draw.index for draw in draws])
    reasons = unpaired_reasons(draws, label.tolist(), names)
    if words := differing_descriptions(requests):
        described = ", ".join(repr(one) for one in words)
        reasons["height"] = f"the sentences describe different people ({described}); word all 'a person' to have none"
    return leak_report(found, label, index, names, reasons)


# sentences that describe different people ("she", "an old man") ------------------------------------------------------
def differing_descriptions(requests: Iterable[ParsedRequest]) -> list[str]:
    """Finds descriptions of people that differ between sentences.

    Args:
        requests: Parsed sentences.

    Returns:
        Words that describe a person; empty if all sentences describe the same kind of person.
    """
    people = [_described(request) for request in requests]
    if len({replace(one, words="") for one in people}) < 2:
        return []
    return list(dict.fromkeys(one.words for one in people if one.is_described))


def done_by_anybody(request: ParsedRequest) -> ParsedRequest:
    """Removes the description of the person from a request, so that only the subject determines it.

    Args:
        request: The request.

    Returns:
        A copy without description.
    """
    first, *others = request.people
    if first.plan is None:
        return request
    plan = replace(first.plan, person=DescribedPerson())
    return replace(request, people=(replace(first, plan=plan), *others))


def _described(request: ParsedRequest) -> DescribedPerson:
    plan = request.people[0].plan
    return DescribedPerson() if plan is None else plan.person
