"""Every word of the sentence that says what is seen is shown by a step of its clause, or it is named as not shown.

`coverage` and `mentions` look for what the grammar is known to lose. Here it is the other way round: the words of the
sentence as it was given (verbs, parts of the body, ways, sides, numbers, manners) are checked against the steps of the
clause that they stand in, whatever patterns have made of it, and a word that no step accounts for is named.
"""

import re
from collections.abc import Callable, Sequence
from difflib import SequenceMatcher
from itertools import groupby

from mmweaver.motion.language.activities import BY_KEY
from mmweaver.motion.language.coverage import goes_aside
from mmweaver.motion.language.lexicon import ARMS, FILLERS, SPEEDS
from mmweaver.motion.language.plan import ClauseRecord, Step
from mmweaver.motion.language.verb_steps import LEGS
from mmweaver.motion.language.verbs import ACTIVITY_OF_LEMMA, words_in
from mmweaver.motion.language.words import word_of

TOKEN = re.compile(r"[a-z]+(?:'[a-z]+)?|\d+(?:\.\d+)?|[,.;:_]+")
_STEM = 4  # letters by which words are aligned: "twists" and "twist"
_SMALL = words_in(
    """
    a an the and then to of in on at as for from by with into while this that his her their its is are was he she it
    they person man , . ; :
    """
)
_CONNECTIVES = words_in(", . ; : and then while before after until")
_PAIRS = {("back", "forth"), ("up", "down"), ("to", "fro"), ("left", "right"), ("in", "out")}
_LINKS = _CONNECTIVES | words_in("afterwards next finally")
_UNDERFOOT = "walk jog sidestep limp stagger crawl leap stumble"
_ON_FEET = words_in(_UNDERFOOT)
_LIFTED = "raise raise_hold hands_up arm_extension"

# (words, activities that show what the words say): what is done with a part of the body, or which way.
SHOWN_BY: tuple[tuple[str, str], ...] = (
    (
        "leg legs foot feet knee knees thigh thighs ankle ankles shin shins heel heels toe toes tiptoe tiptoes",
        """
        kick stomp raise_leg one_leg hop_one_leg lunge side_lunge limb_extension kneel kneel_down kneel_up squat crouch
        march limp tree_pose warrior_pose downward_dog stairs crawl push_ups sit_ups jump leap hop jumping_jacks bend
        pedal roundhouse side_kick walking_lunge
        """,
    ),
    (
        "neck chin forehead nose ear ears cheek mouth face eye eyes",
        "nod shake_head look_around drink eat phone brush_teeth comb yawn cough",
    ),
    ("elbow elbows", "knock_elbow plank"),
    ("shoulder shoulders", "shrug arm_circles arms_out look_around stumble"),
    ("hip hips waist pelvis", "hips twist dance lean hula_hoop"),
    (
        "torso trunk chest stomach belly sternum breast",
        """
        twist lean bend bow hips dance golf cross_arms carry push push_hand pull_hand breathe cough yawn lie lie_down
        lie_on_seat recline fall get_up push_ups sit_ups plank crawl stumble raise_leg
        """,
    ),
    (
        "together",
        "clap jump leap hop jumping_jacks wipe",
    ),
    ("apart outward outwards wide", "arms_out jumping_jacks side_lunge arm_extension limb_extension stretch"),
    (
        "up upward upwards upright",
        f"""
        stand_up get_up kneel_up sit_up raise_leg jump leap hop hop_one_leg stairs pick_up stretch jumping_jacks carry
        stand sit march push_ups one_leg knock_elbow draw_circle draw_z reach jacket_off wave {_LIFTED} {_UNDERFOOT}
        sit_ups arm_circles breathe yawn kick look_around lower_arm swipe
        """,
    ),
    (
        "down downward downwards",
        f"""
        sit_down lie lie_down kneel kneel_down crouch squat bend bow put_down lower_arm fall fall_off recline
        lie_on_seat lunge stairs pick_up jump leap hop hop_one_leg jumping_jacks raise_leg raise stomp downward_dog
        push_ups sit_ups sit raise knock_elbow arm_extension stand dance look_around type write swipe {_UNDERFOOT}
        """,
    ),
    (
        "forward forwards front ahead",
        """
        kick punch jab cross hook uppercut push throw reach lunge bend bow fall point push_hand golf forehand backhand
        forward_roll roundhouse carry open_door knock wipe sweep vacuum
        """,
    ),
    ("high higher", f"kick roundhouse side_kick stretch crouch jumping_jacks {_LIFTED}"),
    ("low lower", "crouch squat bend bow lower_arm lunge"),
    ("diagonal diagonally sideways laterally", ""),
    ("toward towards", "reach turn point push"),
)  # fmt: skip
_SHOWN_BY: dict[str, frozenset[str]] = {word: words_in(keys) for words, keys in SHOWN_BY for word in words.split()}
_ALSO: dict[str, Callable[[Step], bool]] = {
    **dict.fromkeys(
        ("forward", "forwards", "front", "ahead"),
        lambda step: (
            step.direction in ("forwards", "towards")
            or step.facing == "towards"
            or step.lower == "turn"
            or (step.lower in _ON_FEET and step.direction not in ("left", "right", "backwards", "back"))
        ),
    ),
    **dict.fromkeys(("diagonal", "diagonally", "sideways", "laterally"), goes_aside),
    "face": lambda step: bool(step.facing) or step.lower == "turn",
    **dict.fromkeys(
        ("toward", "towards"), lambda step: bool(step.direction or step.target or step.facing or step.place)
    ),
    **dict.fromkeys(("apart", "outward", "outwards", "wide"), lambda step: step.style == "wide"),
    "upright": lambda step: step.lower in ("stand", "sit"),
    **dict.fromkeys(("high", "higher"), lambda step: step.style == "high"),
    **dict.fromkeys(("up", "upward", "upwards"), lambda step: step.direction == "pacing" or step.style == "high"),
}
_RISES = words_in("stand sit get wind come")
_ANGLES = words_in("90 180 270 360")
_ROUND, _NOT_OUT = words_in("draw_circle stir arm_circles"), words_in("raise raise_hold wave clap hands_up")
_ONE_LEGGED = words_in("kick stomp raise_leg one_leg hop_one_leg lunge")
_COUNTED = words_in("few several multiple couple many")
_SIDE = re.compile(r"(?:left|right)(?:wards?)?")
OF_A_LIMB = ARMS | LEGS | words_in("palm forearm elbow shoulder hip ear eye cheek thigh heel wrist fist finger")
_TO, _WHOSE = words_in("to towards toward on onto at"), words_in("the his her their its")
_NOUNS = words_in(
    """
    step steps box boxes phone comb text point points drink pace paces face faces rest head circle turn turns stop bow
    bend seat dust lift stretch movement dance march march walk run brush play fiddle cook type reads light
    """
)


def unaccounted(
    text: str, steps: Sequence[Step], records: dict[int, ClauseRecord], shown_otherwise: set[int]
) -> list[tuple[int, str]]:
    """(number of the clause, what is not shown) for each word of the sentence that no step accounts for.

    `text`: as it was given, in lower case, with "_" for letters that name no limb; `shown_otherwise`: clauses whose
    record says already that something else is acted out; of the words that are gone from them only sides and numbers
    are looked for.
    """
    tokens = TOKEN.findall(text)
    numbers, sure = clause_of_each(tokens, records)
    rewritten = {*records} - {number for number, is_sure in zip(numbers, sure, strict=True) if is_sure}
    lost: list[tuple[int, str]] = []
    for i in range(len(tokens)):
        near = {numbers[i]} if sure[i] else {numbers[i], *numbers[i : i + 8], *rewritten}
        own = [step for step in steps if near & {*step.clauses}] or list(steps)
        replaced = numbers[i] in shown_otherwise and not sure[i]
        checks = (_side, _number, _turn, _verb) if replaced else _CHECKS
        for check in checks:
            how = check(tokens, i, own)
            if how:
                lost.append((numbers[i], how))
                break
    return list(dict.fromkeys(lost))


def clause_of_each(tokens: list[str], records: dict[int, ClauseRecord]) -> tuple[list[int], list[bool]]:
    """The number of the clause that each token stands in, by aligning the sentence with its clauses, and if it does."""
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
        if number is None and tokens[i] in _CONNECTIVES:
            number = next((other for other in found[i:] if other is not None), last)
        last = last if number is None else number
        numbers.append(last)
    sure = [number is not None for number in found]
    for number, part in _wholly_rewritten(tokens, numbers, sure, records):
        for place in part:
            numbers[place] = number
    return numbers, sure


def as_given(text: str, records: dict[int, ClauseRecord]) -> dict[int, str]:
    """The sentence's own words of each clause, whose record may hold what they were taken as.

    Words that do not stand together are joined by an ellipsis. A clause that patterns have added has none.
    """
    found = list(TOKEN.finditer(text.lower()))
    tokens = [one[0] for one in found]
    for i in range(1, len(tokens)):  # "for a while" and "back and forth" link nothing
        pair = tuple(tokens[i - 1 : i + 2 : 2])
        tokens[i] = (
            "_" if tokens[i - 1 : i + 1] == ["a", "while"] or (tokens[i] == "and" and pair in _PAIRS) else tokens[i]
        )
    numbers = _of_whole_parts(tokens, records) or clause_of_each(tokens, records)[0]
    words = {}
    for number in records:
        runs = [[*run] for own, run in groupby(range(len(tokens)), key=numbers.__getitem__) if own == number]
        said = []
        for run in runs:
            while run and tokens[run[0]] in _LINKS:
                del run[0]
            while run and tokens[run[-1]] in _LINKS:
                del run[-1]
            said += [text[found[run[0]].start() : found[run[-1]].end()]] if run else []
        words[number] = " ... ".join(said)
    return words


def _of_whole_parts(tokens: list[str], records: dict[int, ClauseRecord]) -> list[int]:
    """The number of the clause of each token where the sentence has as many parts between links as clauses; else []."""
    numbers, part, is_open = [], -1, False
    for token in tokens:
        if token in _LINKS:
            is_open = False
        elif not is_open:
            part, is_open = part + 1, True
        numbers.append(max(part, 0))
    return [sorted(records)[number] for number in numbers] if part + 1 == len(records) else []


def _wholly_rewritten(
    tokens: list[str], numbers: list[int], sure: list[bool], records: dict[int, ClauseRecord]
) -> list[tuple[int, list[int]]]:
    """Clauses of which no word is left, with the places of the words between two links that are nobody else's."""
    parts: list[list[int]] = [[]]
    for place, token in enumerate(tokens):
        if token in _LINKS:
            parts.append([])
        else:
            parts[-1].append(place)
    free = [part for part in parts if part and not any(sure[place] for place in part)]
    gone = sorted({*records} - {number for number, is_sure in zip(numbers, sure, strict=True) if is_sure})
    return list(zip(gone, free, strict=True)) if len(gone) == len(free) else []


def _side(tokens: list[str], i: int, own: list[Step]) -> str:
    """A side that something goes to, which no step does."""
    if not _SIDE.fullmatch(tokens[i]) or OF_A_LIMB & set(tokens[i + 1 : i + 3]):
        return ""
    before = tokens[max(i - 2, 0) : i]
    aimed = len(before) == 2 and before[0] in _TO | {"from"} and before[1] in _WHOSE
    if not aimed or any(goes_aside(step) or step.turn_deg for step in own):
        return ""
    shown = any(step.direction in ("left", "right") and step.lower in ("kick", "fall_off", "side_kick") for step in own)
    shown = shown or any(step.lower == "side_lunge" for step in own)
    return "" if shown else "the side is not shown"


def _number(tokens: list[str], i: int, own: list[Step]) -> str:
    """A number of movements that no step has."""
    token, after = tokens[i], tokens[i + 1 : i + 4]
    counted = any(word_of(word).is_activity or word in ("steps", "times") for word in after[:3])
    vague = {"after", "later"} & {*tokens[max(i - 2, 0) : i], *after}
    if token in _COUNTED and counted and not vague and not any(step.count or step.lower == "dance" for step in own):
        return f"{token!r} is not kept"
    return ""


def _one_step(tokens: list[str], i: int, own: list[Step]) -> str:
    """ "A step" or "one step", where the steps have no number."""
    if (
        tokens[i] != "step"
        or tokens[i - 1] == "side"
        or not {"a", "an", "one", "another", "single"} & set(tokens[max(i - 3, 0) : i])
    ):
        return ""
    going = [step for step in own if step.lower in ("walk", "sidestep", "jog", "limp", "stagger")]
    return "that it is one step is not kept" if going and not any(step.count for step in going) else ""


def _each_leg(tokens: list[str], i: int, own: list[Step]) -> str:
    """Both legs or each, where the steps have one or leave it open."""
    if tokens[i] not in ("both", "each", "alternating", "alternate") or not LEGS & {*tokens[i + 1 : i + 3]}:
        return ""
    feet = [step.foot for step in own if step.lower in _ONE_LEGGED]
    return f"{tokens[i]!r} is not shown" if feet and not {"left", "right"} <= {*feet} else ""


def _turn(tokens: list[str], i: int, own: list[Step]) -> str:
    """Which way round, or by which angle, where no step turns so."""
    token = tokens[i]
    if token.endswith("clockwise"):
        sign = (
            -1.0 if token == "clockwise" and not {"counter", "anti", "against"} & {*tokens[max(i - 2, 0) : i]} else 1.0
        )
        side = {-1.0: "right", 1.0: "left"}[sign]
        if any(step.upper in _ROUND for step in own):
            return ""
        turns = any(
            (step.arc_deg or step.turn_deg) * sign > 0 or (step.lower == "turn" and step.direction == side)
            for step in own
        )
        return "" if turns else f"{token!r} is not shown"
    if token not in _ANGLES and not (token.isdigit() and "".join(tokens[i + 1 : i + 2]).startswith("deg")):
        return ""
    return "" if any(float(token) in _angles(step) for step in own) else f"'{token} degrees' is not shown"


def _angles(step: Step) -> set[float]:
    """The angles that a step turns or bends by."""
    plain = 90.0 if step.direction in ("left", "right") else 180.0
    return {abs(step.turn_deg), abs(step.arc_deg), plain if step.lower == "turn" else 0.0}


def _way(tokens: list[str], i: int, own: list[Step]) -> str:
    """A part of the body or a way that no step has."""
    token = tokens[i]
    if token == "out":
        lifted = any(step.upper in _NOT_OUT for step in own) and tokens[i + 1 : i + 2] != ["of"]
        return "'out' is not shown" if lifted else ""
    if token not in _SHOWN_BY or any(has_way(step, token) for step in own):
        return ""
    after = tokens[i + 1 : i + 4]
    lifted = any(step.upper in _NOT_OUT for step in own)
    if (tokens[i - 1 : i + 2] == ["in", "front", "of"] and not lifted) or (
        token in _TO and {"left", "right"} & {*after}
    ):
        return ""
    if token == "up" and i and {word_of(word).lemma for word in tokens[max(i - 2, 0) : i]} & _RISES:
        return ""
    return f"{token!r} is not shown"


def has_way(step: Step, word: str) -> bool:
    """Whether a step has the part of the body or the way that a word of `SHOWN_BY` names."""
    return bool(_doing(step) & _SHOWN_BY[word]) or (word in _ALSO and _ALSO[word](step))


def _doing(step: Step) -> set[str]:
    """The activities of a step, without the standing during an activity of the hands."""
    return {step.upper} if step.upper and step.lower == "stand" else {step.lower, step.upper}


def _verb(tokens: list[str], i: int, own: list[Step]) -> str:
    """A verb that no step is like."""
    token = tokens[i]
    word = word_of(token)
    if (
        token in _SHOWN_BY
        or not word.is_activity
        or token in _NOUNS
        or (word.form == "base" and i and tokens[i - 1] not in ("and", "then"))
        or tokens[i + 1 : i + 2] == ["asleep"]
    ):
        return ""
    lower, upper = ACTIVITY_OF_LEMMA[word.lemma]
    head_bowed = lower == "bow" and any(step.facing == "down" for step in own)
    bent = lower == "bend" and any(step.arc_deg for step in own)
    stays = (upper or lower) == "stand"
    if stays or head_bowed or bent or any(_is_like(step, upper or lower) for step in own):
        return ""
    return f"{token!r} is not shown"


_ALIKE = tuple(
    words_in(alike)
    for alike in (
        "walk jog sidestep limp stagger march stairs crawl", "jump leap hop hop_one_leg jumping_jacks",
        "sit sit_down sit_up stand_up", "kneel kneel_down kneel_up", "stumble fall fall_off push",
        "bend bow pick_up lean stretch", "pick_up crouch squat", "raise wave",
        "lie lie_down lie_on_seat recline get_up fall", "lunge side_lunge", "stand stand_up get_up kneel_up one_leg",
        "raise raise_hold arms_out arm_extension hands_up stretch limb_extension raise_leg knock_elbow pick_up",
        "reach pick_up put_down text drink carry phone read", "push push_hand", "pull pull_hand jacket_off",
        "wipe brush_teeth sweep stir", "fall lower_arm", "stretch push_hand", "turn twist", "kick raise_leg",
        "read text type", "throw punch jab cross hook uppercut", "throw roll_over roll_in_bed", "turn roundhouse",
        "turn hula_hoop", "walk lunge walking_lunge", "kick roundhouse side_kick",
        "turn roll_over roll_in_bed", "carry walk", "raise_leg raise one_leg",
    )
)  # fmt: skip


def alike(activity: str, key: str, step: Step | None = None) -> bool:
    """Whether one activity shows another, or what the grammar makes of it; `step`: a path or a look turns, too."""
    bent = step is not None and bool(step.arc_deg or step.facing)
    round_about = activity == "turn" and (bent or key in _ROUND or key == "look_around")
    return round_about or activity == key or any(activity in group and key in group for group in _ALIKE)


def _is_like(step: Step, activity: str) -> bool:
    """Whether a step is what a verb names."""
    return any(alike(activity, key, step) for key in _doing(step))


_OF_SPEED = ("ly", "fast", "quick", "slow")
_AGAIN = words_in("repeatedly continuously constantly")
_NO_MANNER = words_in(
    "finally gradually completely fully simultaneously alternately horizontally vertically counterclockwise directly"
)


def _manner(tokens: list[str], i: int, own: list[Step]) -> str:
    """An adverb that changes no step and is not among the words that say nothing."""
    token = tokens[i]
    if token in _AGAIN and all(BY_KEY[step.lower].once and not step.upper and not step.count for step in own):
        return f"{token!r} is not shown"
    if token in SPEEDS and token.endswith(_OF_SPEED) and token not in _NO_MANNER:
        return "" if any(step.speed == SPEEDS[token] for step in own) else f"{token!r} is not shown"
    if not token.endswith("ly") or token in FILLERS or token in _ALSO or token in _NO_MANNER:
        return ""
    return f"{token!r} is not shown"


_CHECKS = (_side, _number, _turn, _one_step, _each_leg, _way, _verb, _manner)
