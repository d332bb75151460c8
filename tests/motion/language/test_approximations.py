"""Other words and similar movements: what is said of them, and that known sentences stay as they are."""

import re

import pytest

from mmweaver.core.errors import InputError
from mmweaver.motion.language.approximations import APPROXIMATIONS, apply_approximations
from mmweaver.motion.language.sentence import parse


def test_every_replacement_is_understood():
    for one in APPROXIMATIONS:
        instead = re.sub(r"\\\d", "", one.instead).strip()
        if (
            instead
            and re.match(r"[a-z]+s\b", instead)
            and not instead.startswith(("in ", "limping"))
            and one.instead == instead
        ):
            assert parse(f"a person {instead}").steps, one.instead


def test_known_sentences_are_left_alone_and_unknown_ones_refused():
    text = "A person walks to the left, then waves."
    assert apply_approximations(text, only_always=True) == text
    for unknown in ("a person does a handstand", "a person teleports", "a person does a cartwheel"):
        with pytest.raises(InputError, match=r"no activity|cannot"):
            parse(unknown)


def test_only_how_something_is_done_is_left_out():
    record = parse("a person walks like a stork").clauses[0]
    assert record.status == "approximated"
    assert "resembles" in record.how or "'like a stork' is not shown" in record.how
    for main in ("walks and does a handstand", "jumps over the chair", "two people walk", "waves without walking"):
        with pytest.raises(InputError):
            parse(main)
