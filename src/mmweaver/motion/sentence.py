"""A sentence -> MotionPlan: every clause becomes a step or an overlay, or the error says which clause could not."""

from dataclasses import replace

from mmweaver.core.errors import InputError
from mmweaver.motion.clause_reading import Reading, read_clause
from mmweaver.motion.clauses import clauses_of
from mmweaver.motion.plan import MotionPlan, Step
from mmweaver.motion.words import words_of

LONGEST_TEXT = 1000
MOST_STEPS = 24
SEATED = ("sit", "sit_down")
LOWERING = {"lower", "lowers", "lowering", "lowered", "drops", "drop"}


def parse(text: str) -> MotionPlan:
    """Reads what a person does, in the order of time, without times yet.

    Left and right of a direction are the viewer's (as in the photo), of a hand the person's own, of a turn the
    person's own. Raises InputError for an empty or overlong text, a negation, several people, or a clause that names
    no activity that is known: nothing is left out silently. See docs/decisions on language.
    """
    if not text.strip():
        raise InputError(f"the text is empty; say what the person does, for example {EXAMPLE!r}")
    if len(text) > LONGEST_TEXT:
        raise InputError(f"the text has {len(text)} characters, {LONGEST_TEXT} are allowed; say it shorter")
    readings: list[Reading] = []
    notes: list[str] = []
    for clause in clauses_of(words_of(text)):
        reading = read_clause(clause)
        notes += reading.notes
        if reading.adds_nothing and readings and reading.link in ("and", "comma", "then", "while"):
            readings[-1].absorb(reading)
        elif reading.steps:
            readings.append(reading)
        elif readings and readings[-1].steps[-1].upper == "raise" and LOWERING & set(reading.unknown):
            continue  # a raised hand comes down by itself
        elif not reading.is_empty:
            raise InputError(f"the clause {clause.text!r} names no activity that is known; known: {KNOWN}")
    if not readings:
        raise InputError(f"no activity is named in {text.strip()!r}; known: {KNOWN}")
    steps = _carried_over(_postures(_in_sequence(readings)))
    if len(steps) > MOST_STEPS:
        raise InputError(f"the text asks for {len(steps)} movements, {MOST_STEPS} are allowed; say fewer")
    return MotionPlan(text=text, steps=tuple(steps), notes=tuple(dict.fromkeys(notes)))


EXAMPLE = "a person walks towards the radar, then waves"


def _in_sequence(readings: list[Reading]) -> list[Step]:
    """Overlays joined, everything else one after the other."""
    steps: list[Step] = []
    for i, reading in enumerate(readings):
        first, rest = reading.steps[0], reading.steps[1:]
        if steps and _goes_together(readings[i - 1], reading):
            steps[-1] = overlay(steps[-1], first)
        else:
            steps.append(first)
        for step in rest:  # several in one clause: "sits drinking water"
            steps[-1] = overlay(steps[-1], step)
    return steps


def _goes_together(before: Reading, reading: Reading) -> bool:
    if reading.link == "while":
        return True
    one, other = before.steps[-1], reading.steps[0]
    compatible = _can_overlay(one, other)
    if reading.link == "and":
        if one.lower in ("sit", "stand") and not one.upper and other.upper and other.lower == "stand":
            return one.lower == "sit" or before.form == reading.form
        return compatible and before.form == reading.form == "ing"
    return reading.link == "comma" and compatible and reading.form == "ing" and before.form != "ing"


def _can_overlay(one: Step, other: Step) -> bool:
    lowers = [step.lower for step in (one, other) if step.lower != "stand"]
    uppers = [step.upper for step in (one, other) if step.upper]
    return len(uppers) == 1 and len(lowers) <= 1 and "jumping_jacks" not in lowers


def overlay(one: Step, other: Step) -> Step:
    """Both at once: the legs of one, the arms of the other. Raises InputError where both need the same limbs."""
    if {one.lower, other.lower} <= {"stand"} and not (one.upper and other.upper):
        pass
    elif not _can_overlay(one, other):
        raise InputError(
            f"{one.name} and {other.name} cannot be shown at the same time; say 'then' to have one after the other"
        )
    lower = one if one.lower != "stand" or other.lower == "stand" else other
    upper = one if one.upper else other
    return replace(
        lower,
        upper=upper.upper,
        hand=upper.hand,
        count=upper.count if upper.upper else lower.count,
        speed=lower.speed or upper.speed,
        seconds=lower.seconds or upper.seconds,
        facing=lower.facing or upper.facing,
        clause=f"{one.clause}, {other.clause}",
    )


def _postures(steps: list[Step]) -> list[Step]:
    """Who sits stays seated until standing up; who sits after something else first sits down."""
    result: list[Step] = []
    seated = False
    for step in steps:
        before = result[-1] if result else None
        if step.lower == "stand_up" and not seated and result:
            step = replace(step, lower="stand")
            if before and before.lower == "squat":
                continue
        elif step.lower in SEATED:
            if result and not seated:
                if step.upper:  # sits down, then does it seated
                    result.append(replace(step, lower="sit_down", upper="", count=0, seconds=0.0))
                    step = replace(step, lower="sit")
                else:
                    step = replace(step, lower="sit_down")
            elif seated:
                step = replace(step, lower="sit")
            elif step.lower == "sit_down" and step.upper:
                result.append(replace(step, upper="", count=0, seconds=0.0))
                step = replace(step, lower="sit")
            seated = True
        elif seated and step.lower == "stand" and step.upper and not step.on_feet:
            step = replace(step, lower="sit")
        elif seated and step.lower != "stand_up":
            result.append(Step(lower="stand_up", clause=step.clause))
            seated = False
        if step.lower == "stand_up":
            seated = False
        result.append(step)
    return _merged(result)


def _carried_over(steps: list[Step]) -> list[Step]:
    """'Walks back' is the way back where there was a way, else backwards; who raised a hand waves with that one."""
    gone = False
    for k, step in enumerate(steps):
        if step.direction == "back" and not gone:
            steps[k] = replace(step, direction="backwards")
        gone = gone or step.moves
        before = steps[k - 1]
        if k and step.upper == "wave" and not step.hand and before.upper == "raise":
            steps[k] = replace(step, hand=before.hand)
    return steps


def _merged(steps: list[Step]) -> list[Step]:
    """Two equal still postures in a row are one."""
    result: list[Step] = []
    for step in steps:
        plain = step.lower in ("sit", "stand") and not step.upper and not step.seconds and not step.facing
        same = (step.lower, "sit_down") if step.lower == "sit" else (step.lower,)
        if not (plain and result and result[-1].lower in same and not result[-1].upper):
            result.append(step)
    return result
