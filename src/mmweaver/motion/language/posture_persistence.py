"""Persistence of postures: arms stay in place, and a lowered body stays down, until a clause ends it."""

from collections.abc import Collection, Mapping, Sequence
from dataclasses import replace

from mmweaver.motion.language.activities import BY_KEY, words_in
from mmweaver.motion.language.lexicon import ARMS
from mmweaver.motion.language.modifiers import OPPOSITE
from mmweaver.motion.language.plan import Step, Way
from mmweaver.motion.language.simultaneous import ARMS_TAKEN, ONE_ARMED

# Persistent postures of the arms, and movements of the head alone, for which they come down.
ARM_POSTURES = words_in("cross_arms hips arms_out raise_hold hands_up")
_OF_THE_HEAD = words_in("look_around nod shake_head")
# Postures of legs or trunk -> the step that holds them.
_HELD_LOW = {"squat": "crouch", "crouch": "crouch", "raise_leg": "one_leg", "one_leg": "one_leg"}
_HELD_BENT = ("bend", "lean")
STAYING = words_in(
    "stay stays staying remain remains remaining hold holds holding keep keeps keeping wait waits waiting pause pauses"
    " pausing freeze freezes freezing rest rests resting"
)
_NO_ARMS_FREE = ARMS_TAKEN | words_in(
    "dance crawl push_ups sit_ups plank downward_dog limb_extension side_lunge tree_pose warrior_pose pedal stairs"
)
_COMING_BACK = words_in(
    "lower lowers lowering lowered drop drops dropping down up upright straightens straightening release releases"
    " uncrosses unfolds back stand_up"
)
_RISING = _COMING_BACK | words_in("stand stands standing")
_IT = words_in("it them up there")
LOWERED = words_in("lower lowers lowering lowered drop drops dropping down release releases releasing")
_PUTTING = words_in("put puts putting bring brings bringing take takes taking let lets")
_WITH_A_RAISED_HAND, _WITH_WHAT_IS_TAKEN = words_in("throw punch"), words_in("throw drink eat pull")
_AS_HANGING = "arms that go down are shown as hanging"
_SETTLING_S = 1.2  # time to enter a posture that is held for a given time

Lost = list[tuple[int, str]]


def persist_postures(
    steps: Sequence[Step], clauses: Mapping[int, str], afterwards: Collection[int] = ()
) -> tuple[list[Step], Lost]:
    """Applies persistent postures to the steps.

    Args:
        steps: Steps of the plan.
        clauses: Words of each clause by its number, with its report.
        afterwards: Clauses that begin with "then", before which a raised arm comes down.

    Returns:
        The steps, and (number of the clause, what is not shown) for postures that cannot persist.
    """
    result: list[Step] = []
    lost: Lost = []
    for given in steps:
        given = _lowered_from_there(result, given, lost)
        before = result[-1] if result else None
        step = _inherited_hand(before, _kept_up(given, clauses))
        own = words_in(" ".join(clauses.get(number, "") for number in step.clauses))
        if before is None or _comes_back(before, step, clauses):
            result.append(step)
            continue
        stays = step.lower == "stand" and not step.upper and not step.on_feet and bool(own & STAYING) and not own & ARMS
        held = _held_pose(before, step) if stays else None
        if held is not None:
            result[-1] = held
        elif _stays_raised(before, step) and not _follows(step, afterwards) and not own & ARMS:
            raised = replace(before, upper="raise_hold")
            result[-1:] = _kept_arms(raised, step, moves_arms=False)
        elif before.upper in ARM_POSTURES and before.other_hand is None and not step.upper:
            result[-1:] = _kept_arms(before, step, moves_arms=bool(own & ARMS))
        else:
            if step.clauses and before.upper in ARM_POSTURES and step.upper in _OF_THE_HEAD:
                lost.append((step.clauses[0], f"{BY_KEY[before.upper].name} ends before it"))
            result.append(step)
    rises = _comes_up_last(result[-1], clauses) if result else None
    if rises is not None and result[-1].style == "held" and not result[-1].upper:
        result[-1] = replace(result[-1], style="released")
    elif rises is not None and result[-1].lower in _HELD_LOW.values():
        result.append(Step(lower="stand", clauses=(rises,), clause=clauses[rises]))
    down = _brought_back_by(result[-1], clauses) if result else None
    if down is not None:
        lower = "stand" if result[-1].moves else result[-1].lower
        result.append(Step(lower=lower, seat=result[-1].seat, clauses=(down,), clause=clauses[down]))
    return result, lost


def _comes_up_last(last: Step, clauses: Mapping[int, str]) -> int | None:
    """The clause after the last step, without a step of its own, that ends a held posture."""
    after = {number: words_in(words) for number, words in clauses.items() if number > max(last.clauses, default=-1)}
    return next((number for number, own in after.items() if own & _RISING and not own & STAYING), None)


def _lowered_from_there(result: list[Step], step: Step, lost: Lost) -> Step:
    """A step that lowers arms, which stay up in the previous step; standing if they have not been up."""
    if not result or step.upper != "lower_arm" or step.lower != "stand" or step.other_hand is not None:
        return step
    before = result[-1]
    if before.upper == "raise" and before.lower == "stand" and before.count < 2 and before.other_hand is None:
        result[-1] = replace(before, upper="raise_hold", count=0)
    elif before.upper not in ("raise_hold", "lower_arm"):
        lost += [(number, _AS_HANGING) for number in step.clauses[:1]]
        return replace(step, upper="", hand="", count=0)
    return step


def _brought_back_by(last: Step, clauses: Mapping[int, str]) -> int | None:
    """The last clause, if it lowers arms that would otherwise stay up: 'folds the arms and lowers them'."""
    still = (
        last.lower in ("stand", "sit", "kneel", "walk", "jog")
        and last.upper in ARM_POSTURES
        and last.other_hand is None
    )
    after = [number for number in clauses if number > max(last.clauses, default=-1)]  # two postures that are one step
    for number in [*last.clauses[1:][-1:], *after] if still else []:
        own = words_in(clauses.get(number, ""))
        if _AS_HANGING in clauses.get(number, ""):
            return number
        if number in last.clauses and _brings_down(own) and not own & (STAYING - {"rests", "resting", "rest"}):
            return number
    return None


def _brings_down(words: Collection[str]) -> bool:
    """Whether the words of a clause bring the arms down: 'lowers them', 'puts it down'."""
    return bool(LOWERED & {*words} or ("down" in words and _PUTTING & {*words}))


def _follows(step: Step, afterwards: Collection[int]) -> bool:
    """Whether a step begins a clause that follows with "then", or belongs to no clause."""
    return not step.clauses or min(step.clauses) in afterwards


def _stays_raised(before: Step, step: Step) -> bool:
    """Whether a raised arm is still up: the next movement leaves the arms alone."""
    lifted = before.upper == "raise" and before.lower == "stand" and not (before.count or before.other_hand)
    free = step.lower not in _NO_ARMS_FREE and step.lower != "stand" and BY_KEY[step.lower].posture == "feet"
    return lifted and free and not step.upper


def _inherited_hand(before: Step | None, step: Step) -> Step:
    """The hand that was raised, held out or took something also performs the next activity."""
    if before is None or before.hand not in OPPOSITE or step.hand or step.other_hand:
        return step
    lifted = before.upper in ("raise", "raise_hold", "arms_out") and step.upper in ONE_ARMED | _WITH_A_RAISED_HAND
    took = (before.lower == "pick_up" or before.upper == "reach") and step.upper in _WITH_WHAT_IS_TAKEN
    return replace(step, hand=before.hand) if lifted or took else step


def _kept_up(step: Step, clauses: Mapping[int, str]) -> Step:
    """A raised arm or leg kept up by a clause without a step of its own: 'raises an arm, keeps it up and walks'."""
    more = [words_in(clauses.get(number, "")) for number in step.clauses[1:]]
    if len(more) > 1 and _brings_down(more[-1]):  # "holds it, puts it down"
        del more[-1]
    staying = STAYING | {"for"} if step.seconds else STAYING  # "holds them" is taken out of "holds them for 3 seconds"
    if step.count or not any(words & staying and "down" not in words for words in more):
        return step
    if step.lower == "raise_leg" and not step.upper:
        return replace(step, lower="one_leg", foot=OPPOSITE.get(step.foot, ""))
    goes = step.lower in ("walk", "jog") and any(words & STAYING and words & _IT for words in more)
    is_arm = step.upper == "raise" and (step.lower == "stand" or goes) and not any("down" in words for words in more)
    return replace(step, upper="raise_hold") if is_arm else step


def _comes_back(before: Step, step: Step, clauses: Mapping[int, str]) -> bool:
    """Whether a clause without a step has brought arms, legs or trunk back: 'lowers them', 'straightens up'."""
    first, last = max(before.clauses, default=-1), min(step.clauses, default=-1)
    between = [*before.clauses[1:], *range(first + 1, last)]
    said = [clauses.get(number, "") for number in between]
    return any(_AS_HANGING in words for words in said) or any(
        own & _COMING_BACK and not own & STAYING for own in map(words_in, said)
    )


def _held_pose(before: Step, step: Step) -> Step | None:
    """One step that enters the previous step's posture and stays in it; None if it has none that is held."""
    seconds = step.seconds + _SETTLING_S if step.seconds else before.seconds
    kept = replace(before, seconds=seconds, clauses=_together(before, step), clause=f"{before.clause}, {step.clause}")
    if before.count > 1:
        return None
    if before.lower in _HELD_LOW:
        foot = OPPOSITE.get(before.foot, "") if before.lower == "raise_leg" else before.foot
        return replace(kept, lower=_HELD_LOW[before.lower], count=0, style="", foot=foot)
    if before.lower in _HELD_BENT:
        return replace(kept, style="held", count=0)
    if before.lower == "stand" and before.upper == "raise":
        return replace(kept, upper="raise_hold", count=0)
    return None


def _kept_arms(before: Step, step: Step, *, moves_arms: bool) -> list[Step]:
    """The two steps with the arms unchanged in the second one; one step if nothing else happens."""
    if moves_arms or step.lower in _NO_ARMS_FREE or BY_KEY[step.lower].posture == "floor":
        return [before, step]
    arms = {"upper": before.upper, "hand": before.hand}
    if before.upper == "arms_out" and not step.moves:
        arms["direction"] = step.direction or (Way.FORWARDS if before.arms_ahead else None)
    if before.arms_ahead and step.moves:
        arms["style"] = step.style or "ahead"
    if step.lower == before.lower and not step.moves and not step.facing and step.lower in ("stand", "sit", "kneel"):
        seconds = step.seconds + _SETTLING_S if step.seconds else before.seconds
        return [replace(before, seconds=seconds, clauses=_together(before, step))]
    return [before, replace(step, **arms)]


def _together(before: Step, step: Step) -> tuple[int, ...]:
    return tuple(dict.fromkeys((*before.clauses, *step.clauses)))
