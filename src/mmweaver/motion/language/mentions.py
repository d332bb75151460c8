"""What a sentence names in its plain words, and none of its steps has.

`coverage` looks at the words that the grammar was left with. Patterns before it rewrite phrases and take some away, so
what they lose is lost for it, too. Here the sentence as it was given is searched for limbs, sides, ways and things, and
each is compared with the steps of the clauses that hold it, whatever the patterns have made of it.
"""

import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import pairwise

from mmweaver.motion.language.coverage import goes_aside, goes_round, moves_one_hand, sides_of
from mmweaver.motion.language.lexicon import SEATS
from mmweaver.motion.language.plan import ClauseRecord, Step
from mmweaver.motion.language.verbs import words_in

_WHOSE = r"(?:his|her|their|its|the|both|one|each|your|own)"
_HAND = r"(?:hand|arm|fist|palm|wrist|elbow|forearm|finger)s?"
_LEG = r"(?:legs?|foot|feet|knees?|thighs?|ankles?|shins?|heels?|toes?)"
_SIDED_LIMB = re.compile(rf"\b(left|right)(?: (?:and|or) (?:left|right))? (?:[a-z]+ )?({_HAND}|{_LEG})\b")
# Which foot begins a walk, getting to one's feet, and lengths in feet are no movements of a foot.
_NO_LIMB = re.compile(
    r"\b(?:start|begin|lead|stepp?)(?:s|ing)?(?: [a-z]+)?,? (?:with|on|by) [a-z ]*?(?:foot|leg|feet)\b"
    r"|\b(?:left|right) (?:foot|leg) (?:first|leading|in front)\b"
    r"|\b(?:to|on|onto) (?:his|her|their|its|the|two|both)(?: (?:own|two))? feet\b"
    r"|\b(?:\d+|two|three|four|five|ten|few) feet\b"
    r"|\b(?:left|right)[- ]hand(?=[- ]side)|\b(?:starting|initial) (?:foot|leg)"
    r"|\bshoulders?[- ](?:width|height|level|high)\b"
)


@dataclass(frozen=True, kw_only=True)
class _Part:
    """A part of the body: the words for it, and the activities that have to do with it."""

    words: str
    activities: frozenset[str]


_PARTS = (
    _Part(
        words=rf"{_LEG}|tip-?toes?",
        activities=words_in(
            """
            kick roundhouse side_kick stomp raise_leg one_leg hop_one_leg lunge walking_lunge side_lunge limb_extension
            kneel kneel_down kneel_up squat crouch march limp tree_pose warrior_pose downward_dog stairs crawl push_ups
            jump leap hop jumping_jacks bend sit_ups pedal
            """
        ),
    ),
    _Part(
        words=r"(?<=is )head|(?<=er )head|(?<=ir )head|(?<=[th][se] )head|neck|chin|forehead|nose|ears?|cheek|mouth",
        activities=words_in(
            """
            nod shake_head look_around drink eat phone brush_teeth comb yawn cough raise raise_hold arm_extension
            hands_up clap reach stretch
            """
        ),
    ),
    _Part(words="elbows?", activities=words_in("knock_elbow plank raise")),
    _Part(words="shoulders?", activities=words_in("shrug arm_circles arms_out raise look_around stumble")),
    _Part(words="hips?", activities=words_in("hips twist dance lean hula_hoop")),
    _Part(
        words=r"torso|trunk|waist|upper body|chest|stomach|belly",
        activities=words_in(
            """
            twist lean bend bow hips dance golf cross_arms arms_out carry hands_up push push_hand pull_hand raise
            pull stretch breathe cough yawn clap lie lie_down lie_on_seat recline fall get_up push_ups plank crawl
            stumble raise_leg sit_ups
            """
        ),
    ),
)
_TO_AND_FRO = words_in("swipe lean twist shake_head look_around hips dance wave wipe sweep vacuum stumble stagger")
BOTH_SIDES = words_in("swipe stumble stagger twist shake_head look_around hips dance wave")
_ABOVE = words_in("raise raise_hold arm_extension hands_up stretch jumping_jacks arm_circles draw_circle draw_z")


def _does(*keys: str) -> Callable[[Step], bool]:
    return lambda step: bool({step.lower, step.upper} & {*keys})


def _opens_no_door(step: Step) -> bool:
    return not _does("open_door")(step)


def goes_to_and_fro(step: Step, *keys: str) -> bool:
    """Whether a step, or one activity of it, goes to one side and the other."""
    return bool({*(keys or (step.lower, step.upper))} & _TO_AND_FRO) or step.direction == "pacing"


# (words, whether a step has what they say): a way, a height or a thing; the words are named where no step has it.
_WAYS: tuple[tuple[str, Callable[[Step], bool]], ...] = (
    (r"(?:from )?side to side|from one side to the other", goes_to_and_fro),
    (
        r"(?:to the )?left and (?:to the )?right(?! (?:hand|arm|leg|foot|fist|punch))",
        lambda step: goes_to_and_fro(step) or step.hand == "both" or bool(step.foot),
    ),
    (
        r"arms? (?:straight )?(?:up )?out(?:wards?)? (?:away )?(?:to|from)|away from (?:his|her|their|the) sides?",
        _does("arms_out", "arm_extension", "limb_extension", "side_lunge"),
    ),
    (r"sideways|sidewards|to (?:the|one|his|her|their) sides?\b(?! of)|lateral(?:ly)?", goes_aside),
    (r"(?:in |small |big |large |wide )circles?|circular(?:ly)?", goes_round),
    (
        rf"(?:to|near|around|at|towards|in front of|over) {_WHOSE} (?:own )?"
        r"(?:faces?|eyes?|mouth|head|chin|forehead|ears?|nose)\b|to (?:face|mouth|head|ear)(?=$|[,.;]| and\b| area\b)",
        _does("drink", "eat", "phone", "brush_teeth", "comb", "yawn", "cough", "raise_hold", "look_around", "nod"),
    ),
    (r"(?:hands|palms) together", lambda step: step.upper in ("clap", "wipe")),
    (rf"(?:to|at) {_WHOSE} (?:own )?body", lambda step: False),
    (rf"behind {_WHOSE} (?:back|head|neck|body)", lambda step: False),
    (
        rf"(?:above|over) {_WHOSE} heads?|overhead",
        lambda step: bool({step.lower, step.upper} & _ABOVE) or step.style == "high",
    ),
    (
        rf"(?<=from )(?:off )?(?:an? |{_WHOSE} )?(?:[a-z]+ )?(?:shelf|table|desk|counter|cupboard|wall|bookshelf|rack)",
        lambda step: not _does("pick_up")(step),
    ),
    (
        rf"(?:on(?:to)?|off|in(?:to)?) (?:an? |{_WHOSE} )(?:[a-z]+ )?(?:{'|'.join(sorted(SEATS))})\b",
        lambda step: step.uses_seat or step.direction == "seat" or step.place is not None,
    ),
    (
        rf"(?:under|underneath|below|beneath) (?:an? |{_WHOSE} )(?:[a-z]+ )?(?!chin|nose|arms?|head)[a-z]+",
        lambda step: False,
    ),
    (r"across (?:the|a) (?:room|floor|hall|kitchen)", lambda step: step.moves),
    (
        rf"(?:onto|on|into|to) (?:an? |{_WHOSE} )?(?:[a-z]+ )?(?:shelf|table|desk|counter|cupboard|bookshelf|rack)\b",
        lambda step: not _does("pick_up")(step),
    ),
    (
        r"(?<=opens )(?!(?:the |a |an |his |her |their )?(?:[a-z]+ )?doors?\b)[a-z]+(?: [a-z]+)?",
        _opens_no_door,
    ),
)  # fmt: skip
# "hops on the left foot, then on the right": the same limb of the other side, without its name.
_OTHER_LIMB = re.compile(
    rf"\b(left|right) ({_HAND}|{_LEG})\b[^.;]*?\b(?:then|and)\b(?: with| on)?(?: {_WHOSE}| the)? (left|right)"
    r"(?: one)?(?= *$|[,.;]| and\b| then\b)"
)
_SIDED_WAY = re.compile(
    rf"\b(left|right)(?:wards?)?\b(?!-| (?:[a-z]+ )?(?:{_HAND}|{_LEG}|side|shoulder|hip|ear|eye|cheek"
    r"|punch|jab|hook|kick|after|before|now|there)\b)"
)
_STAYS_LOW = re.compile(r"\bin(?:to)? an? (?:[a-z]+ ){0,2}squat\b|\bsquat\w* down\b")
_RISING = ("stand_up", "kneel_up", "get_up", "sit_up")
_GOING_ON = ("walk", "jog", "turn", "sidestep", "leap", "stand")


def _goes_on_feet(before: Step, after: Step) -> bool:
    """Whether the movement needs feet anyway; who is on the knees or the floor may turn or hop there."""
    return after.lower in _GOING_ON and not (after.lower in ("turn", "leap") and before.lower in ("kneel_up", "get_up"))


def without_no_limbs(text: str) -> str:
    """The sentence in lower case, with "_" for the letters of phrases that name a limb and move none."""
    return _NO_LIMB.sub(lambda found: "_" * len(found[0]), " ".join(text.lower().split()))


def not_in_any_step(text: str, steps: Sequence[Step], records: dict[int, ClauseRecord]) -> list[tuple[str, str]]:
    """(words, what of them is not shown): each limb, side, way and thing that the sentence names and no step has."""
    folded = without_no_limbs(text)

    def steps_of(words: str) -> Sequence[Step]:
        numbers = {number for number, record in records.items() if words in record.clause}
        return [step for step in steps if numbers & set(step.clauses)] or steps

    lost = []
    for found in _SIDED_LIMB.finditer(folded):
        side, is_hand = found[1], re.fullmatch(_HAND, found[2]) is not None
        if not any(moves_limb(step, side, is_hand=is_hand) for step in steps_of(found[0])):
            lost.append((found[0], "which hand or foot it is is not shown"))
    for part in _PARTS:
        for found in re.finditer(rf"\b(?:{part.words})\b", folded):
            if not any({step.lower, step.upper} & part.activities for step in steps_of(found[0])):
                lost.append((found[0], f"what happens with {found[0]!r} is not shown"))
    both_sides = {"left", "right"} <= set().union(*map(sides_of, steps))
    for words, has_it in _WAYS:
        for found in re.finditer(rf"\b(?:{words})", folded):
            shown = [has_it(step) for step in steps_of(found[0])]
            if both_sides and "left" in found[0] and "right" in found[0]:  # one after the other
                continue
            if not (all(shown) if has_it is _opens_no_door else any(shown)):
                lost.append((found[0], f"{found[0]!r} is not shown"))
    lost += _sides_left_out(folded, steps)
    return list(dict.fromkeys(lost))


def _sides_left_out(folded: str, steps: Sequence[Step]) -> list[tuple[str, str]]:
    """Of two sides that are named, the one that no step has."""
    for found in _OTHER_LIMB.finditer(folded):
        is_hand = re.fullmatch(_HAND, found[2]) is not None
        if found[3] != found[1] and not any(moves_limb(step, found[3], is_hand=is_hand) for step in steps):
            return [(found[3], "the other hand or foot is not shown")]
    named = {found[1] for found in _SIDED_WAY.finditer(folded)}
    shown = {side for step in steps for side in sides_of(step) | (set() if step.place is None else step.place.sides)}
    to_and_fro = any({step.lower, step.upper} & BOTH_SIDES and not step.facing for step in steps)
    if len(named) == 2 and len(shown) < 2 and not to_and_fro:
        return [(next(found[0] for found in _SIDED_WAY.finditer(folded)), "the other side is not shown")]
    return []


def moves_limb(step: Step, side: str, *, is_hand: bool) -> bool:
    if is_hand:
        with_hand = step.hand in (side, "both") and moves_one_hand(step)
        return with_hand or (step.lower == "limb_extension" and step.foot == side)
    lifts_the_other = step.lower == "one_leg" and bool(step.foot)  # "raises the left leg and holds it"
    return step.foot in (side, "both") or lifts_the_other or step.lower in ("push_ups", "plank")


def risings_that_no_clause_names(steps: Sequence[Step]) -> list[tuple[Step, str]]:
    """(step after, what is said) where somebody gets up only because the library does the next movement standing."""
    low = [
        (after, f"{after.name} is shown standing, after getting up")
        for before, after in pairwise(steps)
        if before.lower == "squat" and _STAYS_LOW.search(before.clause) and not before.count
        and after.lower == "stand" and after.upper and not after.on_feet and before.clauses != after.clauses
    ]  # fmt: skip
    return low + [
        (after, f"{after.name} is shown {'standing, ' * (after.posture == 'feet')}after getting up")
        for before, after in pairwise(steps)
        if before.lower in _RISING and not before.clauses and not _goes_on_feet(before, after)
    ]
