"""The outcome of every clause, judged by what the joints do: done, approximated or not done."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

from mmweaver.core.errors import InputError
from mmweaver.core.records import PoseSequence, Scene
from mmweaver.motion.language.plan import APPROXIMATED, DONE, NOT_DONE, ClauseRecord, Step
from mmweaver.motion.planning.asked import Deviation, quantities
from mmweaver.motion.verification.facts import Facts, Measurement

LOST = 0.75  # share of what is asked beyond which it is not done at all


class NotDoneError(InputError):
    """A sentence of which something is not done, if that is refused."""


@dataclass(frozen=True, kw_only=True)
class VerifiedStep:
    """One step with what was measured of it.

    Attributes:
        step: The step as the sentence asks for it.
        facts: What the joints show in its time.
        deviations: What they show otherwise than asked.
    """

    step: Step
    facts: Facts
    deviations: tuple[Deviation, ...]


def verified_steps(
    asked: Sequence[Step], shown: Sequence[Step], pose: PoseSequence, scene: Scene
) -> list[VerifiedStep]:
    """Measures every step and compares it with what is asked.

    Args:
        asked: Steps of the sentence, before the room has changed them.
        shown: The same steps with the times at which they are shown.
        pose: Joints over time.
        scene: The room.
    """
    measurement = Measurement(pose, scene.floor_z_m)
    found = []
    for step, now in zip(asked, shown, strict=True):
        facts = measurement.facts(now.start_s, now.end_s)
        deviations = (quantity.deviation(facts) for quantity in quantities(step, scene))
        found.append(VerifiedStep(step=step, facts=facts, deviations=tuple(one for one in deviations if one)))
    return found


def verified_clauses(clauses: Sequence[ClauseRecord], steps: Sequence[VerifiedStep]) -> tuple[ClauseRecord, ...]:
    """The records of all clauses with facts, lowered where the joints deviate.

    Args:
        clauses: Records of the parser: what of the words is shown at all.
        steps: The measured steps.
    """
    records = []
    for number, record in enumerate(clauses):
        own = [one for one in steps if number in one.step.clauses]
        for one in own:
            for deviation in one.deviations:
                status = NOT_DONE if deviation.lost > LOST and record.status == DONE else APPROXIMATED
                record = record.lowered_to(status, deviation.words)
        records.append(replace(record, facts=tuple(one.facts.meta() for one in own)))
    return tuple(records)


def outcome_line(clauses: Sequence[ClauseRecord]) -> str:
    """One line on all clauses: how many are done, and what the others show instead."""
    done = sum(one.status == DONE for one in clauses)
    others = [one.sentence for one in clauses if one.status != DONE]
    if not others:
        return f"motion: all {done} clauses done as measured" if done > 1 else "motion: done as measured"
    return f"motion: {done} of {len(clauses)} clauses done; " + "; ".join(others)


def check_done(text: str, clauses: Sequence[ClauseRecord]) -> None:
    """Checks that every clause of a sentence is done.

    Args:
        text: The sentence.
        clauses: Verified records of its clauses.

    Raises:
        NotDoneError: With what is shown instead.
    """
    others = [clause.sentence for clause in clauses if clause.status != DONE]
    if others:
        raise NotDoneError(
            f"not everything is done as {text!r} says: {'; '.join(others)}; word it otherwise, take another place or"
            " room, or leave out --strict"
        )
