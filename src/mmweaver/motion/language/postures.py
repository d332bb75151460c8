"""Postures: sitting, kneeling and lying last until the person gets up; missing transitions are inserted.

Complete descriptions of steps: limb and side, direction, posture, speed, count, seconds, place, overlays.

They follow what `motion/animation/library` and `motion/planning` make of each field, not the wording of the sentence.
"""

import re
from collections.abc import Iterable, Sequence
from dataclasses import replace
from itertools import groupby, pairwise

from mmweaver.motion.language.activities import BY_KEY, words_in
from mmweaver.motion.language.plan import FALLING_ON, FALLS, FALLS_OFF, NOT_DONE, ClauseRecord, Shape, Step, Way
from mmweaver.motion.language.posture_persistence import STAYING

# Done once without a number, though they do not end the step; and repeatedly, within two seconds each.
_ONCE = words_in("lunge roll_over roll_in_bed raise point swipe")
_RHYTHMIC = words_in(
    """
    hop hop_one_leg jumping_jacks wave clap knock nod shake_head arm_circles punch push_ups sit_ups stairs count_fingers
    """
)
PACES = words_in("walk jog sidestep limp stagger march walking_lunge")
SPEEDS_SAID = {-1: " slowly", 0: "", 1: " quickly"}
_SMALL_NUMBERS = ("no", "one", "two", "three", "four", "five", "six", "seven", "eight", "nine", "ten", "eleven")


def frequency_text(step: Step, key: str) -> str:
    """Wording of the repetitions of an activity; "" if it has none.

    Args:
        step: The step.
        key: Key of the activity.
    """
    activity = BY_KEY[key]
    if activity.counted_s is None or key in PACES or step.style in ("held", "released"):
        return ""
    if step.count:
        return f" {times_said(step.count)}"
    is_once = (activity.once or key in _ONCE) and step.style != "frontlunge"
    if step.several and not activity.hands and not (is_once and step.upper):
        return " twice or more"
    if is_once:
        return " once"
    return " repeatedly" if key in _RHYTHMIC else " once or more"


def times_said(count: int) -> str:
    """Words for a number of repetitions: once, twice, three times."""
    return {1: "once", 2: "twice"}.get(count, f"{_number(count)} times")


def steps_said(count: int) -> str:
    """Words for a number of paces: one step, two steps."""
    return "one step" if count == 1 else f"{_number(count)} steps"


def _number(count: int) -> str:
    return _SMALL_NUMBERS[count] if count < len(_SMALL_NUMBERS) else str(count)


_SIDES = ("left", "right")
_WAYS = {
    **{way: f" {way}" for way in ("forwards", "backwards", "away", "around")},
    **{side: f" to the {side} in the photo" for side in _SIDES},
    "away": " away from the radar",
    "towards": " towards the radar",
    "pacing": " to and fro",
    "spot": " on the spot",
    "seat": " to a seat",
    "back": " back the way it came",
}
_STYLES_OF_WALKS = {
    "tandem": " heel to toe",
    "cane": " with a cane",
    "rollator": " with a rollator",
    "crutches": " on crutches",
    "pushing": " pushing something",
}
_ONTO = {
    "back": "on the back",
    "front": "on the belly",
    **{side: f"on the person's {side} side" for side in _SIDES},
}
_LYING = words_in("lie lie_down fall collapse")


def body_phrase(step: Step) -> str:
    """Describes a body activity: 'walking three steps backwards', 'lunging ahead with the left leg twice'.

    Args:
        step: The step.
    """
    name = BY_KEY[step.lower].shown or BY_KEY[step.lower].name
    if step.lower == "jog" and step.style != "jog":
        name = "running"
    if step.lower == "kneel_up" and step.style == "knee":
        name = f"standing up from the {step.foot} knee" if step.foot else "standing up from one knee"
    if step.lower == "turn":
        return f"turning{_turn(step)}{SPEEDS_SAID[step.speed]}"
    if step.lower == "lunge" and not step.foot and (step.count > 1 or step.style):
        name = "lunging ahead with each leg in turn"
    which = f"the {step.foot}" if step.foot else "one"
    own_side = f"the person's {step.direction} side" if step.direction in _SIDES else "a side"
    name = name.format(foot=f"{which} foot", leg=f"{which} leg", own_side=own_side)
    if step.lower in ("pick_up", "put_down"):
        name += hand_suffix(hand_of(step, step.lower))
    paces = f" {steps_said(step.count)}" if step.lower in PACES and step.count and not step.upper else ""
    return f"{name}{paces}{_way(step)}{SPEEDS_SAID[step.speed]}{frequency_text(step, step.lower)}"


def _support(step: Step) -> str:
    """Seat, direction on it or from it, or manner of sitting on the floor."""
    if step.posture == "ground":
        return {"crossed": " cross-legged", "legs_out": " with the legs stretched out"}.get(step.style, "")
    if step.lower == "fall_off":
        return f" to the person's {step.style}"
    if step.lower == "seated_lean":
        aside = f" to the person's {step.direction}" if step.direction in _SIDES else " forwards"
        return " backwards" if step.direction == Way.BACKWARDS else aside
    named = step.seat and step.lower not in ("stand_up", "slip", "floor_rise", "fall_out_of_bed")
    return f" on the {step.seat}" if named else ""


def _way(step: Step) -> str:
    """Direction, support or side of lying of a step."""
    if step.lower in _LYING:
        return f" {_ONTO.get(step.style, 'on the back')}"
    if step.lower == "kneel_up" and step.style == "knee":
        return ""
    if step.style == "knee":
        return f" on the {step.foot} knee" if step.foot else " on one knee"
    if step.uses_seat or step.posture == "ground" or step.lower in ("slip", "floor_rise"):
        return _support(step)
    if step.lower == "lean":
        way = {Way.BACKWARDS: " backwards", None: " to one side"}.get(
            step.direction, f" to the person's {step.direction}"
        )
        return (
            way
            if step.upper
            else way + {"held": " and staying so", "released": ", staying so and coming up"}.get(step.style, "")
        )
    if step.lower == "bend" and step.style in ("held", "released") and not step.upper:
        return " and staying down" if step.style == "held" else ", staying down and coming up"
    if step.lower in ("kick", "roundhouse"):
        return {"back": " to the back", "high": " high up"}.get(step.style, "")
    if not step.moves or step.lower == "forward_roll":
        return _WAYS["spot"] if step.direction == Shape.SPOT and step.lower == "jog" else ""
    return _going(step)


def _going(step: Step) -> str:
    """Manner, destination or direction of a step that changes the position on the floor."""
    if step.lower == "walk" and step.style in _STYLES_OF_WALKS:
        return _STYLES_OF_WALKS[step.style] + _going(replace(step, style=""))
    if step.direction == Shape.CIRCLE:
        return f" in a circle{_round(step)}"
    if step.arc_deg:
        backwards = " backwards" if step.direction == Way.BACKWARDS else ""
        return f"{backwards} in an arc of {abs(step.arc_deg):g} degrees{_own_side(step.arc_deg, step.either_side)}"
    to = f" {step.distance_m:g} m" if step.distance_m else ""
    if step.target or (step.seat and step.direction == Way.SEAT):
        return f"{to} to the {step.target or step.seat}"
    if step.lower == "sidestep" and step.direction not in _SIDES:
        return f"{to} to a side"
    return to + _WAYS.get(step.direction, "")


def _round(step: Step) -> str:
    either = step.either_side or not step.arc_deg
    way = "" if either else " counterclockwise" if step.arc_deg > 0 else " clockwise"
    rounds = round(abs(step.arc_deg) / 360)
    return way + (f", {times_said(rounds)} round" if rounds > 1 else "")


def _turn(step: Step) -> str:
    """Direction and angle of a turn, or what the person then faces."""
    if step.facing:
        facing = {
            "towards": "to face the radar",
            "away": "to face away from the radar",
            "sideways": "sideways to the radar",
        }
        aim = f"to face {step.facing} in the photo" if step.facing in _SIDES else f"to face the {step.facing}"
        return f" {facing.get(step.facing, aim)}"
    if step.turn_deg:
        return f" {abs(step.turn_deg):g} degrees{_own_side(step.turn_deg, step.either_side)}"
    return f" 90 degrees to the person's {step.direction}" if step.direction in _SIDES else " around"


def _own_side(angle_deg: float, either: bool) -> str:
    return "" if either else f" to the person's {'left' if angle_deg > 0 else 'right'}"


# Activities of one hand, and those of both unless the sentence names one.
_ONE_HANDED = words_in(
    """
    wave raise drink eat phone brush_teeth comb wipe write stir knock open_door point throw reach raise_hold lower_arm
    push_hand pull_hand draw_circle draw_z swipe yawn knock_elbow arm_extension cough vacuum jab cross forehand backhand
    tennis_serve pick_up put_down hook uppercut functional_reach seated_reach
    """
)
_OF_BOTH = {  # activities that move one hand even if the sentence names both
    **dict.fromkeys(words_in("eat phone brush_teeth comb wipe write stir open_door point throw"), "right"),
    **dict.fromkeys(words_in("swipe draw_circle draw_z yawn cough vacuum drink"), "left"),
}
_BOTH = words_in("raise_aside raise_ahead arms_out hips arm_circles push pull carry")
_IN_TURN = words_in("punch jab cross hook uppercut")
_LIMBS = ("{hand}", "{arm}", "{forearm}")
_HEIGHTS = {"high": " high up", "up": " upwards", "down": " downwards", "under": " underarm"}


def hand_phrase(step: Step, part: Step) -> str:
    """Describes one hand activity with its limb.

    Args:
        step: The whole step.
        part: The step or the activity of the other hand.
    """
    key, hand = part.upper, hand_of(part, part.upper)
    name = BY_KEY[key].shown or BY_KEY[key].name
    if key == "arms_out":
        arms = "the arms" if hand == "both" else f"the {hand} arm"
        way = "ahead" if part.arms_ahead else "to the sides" if hand == "both" else "to the side"
        name = f"holding {arms} out {way}"
    elif key == "hips":
        name = "holding the hands on the hips" if hand == "both" else f"holding the {hand} hand on the hip"
    elif key == "raise_hold" and step.lower != "stand":  # already up, or coming up meanwhile
        name = "holding {arm} up overhead"
    elif key == "look_around":
        name = {"down": "looking down", **{side: f"looking to the {side} in the photo" for side in _SIDES}}.get(
            part.facing or part.direction, "looking around to both sides"
        )
    elif key == "point":
        side = part.facing or part.direction
        name = f"pointing to the {side} in the photo" if side in _SIDES else "pointing ahead"
    elif key == "swipe":
        across = "" if part.style else " across the body"
        name += f" to the person's {part.direction}" if part.direction in _SIDES else across
    if any(limb in name for limb in _LIMBS):
        which = "both" if hand == "both" else "one" if hand == "one" else f"the {hand}"
        name = name.format(**{limb: f"{which} {limb}{'s' * (hand == 'both')}" for limb in ("hand", "arm", "forearm")})
        name = name.replace("ing it", "ing them") if hand == "both" else name
    elif hand and key not in ("arms_out", "hips"):
        name += hand_suffix(hand) + " in turn" * (hand == "both" and key in _IN_TURN)
    speed = (part.speed or step.speed) if step.lower == "stand" else 0
    return f"{name}{_HEIGHTS.get(part.style, '')}{SPEEDS_SAID[speed]}{frequency_text(part, key)}"


def hand_suffix(hand: str) -> str:
    """Words for the acting hand, such as " with both hands"."""
    return {"both": " with both hands", "one": " with one hand"}.get(hand, f" with the {hand} hand")


def hand_of(part: Step, key: str) -> str:
    """The hand that acts: left, right, both, "one" if the seed chooses it, "" if both are needed anyway.

    Args:
        part: The step.
        key: Key of the activity.
    """
    if key in _ONE_HANDED:
        return _OF_BOTH.get(key, "both") if part.hand == "both" else part.hand or "one"
    if key in ("punch", "text"):  # a phone is in one hand or both if none is named
        return part.hand or (("one" if part.count == 1 else "both") if key == "punch" else "")
    return (part.hand or "both") if key in _BOTH else ""


def add_shown_text(records: Sequence[ClauseRecord], steps: Sequence[Step]) -> tuple[ClauseRecord, ...]:
    """Adds to each record what its clause is shown as: 'then waving' if it begins after another step.

    Descriptions of steps that were since cut or placed are updated.

    Args:
        records: Records of the clauses.
        steps: Final steps.
    """
    shown, seen = [], {0}  # the first step follows nothing
    for places in _places_of_each(len(records), steps):
        shown.append("then " * bool(places and places[0] not in seen) + _at(places, steps))
        seen |= {*places}
    for number, record in enumerate(records):  # "turns left while walking": the step belongs to the other clause
        if record.status != NOT_DONE and not shown[number]:
            shown[number] = next(filter(None, (*shown[number + 1 :], *shown[:number][::-1])), "")
    return tuple(_shown_as(record, words) for record, words in zip(records, shown, strict=True))


def _shown_as(record: ClauseRecord, shown: str) -> ClauseRecord:
    before, now = (f"is shown as {words.removeprefix('then ')}" for words in (record.shown, shown))
    how = record.how.replace(before, now) if record.shown and shown else record.how
    return replace(record, shown=shown, how=how)


def steps_of_each(clauses: int, steps: Sequence[Step]) -> list[list[Step]]:
    """The steps of each clause; a step without a clause counts with the next one that has one.

    A step of several clauses counts with those that have no other of its kind: "walks forward, then backward".

    Args:
        clauses: Number of clauses.
        steps: Final steps.
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
    """The steps at these places in order; "later" marks others in between."""
    runs: list[list[Step]] = []
    for k, place in enumerate(places):
        if k and place == places[k - 1] + 1:
            runs[-1].append(steps[place])
        else:
            runs.append([steps[place]])
    return ", later ".join(map(in_turn, runs))


def in_turn(steps: Iterable[Step]) -> str:
    """Describes steps in order: 'walking backwards, then standing'.

    Args:
        steps: Steps in temporal order; repetitions are summarized.
    """
    names = [doing(step) for step in steps]
    for length in range(1, len(names) // 2 + 1):
        times, rest = divmod(len(names), length)
        if not rest and names == names[:length] * times:
            often = f"all of this {times_said(times)}" if length > 1 else f"{times_said(times)} in a row"
            return f"{', then '.join(names[:length])}, {often}"
    return ", then ".join(name if len([*same]) == 1 else f"{name}, and again" for name, same in groupby(names))


def doing(step: Step) -> str:
    """Complete description of a step: 'walking three steps backwards', 'sitting on the sofa while waving'.

    Args:
        step: The step.
    """
    body = "" if step.lower == "stand" and step.upper else body_phrase(step)
    parts = [body, *(hand_phrase(step, part) for part in step.each if part.upper)]
    ways = {"towards": "the radar", "away": "away from the radar", "sideways": "sideways to the radar"}
    facing = ways.get(step.facing) or (f"{step.facing} in the photo" if step.facing in _SIDES else f"the {step.facing}")
    only_looks = step.upper in ("look_around", "point") and step.facing in _SIDES
    faces = step.facing and not (step.facing == "down" or step.lower == "turn" or only_looks)
    return (
        " while ".join(filter(None, parts))
        + (f", facing {facing}" if faces else "")
        + ("" if step.place is None else f", {step.place.words}")
        + (f" for {step.seconds:g} s" if step.seconds else "")
    )


RISING = {
    "seat": ("stand_up",),
    "knees": ("kneel_up",),
    "floor": ("get_up",),
    "couch": ("sit_up", "stand_up"),
    "ground": ("floor_rise",),
}
STILL = {"seat": "sit", "knees": "kneel", "floor": "lie", "couch": "lie_on_seat", "ground": "floor_sit"}
_WITH_FREE_HANDS = ("sit_down", "kneel_down", "floor_sit_down")
# Activities done lying, and on which side; "": on either.
LYING = {
    "push_ups": "front",
    "plank": "front",
    "sit_ups": "back",
    "mountain_climbers": "front",
    "roll_over": "",
    "try_to_get_up": "",
    "lying_leg_raise": "",
}
_ITS_PLACE = re.compile(r"back[_ ]to[_ ]start|\b(?:position|place|spot|pose|posture|stance)\b")
_FALLS_ON = {Way.FORWARDS: "front", Way.BACKWARDS: "back"}  # direction of a stumble -> style of the fall
_WAYS_OF_FALLING = words_in("back backwards backward onback onbelly forward forwards front ahead")
# Activities of a sitter, and those that a sitter does differently from somebody who stands.
SEATED = words_in("knee_extension seated_march seated_lean seated_reach cross_legs")
_SEATED_FORMS = {"march": "seated_march", "lean": "seated_lean", "bend": "seated_lean", "pick_up": "seated_reach"}
ENTERING = {
    "sit": "sit_down",
    "kneel": "kneel_down",
    "lie": "lie_down",
    "lie_on_seat": "recline",
    "floor_sit": "floor_sit_down",
}


def insert_transitions(steps: list[Step]) -> list[Step]:
    """Inserts the missing transitions: sitting down, kneeling, lying down, getting up.

    Args:
        steps: Steps of the plan.

    Returns:
        All steps, repeated static postures merged.
    """
    result: list[Step] = []
    posture = ""  # not known yet
    for step in steps:
        for one in _transitions_to(step, posture, result):
            result.append(one)
            posture = one.posture
    return merged(_styled(_falling_on(result)))


def _transitions_to(step: Step, posture: str, before: list[Step]) -> list[Step]:
    """The step as performed from a posture, after the transitions that it needs."""
    if step.lower in ("stand_up", "kneel_up", "get_up", "floor_rise"):
        return _rising(step, posture, before)
    if posture == "floor" and step.lower in ("raise_leg", "leg_aside") and not step.upper:
        return [replace(step, lower="lying_leg_raise", style=_lies_on(before))]
    if posture == "seat" and step.lower in _SEATED_FORMS and not (step.upper or step.direction == Shape.SPOT):
        style = "" if step.style == "held" else step.style
        return [replace(step, lower=_SEATED_FORMS[step.lower], style=style)]
    if posture in STILL and step.lower == "stand" and not step.on_feet:  # "sits down, stays for two seconds"
        return [replace(step, lower=STILL[posture])]
    if step.posture == "feet":
        return [*_rising_steps(posture, step), step] if step.lower not in FALLS else [step]
    return _going_down(step, posture, before)


def _rising(step: Step, posture: str, before: list[Step]) -> list[Step]:
    if posture in RISING:
        return [replace(step, lower=lower, seat="") for lower in RISING[posture]]
    if not before:
        return [step]
    if before[-1].lower in ("squat", "pick_up", "put_down", "bow", "bend", "lunge"):
        return []  # these end upright
    return [replace(step, lower="stand")]


def _going_down(step: Step, posture: str, before: list[Step]) -> list[Step]:
    """Sitting, kneeling, lying: stays in the posture, or goes down first."""
    anything_before = bool(before)
    if step.lower == "roll_over" and posture == "couch":
        step = replace(step, lower="roll_in_bed")
    if step.lower in ("recline", "lie_on_seat", "roll_in_bed", *FALLS_OFF) or (posture, step.posture) == (
        "couch",
        "seat",
    ):
        return _seat_transitions(step, posture, anything_before)
    if step.lower in LYING:
        is_there = posture == "floor" and LYING[step.lower] in ("", _lies_on(before))
        down = Step(lower="lie_down", style=LYING[step.lower] or "back", clause=step.clause)
        return [step] if is_there or not before else [*_rising_steps(posture, step), down, step]
    if posture == step.posture:
        if step.lower in ("sit_down", "kneel_down", "lie_down", "floor_sit_down", *FALLS):
            step = replace(step, lower=STILL[posture])
        return [step]
    first = _rising_steps(posture, step)
    if step.lower == "crawl":
        return [*first, Step(lower="kneel_down", clause=step.clause), step] if before else [step]
    if step.lower in SEATED:
        return [*first, Step(lower="sit_down", seat=step.seat, clause=step.clause), step] if before else [step]
    down = ENTERING.get(step.lower, step.lower)
    during = step.upper if step.lower in _WITH_FREE_HANDS and not _is_done_once(step) else ""
    if not anything_before and step.lower == down and step.upper and step.lower not in FALLS:
        return [replace(step, upper=during, count=0, seconds=0.0), replace(step, lower=STILL[step.posture])]
    if not anything_before:
        return [step]
    if step.upper:  # goes down, then does it there
        return [
            *first,
            replace(step, lower=down, upper=during, count=0, seconds=0.0),
            replace(step, lower=STILL[step.posture]),
        ]
    return [*first, replace(step, lower=down)]


def _lies_on(before: list[Step]) -> str:
    """Side on which a body on the floor lies: front | back | left | right."""
    for step in reversed(before):
        if LYING.get(step.lower):
            return LYING[step.lower]
        if step.lower in ("lie_down", *FALLS) or (step.lower == "lie" and step.style):
            return step.style or "back"
    return "back"


def _is_done_once(step: Step) -> bool:
    """Whether the hands' movement has a beginning and an end, so that it does not start while going down."""
    activity = BY_KEY[step.upper] if step.upper else None
    return activity is not None and (activity.once or activity.counted_s is not None)


def _seat_transitions(step: Step, posture: str, anything_before: bool) -> list[Step]:
    """Lying on furniture and falling off it, both from sitting; sitting up from lying."""
    if posture == "couch" and step.lower in ("recline", "lie_on_seat"):
        return [replace(step, lower="lie_on_seat")]
    if step.lower in ("roll_in_bed", "fall_out_of_bed") and posture == "couch":
        return [step]
    if step.lower == "fall_out_of_bed" and not anything_before:
        return [replace(step, lower="lie_on_seat", upper="", count=0, seconds=0.0), step]
    if step.lower in ("lie_on_seat", "roll_in_bed") and not anything_before:
        return [step]
    about = replace(step, upper="", count=0, seconds=0.0)
    entered = [replace(step, lower="recline")] if step.lower == "lie_on_seat" and not step.upper else [step]
    if step.lower in ("roll_in_bed", "fall_out_of_bed") or (step.lower == "lie_on_seat" and step.upper):
        entered = [replace(about, lower="recline"), step]
    if posture == "couch":
        up = replace(about, lower="sit_up")
        return (
            [up]
            if step.posture == "seat" and not step.upper
            else [up, replace(step, lower="sit")]
            if step.posture == "seat"
            else [up, step]
        )
    if posture == "seat":
        return entered
    sits = "sit" if not anything_before and step.lower == "fall_off" else "sit_down"
    return [*_rising_steps(posture, step), replace(about, lower=sits), *entered]


def _rising_steps(posture: str, step: Step) -> list[Step]:
    return [Step(lower=lower, clause=step.clause) for lower in RISING.get(posture, ())]


def _falling_on(steps: list[Step]) -> list[Step]:
    """A stumble with a fall continues in its direction, without coming upright first: `FALLING_ON`."""
    for k, (before, step) in enumerate(pairwise(steps)):
        if before.lower != "stumble" or step.lower != "fall" or before.style:
            continue
        on_front = step.style == "front" or "stumbl" in before.clause
        way = before.direction or (Way.FORWARDS if on_front else Way.BACKWARDS)
        says_how = bool(words_in(step.clause) & _WAYS_OF_FALLING) or step.style not in ("front", "back")
        if not says_how and way in _FALLS_ON:
            steps[k + 1] = step = replace(step, style=_FALLS_ON[way])
        if step.style == _FALLS_ON.get(way):
            steps[k] = replace(before, direction=way, style="" if before.seconds else FALLING_ON)
    return steps


def _styled(steps: list[Step]) -> list[Step]:
    """Lying on back or belly as the person went down; kneeling on the named knee."""
    style, foot, knee, crossed = "", "", "", ""
    for k, step in enumerate(steps):
        if step.lower in LYING:
            style = LYING[step.lower] or style or "back"
        if step.lower in ("lie_down", *FALLS, *FALLS_OFF) or (step.lower in ("lie", "get_up") and not style):
            style = step.style or "back"
        if step.posture == "knees":
            foot, knee = step.foot or foot, step.style or knee
        if step.lower in ("lie", "get_up", "lie_down", *FALLS, *FALLS_OFF, *LYING):
            steps[k] = replace(step, style=style)
        if step.posture == "ground":
            crossed = step.style or crossed
        if step.lower in ("floor_sit", "floor_rise"):
            steps[k] = replace(step, style=crossed)
        if step.lower in ("kneel", "kneel_up"):
            steps[k] = replace(step, foot=foot, style=knee)
        if step.lower in ("stand_up", "get_up", "kneel_up", "floor_rise"):
            style, foot, knee, crossed = "", "", "", ""
    return steps


def inherit_state(steps: list[Step]) -> list[Step]:
    """Resolves what a step takes over from earlier ones.

    'Walks back' returns if the person has walked before, goes on after a turn, else goes backwards; objects that were
    picked up are put down with the same hands.

    Args:
        steps: Steps of the plan, modified in place.
    """
    gone = False
    for k, step in enumerate(steps):
        if step.direction == Way.BACK and not gone and k and _ITS_PLACE.search(step.clause):  # not moved away
            steps[k] = replace(step, lower="stand", direction=None)
        elif step.direction == Way.BACK and not gone:  # "turns around and walks back" goes along the new heading
            turned = k > 0 and steps[k - 1].lower == "turn"
            steps[k] = replace(step, direction=Way.FORWARDS if turned else Way.BACKWARDS)
        gone = gone or step.moves
        lifted = next((one for one in reversed(steps[:k]) if one.lower == "pick_up"), None)
        if step.lower == "put_down" and not step.hand and lifted is not None:
            steps[k] = replace(step, hand=lifted.hand)
    return steps


def merged(steps: list[Step]) -> list[Step]:
    """Merges two equal static postures in a row, unless the second is a pause before the next movement.

    Args:
        steps: Steps in temporal order.
    """
    result: list[Step] = []
    for number, step in enumerate(steps, start=1):
        plain = (
            step.lower in ("sit", "stand", "kneel", "lie", "lie_on_seat", "floor_sit")
            and not step.upper
            and not step.seconds
            and not step.facing
            and not (number < len(steps) and _is_a_pause(step))
        )
        same = {
            "sit": ("sit", "sit_down"),
            "kneel": ("kneel", "kneel_down"),
            "floor_sit": ("floor_sit", "floor_sit_down"),
            "lie": ("lie", "lie_down", *FALLS, *FALLS_OFF),
            "lie_on_seat": ("lie_on_seat", "recline"),
        }.get(step.lower, (step.lower,))
        if not (plain and result and result[-1].lower in same and not result[-1].upper):
            result.append(step)
    return result


def repeat_pairs(steps: list[Step], most: int) -> list[Step]:
    """Repeats going down and up as often as the second is counted: 'sits down and stands up five times'.

    Args:
        steps: Steps in temporal order.
        most: Number of steps up to which pairs are repeated.
    """
    pairs = {
        "stand_up": "sit_down",
        "kneel_up": "kneel_down",
        "get_up": "lie_down",
        "floor_rise": "floor_sit_down",
        "sit_down": "stand_up",
    }
    result: list[Step] = []
    for number, step in enumerate(steps):
        result.append(step)
        is_pair = number > 0 and step.lower in pairs and steps[number - 1].lower == pairs[step.lower]
        if is_pair and step.count > 1 and len(steps) + 2 * step.count - 2 <= most:
            once = [replace(one, count=0) for one in (steps[number - 1], step)]
            result += once * (step.count - 1)
    return result


def _is_a_pause(step: Step) -> bool:
    """Whether a posture is a deliberate pause: 'pauses', 'lies there for a bit'."""
    return step.lower != "stand" and bool((STAYING | {"there"}) & {*step.clause.split()})
