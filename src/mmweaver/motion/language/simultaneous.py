"""Simultaneous steps of a sentence, and how two become one: a walk of two descriptions, legs and arms, an arm each."""

import re
from dataclasses import replace

from mmweaver.core.errors import InputError
from mmweaver.motion.language.activities import BY_KEY, words_in
from mmweaver.motion.language.fallback_parsing import ROUGH
from mmweaver.motion.language.lexicon import RADAR
from mmweaver.motion.language.modifiers import OPPOSITE
from mmweaver.motion.language.parsed_clause import ParsedClause
from mmweaver.motion.language.plan import Shape, Side, Step, Way

# Hand activities that leave the other arm free, and those of them that involve the head.
ONE_ARMED = words_in(
    """
    wave raise arms_out drink eat phone brush_teeth comb wipe write stir knock point hips reach raise_hold lower_arm
    push_hand pull_hand draw_circle draw_z yawn knock_elbow arm_extension swipe
    """
)
AT_THE_HEAD = words_in("drink eat phone brush_teeth comb yawn")
ARMS_TAKEN = words_in("jumping_jacks pick_up put_down throw fall lie_down get_up stumble leap jump forward_roll")
_IN_TURN = ({"walk", "turn"}, {"jog", "turn"})
_REST_S = 0.5  # rest before a hand is raised to wave
_WALKS_ON = re.compile(
    r"\b(?:walk|go|run|jog|mov)(?:s|es|e|ning|ging|ing)? (?:straight )?on$|\b(?:continu|carr(?:y|ies) on|resum|keep)"
)
_PAUSING = ("pause", "stop", "halt")  # not simultaneous: "pauses and waves"
_HELD = ("raise", "raise_hold", "hips", "arms_out", "phone")
# Open-ended activities, during which what "and" adds happens.
_GOING_ON = {"dance", "march", "hop", "twist"}
_PLAYED = {"guitar", "violin"}
# Low postures, in which the hands do what "and" adds before the body comes up.
_LOW = {"bend", "lean", "crouch", "squat", "one_leg", "raise_leg"}


def sequence_steps(parsed_clauses: list[ParsedClause], leaving: int) -> list[Step]:
    """Joins clauses that happen at the same time, and orders all others one after the other.

    If phrases may be dropped, two movements that cannot be shown at once follow each other, which is reported.

    Args:
        parsed_clauses: Clauses with an activity in temporal order.
        leaving: What may be dropped, see `fallback_parsing`.

    Returns:
        Steps in temporal order.

    Raises:
        InputError: If two movements cannot be shown at once.
    """
    steps: list[Step] = []
    for i, parsed in enumerate(parsed_clauses):
        first, rest = parsed.steps[0], parsed.steps[1:]
        if steps and _goes_together(parsed_clauses[i - 1], parsed):
            try:
                before = steps.pop()
                steps += _joined(before, first)
                if {before.lower, first.lower} in _IN_TURN and steps[-1] is first:
                    parsed.say_in_turn(before, first)
            except InputError:
                steps.append(before)
                arms_alone = first.upper and first.lower == "stand"  # continues in the previous posture
                if not leaving or (leaving < ROUGH and steps[-1].posture != first.posture and not arms_alone):
                    raise
                steps.append(first)
                parsed.say_in_turn(steps[-2], first)
        else:
            is_last = i + 1 == len(parsed_clauses)
            if steps and _reads_as_at_once(parsed_clauses[i - 1], parsed, is_last=is_last):  # "dances, jumping"
                parsed.say_in_turn(steps[-1], first)
            steps.append(first)
        for step, form in zip(rest, parsed.forms[1:], strict=True):
            in_turn = form == "s" and steps[-1].moves  # "walks forward lifts the arms"
            together = form == "ing" or (
                _can_overlay(steps[-1], step, in_two=False) and not in_turn
            )  # "sits drinking water"
            if together and not (leaving == ROUGH and not _can_be_joined(steps[-1], step)):
                steps[-1:] = _joined(steps[-1], step)
            else:  # "walks forward turns around"
                if together or form == "past":  # "walks with the legs raised"
                    parsed.say_in_turn(steps[-1], step)
                steps.append(step)
    return steps


def going_on(steps: list[Step]) -> list[Step]:
    """Merges steps that continue from the final pose of the previous one, which does not start anew.

    Args:
        steps: Steps in temporal order.
    """
    result = steps[:1]
    for step in steps[1:]:
        before = result[-1]
        if _only_begins(before, step):
            hand = step.hand or before.hand
            clause, clauses = f"{before.clause}, {step.clause}", (*before.clauses, *step.clauses)
            # a sequence starts within its first gesture: a rest shows the raising of the hand
            at_rest = [replace(before, upper="", hand="", seconds=_REST_S)] if step.upper and len(result) == 1 else []
            result[-1:] = [*at_rest, replace(step, hand=hand, clause=clause, clauses=clauses)]
        else:
            result.append(_facing_onward(before, step))
    return result


def _only_begins(before: Step, step: Step) -> bool:
    """Whether a step is the beginning of the next: "bends down and picks it up", "raises the hand and waves"."""
    if before.count or before.seconds or before.facing or before.place:
        return False
    if step.lower == "pick_up":
        return before.lower in ("bend", "crouch", "squat") and not before.upper
    lifted = (before.lower, before.upper, step.lower, step.upper) == ("stand", "raise", "stand", "wave")
    return lifted and step.hand in ("", before.hand) and before.other_hand is None


def _facing_onward(before: Step, step: Step) -> Step:
    """After turning, opening a door or 'walks on', the walk leads ahead."""
    both_turn = before.lower == step.lower == "turn" and (isinstance(before.direction, Side) or before.turn_deg)
    if both_turn and step.direction == Shape.AROUND and "back" in step.clause.split():  # as far as the turn before
        return replace(step, direction=OPPOSITE.get(before.direction), turn_deg=-before.turn_deg)
    if step.lower not in ("walk", "jog") or step.target or step.place or step.seat:
        return step
    aimless = not step.direction and not step.arc_deg
    turned = before.lower == "turn" and not before.facing and not RADAR & {*step.clause.split()}
    turned &= aimless or step.direction == Way.AWAY
    onward = aimless and (before.upper == "open_door" or _WALKS_ON.search(step.clause) is not None)
    return replace(step, direction=Way.FORWARDS) if turned or onward else step


def _merged_walk(one: Step, other: Step) -> list[Step]:
    """One walk of two descriptions: 'walks to the left, taking five steps'."""
    if one.direction and other.direction and one.direction != other.direction:
        raise InputError(
            f"{one.clause!r} and {other.clause!r} name two directions; say which movement goes where, with 'then'"
        )
    more = one if one.direction or one.arc_deg else other
    return [
        replace(
            more,
            count=one.count or other.count,
            speed=one.speed or other.speed,
            upper=one.upper or other.upper,
            hand=one.hand or other.hand,
            target=one.target or other.target,
            clauses=(*one.clauses, *other.clauses),
        )
    ]


def _joined(one: Step, other: Step) -> list[Step]:
    """Two simultaneous steps as one; a push or a turn during a walk is resolved into a sequence."""
    if one.lower == other.lower and one.moves and not (one.upper and other.upper):
        return _merged_walk(one, other)
    pair = {one.lower, other.lower}
    if pair in ({"walk", "limp"}, {"walk", "stagger"}) and not (one.upper and other.upper):
        gait = next(step.lower for step in (one, other) if step.lower != "walk")
        return _merged_walk(replace(one, lower=gait), replace(other, lower=gait))
    walk, more = (one, other) if one.moves and one.lower != "stumble" else (other, one)
    if "stumble" in pair and walk.moves and walk.lower != "stumble" and not (one.upper or other.upper):
        onward = replace(walk, direction=Way.FORWARDS if walk.direction == Way.FORWARDS else walk.direction, count=0)
        return [walk, more, onward]
    if walk.lower in ("walk", "jog") and more.lower == "turn" and not (one.upper or other.upper or more.facing):
        angle = {"left": 90.0, "right": -90.0, "around": 180.0}.get(more.direction, more.turn_deg)
        if (more.direction == Shape.AROUND and walk.direction) or abs(angle) >= 360.0 or walk.direction == Shape.CIRCLE:
            return [one, other]
        bend = replace(walk, arc_deg=angle, turn_deg=0.0, either_side=not isinstance(more.direction, Side))
        return [replace(bend, direction=Way.BACKWARDS if walk.direction == Way.BACKWARDS else None)]
    return [overlay(one, other)]


def _can_be_joined(one: Step, other: Step) -> bool:
    try:
        _joined(one, other)
    except InputError:
        return False
    return True


def _goes_together(before: ParsedClause, parsed: ParsedClause) -> bool:
    one, other = before.steps[-1], parsed.steps[0]
    if parsed.link == "comma" and parsed.form == "ing" and one.lower == other.lower == "walk" and not other.direction:
        return True
    if parsed.link == "while":
        return True
    compatible = _can_overlay(one, other)
    if parsed.link == "and" and compatible and _is_meanwhile(one, other):
        return True
    if parsed.link == "and":
        if one.upper in _HELD and other.upper and {one.hand, other.hand} == {"left", "right"}:
            return True  # one hand stays in place
        if one.lower in ("sit", "stand") and not one.upper and other.upper and other.lower == "stand":
            pauses = any(word.lemma in _PAUSING for word in before.words)
            return one.lower == "sit" or (before.form == parsed.form and not pauses)
        paces = any(step.count and step.moves for step in (one, other))
        return compatible and before.form == parsed.form == "ing" and not paces
    return parsed.link == "comma" and compatible and parsed.form == "ing" and before.form != "ing"


def _is_meanwhile(one: Step, other: Step) -> bool:
    """Whether what "and" adds happens during the first: 'dances and claps', 'leans over and wipes'."""
    if other.lower in _GOING_ON and not (other.upper or other.moves):
        return one.upper in _PLAYED and one.lower in ("stand", "sit")
    hands = other.upper not in ("", "stretch") and other.lower == "stand" and not (other.on_feet or other.seconds)
    if one.upper or one.moves or one.count > 1 or one.seconds or not hands:
        return False
    return one.lower in _GOING_ON | _LOW


def _reads_as_at_once(before: ParsedClause, parsed: ParsedClause, *, is_last: bool) -> bool:
    """Whether a participle after a comma is simultaneous with the previous movement on the spot."""
    step = parsed.steps[0]
    on_the_spot = bool(step.upper) or not (step.moves or step.lower in ("turn", "stand", "stumble", "fall"))
    if parsed.link == "and":  # "is walking and bending", not "is walking and then bends", "sitting and standing up"
        ends = (
            BY_KEY[before.steps[-1].lower].once or BY_KEY[step.lower].once or before.steps[-1].posture != step.posture
        )
        return parsed.form == before.form == "ing" and on_the_spot and not (ends or before.steps[-1].count)
    # "dances, moving the feet forward and back", "jumps, turning", not "walks forward, turning left"
    on_the_spot |= before.steps[-1].lower == "dance" or (step.lower == "turn" and before.steps[-1].lower == "jump")
    alone = is_last or before.form != "ing"  # "is boxing, hopping", not "is walking, waving and jumping"
    return parsed.link == "comma" and parsed.form == "ing" and alone and on_the_spot


def _can_overlay(one: Step, other: Step, *, in_two: bool = True) -> bool:
    lowers = [step.lower for step in (one, other) if step.lower != "stand"]
    uppers = [step.upper for step in (one, other) if step.upper]
    fits = len(uppers) == 1 or (in_two and len(uppers) == 2 and assign_hands(one, other) is not None)
    return fits and len(lowers) <= 1 and not set(lowers) & ARMS_TAKEN


def assign_hands(one: Step, other: Step) -> tuple[Step, Step] | None:
    """Assigns a hand to each of two hand activities, the one that involves the head first.

    A hand that the sentence leaves open is the opposite of the other one; of two open ones the first gets the right.

    Args:
        one: Step with a hand activity.
        other: Step with another hand activity.

    Returns:
        The steps with hands; None if both need one hand.
    """
    if not {one.upper, other.upper} <= ONE_ARMED or one.other_hand is not None or other.other_hand is not None:
        return None
    unclear = one.clauses == other.clauses and not (one.hand and other.hand)  # "wiping or stirring with the right hand"
    if unclear or "both" in (one.hand, other.hand) or (one.hand and one.hand == other.hand):
        return None
    hand = one.hand or OPPOSITE.get(other.hand, "right")
    pair = replace(one, hand=hand), replace(other, hand=OPPOSITE[hand])
    return (pair[1], pair[0]) if other.upper in AT_THE_HEAD and one.upper not in AT_THE_HEAD else pair


def overlay(one: Step, other: Step) -> Step:
    """Combines two steps: legs of one, arms of the other, or an arm of each.

    Args:
        one: First step in the sentence.
        other: Second step.

    Raises:
        InputError: If both need the same limbs.
    """
    if {one.lower, other.lower} <= {"stand"} and not (one.upper and other.upper):
        pass
    elif not _can_overlay(one, other):
        raise InputError(
            f"{one.name} and {other.name} cannot be shown at the same time; say 'then' to have one after the other"
        )
    if one.upper and other.upper:
        hands = assign_hands(one, other)
        assert hands is not None  # as `_can_overlay` found
        first, second = hands
        legs = one if one.lower != "stand" else other
        together = overlay(
            replace(
                legs,
                upper="",
                hand="",
                count=legs.count if legs.moves else 0,
                direction=None if legs.lower == "stand" else legs.direction,
            ),
            replace(first, lower="stand"),
        )
        clauses = tuple(dict.fromkeys((*one.clauses, *other.clauses)))
        other_hand = replace(second, lower="stand", direction=second.direction if second.upper == "arms_out" else None)
        return replace(together, other_hand=other_hand, clause=f"{one.clause}, {other.clause}", clauses=clauses)
    lower = one if one.lower != "stand" or other.lower == "stand" else other
    upper = one if one.upper else other
    return replace(
        lower,
        upper=upper.upper,
        hand=upper.hand,
        count=upper.count or (0 if lower.moves else lower.count),
        style="held"
        if lower.lower in ("bend", "lean")
        else lower.style or ("ahead" if lower.moves and upper.arms_ahead else ""),
        direction=lower.direction or (upper.direction if upper.upper == "arms_out" and not lower.moves else None),
        speed=lower.speed or upper.speed,
        seconds=lower.seconds or upper.seconds,
        facing=lower.facing or upper.facing,
        place=lower.place or upper.place,
        clause=f"{one.clause}, {other.clause}",
        clauses=(*one.clauses, *other.clauses),
    )
