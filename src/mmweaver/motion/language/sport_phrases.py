"""Phrases of boxing, tennis, kicks and exercises that go somewhere, replaced by one token a movement."""

import re
from collections.abc import Callable

_ADJECTIVES = r"(?:(?:quick|fast|hard|strong|short|straight|powerful|sharp) )*"
_HAND = r"(?:(left|right)(?:[- ]hand(?:ed)?)? )?"
_NUMBER = r"(?:(one|two|three|four|five|six|some|several|a few|\d+) )?"
_PUNCH = (
    rf"(?:(?:an?|the|another|his|her) )?{_NUMBER}{_ADJECTIVES}{_HAND}{_ADJECTIVES}(jab|cross|hook|uppercut)(?:s|es)?\b"
)
_ANY_PUNCH = re.sub(r"\((?!\?)", "(?:", _PUNCH)
_LANDS = r"(?:throws?|throwing|lands?|landing|delivers?|punch(?:es|ing)(?: with)?)"
_DOES = r"(?:does|do|doing|performs?|performing|makes?|making|practi[cs]es|boxes|boxing)(?: with|:| -)?"
_NEXT = r"(?: ?, ?(?:and |then |and then )?|,? (?:and then|and|then|followed by) | ?- ?| ?/ ?| )"
PUNCHES = rf"(?:\b(?P<lands>{_LANDS}) |\b(?P<does>{_DOES}) ?|\b)(?P<list>{_ANY_PUNCH}(?:{_NEXT}{_ANY_PUNCH})*)(?: (?:combination|combo|sequence))?"
_TOKENS = {"jab": "jab", "cross": "cross_punch", "hook": "hook_punch", "uppercut": "uppercut"}
_FEW = {"some": "3", "several": "3", "a few": "3"}
_IN_TURN = re.compile(r"\b(?:left|right)\b")


def named_punches(found: re.Match[str]) -> str:
    """One token for each punch of a list, with its hand and number: "a jab, a cross and a hook".

    A cross or hook that nobody throws or does, and that has no jab or uppercut with it, is none.
    """
    punches = list(re.finditer(_PUNCH, found["list"]))
    names = {punch[3] for punch in punches}
    sure = found["lands"] or names & {"jab", "uppercut"} or (found["does"] and (len(punches) > 1 or punches[0][2]))
    if not sure and not (found["does"] and names == {"hook"}):
        return found[0]
    said = []
    for number, hand, name in (punch.groups() for punch in punches):
        times = f" {_FEW.get(number, number)} times" if number and number != "one" else ""
        said.append(f"{_TOKENS[name]}{f' with the {hand} hand' if hand else ''}{times}")
    ends = "s" if found["lands"] or found["does"] or re.search(r"[bkst]s$|crosses$", found["list"]) else ""
    return " " + " , then ".join(re.sub(r"^\w+", lambda token: token[0] + ends, one) for one in said) + " "


def hands_in_turn(found: re.Match[str]) -> str:
    """One punch for each side: "punches left, right, left"."""
    return " " + " , then ".join(f"punches once with the {side} hand" for side in _IN_TURN.findall(found[2])) + " "


def sided_kick(found: re.Match[str]) -> str:
    """A roundhouse or side kick, with its leg."""
    leg = next((side for side in found.groups()[:-1] if side in ("left", "right")), "")
    token = "side_kick" if found.groups()[-1] == "side" else "roundhouse"
    high = "highkick " if re.search(r"\bhigh\b", found[0]) else ""
    return f" {high}{token}{'s' if found[0].endswith('s') else ''}{f' with the {leg} leg' if leg else ''} "


_LEG = r"(?:(left|right)(?:[- ](?:leg|foot))? )?"
_OWN = r"(?:(?:his|her|its|their|the|both) )*"
_STROKE = r"(?: (?:tennis )?(?:strokes?|swings?|shots?|drives?|hits?|returns?|ground ?strokes?))?(?: in tennis)?"
_HITS = r"(?:(?:hits?|hitting|plays?|playing|performs?|performing|does|doing|swings?|swinging|makes?|making|practi[cs]es) )?"

# Replaced in this order, before all other phrases.
SPORT_PHRASES: tuple[tuple[str, str | Callable[[re.Match[str]], str]], ...] = (
    (r"\b(throws?|does|punches|performs?|lands?) (?:an? |the )?(?:quick |fast )?one[- ]two(?: punch(?:es)?| combination| combo)?\b",
     r"\1 a jab and a cross"),
    (r"\b(?:shadow[- ]?)?box(?:es|ing) ?(?::|-|with) ?(?=(?:an? |some |a few )?(?:left |right )?(?:jab|cross|hook|uppercut))", "throws "),
    (r"\bshadow[- ]?box(?:es|ing)(?=,? (?:throwing|with) )", "stands"),
    (PUNCHES, named_punches),
    (r"\b(punch(?:es|ing)?|box(?:es|ing)?|throws? punches)(?: with (?:the )?)? ((?:left|right)(?:(?: ?, ?(?:and |then )?| and | then | ?- ?)(?:left|right)\b)+)",
     hands_in_turn),
    # kicks
    (rf"\b{_LEG}(?:high )?(?:roundhouse|round[- ]house|turning|round) {_LEG}?(kick)(?:s|ing)?\b", sided_kick),
    (rf"\b{_LEG}(?:high )?(side)[- ]?kick(?:s|ing)?\b", sided_kick),
    (r"\bkick(s|ing)? (?:to the |out to the )?side(?:ways|wards)?\b", r" side_kick\1 "),
    # tennis
    (r"\btennis players?\b", "person"),
    (r"\bswing(?:s|ing)? (?:an? |the |his |her )?(?:tennis )?rac(?:k|qu)et,? (?:(?:with|in|for|as) )?(?:an? )?(?=forehand|backhand)", " "),
    (rf"\b{_HITS}(?:an? |the |some |his |her )?(?:two|double|2)[- ]handed (?:tennis )?backhand{_STROKE}(?! serve)\b", " backhand with both hands "),
    (rf"\b{_HITS}(?:an? |the |some |his |her )?(?:one[- ]handed )?(?:tennis )?(forehand|backhand){_STROKE}(?: first)?\b", r" \1 "),
    (rf"\b(?:{_HITS})(?:an? |the |some |his |her )?tennis serves?\b|\bserv(?:es?|ing) (?:an? |the )?(?:tennis )?ball(?: in tennis)?\b|\bserv(?:es|ing) in tennis\b",
     " tennis_serve "),
    # lunges that go somewhere
    (r"\bwalk(?:s|ing)?[- ]lunges?\b|\blunge[- ]walk(?:s|ing)?\b|\bwalk(?:s|ing)? (?:in|with) lunges\b", " walking_lunge "),
    (r"\blung(?:es|ing)(?: forwards?)? (?:across|through|along) (?:the |a )?(?:room|floor|hall|gym)\b", " walking_lunge forwards "),
    # hips
    (rf"\b(?:circl|rotat|mov|gyrat|roll|swing)(?:es|s|ing) {_OWN}hips (?:around|round|in (?:an? )?(?:(?:big|large|small|wide|full) )*circles?"
     r"|in (?:an? )?circular (?:motions?|movements?))(?: (?:as if|as though|like|as when) (?:using|doing|with|playing with|spinning)? ?(?:an? )?hula[- ]?hoop(?:ing|s)?)?",
     " hula_hoop "),
    (rf"\b(?:circl|rotat|gyrat)(?:es|ing) {_OWN}hips\b|\bhip circles?\b", " hula_hoop "),
    (r"\b(?:(?:does|do|doing|plays?|playing|spins?|spinning|swings?|swinging|twirls?|twirling|uses|using|practi[cs]es|is|are) )?(?:with )?(?:an? |the |some |his |her )?"
     r"hula[- ]?hoop(?:s|ing)?\b(?: around (?:the |his |her )?(?:waist|hips?))?", " hula_hoop "),
    # over the head
    (r"\bforward[- ]rolls?\b|\bfront[- ]rolls?\b|\b(?<!back )(?<!backward )(?<!backwards )somersaults?\b", " forward_roll "),
    (r"\brolls? forwards?\b(?: over (?:his|her|the|one) (?:head|shoulder))?(?: (?:on|over|across) the (?:floor|ground|mat))?", " forward_roll "),
)  # fmt: skip
