"""Verifies coverage: every meaningful word of the sentence is shown by a final step, or reported.

The words are those of the original sentence, before rewriting; each is compared with the steps of its clause. Verbs
and directions need a step each: "jumps, then jumps again" is two.

Aligns the words of the original sentence with the clauses after rewriting.
"""

import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from difflib import SequenceMatcher
from itertools import groupby, pairwise
from pathlib import Path

from mmweaver.core.safe_files.safe_text import read_toml
from mmweaver.motion.language.activities import ACTIVITY_OF_LEMMA, BY_KEY, words_in
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
)
from mmweaver.motion.language.modifiers import OPPOSITE
from mmweaver.motion.language.plan import ClauseRecord, Shape, Side, Step, Way
from mmweaver.motion.language.postures import hand_of
from mmweaver.motion.language.verb_steps import SLIGHT_TURN_DEG
from mmweaver.motion.language.words import Word, correct_spelling, word_of

TOKEN = re.compile(r"[a-z]+(?:'[a-z]+)?|\d+(?:\.\d+)?|[,.;:_]+")
SEPARATORS = words_in(", . ; : and then while before after until")
_STEM = 4  # letters compared: "twists" and "twist"
_SMALL = SEPARATORS | words_in(
    "a an the to of in on at as for from by with into this that his her their its is are was he she it they person man"
)
_PAIRS = {("back", "forth"), ("up", "down"), ("to", "fro"), ("left", "right"), ("in", "out")}
_LINKS = SEPARATORS | words_in("afterwards next finally")
Records = Mapping[int, ClauseRecord]


def clause_of_each(tokens: list[str], records: Records) -> tuple[list[int], list[bool]]:
    """Assigns each token of the original sentence to a clause.

    Args:
        tokens: Tokens of the sentence, in lower case.
        records: Record of each clause by its number.

    Returns:
        Number of the clause of each token, and whether that clause still contains it after rewriting.
    """
    words = [(word, number) for number, record in sorted(records.items()) for word in record.clause.split()]
    words = [(word, number) for word, number in words if word not in _SMALL]
    places = [i for i, token in enumerate(tokens) if token not in _SMALL]
    stems = ([tokens[i][:_STEM] for i in places], [word[:_STEM] for word, _ in words])
    found: list[int | None] = [None] * len(tokens)
    for block in SequenceMatcher(None, *stems, autojunk=False).get_matching_blocks():
        for k in range(block.size):
            found[places[block.a + k]] = words[block.b + k][1]
    last = next((number for number in found if number is not None), min(records))
    numbers = []
    for i, number in enumerate(found):
        if number is None and tokens[i] in SEPARATORS:
            number = next((other for other in found[i:] if other is not None), last)
        last = last if number is None else number
        numbers.append(last)
    kept = [number is not None for number in found]
    for number, part in _wholly_rewritten(tokens, numbers, kept, records):
        for place in part:
            numbers[place] = number
    return numbers, kept


def _wholly_rewritten(
    tokens: list[str], numbers: list[int], kept: list[bool], records: Records
) -> list[tuple[int, list[int]]]:
    """Clauses without any original word, with the positions between two links that no other clause has."""
    parts: list[list[int]] = [[]]
    for place, token in enumerate(tokens):
        if token in _LINKS:
            parts.append([])
        else:
            parts[-1].append(place)
    free = [part for part in parts if part and not any(kept[place] for place in part)]
    gone = sorted({*records} - {number for number, is_kept in zip(numbers, kept, strict=True) if is_kept})
    return list(zip(gone, free, strict=True)) if len(gone) == len(free) else []


def given_words(text: str, records: Records) -> dict[int, str]:
    """The original words of each clause, whose record may hold what they were rewritten to.

    Args:
        text: The sentence.
        records: Record of each clause by its number.

    Returns:
        Words by clause number, joined by an ellipsis if not contiguous; "" for a clause added by rewriting.
    """
    found = list(TOKEN.finditer(text.lower()))
    tokens = [one[0] for one in found]
    for i in range(1, len(tokens)):  # "for a while" and "back and forth" link nothing
        is_pair = tokens[i] == "and" and tuple(tokens[i - 1 : i + 2 : 2]) in _PAIRS
        tokens[i] = "_" if is_pair or tokens[i - 1 : i + 1] == ["a", "while"] else tokens[i]
    numbers = _part_numbers(tokens, records) or clause_of_each(tokens, records)[0]
    words = {}
    for number in records:
        parts = []
        for own, places in groupby(range(len(tokens)), key=numbers.__getitem__):
            run = [*places] if own == number else []
            while run and tokens[run[0]] in _LINKS:
                del run[0]
            while run and tokens[run[-1]] in _LINKS:
                del run[-1]
            parts += [text[found[run[0]].start() : found[run[-1]].end()]] if run else []
        words[number] = " ... ".join(parts)
    return words


def _part_numbers(tokens: list[str], records: Records) -> list[int]:
    """Clause number of each token if the sentence has as many parts between links as clauses; else []."""
    numbers, part, is_open = [], -1, False
    for token in tokens:
        if token in _LINKS:
            is_open = False
        elif not is_open:
            part, is_open = part + 1, True
        numbers.append(max(part, 0))
    return [sorted(records)[number] for number in numbers] if part + 1 == len(records) else []


_TABLE = read_toml(Path(__file__).with_suffix(".toml"))
_SETS = {name: words_in(words) for name, words in _TABLE["words"].items()}
_OF_ACTIVITY = {key: words_in(words) for key, words in _TABLE["of_activity"].items()}
_SHOWN_BY = {word: (words_in(keys), *field) for words, keys, *field in _TABLE["shown_by"] for word in words.split()}
_ALIKE = [words_in(group) for group in _TABLE["alike"]]
_SILENT = frozenset().union(
    _SETS["silent"],
    _SHOWN_BY,
    ARMS,
    LEGS,
    DIRECTIONS,
    DISTANCES,
    LIGHT,
    MANNERS,
    MANY,
    NUMBERS,
    OWN,
    PRONOUNS,
    RADAR,
    SIZES,
    SPEEDS,
)
_LIMBS = ARMS | LEGS | words_in("palm forearm elbow shoulder hip ear eye cheek thigh heel wrist fist finger ankle toe")
_SIDE = re.compile(r"(left|right)(?:wards?)?")
# "to one's feet", lengths in feet and "right after that" name no limb and no side.
_NAMES_NO_LIMB = re.compile(
    r"\b(?:to|on|onto) (?:his|her|their|its|the|two|both)(?: (?:own|two))? feet\b"
    r"|\b(?:\d+|two|three|four|five|ten|few) feet\b|\bright (?:after|before|now|there)\b"
    r"|\bshoulders?[- ](?:width|height|level|high)\b"
)
_NO_MOVEMENT = re.compile(r"like|though|although|if|not|never|without|\w+n't")  # precedes comparisons and negations
_MANY_TIMES = 4  # slots of a step that paces
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
    steps: Sequence[Step]
    sentence: list[str]

    @property
    def word(self) -> Word:
        return word_of(self.text)

    def before(self, count: int) -> list[str]:
        return self.sentence[max(self.place - count, 0) : self.place]

    def after(self, count: int) -> list[str]:
        return self.sentence[self.place + 1 : self.place + 1 + count]

    def words_after(self, count: int) -> list[str]:
        """The next words, whatever marks stand between them: "a few, slow steps"."""
        return [text for text in self.after(count + 2) if text[0].isalnum()][:count]


def not_covered(
    text: str, steps: Sequence[Step], records: dict[int, ClauseRecord], approximated: set[int]
) -> list[tuple[int, str]]:
    """Finds what the steps do not show of a sentence.

    Args:
        text: The original sentence, in lower case.
        steps: Final steps, each hand separately (`Step.each`).
        records: Record of each clause by its number.
        approximated: Clauses whose record already reports an approximation.

    Returns:
        (Number of the clause, what is not shown) for each word that no step accounts for.
    """
    tokens = _tokens(text, steps, records)
    lost: list[tuple[int, str]] = []
    for token in tokens:
        is_replaced = token.clause in approximated
        checks = _OF_REPLACED if is_replaced and not token.is_kept else _CHECKS if is_replaced else (*_CHECKS, _noun)
        how = next(filter(None, (check(token) for check in checks)), "")
        lost += [(token.clause, how)] if how else []
    lost += [(after.clauses[0], f"{after.name} is shown after getting up") for after in _steps_after_rising(steps)]
    reported = {how for _, how in lost}
    for token in _unmatched_tokens(tokens, steps):
        if token.clause not in approximated and f"{token.text!r} is not shown" not in reported:
            lost.append((token.clause, f"{token.text!r} has no movement of its own"))
    return list(dict.fromkeys(lost))


def _steps_after_rising(steps: Sequence[Step]) -> Iterator[Step]:
    """Steps before which the body gets up only because the library performs them standing."""
    for before, after in pairwise(steps):
        on_feet = after.lower in ("walk", "jog", "turn", "sidestep", "leap", "stand") and not after.upper
        rises = before.lower in ("stand_up", "kneel_up", "get_up", "sit_up") and not before.clauses
        if rises and after.clauses and not on_feet:
            yield after


def _tokens(text: str, steps: Sequence[Step], records: dict[int, ClauseRecord]) -> list[_Token]:
    pairs = zip(text.split(), correct_spelling(text)[0].split(), strict=True)
    corrected = " ".join(old if old.rstrip("s,.;") == new.rstrip("s,.;") else new for old, new in pairs)
    texts = TOKEN.findall(_NAMES_NO_LIMB.sub(lambda found: "_" * len(found[0]), corrected))
    numbers, kept = clause_of_each(texts, records)
    rewritten = {*records} - {number for number, is_kept in zip(numbers, kept, strict=True) if is_kept}
    tokens, part = [], 0
    for place, one in enumerate(texts):
        part += one in SEPARATORS
        near = {numbers[place]} if kept[place] else {*numbers[place : place + 8], *rewritten}
        own = [step for step in steps if near & {*step.clauses}] or steps
        tokens.append(_Token(one, place, numbers[place], part, kept[place], own, steps, texts))
    return tokens


def _doing(step: Step) -> set[str]:
    """The activities of a step, without standing during a hand activity."""
    return {step.upper} if step.upper and step.lower == "stand" else {step.lower, step.upper} - {""}


def _limb_side(token: _Token) -> str:
    """Left or right of a hand or a leg."""
    following = token.after(3)
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


def _side(token: _Token) -> str:
    """A side as a direction."""
    side = _SIDE.fullmatch(token.text)
    if side is None or _LIMBS & {*token.after(2)}:
        return ""
    is_shown = any(_goes_aside(step) or {side[1], "both"} & {step.hand, step.foot} for step in token.own)
    return "" if is_shown else "the side is not shown"


def _goes(step: Step, way: str) -> bool:
    """Whether a step goes left, right, ahead or back, or moves the hand or foot of that side."""
    if way in ("back", "ahead") and step.lower == "sidestep":
        return False
    if way == "back":
        back = step.direction in (Way.BACKWARDS, Way.BACK, Shape.PACING, Way.AWAY) or step.style == "back"
        return back or step.place is not None or step.lower in ("lie", "lie_down", "fall", "turn")
    if way == "ahead":
        ahead = step.direction in (Way.FORWARDS, Way.TOWARDS) or step.facing == "towards" or step.lower == "turn"
        onward = step.lower in _SETS["gaits"] and step.direction not in (Side.LEFT, Side.RIGHT, Way.BACKWARDS, Way.BACK)
        return ahead or onward or bool(_doing(step) & _SHOWN_BY["forward"][0])
    to_both = {step.lower, step.upper} & _SETS["to_and_fro"] and not step.direction
    return bool(to_both or _goes_aside(step) or {way, "both"} & {step.hand, step.foot})


def _goes_aside(step: Step) -> bool:
    directed = step.moves or step.lower in ("turn", "stumble", "lean", "kick", "fall_off", "side_kick")
    sides = {step.direction if directed else "", step.style, step.facing}
    turns = (step.arc_deg or step.turn_deg) and not step.either_side
    placed = step.place is not None or step.target or (step.seat and step.moves)
    to_a_side = {step.lower, step.upper} & _SETS["sideways"] and not step.arms_ahead
    return bool(sides & {"left", "right", "side", "sideways", "seat"} or turns or placed or to_a_side)


def _number(token: _Token) -> str:
    """A number of repetitions or steps."""
    text, own = token.text, token.own
    following = [
        word_of(word) for word in token.words_after(3) if word not in SIZES | SPEEDS.keys() | {"left", "right"}
    ]
    is_count = any(word.is_activity or word.text in ("step", "steps", "times", "circles") for word in following[:2])
    is_vague = bool({"after", "later", "legged", "handed", "side"} & {*token.before(2), *token.after(3)})
    if text == "step" and {"a", "an", "one", "another", "single"} & {*token.before(3)}:
        going = [step for step in own if step.lower in _SETS["gaits"]]
        is_lost = bool(going) and not is_vague and not any(step.count for step in going)
        return "that it is one step is not kept" if is_lost else ""
    if text in TIMES or (text == "times" and token.place):
        return "" if any(map(_is_counted, own)) else "how often is not kept"
    is_count &= text != "some" or "steps" in token.words_after(2)
    if not is_count or is_vague or "".join(token.after(1)).startswith("deg"):
        return ""
    if text in _SETS["vague_numbers"]:
        return "" if any(step.count or step.lower in ("dance", "stairs") for step in own) else f"{text!r} is not kept"
    if not (text in NUMBERS or text.isdigit()):
        return ""
    kept = {0.0, 1.0, *(number for step in own for number in _numbers_of(step))}
    return "" if float(NUMBERS.get(text, text)) in kept else f"the number {text!r} is not kept"


def _is_counted(step: Step) -> bool:
    countable = any(BY_KEY[key].counted_s is not None for key in (step.upper or step.lower, step.lower))
    countable |= step.lower in ("sit_down", "stand_up", "kneel_up", "get_up")  # `postures.repeat_pairs`
    return bool((step.count and (countable or step.count == 1)) or max(abs(step.turn_deg), abs(step.arc_deg)) >= 360)


def _numbers_of(step: Step) -> Iterator[float]:
    angles = (abs(step.turn_deg), abs(step.arc_deg))
    yield from (float(step.count), step.seconds, step.distance_m, *angles)
    yield from (angle / whole for angle in angles for whole in (90.0, 180.0, 360.0))
    yield from () if step.place is None else (step.place.distance_m,)


def _turn(token: _Token) -> str:
    """Direction or angle of a turn."""
    text, own = token.text, token.own
    if text.endswith("clockwise"):
        counter = text != "clockwise" or {"counter", "anti", "against"} & {*token.before(2)}
        sign, side = (1.0, "left") if counter else (-1.0, "right")
        angles = [0.0 if step.either_side else step.arc_deg or step.turn_deg for step in own]
        turns = any(angle * sign > 0 for angle in angles)
        turns |= any((step.lower, step.direction) == ("turn", side) for step in own)
        return "" if turns or any(step.upper in _SETS["rounds"] for step in own) else f"{text!r} is not shown"
    if text in ("circle", "circles", "circular", "circularly"):
        return "" if any(map(_goes_round, own)) else "the circle is not shown"
    if text not in ("90", "180", "270", "360") and not (text.isdigit() and "".join(token.after(1)).startswith("deg")):
        return ""
    return "" if any(float(text) in _angles(step) for step in own) else f"'{text} degrees' is not shown"


def _goes_round(step: Step) -> bool:
    turns = step.arc_deg or step.turn_deg or step.lower in ("turn", "hula_hoop") or step.upper in _SETS["rounds"]
    return bool(turns or (step.direction == Shape.CIRCLE and step.moves))


def _angles(step: Step) -> set[float]:
    plain = 90.0 if isinstance(step.direction, Side) else 180.0
    return {abs(step.turn_deg), abs(step.arc_deg), plain if step.lower == "turn" else 0.0}


def _uses_both(step: Step) -> bool:
    """Whether both hands or both legs act."""
    if step.upper:
        return hand_of(step, step.upper) in ("both", "")
    in_turn = step.count > 1 and step.lower in ("lunge", "walking_lunge")
    on_both = step.posture == "knees" and step.style != "knee"
    return in_turn or on_both or step.lower not in _SETS["single_foot"]


# What shows a word in addition to the activities of its row in the table.
_BY_FIELD: dict[str, Callable[[Step], bool]] = {
    "ahead": lambda step: _goes(step, "ahead"),
    "back": lambda step: _goes(step, "back"),
    "aside": _goes_aside,
    "aimed": lambda step: bool(step.direction or step.target or step.facing or step.place or step.seat),
    "faces": lambda step: bool(step.facing) or step.lower == "turn",
    "wide": lambda step: step.style == "wide",
    "high": lambda step: step.style == "high",
    "up": lambda step: step.direction == Shape.PACING or step.style in ("high", "up"),
    "far": lambda step: bool(
        step.place or step.target or step.direction in (Shape.PACING, Shape.CIRCLE) or step.distance_m
    ),
    "elsewhere": lambda step: step.moves or step.lower == "turn" or bool(step.place or step.facing),
    "placed": lambda step: bool(step.place or step.target or step.direction == Way.TOWARDS),
    "round": lambda step: _goes_round(step) or step.direction in (Shape.PACING, Shape.AROUND),
    "lasts": lambda step: bool(step.moves or step.seconds or abs(step.turn_deg) == SLIGHT_TURN_DEG),
    "low": lambda step: step.lower != "stand",
    "off": lambda step: BY_KEY[step.lower].counted_s is not None,
    "hands": lambda step: bool(step.upper),
    "both": _uses_both,
}


def _way(token: _Token) -> str:
    """A part of the body or a direction."""
    text = token.text
    keys, *field = _SHOWN_BY.get(text, (frozenset(),))
    by_field = any(_BY_FIELD[name](step) for name in field for step in token.own)
    by_field |= any(text in _OF_ACTIVITY.get(key, ()) for step in token.own for key in _doing(step))
    if text not in _SHOWN_BY or by_field or any(_doing(step) & keys for step in token.own):
        return ""
    if text in _AHEAD and ARMS & {*token.before(1)} and any(step.upper == "arms_out" for step in token.own):
        return "" if any(step.arms_ahead for step in token.own) else f"{text!r} is not shown"
    before, after = token.before(2), token.after(3)
    in_front_of = before[-1:] == ["in"] and after[:1] == ["of"] and not any(step.upper for step in token.own)
    names_none = text in ("toward", "towards", "hand") and {"left", "right", "side"} & {*after}  # covered by the side
    rises = text == "up" and {word_of(word).lemma for word in before} & _SETS["rising"]
    return "" if in_front_of or names_none or rises else f"{text!r} is not shown"


def _verb(token: _Token) -> str:
    """A verb that no step is like."""
    activity = _activity(token)
    is_head = activity == "bow" and any(step.facing == "down" for step in token.own)
    is_shown = not activity or activity == "stand" or is_head or any(_is_like(step, activity) for step in token.own)
    return "" if is_shown else f"{token.text!r} is not shown"


def _activity(token: _Token) -> str:
    """The activity that a verb names, "" for other words and for nouns."""
    word, before = token.word, token.before(1)
    is_noun = token.text in _SETS["nouns"] or (
        word.form == "base" and before and before[0] not in _SETS["before_verbs"]
    )
    if token.text in _SHOWN_BY or not word.is_activity or is_noun:
        return ""
    return next(filter(None, reversed(ACTIVITY_OF_LEMMA[word.lemma])), "")


def _is_like(step: Step, activity: str) -> bool:
    return any(_alike(activity, key, step) for key in _doing(step))


def _alike(activity: str, key: str, step: Step | None = None) -> bool:
    """Whether one activity shows another, or what the grammar makes of it; with `step`, a bend or a look turns too."""
    bent = step is not None and bool(step.arc_deg or step.facing)
    round_about = activity in ("turn", "bend") and (bent or key in _SETS["rounds"] or key == "look_around")
    return round_about or activity == key or any(activity in group and key in group for group in _ALIKE)


def _manner(token: _Token) -> str:
    """An adverb, a size or a manner that changes no step."""
    text, own = token.text, token.own
    if text in ("repeatedly", "continuously", "constantly"):
        often = any(step.count > 1 or not BY_KEY[step.upper or step.lower].once for step in own) or len(own) > 1
        return "" if often else f"{text!r} is not shown"
    if text in SPEEDS and text.endswith(("ly", "fast", "quick", "slow")) and text not in _SETS["no_manner"]:
        return "" if any(step.speed == SPEEDS[text] for step in own) else f"{text!r} is not shown"
    sized = text in SIZES and _SETS["sized"] & {*token.words_after(3)} and not any(step.style == "high" for step in own)
    adverb = text.endswith("ly") and text not in FILLERS | _SETS["no_manner"] | _SHOWN_BY.keys()
    return f"{text!r} is not shown" if sized or adverb or text in MANNERS else ""


def _noun(token: _Token) -> str:
    """A thing or a place unrelated to any step: "on a tight rope"."""
    is_shown = token.text in _SILENT or not _is_opened(token) or any(_concerns(step, token.text) for step in token.own)
    return "" if is_shown else f"{token.text!r} is not shown"


def _is_opened(token: _Token) -> bool:
    """Whether a word belongs to a phrase opened by a determiner or preposition, between a verb and the next one."""
    before = [word_of(text) for text in token.before(token.place)]
    if not any(other.is_verb or other.is_going or other.text in ("is", "are", "plays") for other in before):
        return False  # the subject
    for other in reversed(before):
        if other.text in _SETS["opening"]:
            is_verb = (token.word.is_verb or token.word.is_going) and before[-1].text not in ("a", "an", "the")
            return not is_verb and re.search(r"[^a-z']|ly$|ing$", token.text) is None
        if other.text in SEPARATORS | _SETS["people"] or other.is_verb or other.is_going:
            return False
    return False


def _concerns(step: Step, noun: str) -> bool:
    keys = _doing(step)
    handled = bool(keys & _SETS["handling"])
    if any(noun in _OF_ACTIVITY.get(key, ()) for key in keys) or (noun in _SETS["carried"] and handled):
        return True
    if noun in _SETS["curves"] and (
        step.arc_deg or step.direction in (Shape.CIRCLE, Shape.AROUND) or step.lower == "turn"
    ):
        return True
    stem = noun.removesuffix("s")
    if step.place is not None and stem in re.findall("[a-z]+", step.place.words):
        return True
    placed = step.target or step.place is not None or step.seat or step.uses_seat or step.facing or handled
    is_named = any(word.startswith(stem[:4]) for key in keys for word in BY_KEY[key].name.split())
    return is_named or (noun in SEATS | TARGETS.keys() and bool(placed))


def _again(token: _Token) -> str:
    """A further repetition: 'then another one', '90 more'."""
    is_more = token.text == "another" or (token.text == "more" and not "".join(token.after(1)).endswith("ly"))
    keys = [key for step in token.steps for key in _doing(step)]
    often = len({*keys}) < len(keys) or any(step.count > 1 for step in token.own)
    return f"{token.text!r} is not shown" if is_more and not often else ""


def _back_to(token: _Token) -> str:
    """The way back to an earlier position."""
    after = token.after(4)
    if token.text != "back" or after[:1] not in (["to"], ["where"]) or _SETS["postures"] & {*after}:
        return ""
    here = next((i for i, step in enumerate(token.steps) if token.clause in step.clauses), 0)
    gone = [i for i, step in enumerate(token.steps[:here]) if step.moves]
    ways = {step.direction for step in token.steps[:here]}
    returns = any(
        _goes(step, "back") or step.target or step.seat or (step.direction and OPPOSITE.get(step.direction) in ways)
        for step in (*token.own, *token.steps[here:])
    )
    return "the way back is not shown" if gone and not returns else ""


def _order(token: _Token) -> str:
    """Temporal order with an ambiguous "after", and simultaneity."""
    order = [min(step.clauses) for step in token.steps if step.clauses]
    following = [word_of(text) for text in token.after(6)]
    in_turn = len(token.own) > 1 and token.own[-1].lower not in ("stumble", token.own[0].lower)
    if token.text == "during" and in_turn and any(word.is_activity for word in following[:3]):
        return "'during' is not shown"
    is_open = token.before(1) in (["and"], [","], ["then"]) or token.after(1) in ([","], [])
    two = sum(word.form == "ing" for word in following) > 1 and len(token.steps) > 2
    return (
        "the order of the movements is ambiguous"
        if token.text == "after" and order != sorted(order) and (is_open or two)
        else ""
    )


_OF_REPLACED = (_limb_side, _side, _number, _turn, _verb)
_CHECKS = (_limb_side, _side, _number, _turn, _again, _back_to, _order, _way, _verb, _manner)


def _unmatched_tokens(tokens: list[_Token], steps: Sequence[Step]) -> Iterator[_Token]:
    """Verbs and directions named more often than steps show them, by bipartite matching."""
    mentions = _distinct([(token, _movement(token), _way_named(token)) for token in tokens])
    slots: list[set[int]] = []
    for step in steps:
        ways = {i for i, (token, _, way) in enumerate(mentions) if way and step in token.own and _goes(step, way)}
        aside = {i for i in ways if mentions[i][2] in ("left", "right")}
        often = 1 if step.moves and step.lower not in ("hop", "hop_one_leg", "leap") else max(step.count, 1)
        for key in _doing(step):
            slots += [{i for i, (_, named, _) in enumerate(mentions) if named and _alike(named, key, step)}] * often
        to_and_fro = {step.lower, step.upper} & _SETS["to_and_fro"] or step.direction in (Shape.PACING, Shape.CIRCLE)
        slots += [aside, ways - aside] * (_MANY_TIMES if to_and_fro or step.count > 1 else 1)
        slots += [{i for i, (_, named, _) in enumerate(mentions) if named == "turn"}] * bool(step.arc_deg)
    taken: dict[int, int] = {}  # slot -> mention

    def takes(mention: int, tried: set[int]) -> bool:
        for k, fitting in enumerate(slots):
            if mention in fitting and k not in tried:
                tried.add(k)
                if k not in taken or takes(taken[k], tried):
                    taken[k] = mention
                    return True
        return False

    yield from (mentions[i][0] for i in range(len(mentions)) if not takes(i, set()))


def _distinct(mentions: list[tuple[_Token, str, str]]) -> list[tuple[_Token, str, str]]:
    """The mentions without those that only extend the previous one: "walks, walking slowly", "leans and reaches"."""
    found: list[tuple[_Token, str, str]] = []
    last: dict[bool, tuple[_Token, str, str]] = {}
    for mention in mentions:
        token, activity, way = mention
        if not (activity or way):
            continue
        before = last.get(bool(way))
        if before is not None:
            same_part = before[0].part == token.part or before[0].clause == token.clause
            same_verb = not way and _alike(before[1], activity) and (same_part or token.word.form == "ing")
            if same_verb or (way and before[2] == way and same_part):
                continue
            if f"{before[1]} {activity}" in _TABLE["one_movement"] and before in found:
                found.remove(before)
        last[bool(way)] = mention
        found.append(mention)
    return found


def _movement(token: _Token) -> str:
    """Activity named as a movement of its own, not compared with, negated or continued."""
    activity, before = _activity(token), token.before(2)
    is_prepared = before[-1:] and before[-1] in _SETS["before_nouns"]
    is_none = any(map(_NO_MOVEMENT.fullmatch, before)) or _SETS["going_on"] & {*before}
    return "" if activity in _SETS["not_counted"] or is_none or is_prepared else activity


def _way_named(token: _Token) -> str:
    """left | right | ahead | back for a word that states a direction of motion, else ""."""
    before, after, side = token.before(3), token.after(3), _SIDE.fullmatch(token.text)
    last, following = "".join(before[-1:]), "".join(after[:1])
    if side is not None:
        is_pair = "and" in (last, following) or "from" in before or (following == "to" and _SIDE.fullmatch(after[-1]))
        return "" if is_pair or _LIMBS & {*after[:2]} or {"face", "faces"} & {*before} else side[1]
    if token.text in _AHEAD:
        return "" if last in ARMS or (following == "and" and {*after} & _BACK) else "ahead"
    is_side = following in ("left", "right")
    is_way = is_side or (last not in _SETS["before_back"] and following not in _SETS["after_back"])
    is_way &= token.text in _BACK
    return "back" if is_way and not (last == "and" and {*before} & _AHEAD) else ""
