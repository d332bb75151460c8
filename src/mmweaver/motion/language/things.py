"""Things that a step acts on: who wipes the table stands before it and faces it, who sits at it faces it, too."""

import re
from dataclasses import replace

from mmweaver.motion.language.lexicon import SEATS, TARGETS
from mmweaver.motion.language.places import AIM, Place
from mmweaver.motion.language.plan import Step

# Hand activities that are done to a thing, and the thing that is meant if the sentence names none.
ACTS_ON = {
    "open_door": "door",
    "knock": "",
    "wipe": "",
    "write": "",
    "type": "",
    "stir": "",
    "push": "",
    "pull": "",
    "reach": "",
    "push_hand": "",
    "pull_hand": "",
    "clap": "",  # washing hands at a sink
}
_TABLES = ("table", "desk", "counter")
_IT = re.compile(r"\b(?:it|them)\b")
_WORD = re.compile("[a-z]+")
_THINGS = "|".join(word for word in TARGETS if word != "wall")
_LOOKS = re.compile(
    r"\b(?P<verb>look|gaz|star|peer|glanc)(?P<ending>e?s|ing)\b(?: out| over| straight)?"
    r"(?: of| at| through| towards?| into)?"
    rf" (?P<thing>(?:the|an?|his|her|their) (?:[a-z]+ )??(?:{_THINGS}))\b"
)
_SIDEWAYS = re.compile(
    r"\b((?:(stand|sit|wait|wav|clap|squat|bow|kneel|stay)|turn|fac)(?:e?s|e|t?ing)?(?: (?!and\b|then\b)[a-z]+){0,3}?)"
    r" (?:sideways|side[- ]on|in profile|with (?:his|her|the|one|a) side)(?: on)? to(?:wards?)? (?:the )?"
    r"(?:radar|camera|sensor|viewer)\b"
)
_OPENS = re.compile(
    rf"\b(?:open|clos|shut)(?:e?s|t?ing|e)? (?:the |an? |his |her )(?:[a-z]+ )??({'|'.join(TARGETS)})\b"
)
_MAIN = re.compile(r"(?:^|,|;|\.|\band|\bthen|\bperson|\bman|\bwoman|\bshe|\bhe) $")


def looks_as_facing(text: str) -> str:
    """Rewrites looks at a thing of the room to facing it: 'looks out of the window', 'facing the window'.

    Args:
        text: The sentence in lower case.

    >>> looks_as_facing("a person looks out of the window")
    'a person stands facing the window'
    """

    def facing(found: re.Match[str]) -> str:
        stands = found["ending"] != "ing" and _MAIN.search(found.string[: found.start()])
        return f"{'stands ' if stands else 'while ' * (found['ending'] != 'ing')}facing {found['thing']}"

    text = _SIDEWAYS.sub(lambda found: f"{found[1]}{' facing' if found[2] else ''} {AIM}sideways ", text)
    return _LOOKS.sub(facing, text)


def face_things(steps: list[Step], given_text: str) -> list[Step]:
    """Turns steps to the things that they act on, and places them there.

    Args:
        steps: Steps in temporal order.
        given_text: The sentence, whose words steps may no longer have.

    Returns:
        The steps with place and facing.
    """
    found: list[Step] = []
    last, is_there, gone = "", False, False
    opened = [TARGETS[found[1]] for found in _OPENS.finditer(given_text.lower())]
    for step in steps:
        named = opened.pop(0) if step.upper == "open_door" and opened else _named(step)
        at = step.place.landmark if step.place is not None and step.place.relation == "near" else ""
        at = at or (step.target if step.moves and step.target not in SEATS else "")
        if step.moves:
            gone, is_there = True, bool(at)
        last = at or named or last
        is_there = is_there or bool(at)
        thing = _thing(step, named, at, last if is_there or _IT.search(step.clause) else "")
        if thing and not step.facing:
            step = replace(step, facing=thing)
        if thing and not gone and step.upper in ACTS_ON and (step.place is None or not step.place.landmark):
            step = replace(step, place=Place("near", thing, also=step.place))
            is_there = True
        found.append(step)
    return found


def _named(step: Step) -> str:
    """The first thing that the words of a step name, other than one to sit on."""
    kinds = (TARGETS[word] for word in _WORD.findall(step.clause) if word in TARGETS and word not in SEATS)
    return next((kind for kind in kinds if kind != "wall"), "")


def _thing(step: Step, named: str, at: str, last: str) -> str:
    """The kind of landmark that a step acts on; "" if none."""
    if step.moves or step.facing or step.lower == "turn":
        return ""
    if step.uses_seat:
        return at if at in _TABLES else ""
    if step.upper in ACTS_ON and step.lower == "stand":
        return at if step.upper == "clap" else at or named or last or ACTS_ON[step.upper]
    return ""
