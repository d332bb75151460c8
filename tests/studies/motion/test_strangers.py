"""The count of everyday sentences."""

from pathlib import Path

import pytest

from mmweaver.generate import Weaver
from studies.motion.strangers import SECOND, SENTENCES, outcome, result_row


def test_outcomes_and_shares():
    weaver = Weaver("physics")
    texts = ("a person waves", "a person irons a shirt", "a person teleports")
    outcomes = [outcome(weaver, weaver.sample_room(), text) for text in texts]
    assert [kind for kind, _ in outcomes] == ["done", "approximated", "refused"]
    row = result_row(outcomes, "0" * 64)
    assert row["metrics"]["made"]["value"] == 2 / 3
    assert row["reasons"] == {"unknown": 1}


@pytest.mark.parametrize(("path", "count"), [(SENTENCES, 200), (SECOND, 150)])
def test_all_sentences_differ(path: Path, count: int):
    texts = path.read_text(encoding="utf-8").splitlines()
    assert len(set(texts)) == len(texts) == count
