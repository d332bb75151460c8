"""Parses a clause into its steps: its verbs, and their direction, hand, speed, count and seat."""

import re
from dataclasses import replace
from functools import reduce
from itertools import pairwise

from mmweaver.core.errors import InputError
from mmweaver.motion.language.activities import ACTIVITY_OF_LEMMA, words_in
from mmweaver.motion.language.approximations import MARK, approximation_of
from mmweaver.motion.language.clauses import Clause
from mmweaver.motion.language.described_person import PEOPLE
from mmweaver.motion.language.lexicon import (
    ALL_WORDS,
    ARMS,
    BEFORE_NOUNS,
    BOTH,
    DIRECTIONS,
    DISTANCES,
    FILLERS,
    FLOOR_VERBS,
    LEG_VERBS,
    LEGS,
    MANY,
    NEGATIONS,
    NOT_HUMAN,
    NOUNS_LIKE_VERBS,
    NUMBERS,
    OTHER_MOVEMENT,
    OWN,
    RADAR,
    SEATS,
    STEPPING,
    TARGETS,
    THINGS,
)
from mmweaver.motion.language.measures import CADENCE, SPEED
from mmweaver.motion.language.modifiers import STYLE, modifiers
from mmweaver.motion.language.parsed_clause import ParsedClause
from mmweaver.motion.language.places import AIM, Place, place_of
from mmweaver.motion.language.places import MARK as PLACE
from mmweaver.motion.language.suggestions import not_known
from mmweaver.motion.language.verb_steps import GAITS, step_of
from mmweaver.motion.language.words import Word


def parse_clause(clause: Clause) -> ParsedClause:
    """Parses verbs and modifiers of a clause.

    Args:
        clause: The clause; tokens of places and approximations are removed from its words.

    Returns:
        Steps, and modifiers of a clause without a verb.

    Raises:
        InputError: If the clause is not understood, or would be acted out as something else.
    """
    words = clause.words
    parsed = ParsedClause(clause.link, clause.text, number=clause.number, words=words)
    marked = [word.text for word in words if word.text.startswith(MARK)]
    clause.words = words = [word for word in words if word.text not in marked]
    meant = [approximation_of(token) for token in dict.fromkeys(marked)]
    parsed.approximations += [how for how, _ in meant]
    parsed.in_turn = any(in_turn for _, in_turn in meant)
    places = [word.text for word in words if word.text.startswith(PLACE)]
    clause.words = words = [word for word in words if word.text not in places]
    _refuse(clause)
    verbs = _verbs(words, is_placed=any(place_of(token).is_goal for token in places))
    if not verbs:
        parsed.about = replace(
            modifiers(words, clause.text, parsed.notes),
            place=reduce(Place.together_with, map(place_of, places)) if places else None,
        )
        _note_unknown(words, clause, parsed, has_verb=False)
        return parsed
    for one, other in pairwise(verbs):  # "a hopping walk"
        if other == one + 1 and words[one].form == "ing" and words[other].form in ("base", "s"):
            raise InputError(not_known(clause.text, f"{words[one].text} {words[other].text}"))
    for at in verbs:  # "a chachacha basic step"
        noun = words[at].lemma in ("step", "turn", "jump") and words[at].form in ("base", "s") and at
        if noun and not is_known(words[at - 1]) and words[at - 1].text[:1].isalpha():
            subject = words[at].form == "s" and words[at].text not in ("steps", "turns", "jumps")
            if not subject and any(word.is_verb and not word.is_activity for word in words[:at]):
                raise InputError(not_known(clause.text, words[at - 1].text))
    _note_unknown(words, clause, parsed, has_verb=True)
    parsed.form = _form(words, verbs[0])
    # Words before the first verb belong to it.
    starts = [0, *(_start_of(words, before, at) for before, at in pairwise(verbs))]
    ends = [*starts[1:], len(words)]
    for k, (at, end) in enumerate(zip(verbs, ends, strict=True)):
        begin = starts[k]
        own = words[begin:end]
        about = modifiers(own, clause.text, parsed.notes)
        step = replace(step_of(own, at - begin, about, clause.text), clauses=(clause.number,))
        is_held = words[at].form == "past" and any(word.text == "with" for word in words[begin:at])
        if is_held and step.upper == "raise" and not step.count:  # "with the left arm raised"
            step = replace(step, upper="raise_hold")
        parsed.steps.append(step)
        parsed.forms.append(_form(words[starts[k] :], at - starts[k]) if k else parsed.form)
    for token in places:
        _put_at(parsed, place_of(token))
    kept = any(step.distance_m and step.lower in GAITS for step in parsed.steps)
    lengths = any(
        other.text in DISTANCES and (one.text in NUMBERS or one.text not in (*OWN, *BOTH, "the", "with"))
        for one, other in pairwise(words)
    )  # "ten feet", "a few metres", not "his feet"
    if lengths and not kept:
        parsed.approximations.append("the distance is not kept: it follows from time and speed")
    paced = any((step.speed_mps or step.steps_hz) and step.lower in GAITS for step in parsed.steps)
    if not paced and any(word.text.startswith((SPEED, CADENCE)) for word in words):
        parsed.approximations.append("the speed is not kept")
    return parsed


def _put_at(parsed: ParsedClause, place: Place) -> None:
    """Assigns a place to the clause's last step: where it is done, or the destination or length of a walk."""
    last = parsed.steps[-1]
    how = {"against": "the wall is not touched", "in": "is shown just before the door" * (place.landmark == "door")}
    if how.get(place.relation):
        parsed.approximations.append(how[place.relation])
    if place.relation in ("under", "outside"):
        last = replace(last, place=place)
    elif last.moves and place.relation == "range":
        last = replace(last, distance_m=place.distance_m)
    elif last.moves and last.lower not in ("walk", "jog"):
        parsed.approximations.append(f"{place.words!r} is left open for {last.name}")
    else:
        both = place if last.place is None else last.place.together_with(place)
        last = replace(last, place=both, target="" if place.is_goal else last.target)
    parsed.steps[-1] = last


def _start_of(words: list[Word], before: int, at: int) -> int:
    """Index where a later verb's own words begin: at its light verb ("takes a turn"), else at its adjectives."""
    if words[at].form == "past":  # "walks with the left hand raised"
        noun = [i for i in range(before + 1, at) if words[i].text == "with"]
        if noun:
            return noun[-1]
    light = [i for i in range(before + 1, at) if words[i].is_verb and not words[i].is_activity]
    if light:
        return light[0]
    turned = ACTIVITY_OF_LEMMA.get(words[before].lemma) == ("turn", "")  # "turns 180 degrees walks back"
    while at - 1 > before and (
        words[at - 1].text in BEFORE_NOUNS or (words[at - 1].text.startswith("deg") and not turned)
    ):
        at -= 1
    return at


_OF_THEM = re.compile(r"(?<!side)(?<!sides)(?<!front)(?<!ahead) of them\b")


def _refuse(clause: Clause) -> None:
    """Raises InputError for negations, several people, animals, and unknown movements."""
    texts = {word.text for word in clause.words}
    still = texts & {"moving", "movement", "motion"} and texts & {"without", "not", "no"}
    if texts & NEGATIONS and not still:
        raise InputError(f"{clause.text!r} says what is not done; say what the person does instead")
    if texts & MANY or _OF_THEM.search(clause.text):
        raise InputError(f"{clause.text!r} speaks of several people; say it of one and give --text once for each")
    if texts & NOT_HUMAN:
        raise InputError(f"{clause.text!r} is not about a person alone; only one person can be shown")
    lemmas = {word.lemma for word in clause.words if word.is_activity}
    other = [word.text for word in clause.words if word.text in OTHER_MOVEMENT and not _harmless(word, texts, lemmas)]
    if other:
        raise InputError(not_known(clause.text, other[0]))


def _harmless(word: Word, texts: set[str], lemmas: set[str]) -> bool:
    """Whether a word that may name an unknown movement does not, given the clause's verbs."""
    if word.text in LEGS and lemmas & LEG_VERBS:
        return True
    if word.text in ("over", "legs", "leg", "foot", "knees", "knee", "head", "shoulder", "shoulders"):
        lifted = texts & {"raise", "raises", "raising", "raised", "lift", "lifts", "lifting", "lifted"}
        jumped = texts & {"jump", "jumps", "jumping", "hop", "hops", "leaps"}
        if word.text in ("head", "shoulder", "shoulders"):
            return not lifted or "above" in texts or "over" in texts or bool(texts & ARMS)
        if word.text == "over":
            return not jumped and "chair" not in texts
        return not lifted and word.text not in ("leg", "foot", "knee") and "on" not in texts
    if word.text == "eight":
        return bool(texts & {"step", "steps", "times", "meters", "metres", "m", "second", "seconds"})
    if word.text in ("floor", "ground"):
        return bool(lemmas & FLOOR_VERBS) or not texts & {"sit", "sits", "sitting", "seated", "sit_down", "sat"}
    return word.text == "against" and "pushed" in lemmas


_FACED = words_in("the a an to me us another other each opposite what where away")
_IT = ("them", "it", "him", "her")
_OF_THE_BODY = frozenset({"waist", "hips", "torso", "trunk", "shoulders", "head", "legs", "leg", "knees", "body"})


def _verbs(words: list[Word], *, is_placed: bool) -> list[int]:
    """Positions of the words that name an activity, without light verbs and nouns that repeat a verb.

    `is_placed`: the clause names a destination.
    """
    found: list[int] = []
    texts = {word.text for word in words}
    for i, word in enumerate(words):
        if word.text == "head" and i and words[i - 1].text not in ("to", "and", "then", "they"):
            continue  # the part of the body, as in "tilts the head" and "tilts head"
        after = words[i + 1].text if i + 1 < len(words) else ""
        if word.lemma == "reach" and after in ("the", "his", "her", "its", "their"):
            continue  # "reaches the end"
        if word.lemma == "move" and (texts & ARMS or texts & _OF_THE_BODY or after in _IT):
            continue  # the arm moves in an unknown way
        goes_somewhere = is_placed or bool(texts & {*DIRECTIONS, *RADAR, *SEATS, *TARGETS})
        if (word.is_going and goes_somewhere) or (word.is_activity and not _is_noun(words, i, found)):
            found.append(i)
    if len(found) > 1 and words[found[0]].lemma in ("stop", "halt") and words[found[1]].form == "ing":
        return found[:1]  # "stops walking" is standing still
    return found


def _is_gait(word: Word) -> bool:
    return ACTIVITY_OF_LEMMA.get(word.lemma, ("", ""))[0] in ("walk", "jog", "march", "hop", "jump")


def _is_noun(words: list[Word], i: int, found: list[int]) -> bool:
    """'drinks a drink', 'box' as a thing, 'the hand wave': a noun after another verb of the clause."""
    word, before = words[i], words[i - 1].text if i else ""
    if word.lemma == "face":
        return _is_the_face(words, i) or bool(found)
    if word.text == "pace":
        return before not in ("to", "they", "i", "we", "you", "")  # "at a moderate pace", "increases pace"
    if _is_adjective(words, i):
        return True
    if word.form == "ing" or word.lemma in ("sit_down", "stand_up", "jumping_jack", "seated"):
        return False
    if word.lemma in ("drink", "stop") and before in ("a", "the", "his", "her", "their"):
        return bool(found)
    if _is_plain_noun(word, _word_before_adjectives(words, i) if found else before, after_a_verb=bool(found)):
        return True
    if word.lemma == "step" and found and "with" in [other.text for other in words[max(i - 4, 0) : i]]:
        return True  # "jumps onto it with one large step"
    going = any(words[k].lemma in STEPPING or _is_gait(words[k]) for k in found)
    if word.lemma == "step" and word.form in ("base", "s") and going:
        return not any(other.is_verb and not other.is_activity for other in words[found[-1] + 1 : i])
    same = [k for k in found if ACTIVITY_OF_LEMMA.get(words[k].lemma, ("walk", "")) == ACTIVITY_OF_LEMMA[word.lemma]]
    return bool(same) and same[-1] == found[-1]  # "walks a walk", not "walks to the left, turns around walk back"


def _word_before_adjectives(words: list[Word], i: int) -> str:
    """The word before word `i`, or before an adjective of it that follows an article: "a" of 'a heavy box'."""
    at = i - 1
    if at > 0 and words[at - 1].text in ("a", "an", "the", *OWN) and not (words[at].is_verb or words[at].text in OWN):
        at -= 1
    return words[at].text if at >= 0 else ""


_BEFORE_BOXES = frozenset({"this", "that", "these", "those", "some", "few", "several", "many", "more", "of", *NUMBERS})


def _is_plain_noun(word: Word, before: str, *, after_a_verb: bool) -> bool:
    """'karate type moves', 'a box', 'his phone', 'a starting point': nouns that look like a verb."""
    owned = before in ("a", "the", "his", "her", "their", "my")
    if word.form == "base" and word.lemma == "point":
        return after_a_verb or before in ("a", "the", "starting", "same", "specific")
    return (
        (word.lemma == "seat" and word.form != "past")
        or (owned and word.lemma in ("phone", "text", "comb"))
        or (word.text in ("box", "boxes") and (owned or before in _BEFORE_BOXES or before.isdigit()))
    )


def _is_the_face(words: list[Word], i: int) -> bool:
    """Whether "face" is the part of the body: nothing that can be faced follows, or a hand touches it."""
    before, after = words[i - 1].text if i else "", words[i + 1].text if i + 1 < len(words) else ""
    put = before == "to" and i > 1 and words[i - 2].text in ("it", "them", "something", "hand", "hands")
    aimed = after in _FACED or after in DIRECTIONS or after in OWN
    return put or before in (*OWN, "the", "a", "near") or (words[i].form == "base" and not aimed)


def _is_adjective(words: list[Word], i: int) -> bool:
    """ "Throws a skipping rock"."""
    before, noun = words[i - 1].text if i else "", words[i + 1] if i + 1 < len(words) else None
    is_article = words[i].form == "ing" and before in ("a", "an")
    return is_article and noun is not None and not is_known(noun) and any(other.is_verb for other in words[:i])


def _form(words: list[Word], at: int) -> str:
    light = next((word for word in words[:at] if word.is_verb and not word.is_activity), None)
    return light.form if light else words[at].form


def _note_unknown(words: list[Word], clause: Clause, parsed: ParsedClause, *, has_verb: bool) -> None:
    """Reports unknown words of a clause with a verb; one that looks like another activity is an error."""
    unknown = [word.text for word in words if not is_known(word)]
    if not has_verb:
        parsed.unknown = unknown + [word.text for word in words if word.is_verb and word.text != "face"]
        return
    moved = next((i for i, word in enumerate(words) if word.lemma == "move"), None)
    if moved is not None and any(not is_known(word) or word.text in THINGS for word in words[moved + 1 : moved + 3]):
        raise InputError(not_known(clause.text, "move"))
    if moved is not None and {word.text for word in words} & ARMS and sum(word.is_activity for word in words):
        parsed.approximations.append("how the arms move is not shown")
    odd = _unknown_manner(words)
    if odd:
        raise InputError(not_known(clause.text, odd))
    for text in unknown:
        doing = (text.endswith("ing") and len(text) > 4) or (text.endswith("ed") and len(text) > 3)
        if doing and text not in NOUNS_LIKE_VERBS:
            raise InputError(not_known(clause.text, text))
    subject = _subject(words) if clause.number == 0 else ""
    unknown = [text for text in unknown if text not in (subject, "if")]
    if unknown:
        listed = " and ".join(repr(text.replace("_", " ").replace("-", " ")) for text in unknown)
        parsed.approximations.append(f"{listed} {'is' if len(unknown) == 1 else 'are'} not shown")


def _subject(words: list[Word]) -> str:
    """The noun before the first verb, if the clause begins with one: 'burglar' of 'a burglar tiptoes'."""
    if len(words) > 2 and words[0].text in ("a", "an", "the") and words[2].is_verb and not words[1].is_verb:
        return words[1].text
    return ""


def _unknown_manner(words: list[Word]) -> str:
    """An unknown word for a manner or an action: 'in a pentagon', 'performs capoeira'; "" if there is none."""
    for i, word in enumerate(words):
        if is_known(word) or not word.text[:1].isalpha():
            continue
        before = [other.text for other in words[max(i - 3, 0) : i]]
        if before[-2:] in (["in", "a"], ["in", "an"], ["of", "a"], ["of", "an"], ["like", "a"]):
            return word.text
        lead = i - 1
        while lead >= 0 and words[lead].text in ("a", "an", "the", "some", "his", "her", "with"):
            lead -= 1
        if lead >= 0 and words[lead].lemma in ("do", "perform", "make", "practice", "practise", "execute"):
            following = words[i + 1] if i + 1 < len(words) else None
            if following is None or not following.is_verb:
                return word.text
    return ""


_KNOWN = frozenset().union(
    ALL_WORDS - NEGATIONS - MANY - NOT_HUMAN - OTHER_MOVEMENT,
    FILLERS | OWN | PEOPLE | LEGS | NUMBERS.keys(),
    words_in(
        "left right not without moving sideways on_spot lookdown onback onbelly one_knee highkick frontlunge reach_high"
    ),
)


def is_known(word: Word) -> bool:
    """Whether a word has a known meaning, or none that matters, in a sentence about a movement."""
    text = word.text
    is_token = text.startswith((AIM, "arc", "deg", "from_", "on_", "fraction_", "rounds_", SPEED, CADENCE, STYLE))
    is_token |= len(text) == 1
    return word.is_verb or text in _KNOWN or is_token or text.replace(".", "").isdigit()
