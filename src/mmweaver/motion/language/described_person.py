"""Who does it: sex, age, stature and build, where the sentence says so."""

import re
from dataclasses import dataclass

_WOMEN = "woman|women|lady|girl|female|mother|mom|grandma|grandmother|granny|wife|daughter|sister|waitress|actress"
_MEN = "man|men|gentleman|boy|male|guy|father|dad|grandpa|grandfather|husband|son|brother|policeman|fireman|waiter"
_CHILDREN = "child|kid|boy|girl|toddler|baby|schoolboy|schoolgirl|pupil"
PEOPLE = frozenset("|".join((_WOMEN, _MEN, _CHILDREN)).split("|"))
PERSON_NOUNS = "|".join((*PEOPLE, "person", "human", "adult", "user", "somebody", "someone", "teenager"))
_ANYBODY = (
    r"person|human|adult|user|subject|figure(?![- ](?:of |eight|8))|individual|participant|patient"
    "|resident|tenant|somebody|someone|youth|teenager|nurse"
)
_NOUN = rf"(?P<noun>{_WOMEN}|{_MEN}|{_CHILDREN}|{_ANYBODY}|elderly|athlete|worker|student|player|dancer)"
_OLD = frozenset(["old", "elderly", "aged", "senior", "aging", "ageing"])
_GRAND = frozenset(["grandma", "grandmother", "granny", "grandpa", "grandfather", "elderly"])
_STATURE = {"tall": 1, "short": -1, "small": -1, "little": -1, "tiny": -1, "huge": 1, "giant": 1}
_BUILD = {
    **dict.fromkeys(("heavy", "fat", "overweight", "obese", "stout", "chubby", "plump", "stocky", "big", "large"), 1),
    **dict.fromkeys(("muscular", "strong", "burly", "corpulent", "broad"), 1),
    **dict.fromkeys(("slim", "thin", "skinny", "slender", "lean", "lanky", "petite"), -1),
}
BUILDS = "|".join(_BUILD)
_ADJECTIVES = "|".join(sorted({*_OLD, *_STATURE, *_BUILD, "young", "very", "rather", "and", "middle-aged"}, key=len))
_PERSON = re.compile(rf"\b(?P<words>(?:(?:{_ADJECTIVES})[ ,]+)*){_NOUN}\b")
_PRONOUN = re.compile(r"\b(he|she|his|her|himself|herself)\b")


@dataclass(frozen=True, kw_only=True)
class DescribedPerson:
    """What a sentence says of its person; "" and 0 where it says nothing."""

    words: str = ""  # of the sentence
    sex: str = ""  # female | male
    age: str = ""  # child | old
    stature: int = 0  # -1 short, 1 tall
    build: int = 0  # -1 slim, 1 heavy

    @property
    def is_described(self) -> bool:
        return bool(self.sex or self.age or self.stature or self.build)


def described_person(text: str) -> DescribedPerson:
    """The person of a sentence: of its first noun for a person with its adjectives, else of its first pronoun.

    >>> described_person("a tall old woman walks")
    DescribedPerson(words='tall old woman', sex='female', age='old', stature=1, build=0)
    """
    folded = text.lower()
    found = _PERSON.search(folded)
    subject = re.search(r"\b(?:he|she)\b", folded)
    if found is not None and subject is not None and subject.start() < found.start():
        found = None  # "she rocks a baby"
    if found is None or found["noun"] in _ANYBODY.split("|"):
        pronoun = _PRONOUN.search(folded)
        sex = "" if pronoun is None else "female" if pronoun[1] in ("she", "her", "herself") else "male"
        if found is None:
            return DescribedPerson(words=pronoun[1] if pronoun else "", sex=sex)
    else:
        sex = "female" if found["noun"] in _WOMEN.split("|") else "male" if found["noun"] in _MEN.split("|") else ""
    adjectives = re.split(r"[ ,]+", found["words"])
    age = "child" if found["noun"] in _CHILDREN.split("|") else ""
    if not age and (set(adjectives) & _OLD or found["noun"] in _GRAND):
        age = "old"
    return DescribedPerson(
        words=found.group().strip(),
        sex=sex,
        age=age,
        stature=0 if age == "child" else next((_STATURE[word] for word in adjectives if word in _STATURE), 0),
        build=next((_BUILD[word] for word in adjectives if word in _BUILD), 0),
    )
