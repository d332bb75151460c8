"""Matched draws of a list of sentences in one room: each place, heading, person and seed serves every sentence once."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from mmweaver.activity_sets.described_people import differing_descriptions
from mmweaver.activity_sets.leak_report import circumstances, leak_report
from mmweaver.activity_sets.matched_draws import Draw, matched_draws, obstacle_of, places_of, why_placed_apart
from mmweaver.core.errors import InputError
from mmweaver.core.records import Scene
from mmweaver.core.seeding import stream
from mmweaver.formats.npz_files import read_poses_npz
from mmweaver.weaver.front_door import compose_request
from mmweaver.weaver.parsed_request import ParsedRequest

PLACES, SUBJECTS = 12, 10
TRIES = 3  # seeds with which a sentence is tried wherever the planner likes


@dataclass(frozen=True, kw_only=True)
class GivenPlacing:
    """What every sequence shares because the user says so; None is drawn."""

    start_m: tuple[float, float] | None = None
    heading_deg: float | None = None  # 0 towards the radar, 90 to the picture's right
    height_m: float | None = None
    subject: int | None = None

    def applied(self, draw: Draw, seed: int | None = None) -> Draw:
        """The draw with what is given; its heading is a multiple of 0.1 degrees, its seed its own or from `seed` on."""
        degrees = round(math.degrees(draw.heading_rad) + 90, 1) if self.heading_deg is None else self.heading_deg
        subject = draw.subject if self.subject is None else self.subject
        return replace(
            draw, start_m=self.start_m or draw.start_m, heading_rad=heading_rad(degrees), subject=subject,
            seed=draw.seed if seed is None else seed + draw.index,
        )  # fmt: skip


def heading_rad(degrees: float) -> float:
    """The direction, from +x towards +y, of a heading on the command line.

    >>> heading_rad(90.0)
    0.0
    """
    return math.radians(degrees) - math.pi / 2


def heading_deg_of(radians: float) -> float:
    """The inverse of `heading_rad`."""
    return round(math.degrees(radians) + 90, 10)


def heading_deg(draw: Draw) -> float:
    """The heading of a draw as the command line takes it.

    >>> ahead = heading_rad(33.3)
    >>> heading_deg(Draw(index=0, room=0, place=0, start_m=(0.0, 2.0), heading_rad=ahead, subject=0, seed=0))
    33.3
    """
    return round(math.degrees(draw.heading_rad) + 90, 1)


def placed(request: ParsedRequest, draw: Draw, height_m: float | None = None) -> ParsedRequest:
    """The request of one person with the place, heading, person and seed of a draw."""
    person = replace(request.people[0], start_m=draw.start_m, subject=draw.subject, height_m=height_m)
    return replace(request, people=(person,), heading_rad=draw.heading_rad, seed=draw.seed)


def sentence_draws(
    requests: dict[str, ParsedRequest], scene: Scene, number: int, seed: int, given: GivenPlacing
) -> tuple[list[dict[str, Draw]], dict[str, str]]:
    """`number` times the draw of each sentence, and why each sentence that the room has no place for is left out.

    Raises InputError where nothing serves one of the rest.
    """
    refused = without_place(requests, scene, seed)
    texts = [text for text in requests if text not in refused]
    if not texts:
        return [], refused
    possible = [requests[text] for text in texts]

    def obstacle(draw: Draw, label: int) -> str:
        try:
            compose_request(placed(possible[label], given.applied(draw, seed), given.height_m), scene)
        except InputError as error:
            return obstacle_of(texts[label], error)
        return ""

    places = [places_of(scene, possible[0].range_window_m, PLACES, seed)]
    draws = matched_draws(places, number, SUBJECTS, seed, len(possible), obstacle)
    return [
        {text: given.applied(draw, seed) for text, draw in zip(texts, each, strict=True)} for each in draws
    ], refused


def without_place(requests: dict[str, ParsedRequest], scene: Scene, seed: int) -> dict[str, str]:
    """Why each sentence that the room has no place for wherever the planner tries cannot be made, by sentence."""
    return {text: why for text, request in requests.items() if (why := _impossible(request, scene, seed))}


def _impossible(request: ParsedRequest, scene: Scene, seed: int) -> str:
    """Why a sentence has no place wherever the planner tries; "" where it has one."""
    why = ""
    for number in range(TRIES):
        try:
            compose_request(replace(request, seed=seed + number), scene)
            return ""
        except InputError as error:
            why = str(error)
    return why


def order_of(texts: Sequence[str], draw: int, seed: int) -> list[str]:
    """The sentences of a draw in random order, so that a sequence's number says nothing of its sentence."""
    return [texts[int(place)] for place in stream(seed, "sentence draws", "order", draw).permutation(len(texts))]


def folder_leaks(
    folders: Sequence[Path], texts: Sequence[str], draws: Sequence[Draw], requests: Sequence[ParsedRequest]
) -> dict[str, Any]:
    """The leak report of result folders: what predicts their sentences without a look at the radar signal."""
    poses = [read_poses_npz(folder / "pose.npz")[0] for folder in folders]
    names = list(dict.fromkeys(texts))
    label = np.asarray([names.index(text) for text in texts])
    more = {
        "person": [draw.subject for draw in draws], "height": [pose.height_m for pose in poses],
        "file_size": [(folder / "radar.npz").stat().st_size for folder in folders],
    }  # fmt: skip
    found = circumstances([pose.joints_m for pose in poses], label, **more)
    index = np.asarray([draw.index for draw in draws])
    reasons = why_placed_apart(draws, label.tolist(), names)
    if words := differing_descriptions(requests):
        described = ", ".join(repr(one) for one in words)
        reasons["height"] = f"the sentences describe different people ({described}); word all 'a person' to have none"
    return leak_report(found, label, index, names, reasons)
