"""What steps show, wholly, in words: limb and side, way, posture, speed, count, seconds, place, what is done at once.

They follow what `motion/animation/library` and `motion/planning` make of each field, not what a sentence said of it.
"""

from collections.abc import Iterable, Sequence
from dataclasses import replace
from itertools import groupby

from mmweaver.motion.language.named_body import of_the_body
from mmweaver.motion.language.named_counts import times_said
from mmweaver.motion.language.named_hands import of_a_hand
from mmweaver.motion.language.plan import NOT_DONE, ClauseRecord, Step

_SIDES = ("left", "right")


def with_what_is_shown(records: Sequence[ClauseRecord], steps: Sequence[Step]) -> tuple[ClauseRecord, ...]:
    """The records with what each clause is shown as: 'then waving' where that begins after another step.

    Records that said so of other steps, before these were cut or placed, say it of these.
    """
    shown, seen = [], {0}  # what begins with the first step follows nothing
    for places in _places_of_each(len(records), steps):
        shown.append("then " * bool(places and places[0] not in seen) + _at(places, steps))
        seen |= {*places}
    for number, record in enumerate(records):  # "turns left while walking": the step is that of the other clause
        if record.status != NOT_DONE and not shown[number]:
            shown[number] = next(filter(None, (*shown[number + 1 :], *shown[:number][::-1])), "")
    return tuple(_shown_as(record, words) for record, words in zip(records, shown, strict=True))


def _shown_as(record: ClauseRecord, shown: str) -> ClauseRecord:
    before, now = (f"is shown as {words.removeprefix('then ')}" for words in (record.shown, shown))
    how = record.how.replace(before, now) if record.shown and shown else record.how
    return replace(record, shown=shown, how=how)


def steps_of_each(clauses: int, steps: Sequence[Step]) -> list[list[Step]]:
    """The steps of each of so many clauses; one that no clause names counts with the next one that a clause does.

    A step of several clauses counts with those that have no other of its kind: "walks forward, then backward".
    """
    return [[steps[place] for place in places] for places in _places_of_each(clauses, steps)]


def _places_of_each(clauses: int, steps: Sequence[Step]) -> list[list[int]]:
    named = [[*dict.fromkeys(number for part in step.each for number in part.clauses)] for step in steps]
    does = [(step.lower, step.upper) for step in steps]
    alone = {(own[0], doing) for own, doing in zip(named, does, strict=True) if len(own) == 1}
    of_each: list[list[int]] = [[] for _ in range(clauses)]
    waiting: list[int] = []
    for place, own in enumerate(named):
        if len(own) > 1:
            own = [number for number in own if (number, does[place]) not in alone] or own[-1:]
        if len(own) == 1:
            alone.add((own[0], does[place]))
        waiting.append(place)
        for k, number in enumerate(own):
            of_each[number] += waiting if k == 0 else [place]
        waiting = [] if own else waiting
    return of_each


def _at(places: Sequence[int], steps: Sequence[Step]) -> str:
    """The steps at these places in their order; others come between them where it says "later"."""
    runs: list[list[Step]] = []
    for k, place in enumerate(places):
        if k and place == places[k - 1] + 1:
            runs[-1].append(steps[place])
        else:
            runs.append([steps[place]])
    return ", later ".join(map(in_turn, runs))


def in_turn(steps: Iterable[Step]) -> str:
    """Steps in the order in which they are shown: 'walking backwards, then standing'."""
    names = [doing(step) for step in steps]
    for length in range(1, len(names) // 2 + 1):
        times, rest = divmod(len(names), length)
        if not rest and names == names[:length] * times:
            often = f"all of this {times_said(times)}" if length > 1 else f"{times_said(times)} in a row"
            return f"{', then '.join(names[:length])}, {often}"
    return ", then ".join(name if len([*same]) == 1 else f"{name}, and again" for name, same in groupby(names))


def doing(step: Step) -> str:
    """All that a step shows: 'walking three steps backwards', 'sitting on the sofa while waving with one hand'."""
    body = "" if step.lower == "stand" and step.upper else of_the_body(step)
    parts = [body, *(of_a_hand(step, part) for part in step.each if part.upper)]
    facing = {"towards": "the radar", "away": "away from the radar"}.get(step.facing) or (
        f"{step.facing} in the photo" if step.facing in _SIDES else f"the {step.facing}"
    )
    only_looks = step.upper in ("look_around", "point") and step.facing in _SIDES
    faces = step.facing and not (step.facing == "down" or step.lower == "turn" or only_looks)
    return (
        " while ".join(filter(None, parts))
        + (f", facing {facing}" if faces else "")
        + ("" if step.place is None else f", {step.place.words}")
        + (f" for {step.seconds:g} s" if step.seconds else "")
    )
