"""One check of honesty: every word of the sentence that says what is seen is shown by a final step, or reported.

The words are those of the sentence as it was given, whatever rewriting has made of them; each is compared with the
steps of the clause that it stands in. Verbs and ways need a step of their own: "jumps, then jumps again" is two.
"""

import re
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path

from mmweaver.core.safe_files.safe_text import read_toml
from mmweaver.motion.language.activities import ACTIVITY_OF_LEMMA, BY_KEY, words_in
from mmweaver.motion.language.alignment import SEPARATORS, TOKEN, clause_of_each
from mmweaver.motion.language.lexicon import (
    ARMS,
    DIRECTIONS,
    DISTANCES,
    FILLERS,
    LEGS,
    LIGHT,
    MANNERS,
    MANY,
    NUMBERS,
    OWN,
    PRONOUNS,
    RADAR,
    SEATS,
    SIZES,
    SPEEDS,
    TARGETS,
    TIMES,
)  # fmt: skip
from mmweaver.motion.language.plan import ClauseRecord, Step
from mmweaver.motion.language.spelling import correct_spelling
from mmweaver.motion.language.step_names import hand_of
from mmweaver.motion.language.words import Word, word_of

_TABLE = read_toml(Path(__file__).with_suffix(".toml"))
_SETS = {name: words_in(words) for name, words in _TABLE["words"].items()}
_OF_ACTIVITY = {key: words_in(words) for key, words in _TABLE["of_activity"].items()}
_SHOWN_BY = {word: words_in(keys) for words, keys in _TABLE["shown_by"] for word in words.split()}
_ALIKE = [words_in(group) for group in _TABLE["alike"]]
_SILENT = frozenset().union(
    _SETS["silent"], _SHOWN_BY, ARMS, LEGS, DIRECTIONS, DISTANCES, LIGHT, MANNERS, MANY, NUMBERS, OWN, PRONOUNS, RADAR,
    SIZES, SPEEDS,
)  # fmt: skip
_LIMBS = ARMS | LEGS | words_in("palm forearm elbow shoulder hip ear eye cheek thigh heel wrist fist finger ankle toe")
_SIDE = re.compile(r"(left|right)(?:wards?)?")
# Getting to one's feet, lengths in feet and "right after that" name no limb and no side.
_NAMES_NO_LIMB = re.compile(
    r"\b(?:to|on|onto) (?:his|her|their|its|the|two|both)(?: (?:own|two))? feet\b"
    r"|\b(?:\d+|two|three|four|five|ten|few) feet\b|\bright (?:after|before|now|there)\b"
    r"|\bshoulders?[- ](?:width|height|level|high)\b"
)
_COMPARED, _DENIED = words_in("like though although if"), re.compile(r"not|never|without|\w+n't")
_TO_AND_FRO = words_in("swipe stumble stagger twist shake_head look_around hips dance wave sweep vacuum wipe lean")
_MANY_TIMES = 4  # slots of a step that goes to and fro
_AHEAD, _BACK = words_in("forward forwards ahead"), words_in("backward backwards back")


@dataclass(frozen=True)
class _Token:
    """One word of the sentence: its place, the number of its clause, the steps that may show it."""

    text: str
    place: int
    clause: int
    part: int  # between two connectives
    is_kept: bool  # whether its clause still has it after rewriting
    own: Sequence[Step]

    @property
    def word(self) -> Word:
        return word_of(self.text)


def not_covered(
    text: str, steps: Sequence[Step], records: dict[int, ClauseRecord], approximated: set[int]
) -> list[tuple[int, str]]:
    """What the steps do not show of a sentence.

    Args:
        text: the sentence as it was given, in lower case.
        steps: the final steps, each hand by itself (`Step.each`).
        records: the record of each clause by its number.
        approximated: clauses whose record says already that something else is shown.

    Returns:
        (number of the clause, what is not shown) of each word that no step accounts for.
    """
    tokens = _tokens(text, steps, records)
    lost = []
    for token in tokens:
        replaced = token.clause in approximated
        checks = _OF_REPLACED if replaced and not token.is_kept else _CHECKS
        for check in checks:
            if not (replaced and check is _noun) and (how := check(tokens, token)):
                lost.append((token.clause, how))
                break
    lost += [(after.clauses[0], f"{after.name} is shown after getting up") for after in _after_rising(steps)]
    reported = {how for _, how in lost}
    for token in _without_own_step(tokens, steps):
        how = f"{token.text!r} has no movement of its own"
        if token.clause not in approximated and f"{token.text!r} is not shown" not in reported:
            lost.append((token.clause, how))
    return list(dict.fromkeys(lost))


def _after_rising(steps: Sequence[Step]) -> Iterator[Step]:
    """Steps before which somebody gets up only because the library does the movement standing."""
    for before, after in pairwise(steps):
        on_feet = after.lower in ("walk", "jog", "turn", "sidestep", "leap", "stand") and not after.upper
        rises = before.lower in ("stand_up", "kneel_up", "get_up", "sit_up") and not before.clauses
        if rises and after.clauses and not on_feet:
            yield after


def _tokens(text: str, steps: Sequence[Step], records: dict[int, ClauseRecord]) -> list[_Token]:
    folded = _NAMES_NO_LIMB.sub(lambda found: "_" * len(found[0]), " ".join(_corrected(text).split()))
    texts = TOKEN.findall(folded)
    numbers, kept = clause_of_each(texts, records)
    rewritten = {*records} - {number for number, is_kept in zip(numbers, kept, strict=True) if is_kept}
    tokens, part = [], 0
    for place, one in enumerate(texts):
        part += one in SEPARATORS
        near = {numbers[place]} if kept[place] else {*numbers[place : place + 8], *rewritten}
        own = [step for step in steps if near & {*step.clauses}] or steps
        tokens.append(_Token(one, place, numbers[place], part, kept[place], own))
    return tokens


def _corrected(text: str) -> str:
    """The text with misspellings corrected; a plural stays one."""
    pairs = zip(text.split(), correct_spelling(text)[0].split(), strict=True)
    return " ".join(old if old.rstrip("s,.;") == new.rstrip("s,.;") else new for old, new in pairs)


def _texts(tokens: list[_Token], start: int, end: int) -> list[str]:
    return [token.text for token in tokens[max(start, 0) : max(end, 0)]]


def _limb_side(tokens: list[_Token], token: _Token) -> str:
    """Left or right of a hand or a leg."""
    following = _texts(tokens, token.place + 1, token.place + 4)
    limb = next((text for text in following[:2] if text in ARMS | LEGS), "")
    if token.text not in ("left", "right") or not limb or "side" in following:
        return ""
    is_shown = any(_moves_limb(step, token.text, is_hand=limb in ARMS) for step in token.own)
    return "" if is_shown else "which hand or foot it is is not shown"


def _moves_limb(step: Step, side: str, *, is_hand: bool) -> bool:
    if is_hand:
        with_hand = (step.upper and step.upper not in _SETS["no_single_hand"]) or step.lower in ("pick_up", "put_down")
        return bool(with_hand and step.hand in (side, "both")) or (step.lower == "limb_extension" and step.foot == side)
    other_leg = step.lower == "one_leg" and bool(step.foot)  # "raises the left leg and holds it"
    return other_leg or (step.foot == side and step.lower in _SETS["single_foot"])


def _side(tokens: list[_Token], token: _Token) -> str:
    """A side that something goes to."""
    side = _SIDE.fullmatch(token.text)
    if side is None or _LIMBS & {*_texts(tokens, token.place + 1, token.place + 3)}:
        return ""
    is_shown = any(goes_aside(step) or side[1] in (step.hand, step.foot) or "both" in (step.hand, step.foot)
                   for step in token.own)  # fmt: skip
    return "" if is_shown else "the side is not shown"


def goes_aside(step: Step) -> bool:
    """Whether a step goes, turns, looks or is done to one side."""
    directed = step.moves or step.lower in ("turn", "stumble", "lean", "kick", "fall_off", "side_kick")
    sides = {step.direction if directed else "", step.style, step.facing}
    turns = (step.arc_deg or step.turn_deg) and step.style != "either"
    placed = step.place is not None or step.target or (step.seat and step.moves)
    to_a_side = {step.lower, step.upper} & _SETS["sideways"] and not step.arms_ahead
    return bool(sides & {"left", "right", "side", "seat"} or turns or placed or to_a_side)


def _number(tokens: list[_Token], token: _Token) -> str:
    """How often something is done, or with how many steps."""
    text = token.text
    following = [
        word for word in tokens[token.place + 1 : token.place + 4] if word.text not in SIZES | {"left", "right"}
    ]
    counts = [word.text for word in following[:2] if word.word.is_activity or word.text in ("step", "steps", "times")]
    vague = {"after", "later", "legged", "handed", "side"} & {*_texts(tokens, token.place - 2, token.place + 4)}
    if text in _SETS["vague_numbers"]:
        is_lost = bool(counts) and not vague and not any(step.count or step.lower == "dance" for step in token.own)
        return f"{text!r} is not kept" if is_lost else ""
    if (
        text == "step"
        and not vague
        and {"a", "an", "one", "another", "single"} & {*_texts(tokens, token.place - 3, token.place)}
    ):
        going = [step for step in token.own if step.lower in _SETS["gaits"]]
        return "that it is one step is not kept" if going and not any(step.count for step in going) else ""
    if text in TIMES or (text == "times" and token.place):
        return "" if any(map(_is_counted, token.own)) else "how often is not kept"
    of_degrees = "".join(word.text for word in following[:1]).startswith("deg")
    if not (text in NUMBERS or text.isdigit()) or not counts or vague or of_degrees:
        return ""
    kept = {0.0, 1.0, *(number for step in token.own for number in _numbers_of(step))}
    return "" if float(NUMBERS.get(text, text)) in kept else f"the number {text!r} is not kept"


def _is_counted(step: Step) -> bool:
    """Whether it is done as often as the sentence says."""
    countable = any(BY_KEY[key].counted_s is not None for key in (step.upper or step.lower, step.lower))
    return bool((step.count and (countable or step.count == 1)) or max(abs(step.turn_deg), abs(step.arc_deg)) >= 360)


def _numbers_of(step: Step) -> Iterator[float]:
    angles = (abs(step.turn_deg), abs(step.arc_deg))
    yield from (float(step.count), step.seconds, step.distance_m, *angles)
    yield from (angle / whole for angle in angles for whole in (90.0, 180.0, 360.0))
    yield from () if step.place is None else (step.place.distance_m,)


def _turn(tokens: list[_Token], token: _Token) -> str:
    """Which way round, or by which angle."""
    text, own = token.text, token.own
    if text.endswith("clockwise"):
        counter = text != "clockwise" or {"counter", "anti", "against"} & {
            *_texts(tokens, token.place - 2, token.place)
        }
        sign, side = (1.0, "left") if counter else (-1.0, "right")
        turns = any(
            (step.arc_deg or step.turn_deg) * sign > 0 or (step.lower == "turn" and step.direction == side)
            for step in own
        )
        round_about = any(step.upper in _SETS["rounds"] for step in own)
        return "" if turns or round_about else f"{text!r} is not shown"
    if text in ("circle", "circles", "circular", "circularly"):
        return "" if any(map(_goes_round, own)) else "the circle is not shown"
    of_degrees = "".join(_texts(tokens, token.place + 1, token.place + 2)).startswith("deg")
    if text not in ("90", "180", "270", "360") and not (text.isdigit() and of_degrees):
        return ""
    return "" if any(float(text) in _angles(step) for step in own) else f"'{text} degrees' is not shown"


def _goes_round(step: Step) -> bool:
    turns = step.arc_deg or step.turn_deg or step.lower in ("turn", "hula_hoop") or step.upper in _SETS["rounds"]
    return bool(turns or (step.direction == "circle" and step.moves))


def _angles(step: Step) -> set[float]:
    """The angles that a step turns or bends by."""
    plain = 90.0 if step.direction in ("left", "right") else 180.0
    return {abs(step.turn_deg), abs(step.arc_deg), plain if step.lower == "turn" else 0.0}


def goes_back(step: Step) -> bool:
    back = step.direction in ("backwards", "back", "pacing", "away") or step.style == "back"
    return back or step.place is not None or step.lower in ("lie", "lie_down", "fall", "turn")


def _goes_ahead(step: Step) -> bool:
    ahead = step.direction in ("forwards", "towards") or step.facing == "towards" or step.lower == "turn"
    return ahead or (step.lower in _SETS["gaits"] and step.direction not in ("left", "right", "backwards", "back"))


_ALSO: dict[str, Callable[[Step], bool]] = {
    **dict.fromkeys(("forward", "forwards", "front", "ahead"), _goes_ahead),
    **dict.fromkeys(("backward", "backwards"), goes_back),
    **dict.fromkeys(("diagonal", "diagonally", "sideways", "laterally", "lateral"), goes_aside),
    **dict.fromkeys(("face", "facing", "faces"), lambda step: bool(step.facing) or step.lower == "turn"),
    **dict.fromkeys(("toward", "towards"), lambda s: bool(s.direction or s.target or s.facing or s.place or s.seat)),
    **dict.fromkeys(("apart", "outward", "outwards", "wide"), lambda step: step.style == "wide"),
    **dict.fromkeys(("high", "higher"), lambda step: step.style == "high"),
    **dict.fromkeys(("up", "upward", "upwards"), lambda s: s.direction == "pacing" or s.style in ("high", "up")),
    **dict.fromkeys(("hand", "hands", "arm", "arms", "fist", "fists"), lambda step: bool(step.upper)),
    "above": lambda step: step.style == "high",
    **dict.fromkeys(("across", "through"), lambda step: step.moves),
    **dict.fromkeys(("behind", "between"), lambda s: s.moves or s.lower == "turn" or bool(s.place or s.facing)),
    "both": lambda step: not step.upper or hand_of(step, step.upper) in ("both", ""),
}  # fmt: skip


def _way(tokens: list[_Token], token: _Token) -> str:
    """A part of the body or a way."""
    text = token.text
    if text not in _SHOWN_BY or any(_doing(step) & _SHOWN_BY[text] for step in token.own):
        return ""
    if text in _ALSO and any(map(_ALSO[text], token.own)):
        return ""
    before, after = _texts(tokens, token.place - 2, token.place), _texts(tokens, token.place + 1, token.place + 4)
    in_front_of = before[-1:] == ["in"] and after[:1] == ["of"] and not any(step.upper for step in token.own)
    aims = text in ("toward", "towards") and {"left", "right"} & {*after}
    of_a_side = text == "hand" and "side" in after
    rises = text == "up" and {word_of(word).lemma for word in before} & _SETS["rising"]
    return "" if in_front_of or aims or rises or of_a_side else f"{text!r} is not shown"


def _doing(step: Step) -> set[str]:
    """The activities of a step, without the standing during an activity of the hands."""
    return {step.upper} if step.upper and step.lower == "stand" else {step.lower, step.upper} - {""}


def _verb(tokens: list[_Token], token: _Token) -> str:
    """A verb that no step is like."""
    activity = _activity(tokens, token)
    is_head = activity == "bow" and any(step.facing == "down" for step in token.own)
    is_shown = not activity or activity == "stand" or is_head or any(_is_like(step, activity) for step in token.own)
    return "" if is_shown else f"{token.text!r} is not shown"


def _activity(tokens: list[_Token], token: _Token) -> str:
    """The activity that a verb names, "" for other words and for nouns."""
    word, before = token.word, _texts(tokens, token.place - 1, token.place)
    is_noun = token.text in _SETS["nouns"] or (word.form == "base" and before and before[0] not in ("and", "then"))
    if token.text in _SHOWN_BY or not word.is_activity or is_noun:
        return ""
    lower, upper = ACTIVITY_OF_LEMMA[word.lemma]
    return upper or lower


def alike(activity: str, key: str, step: Step | None = None) -> bool:
    """Whether one activity shows another, or what the grammar makes of it; `step`: a path or a look turns, too."""
    bent = step is not None and bool(step.arc_deg or step.facing)
    round_about = activity in ("turn", "bend") and (bent or key in _SETS["rounds"] or key == "look_around")
    return round_about or activity == key or any(activity in group and key in group for group in _ALIKE)


def _is_like(step: Step, activity: str) -> bool:
    return any(alike(activity, key, step) for key in _doing(step))


def _manner(tokens: list[_Token], token: _Token) -> str:
    """An adverb, a size or a manner that changes no step."""
    text, own = token.text, token.own
    if text in ("repeatedly", "continuously", "constantly"):
        often = any(step.count > 1 or not BY_KEY[step.upper or step.lower].once for step in own) or len(own) > 1
        return "" if often else f"{text!r} is not shown"
    if text in SPEEDS and text.endswith(("ly", "fast", "quick", "slow")) and text not in _SETS["no_manner"]:
        return "" if any(step.speed == SPEEDS[text] for step in own) else f"{text!r} is not shown"
    following = _texts(tokens, token.place + 1, token.place + 4)
    sized = text in SIZES and _SETS["sized"] & {*following} and not any(step.style == "high" for step in own)
    adverb = text.endswith("ly") and text not in FILLERS | _SETS["no_manner"] and text not in _ALSO
    return f"{text!r} is not shown" if sized or adverb or text in MANNERS else ""


def _noun(tokens: list[_Token], token: _Token) -> str:
    """A thing or a place that no step has to do with: "on a tight rope"."""
    if token.text in _SILENT or not _is_opened(tokens, token):
        return ""
    return "" if any(_has_to_do_with(step, token.text) for step in token.own) else f"{token.text!r} is not shown"


def _is_opened(tokens: list[_Token], token: _Token) -> bool:
    """Whether a word belongs to what a determiner or a preposition opens, after a verb and before the next one."""
    before = tokens[: token.place]
    if not any(other.word.is_verb or other.word.is_going or other.text in ("is", "are", "plays") for other in before):
        return False  # whoever does it
    for other in reversed(before):
        if other.text in _SETS["opening"]:
            is_verb = (token.word.is_verb or token.word.is_going) and before[-1].text not in ("a", "an", "the")
            return not is_verb and re.search(r"[^a-z']|ly$|ing$", token.text) is None
        if other.text in SEPARATORS | _SETS["people"] or other.word.is_verb or other.word.is_going:
            return False
    return False


def _has_to_do_with(step: Step, text: str) -> bool:
    keys = _doing(step)
    if any(text in _OF_ACTIVITY.get(key, ()) for key in keys) or (
        text in _SETS["carried"] and keys & _SETS["handling"]
    ):
        return True
    if text in _SETS["curves"] and (step.arc_deg or step.direction in ("circle", "around") or step.lower == "turn"):
        return True
    names = " ".join(BY_KEY[key].name for key in keys).split()
    placed = step.target or step.place is not None or step.seat or step.uses_seat or step.facing
    of_place = step.place is not None and text.removesuffix("s") in re.findall("[a-z]+", step.place.words)
    is_named = any(name.startswith(text.removesuffix("s")[:4]) for name in names)
    return of_place or is_named or (text in SEATS | TARGETS.keys() and bool(placed or keys & _SETS["handling"]))


_OF_REPLACED = (_limb_side, _side, _number, _turn, _verb)
_CHECKS = (_limb_side, _side, _number, _turn, _way, _verb, _manner, _noun)


def _without_own_step(tokens: list[_Token], steps: Sequence[Step]) -> Iterator[_Token]:
    """Verbs and ways that are named more often than steps show them."""
    mentions = [(token, _activity_of_own(tokens, token), _way_of(tokens, token)) for token in tokens]
    mentions = _distinct([mention for mention in mentions if mention[1] or mention[2]])
    slots: list[set[int]] = []
    for step in steps:
        named = range(len(mentions))
        ways = {i for i in named if mentions[i][2] and step in mentions[i][0].own and _goes(step, mentions[i][2])}
        aside = {i for i in ways if mentions[i][2] in ("left", "right")}
        moves = step.moves and step.lower not in ("hop", "hop_one_leg", "leap")
        for key in _doing(step):
            verbs = {i for i in named if mentions[i][1] and alike(mentions[i][1], key, step)}
            slots += [verbs] * (1 if moves else max(step.count, 1))
        to_and_fro = {step.lower, step.upper} & _TO_AND_FRO or step.count > 1 or step.direction in ("pacing", "circle")
        slots += [aside, ways - aside] * (_MANY_TIMES if to_and_fro else 1)
        slots += [{i for i in named if mentions[i][1] == "turn"}] * bool(step.arc_deg)
    matched = _matched(len(mentions), slots)
    yield from (mentions[i][0] for i in range(len(mentions)) if i not in matched)


_Mention = tuple[_Token, str, str]  # token, the activity or "", the way or ""


def _distinct(mentions: list[_Mention]) -> list[_Mention]:
    """The mentions without those that only say more of the one before: "walks, walking slowly", "leans and reaches"."""
    found: list[_Mention] = []
    last: dict[bool, _Mention] = {}
    for mention in mentions:
        token, activity, way = mention
        before = last.get(bool(way))
        if before is not None:
            same_part = before[0].part == token.part or before[0].clause == token.clause
            again = before[2] == way if way else alike(before[1], activity) and (same_part or token.word.form == "ing")
            begins = f"{before[1]} {activity}" in _TABLE["one_movement"]
            if again and (same_part or not way):
                continue
            if begins and before in found:
                found.remove(before)
        last[bool(way)] = mention
        found.append(mention)
    return found


def _activity_of_own(tokens: list[_Token], token: _Token) -> str:
    """The activity that a word names as a movement by itself, not what is compared with, denied or goes on."""
    activity, before = _activity(tokens, token), _texts(tokens, token.place - 2, token.place)
    in_part = [one.text for one in tokens[: token.place] if one.part == token.part]
    is_no_movement = _COMPARED & {*in_part} or any(_DENIED.fullmatch(text) for text in before)
    prepared = before[-1:] and before[-1] in _SETS["before_nouns"]
    goes_on = _SETS["going_on"] & {*before}
    return "" if activity in _SETS["not_counted"] or is_no_movement or goes_on or prepared else activity


def _way_of(tokens: list[_Token], token: _Token) -> str:
    """left | right | ahead | back of a word that says which way somebody goes, else ""."""
    before, after = _texts(tokens, token.place - 3, token.place), _texts(tokens, token.place + 1, token.place + 4)
    side, last = _SIDE.fullmatch(token.text), before[-1:]
    if side is not None:
        pair = (
            after[:1] == ["and"]
            or last == ["and"]
            or "from" in before
            or (after[:1] == ["to"] and _SIDE.fullmatch(after[-1]))
        )
        return "" if pair or _LIMBS & {*after[:2]} or {"face", "faces"} & {*before} else side[1]
    if token.text in _AHEAD:
        return "" if (last and last[0] in ARMS) or (after[:1] == ["and"] and {*after} & _BACK) else "ahead"
    if token.text in _BACK:
        is_noun = last and last[0] in _SETS["before_back"]
        return (
            ""
            if is_noun or (after and after[0] in _SETS["after_back"]) or (last == ["and"] and {*before} & _AHEAD)
            else "back"
        )
    return ""


def _goes(step: Step, way: str) -> bool:
    if way in ("left", "right"):
        both = {step.lower, step.upper} & _TO_AND_FRO and not step.direction
        return bool(both or goes_aside(step) or {way, "both"} & {step.hand, step.foot})
    return goes_back(step) if way == "back" else _goes_ahead(step) or bool(_doing(step) & _SHOWN_BY["forward"])


def _matched(mentions: int, slots: list[set[int]]) -> set[int]:
    """As many mentions as can be shown at all, each slot by one (bipartite matching)."""
    taken: dict[int, int] = {}  # slot -> mention

    def takes(mention: int, tried: set[int]) -> bool:
        for k, fitting in enumerate(slots):
            if mention in fitting and k not in tried:
                tried.add(k)
                if k not in taken or takes(taken[k], tried):
                    taken[k] = mention
                    return True
        return False

    for mention in range(mentions):
        takes(mention, set())
    return set(taken.values())
