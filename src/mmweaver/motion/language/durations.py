"""Converts durations in words to seconds: 'one minute and a half', 'half an hour', 'a minute and 20 seconds'."""

import re

_DIGITS = "one two three four five six seven eight nine"
_TEENS = "ten eleven twelve thirteen fourteen fifteen sixteen seventeen eighteen nineteen"
_TIES = "twenty thirty forty fifty sixty seventy eighty ninety"
_SMALL = {word: value for value, word in enumerate(f"{_DIGITS} {_TEENS}".split(), start=1)}
_TENS = {word: 10 * value for value, word in enumerate(_TIES.split(), start=2)}
_SECONDS = {"h": 3600.0, "m": 60.0, "s": 1.0}  # by the first letter of the unit
_FRACTIONS = {"half": 0.5, "quarter": 0.25, "three quarters": 0.75}

_ALONE = "|".join(sorted(_SMALL, key=len, reverse=True))
_WORD = rf"(?:{_TIES.replace(' ', '|')})(?:[- ](?:{_DIGITS.replace(' ', '|')}))?|{_ALONE}"
_NUMBER = rf"\d+(?:\.\d+)?|{_WORD}|an?|another|a couple(?: of)?|a few|several"
_UNIT = r"(?P<{}>hours?|hrs?|minutes?|mins?|seconds?|secs?)\b"
_MORE = r"(?: and (?:a |one )?(?P<{}>half|quarter|three quarters))?"
_PART = re.compile(
    rf"\b(?:(?P<fraction>half|(?:an? )?quarter|three quarters) (?:of )?(?:an? )?{_UNIT.format('whole')}"
    rf"|(?P<number>{_NUMBER}){_MORE.format('before')} ?{_UNIT.format('unit')}{_MORE.format('after')}"
    r"|(?P<digits>\d+(?:\.\d+)?) ?(?P<short>h|min|s)\b)",
    re.IGNORECASE,
)
_JOINT = re.compile(r",?(?: and)? ", re.IGNORECASE)
_LASTING = re.compile(
    r"\b(?:for|lasting|during|within|takes|about|around|nearly|almost|over|last|next) $", re.IGNORECASE
)
_NO_DURATION = re.compile(
    r" (?:later|afterwards|time|try|attempt|step|one|hand|man|woman|person|set|round)\b", re.IGNORECASE
)
_VAGUE = {"a couple of": 2.0, "a couple": 2.0, "a few": 3.0, "several": 3.0}


def durations_in_seconds(text: str) -> str:
    """Replaces each duration of a sentence by a number of seconds.

    Args:
        text: The sentence.

    Returns:
        The sentence; `text` itself if it has no duration.

    >>> durations_in_seconds("waves for one minute and a half, then rests for half an hour")
    'waves for 90 seconds, then rests for 1800 seconds'
    >>> durations_in_seconds("bows a second time, two seconds later")
    'bows a second time, two seconds later'
    """
    found = list(_PART.finditer(text))
    parts, end = [], 0
    at = 0
    while at < len(found):
        first = last = found[at]
        seconds = _seconds(first)
        while at + 1 < len(found) and _goes_on(last, found[at + 1], text):
            at += 1
            last = found[at]
            seconds += _seconds(last)
        at += 1
        if _is_duration(text, first, last):
            parts += [text[end : first.start()], f"{seconds:g} seconds"]
            end = last.end()
    return "".join([*parts, text[end:]])


def _goes_on(before: re.Match[str], after: re.Match[str], text: str) -> bool:
    """Whether a part continues the same duration: 'one minute' and '20 seconds'."""
    is_joined = _JOINT.fullmatch(text[before.end() : after.start()]) is not None
    return is_joined and _unit_s(after) < _unit_s(before)


def _is_duration(text: str, first: re.Match[str], last: re.Match[str]) -> bool:
    """Whether it is neither a point in time ('two seconds later') nor an ordinal number ('a second time')."""
    number = (first["number"] or "").lower()
    is_article = number in ("a", "an", "another") and first is last and not first["after"]
    is_article = is_article and _unit_s(first) == 1.0
    before = text[: first.start()]
    is_point = _NO_DURATION.match(text[last.end() :]) or before.lower().endswith("after ")
    return not (is_point or (is_article and not _LASTING.search(before)))


def _unit_s(part: re.Match[str]) -> float:
    return _SECONDS[(part["whole"] or part["unit"] or part["short"])[0].lower()]


def _seconds(part: re.Match[str]) -> float:
    if part["fraction"]:
        return _FRACTIONS[re.sub("^an? ", "", part["fraction"].lower())] * _unit_s(part)
    more = sum(_FRACTIONS[part[name].lower()] for name in ("before", "after") if part[name])
    return (_value((part["number"] or part["digits"]).lower()) + more) * _unit_s(part)


def _value(number: str) -> float:
    if number[0].isdigit():
        return float(number)
    if number in _VAGUE:
        return _VAGUE[number]
    tens, _, ones = number.replace("-", " ").partition(" ")
    return float(_TENS.get(tens, 0) + _SMALL.get(ones or tens, 0)) or 1.0  # "a", "another"
