"""One movement where a noun in the singular names it, several where it is a plural."""

import pytest

from mmweaver.motion.language.sentence import parse


@pytest.mark.parametrize(
    ("text", "shown"),
    [
        ("does a hook and a right punch", ["a hook with one hand once", "then punching with the right hand once"]),
        ("throws a left punch", ["punching with the left hand once"]),
        ("throws a straight punch", ["punching with one hand once"]),
        ("throws punches", ["punching with both hands in turn repeatedly"]),
        ("does a squat", ["squatting once"]),
        ("does a squat three times", ["squatting three times"]),
        ("does a squat, three times", ["squatting three times", "squatting three times"]),
        ("takes a big jump", ["jumping once"]),
        ("seems to jump", ["jumping once or more"]),
        ("does a jumping jack", ["doing jumping jacks once"]),
        ("does a sit up", ["doing sit-ups once"]),
        ("does side lunges", ["lunging to the side with one leg, the arms out to the sides twice or more"]),
        ("does front lunges", ["lunging ahead with each leg in turn twice"]),
    ],
)  # fmt: skip
def test_one_or_several(text: str, shown: list[str]) -> None:
    assert [clause.shown for clause in parse(f"a person {text}", in_part=True).clauses] == shown
