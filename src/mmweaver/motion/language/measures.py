"""Converts measures of a sentence to SI: '6 feet' to '1.83 m', 'at 3 km/h' and 'at 100 steps a minute' to tokens."""

import re

from mmweaver.motion.language.lexicon import NUMBERS

SPEED, CADENCE = "mps_", "spm_"  # tokens: hundredths of m/s, steps per minute
_NUMBER = rf"(?:\d+(?:\.\d+)?|an?|half an?|{'|'.join(word for word in NUMBERS if word not in ('once', 'thrice'))})"
_HALF = r"(?: and a half)?"
_METRES = {"m": 1.0, "cm": 0.01, "mm": 0.001, "km": 1000.0, "feet": 0.3048, "inches": 0.0254, "yards": 0.9144}
_UNITS = {
    "m": r"m|met(?:er|re)s?",
    "cm": r"cms?|centimet(?:er|re)s?",
    "mm": r"mms?|millimet(?:er|re)s?",
    "km": r"kms?|kilomet(?:er|re)s?",
    "feet": r"feet|foot|ft\.?|'",
    "inches": r"inch(?:es)?|\"",
    "yards": r"yards?|yd",
}
_ANY_UNIT = "|".join(f"(?P<{name}>(?:{unit})(?![a-z/]))" for name, unit in _UNITS.items())
_LENGTH = re.compile(rf"(?<![\w-])(?P<number>{_NUMBER})(?P<before>{_HALF})[ -]?(?:{_ANY_UNIT})(?P<after>{_HALF})")
_PER = r" ?(?:/|per|an?|each) ?"
_SPEEDS = (
    (rf"(?:m|met(?:er|re)s?){_PER}(?:s|sec|seconds?)\b|mps\b", 1.0),
    (rf"(?:km|kilomet(?:er|re)s?){_PER}(?:h|hr|hours?)\b|km ?/ ?h\b|kmh\b|kph\b", 1 / 3.6),
    (rf"(?:miles?){_PER}(?:h|hours?)\b|mph\b", 0.44704),
    (rf"(?:cm|centimet(?:er|re)s?){_PER}(?:s|sec|seconds?)\b", 0.01),
    (rf"(?:ft|feet|foot){_PER}(?:s|sec|seconds?)\b", 0.3048),
)
_AT = (
    r"(?:\b(?:at|with|of|by) )?(?:(?:an? )?(?:(?:walking |running |constant |steady )?"
    r"(?:speed|pace|rate|velocity|cadence) of )?)?(?:about |around |roughly )?"
)
_SPEED_PATTERNS = [
    (re.compile(rf"{_AT}(?<![\w.-])(?P<number>{_NUMBER})(?P<before>{_HALF}) ?(?:{unit})"), mps) for unit, mps in _SPEEDS
]
_CADENCE = re.compile(rf"{_AT}(\d+(?:\.\d+)?) (?:steps?|paces|strides){_PER}(?:min|minute)\b")
# Two feet that are no length: "stands on his two feet", "with both feet".
_LIMBS = re.compile(r"(?:\b(?:on|with|his|her|their|its|the|both|off|using|from|onto|raises|lifts|over) )$")
_AWAY = re.compile(
    r"\b((?:walk|go|run|jog|step|mov|stroll|crawl|limp)(?:e?s|e|ing|ped|ed|ped|ping)?(?: (?!and\b|then\b)[a-z]+){0,2}?)"
    r" (?:for )?(\d+(?:\.\d+)? m) (away(?: from (?:the |it|me|us)?(?:radar|camera|sensor|)?)?)(?![a-z])"
)


def measures_in_si(text: str) -> str:
    """Replaces lengths by metres and speeds by tokens.

    Args:
        text: The sentence.

    Returns:
        The sentence; unchanged where it has no measure.

    >>> measures_in_si("walks six feet to the left at 3 km/h, then turns 90\u00b0")
    'walks 1.83 m to the left mps_83, then turns 90 degrees'
    """
    text = re.sub(r" ?\u00b0", " degrees", text)
    text = _CADENCE.sub(lambda found: f"{CADENCE}{round(float(found[1]))}", text)
    for pattern, mps in _SPEED_PATTERNS:
        text = pattern.sub(lambda found, mps=mps: f"{SPEED}{round(100 * _value(found) * mps)}", text)
    text = _LENGTH.sub(_metres, text)
    return _AWAY.sub(r"\1 \3 \2", text)


def unmeasured(text: str) -> str:
    """The sentence without its measures, which fields of steps hold and the joints are measured for.

    Args:
        text: The sentence in lower case.
    """
    return re.sub(rf"\b(?:{SPEED}\d+|{CADENCE}\d+|\d+(?:\.\d+)? m)\b", "", measures_in_si(text))


def _metres(found: re.Match[str]) -> str:
    unit = next(name for name in _UNITS if found[name])
    if re.match(r"[^,.;]{0,25}\b(?:tall|high|in height)\b", found.string[found.end() :]):
        return found[0]  # of the person
    is_limb = _LIMBS.search(found.string[: found.start()]) or (found[unit] == "foot" and found["number"] == "one")
    if unit == "feet" and is_limb:
        return found[0]
    if found["number"] in ("a", "an") and unit in ("feet", "inches", "yards", "m"):
        after = found.string[found.end() :]
        if unit != "m" or not re.match(r"\s*(?:$|[,.;]|away|back|for|to|ahead|left|right|towards?|and|then)", after):
            return found[0] if unit == "feet" else f"{_METRES[unit]:g} m"
    return f"{round(_value(found) * _METRES[unit], 2):g} m"


def _value(found: re.Match[str]) -> float:
    number = found["number"].lower()
    groups = found.groupdict()
    half = 0.5 * bool(groups.get("before") or groups.get("after"))
    if number.startswith("half"):
        return 0.5
    return (1.0 if number in ("a", "an") else float(NUMBERS.get(number, 0) or number)) + half
