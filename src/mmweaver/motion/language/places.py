"""Where something is done: 'near the window', 'behind the sofa', 'two metres away', 'on the left'."""

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
_PATTERNS = (
    *((re.compile(rf"\b(?:{words}) (?:the |a |an |his |her |their )?{_ADJECTIVES}(?P<object>{_OBJECT})\b"), relation)
      for relation, words in _RELATIONS.items()),
    (re.compile(rf"\b(?:at |about |some |around )*(?:a distance of )?{_NUMBER}(?P<half> and a half)? ?(?:m|met(?:er|re)s?)"
                rf" (?:away|off|distant)?(?: ?(?:from|in front of|before|ahead of) (?:the )?(?:{'|'.join(RADAR)}))?{_END}"), "range"),
    (re.compile(rf"\b(?:on|at|in) the (?P<object>left|right)(?: hand(?= (?:side|half|corner|part)))?(?: side| half| corner| part)?"
                rf"(?: of the (?:room|picture|photo|image|scene))?{_END}"), "side"),
    (re.compile(r"\bin the (?:middle|centre|center)(?: of the (?:room|picture|photo|image|scene|floor))?" + _END), "middle"),
    (re.compile(r"\b(?:in the background|(?:in|at) the back(?: of the (?:room|picture|scene))|at the (?:far|other) end(?: of the room)?)" + _END), "far"),
    (re.compile(rf"\b(?:in the foreground|(?:close to|near|next to|right in front of) (?:the )?(?:{'|'.join(RADAR)}))" + _END), "close"),
)  # fmt: skip
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

    relation: str  # near | behind | front | leftof | rightof | range | left | right | middle | far | close
    landmark: str = ""  # the Landmark.kind that it is relative to
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
    def words(self) -> str:
        """As it is shown in messages."""
        if self.also is not None:
            return f"{replace(self, also=None).words}, {self.also.words}"
        if self.relation == "range":
            return f"{self.distance_m:g} m from the radar"
        relation = {"front": "in front of", "leftof": "left of", "rightof": "right of"}.get(
            self.relation, self.relation
        )
        if self.landmark:
            return f"{relation} the {self.landmark}"
        return {"middle": "in the middle", "far": "in the background", "close": "close to the radar"}.get(
            self.relation, f"on the {self.relation}"
        )


def mark_places(text: str) -> str:
    """The sentence, in lower case, with a token for each place, and for what is faced or pointed at."""
    text = _WHOM.sub(lambda found: f"{found[1]} {AIM}{found[2]} ", text)
    text = _WHOSE.sub(lambda found: f"{found[1]} {MARK}{found['side'] or found.lastgroup} ", text)
    for pattern in (_AIMED, _FACED):
        text = pattern.sub(lambda found: f"{found[1]} {AIM}{TARGETS[found[2]]} ", text)
    for pattern, relation in _PATTERNS:
        text = pattern.sub(lambda found, relation=relation: f" {_token(found, relation)} ", text)
    return text


def _token(found: re.Match[str], relation: str) -> str:
    groups = found.groupdict()
    if relation == "range":
        number = groups["number"]
        value = 1.0 if number in ("a", "an") else 0.5 if number == "half a" else float(NUMBERS.get(number, 0) or number)
        return f"{MARK}range_{round(100 * (value + 0.5 * bool(groups['half'])))}"
    if relation == "side":
        return MARK + groups["object"]
    return f"{MARK}{relation}_{TARGETS[groups['object']]}" if "object" in groups else MARK + relation


def place_of(token: str) -> Place:
    """The place that a token of `mark_places` stands for.

    >>> place_of("place_behind_couch").words, place_of("place_range_250").distance_m
    ('behind the couch', 2.5)
    """
    relation, _, rest = token.removeprefix(MARK).partition("_")
    return Place(relation, distance_m=int(rest) / 100) if relation == "range" else Place(relation, rest)


def room_of(text: str) -> str:
    """The kind of room that a sentence names, or ""."""
    found = _ROOM.search(text.lower())
    return found[1] if found else ""
