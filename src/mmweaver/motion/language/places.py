"""Where something is done: 'near the window', 'behind the sofa', 'in the corner', 'two metres away', 'on the left'."""

import re
from dataclasses import dataclass, replace

from mmweaver.motion.language.described_person import PEOPLE
from mmweaver.motion.language.lexicon import NUMBERS, RADAR, TARGETS

MARK = "place_"
_RELATIONS = {
    "near": "near|next to|beside|besides|close to|by|at",
    "behind": "behind|in back of",
    "front": "in front of|before",
    "leftof": "to the left of|left of|on the left of",
    "rightof": "to the right of|right of|on the right of",
}
_OBJECT = "|".join(sorted((word for word in TARGETS if word not in ("wall",)), key=len, reverse=True))
_ADJECTIVES = r"(?:(?:open|closed|dining|kitchen|coffee|big|small|front|back|left|right|wooden|leather|garden|room) )*"
_NUMBER = (
    r"(?P<number>\d+(?:\.\d+)?|" + "|".join(word for word, value in NUMBERS.items() if value < 13) + r"|an?|half a)"
)
_ROOMS = "kitchen|living room|bedroom|bathroom|office|hall|hallway|corridor|lab|laboratory|garage|gym|studio|classroom"
_END = (
    r"(?= *(?:$|[,.;!]|and\b|then\b|while\b|with\b|for\b|facing\b|near\b|next\b|beside\b|behind\b|in\b|on\b|at\b|waving\b"
    rf"|{MARK}))"
)
_ARTICLE = "(?:the|an?|one|his|her|their)"
_AT_ONE = rf"{_ARTICLE} {_ADJECTIVES}"
_ANY_OBJECT = f"{_OBJECT}|wall"
_MIDDLE_OF = r"(?:very |exact )?(?:middle|centre|center)(?: of the (?:room|picture|photo|image|scene|floor))?"
_GOES = (
    r"(?:walk|go|run|jogg?|mov|head|com|return|stroll|stepp?|stagger|limp|sneak|hobbl|wander|march|saunter|trudg|strid)"
    r"(?:e?s|e|ing|ed)?"
)
# What is done to something under furniture, or with the eyes, and what is thrown outside, leaves the person where he is.
_DONE_THERE = (
    r"(?:put|plac|tak|pick|look|peer|peek|reach|push|pull|roll|kick|throw|toss|slid|sweep|vacuum|clean|mopp?|wip|search"
    r"|dropp?|stor|lay|chas|point|star|gaz|glanc|listen|grab|get|fetch)(?:e?s|e|t?ing|ed)?"
)
_UNDER = "table|desk|bed|chair|couch|sofa|settee|counter"
_PATTERNS = (
    (re.compile(rf"\bbetween {_AT_ONE}(?P<object>{_ANY_OBJECT}) and (?:{_AT_ONE})?(?P<other>{_ANY_OBJECT})\b"), "between"),
    (re.compile(rf"\bbetween (?:(?:the|two|both|his|her|their) )+{_ADJECTIVES}(?P<object>{_OBJECT})(?:e?s)\b"), "between"),
    (re.compile(r"\b(?:in|into) the (?:open )?(?P<object>doorway|door|entrance)\b(?! frame)"), "in"),
    (re.compile(rf"\b(?:near|next to|beside|besides|close to|by|at|in front of) {_AT_ONE}(?P<object>wall)\b"), "near"),
    (re.compile(r"(?:(?<=stands )|(?<=standing )|(?<=stand )|(?<=sits )|(?<=sitting )|(?<=waits )|(?<=squats )|(?<=crouches )"
                rf"|(?<= back )|(?<=kneels ))against {_AT_ONE}(?P<object>wall)\b"), "against"),
    *((re.compile(rf"\b(?:{words}) (?:the |a |an |his |her |their )?{_ADJECTIVES}(?P<object>{_OBJECT})\b"), relation)
      for relation, words in _RELATIONS.items()),
    (re.compile(rf"\b(?:at |about |some |around )*(?:a distance of )?{_NUMBER}(?P<half> and a half)? ?(?:m|met(?:er|re)s?)"
                rf" (?:away|off|distant)?(?: ?(?:from|in front of|before|ahead of) (?:the )?(?:{'|'.join(RADAR)}))?{_END}"), "range"),
    (re.compile(rf"\b(?:on|at|in) the (?P<object>left|right)(?: hand(?= (?:side|half|corner|part)))?(?: side| half| corner| part)?"
                rf"(?: of the (?:room|picture|photo|image|scene))?{_END}"), "side"),
    (re.compile(rf"\bin the {_MIDDLE_OF}{_END}"), "middle"),
    (re.compile(r"\b(?:in the background|(?:in|at) the back(?: of the (?:room|picture|scene))|at the (?:far|other) end(?: of the room)?)" + _END), "far"),
    (re.compile(rf"\b(?:in the foreground|(?:close to|near|next to|right in front of) (?:the )?(?:{'|'.join(RADAR)}))" + _END), "close"),
)  # fmt: skip
# Places of which a part of the sentence before them decides whether the person is there; the first group is kept.
_CORNER = r"(?:the|a|one) (?:far |near |back )?(?:(?P<side>left|right)(?: hand)? )?(?:far |back )?corner\b(?: of the room\b)?(?! of)"
_FURTHER = r"(?: (?!and\b|then\b|while\b|with\b)[a-z_]+){0,4}?"
_THERE = (
    (re.compile(rf"\b(?P<goes>{_GOES}{_FURTHER}) (?:in)?to(?:wards?)? {_CORNER}"), "in_corner"),
    (re.compile(rf"\b(?P<goes>)(?:in|inside|at) {_CORNER}"), "in_corner"),
    (re.compile(rf"\b(?P<goes>{_GOES}{_FURTHER}) (?:to|into|towards?) the {_MIDDLE_OF}{_END}"), "middle_go"),
    (re.compile(rf"\b(?P<goes>{_GOES}{_FURTHER}) (?:up )?to {_AT_ONE}wall\b"), "near_wall"),
)
_AWAY_FROM_IT = (
    (re.compile(rf"(?<!from )\b(?:under|underneath|beneath|below) {_AT_ONE}(?P<object>{_UNDER})\b"), "under"),
    (re.compile(r"\b(?P<object>)(?:outside|outdoors)\b(?! of| the)"), "outside"),
)
_ACTS_THERE = re.compile(rf"\b{_DONE_THERE}\b(?:(?!\band\b|\bthen\b|\bwhile\b|[,.;]).)*$")
_ROOM = re.compile(rf"\b(?:in|inside|across|through|around) (?:the|a|his|her|their|an) ({_ROOMS})\b")


_PERSON = rf"(?:{'|'.join(sorted(PEOPLE))}|person|human|user|somebody|someone|friend|neighbou?r|stranger|other)"
# Somebody else's side, who is waved to: the body faces it.
_WHOM = re.compile(
    r"\b((?:point|wav|turn|nod|bow|gestur|clap|shout|talk|speak|sing|smil)(?:e?s|e|ing|ed)?\b(?: (?!and\b|then\b|while\b)[a-z]+){0,4}? )"
    rf"(?:at|to|towards?|for) (?:the |an? |his |her |their |another )*(?:[a-z]+ )?{_PERSON} (?:who is )?(?:standing |sitting )?"
    r"(?:on|at|to) (?:the|his|her|their) (left|right)(?: hand side| side)?\b(?! of the (?!room|picture|photo|image|scene))"
)
# Where the person of the sentence is: "a man on the left waves".
_WHOSE = re.compile(
    rf"^((?:an? |the |my |our )?(?:[a-z-]+ ){{0,2}}?{_PERSON}) (?:(?:who|that) (?:is |stands |sits )?)?(?:standing |seated )?"
    r"(?:(?:on|at) the (?P<side>left|right)(?: hand side| side| half| corner)?|in the (?P<middle>middle|cent(?:re|er))"
    r"|(?P<far>in the background|(?:in|at) the back|at the (?:far|other) end)|(?P<close>in the foreground))"
    r"(?: of the (?:room|picture|photo|image|scene|floor))? (?=[a-z]+(?:s|ing)\b)"
)
_AIMED = re.compile(
    r"\b((?:point|wav|turn|nod|bow|gestur)(?:e?s|e|ing|ed)?\b(?: (?!and\b|then\b|while\b)[a-z]+){0,4}? )(?:at|to|towards?)"
    rf" (?:the |a |an |his |her |their ){_ADJECTIVES}({_OBJECT})\b"
)
_FACED = re.compile(
    rf"\b(fac(?:es|e|ing)) (?:to |towards? )?(?:the |a |an |his |her |their ){_ADJECTIVES}({_OBJECT})\b"
)
AIM = "aim_"  # the token for what somebody faces: a Landmark.kind follows


@dataclass(frozen=True)
class Place:
    """A place of a sentence, for the planner to find in the room."""

    # near | behind | front | leftof | rightof | in | against | between | under | outside | range | left | right | middle
    # | far | close
    relation: str
    landmark: str = ""  # the Landmark.kind that it is relative to; wall, corner: of the room
    other: str = ""  # of "between", the other one
    is_end: bool = False  # of "middle": the walk goes there
    distance_m: float = 0.0  # of "range"
    also: "Place | None" = None  # where it is at the same time: 'two metres away on the left'

    def together_with(self, other: "Place") -> "Place":
        """Both places at once, the one at a landmark first."""
        one, more = (other, self) if other.landmark and not self.landmark else (self, other)
        return replace(one, also=more if one.also is None else one.also.together_with(more))

    @property
    def sides(self) -> set[str]:
        """Of left and right, those that it names."""
        return {self.relation} & {"left", "right"} | (set() if self.also is None else self.also.sides)

    @property
    def is_goal(self) -> bool:
        """Whether a walk to it goes there, instead of beginning there."""
        return bool(self.landmark) or self.is_end or self.relation == "outside"

    @property
    def words(self) -> str:
        """As it is shown in messages."""
        if self.also is not None:
            return f"{replace(self, also=None).words}, {self.also.words}"
        if self.relation == "range":
            return f"{self.distance_m:g} m from the radar"
        if self.relation == "between":
            same = self.landmark == self.other
            return f"between two {self.landmark}s" if same else f"between the {self.landmark} and the {self.other}"
        if self.landmark == "door" and self.relation == "in":
            return "in the doorway"
        relation = {"front": "in front of", "leftof": "left of", "rightof": "right of"}.get(
            self.relation, self.relation
        )
        if self.landmark:
            return f"{relation} the {self.landmark}"
        return {
            "middle": "in the middle",
            "far": "in the background",
            "close": "close to the radar",
            "outside": "outside",
        }.get(self.relation, f"on the {self.relation}")


def mark_places(text: str) -> str:
    """The sentence, in lower case, with a token for each place, and for what is faced or pointed at."""
    text = _WHOM.sub(lambda found: f"{found[1]} {AIM}{found[2]} ", text)
    text = _WHOSE.sub(lambda found: f"{found[1]} {MARK}{found['side'] or found.lastgroup} ", text)
    for pattern in (_AIMED, _FACED):
        text = pattern.sub(lambda found: f"{found[1]} {AIM}{TARGETS[found[2]]} ", text)
    for pattern, token in _THERE:
        text = pattern.sub(lambda found, token=token: f"{found['goes']} {_with_side(found, token)} ", text)
    for pattern, relation in _AWAY_FROM_IT:
        text = pattern.sub(lambda found, relation=relation: _unless_acted_there(found, relation), text)
    for pattern, relation in _PATTERNS:
        text = pattern.sub(lambda found, relation=relation: f" {_token(found, relation)} ", text)
    return text


def _with_side(found: re.Match[str], token: str) -> str:
    side = found.groupdict().get("side")
    return f"{MARK}{token} {MARK}{side}" if side else MARK + token


def _unless_acted_there(found: re.Match[str], relation: str) -> str:
    """The token of a place where nobody can be shown; the words where only something is done there."""
    if _ACTS_THERE.search(found.string[: found.start()]):
        return found[0]
    kind = TARGETS.get(found["object"], "")
    return f" {MARK}{relation}_{kind} " if kind else f" {MARK}{relation} "


def _token(found: re.Match[str], relation: str) -> str:
    groups = found.groupdict()
    if relation == "range":
        number = groups["number"]
        value = 1.0 if number in ("a", "an") else 0.5 if number == "half a" else float(NUMBERS.get(number, 0) or number)
        return f"{MARK}range_{round(100 * (value + 0.5 * bool(groups['half'])))}"
    if relation == "side":
        return MARK + groups["object"]
    if relation == "between":
        other = groups.get("other") or groups["object"]
        return f"{MARK}between_{TARGETS[groups['object']]}_{TARGETS[other]}"
    return f"{MARK}{relation}_{TARGETS[groups['object']]}" if "object" in groups else MARK + relation


def place_of(token: str) -> Place:
    """The place that a token of `mark_places` stands for.

    >>> place_of("place_behind_couch").words, place_of("place_range_250").distance_m
    ('behind the couch', 2.5)
    """
    relation, _, rest = token.removeprefix(MARK).partition("_")
    if relation == "range":
        return Place(relation, distance_m=int(rest) / 100)
    if relation == "middle":
        return Place(relation, is_end=rest == "go")
    landmark, _, other = rest.partition("_")
    return Place(relation, landmark, other=other)


def room_of(text: str) -> str:
    """The kind of room that a sentence names, or ""."""
    found = _ROOM.search(text.lower())
    return found[1] if found else ""
