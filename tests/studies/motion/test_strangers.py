"""The count of everyday sentences."""

import pytest

from mmweaver.weaver.front_door import Weaver
from studies.motion.strangers import DRAWS, outcome, result_row


def test_outcomes_and_shares():
    weaver = Weaver("physics")
    texts = ("a person waves", "a person irons a shirt", "a person teleports")
    outcomes = [outcome(weaver, weaver.sample_room(), text) for text in texts]
    assert [kind for kind, _ in outcomes] == ["done", "approximated", "refused"]
    row = result_row(outcomes, "0" * 64)
    assert row["metrics"]["made"]["value"] == 2 / 3
    assert row["reasons"] == {"unknown": 1}


@pytest.mark.parametrize(
    ("draw", "count"), [("default", 200), ("second", 150), ("third", 150), ("fourth", 150), ("fifth", 150)]
)
def test_all_sentences_differ(draw: str, count: int):
    texts = DRAWS[draw].read_text(encoding="utf-8").splitlines()
    assert len(set(texts)) == len(texts) == count
