"""The count of everyday sentences."""

from mmweaver.weaver.front_door import Weaver
from studies.motion.strangers import SENTENCES, outcome, result_row


def test_outcomes_and_shares():
    weaver = Weaver("physics")
    texts = ("a person waves", "a person irons a shirt", "a person teleports")
    outcomes = [outcome(weaver, weaver.sample_room(), text) for text in texts]
    assert [kind for kind, _ in outcomes] == ["done", "approximated", "refused"]
    row = result_row(outcomes, "0" * 64)
    assert row["metrics"]["made"]["value"] == 2 / 3
    assert row["reasons"] == {"unknown": 1}


def test_all_sentences_differ():
    texts = SENTENCES.read_text(encoding="utf-8").splitlines()
    assert len(set(texts)) == len(texts) == 200
