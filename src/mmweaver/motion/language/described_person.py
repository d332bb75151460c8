"""The person described by a sentence: sex, age, stature and build."""

import re
from dataclasses import dataclass

_WOMEN = "woman|women|lady|girl|female|mother|mom|grandma|grandmother|granny|wife|daughter|sister|waitress|actress"
_MEN = "man|men|gentleman|boy|male|guy|father|dad|grandpa|grandfather|husband|son|brother|policeman|fireman|waiter"
_CHILDREN = "child|kid|boy|girl|toddler|baby|schoolboy|schoolgirl|pupil"
_AGES = {"toddler": "toddler", "baby": "baby", "infant": "baby", "teenager": "teenager", "adolescent": "teenager"}
_TEENAGE = frozenset(["teenage", "teenaged", "adolescent"])
PEOPLE = frozenset("|".join((_WOMEN, _MEN, _CHILDREN)).split("|"))
PERSON_NOUNS = "|".join(
    (*PEOPLE, "person", "human", "adult", "user", "somebody", "someone", "teenager", "adolescent", "infant")
)
_ANYBODY = (
    r"person|human|adult|user|subject|figure(?![- ](?:of |eight|8))|individual|participant|patient"
    "|resident|tenant|somebody|someone|youth|teenager|adolescent|infant|giant|dwarf|nurse"
)
_NOUN = rf"(?P<noun>{_WOMEN}|{_MEN}|{_CHILDREN}|{_ANYBODY}|elderly|athlete|worker|student|player|dancer)"
_OLD = frozenset(["old", "elderly", "aged", "senior", "aging", "ageing"])
_GRAND = frozenset(["grandma", "grandmother", "granny", "grandpa", "grandfather", "elderly"])
_STATURE = {
    "tall": 1,
    "short": -1,
    "small": -1,
    "little": -1,
    "tiny": -1,
    "huge": 2,
    "giant": 2,
    "gigantic": 2,
    "dwarf": -2,
}
_BUILD = {
    **dict.fromkeys(("heavy", "fat", "overweight", "obese", "stout", "chubby", "plump", "stocky", "big", "large"), 1),
    **dict.fromkeys(("muscular", "strong", "burly", "corpulent", "broad"), 1),
    **dict.fromkeys(("slim", "thin", "skinny", "slender", "lean", "lanky", "petite"), -1),
}
BUILDS = "|".join(_BUILD)
_ADJECTIVES = "|".join(
    sorted({*_OLD, *_STATURE, *_BUILD, "young", "very", "rather", "and", "middle-aged", *_TEENAGE}, key=len)
)
_PERSON = re.compile(rf"\b(?P<words>(?:(?:{_ADJECTIVES})[ ,]+)*){_NOUN}\b")
_GIANTS = ("giant", "dwarf")
_LENGTH = (
    r"(?:(?P<m{0}>\d(?:\.\d+)?|one|two) ?(?:m|met(?:re|er)s?)|(?P<cm{0}>\d{{2,3}}) ?(?:cm|centimet(?:re|er)s?)"
    r"|(?P<ft{0}>[2-7]|three|four|five|six|seven) ?(?:foot|feet|ft)"
    r"(?: (?:and )?(?P<in{0}>\d+(?= ?(?:in|inch|inches|tall)\b)"
    r"(?: ?(?:in|inch|inches))?)?)?)"
)
# "a 1.6 m tall man", "a man 1.6 m tall", "a woman of 1.6 m", "he is 1.6 m tall and"
_HEIGHTS = (
    re.compile(
        rf"\b{_LENGTH.format(0).replace(' ?', '[ -]?')}(?:[ -]tall)?,? (?=(?:(?:{_ADJECTIVES})[ ,]+)*{_NOUN}\b)"
    ),
    re.compile(
        rf"(?<=[a-z]),?(?: (?:who|that) (?:is|measures)| of)? {_LENGTH.format(1)} tall\b,?"
        rf"| (?:of|(?:who|that) measures) {_LENGTH.format(2)}(?! tall| away| from| to)\b(?: height\b)?"
    ),
    re.compile(rf"(?<=[a-z]) is {_LENGTH.format(3)} tall(?:,? and\b)"),
)
_WORDS = {"one": 1, "two": 2, "three": 3, "four": 4, "five": 5, "six": 6, "seven": 7}
PACE = {"old": 0.75, "toddler": 0.6, "baby": 0.5}  # walking pace relative to the usual one
PACE_ON_THE_SPOT = {"old": 0.75, "child": 1.15, "toddler": 1.2, "baby": 1.2}
_PRONOUN = re.compile(r"\b(he|she|his|her|himself|herself)\b")


@dataclass(frozen=True, kw_only=True)
class DescribedPerson:
    """Traits of the person in a sentence; "" and 0 if not stated."""

    words: str = ""  # of the sentence
    sex: str = ""  # female | male
    age: str = ""  # baby | toddler | child | teenager | old
    stature: int = 0  # -2 a dwarf, -1 short, 1 tall, 2 a giant
    build: int = 0  # -1 slim, 1 heavy
    height_m: float = 0.0  # if stated

    @property
    def is_described(self) -> bool:
        return bool(self.sex or self.age or self.stature or self.build or self.height_m)

    def pace(self, *, moves: bool) -> float:
        """Tempo relative to the usual one.

        Args:
            moves: Whether the person moves over the floor; otherwise on the spot.
        """
        return (PACE if moves else PACE_ON_THE_SPOT).get(self.age, 1.0)


def described_person(text: str) -> DescribedPerson:
    """Traits of a sentence's person, from its first noun for a person with its adjectives, else its first pronoun.

    Args:
        text: The sentence.

    >>> described_person("a tall old woman walks")
    DescribedPerson(words='tall old woman', sex='female', age='old', stature=1, build=0, height_m=0.0)
    """
    folded, height_m, (before, after) = _strip_height(text.lower())
    found = _person(folded)
    subject = re.search(r"\b(?:he|she)\b", folded)
    if found is not None and subject is not None and subject.start() < found.start():
        found = None  # "she rocks a baby"
    if found is None or found["noun"] in _ANYBODY.split("|"):
        pronoun = _PRONOUN.search(folded)
        sex = "" if pronoun is None else "female" if pronoun[1] in ("she", "her", "herself") else "male"
        if found is None:
            return DescribedPerson(words=f"{pronoun[1]}{after}" if pronoun else "", sex=sex, height_m=height_m)
    else:
        sex = "female" if found["noun"] in _WOMEN.split("|") else "male" if found["noun"] in _MEN.split("|") else ""
    adjectives = re.split(r"[ ,]+", found["words"])
    age = _AGES.get(found["noun"], "child" if found["noun"] in _CHILDREN.split("|") else "")
    age = "teenager" if set(adjectives) & _TEENAGE else age
    if not age and (set(adjectives) & _OLD or found["noun"] in _GRAND):
        age = "old"
    return DescribedPerson(
        words=f"{before}{found.group().strip()}{after}",
        sex=sex,
        age=age,
        stature=next((_STATURE[word] for word in (*adjectives, found["noun"]) if word in _STATURE), 0),
        build=next((_BUILD[word] for word in adjectives if word in _BUILD), 0),
        height_m=height_m,
    )


def strip_stature(text: str) -> str:
    """Removes the description of the person's height, which the body shows and no step.

    Args:
        text: The sentence.

    >>> strip_stature("a 1.6 m tall man waves to a small boy")
    'a man waves to a small boy'
    """
    text = _strip_height(text)[0]
    found = _person(text)
    if found is None:
        return text
    kept = re.sub(rf"\b(?:{'|'.join((*_STATURE, *_TEENAGE))})\b[ ,]*", "", found["words"])
    noun = "person" if found["noun"] in _GIANTS else found["noun"]
    return text[: found.start()] + kept + noun + text[found.end() :]


def _person(text: str) -> re.Match[str] | None:
    """The first noun for a person; a giant or a dwarf only where the sentence begins with it."""
    for found in _PERSON.finditer(text):
        if found["noun"] not in _GIANTS or re.fullmatch(r"(?:an? |the )?", text[: found.start()]):
            return found
    return None


def _strip_height(text: str) -> tuple[str, float, tuple[str, str]]:
    """The sentence without a height next to its person's noun; the metres; and its words before and after the noun."""
    for number, pattern in enumerate(_HEIGHTS):
        for found in pattern.finditer(text):
            person = _person(text[: found.start()])
            is_first = person is None if number == 0 else person is not None and person.end() == found.start()
            is_first |= number == 2 and text[: found.start()] in ("he", "she")
            if is_first:
                kept = text[: found.start()] + text[found.end() :]
                words = found[0].removesuffix(" and").rstrip(", ")
                return kept, _metres(found), ("", words) if number else (f"{words} ", "")
    return text, 0.0, ("", "")


def _metres(found: re.Match[str]) -> float:
    """The length of a match of `_LENGTH`."""
    parts = {
        re.sub(r"\d", "", name): value for name, value in found.groupdict().items() if value and name[-1].isdigit()
    }
    numbers = {name: float(_WORDS.get(value) or re.sub("[^0-9.]", "", value)) for name, value in parts.items()}
    inches = 12 * numbers.get("ft", 0.0) + numbers.get("in", 0.0)
    return round(numbers.get("m", 0.0) + numbers.get("cm", 0.0) / 100 + 0.0254 * inches, 3)
