import json
from pathlib import Path

import pytest

from mmweaver.core.errors import InputError
from mmweaver.motion.language.plan import MotionPlan
from mmweaver.motion.language.sentence import parse
from studies.motion import kitml
from studies.motion.kitml import Sentence, fresh_draw, reading_of, result_row, sentences_of, understood


def sentences(count: int) -> list[Sentence]:
    texts = ("a person walks forward", "a person teleports")
    return [Sentence(name=f"{k:05d}_0", motion=f"{k:05d}", text=texts[k % 2]) for k in range(count)]


def test_half_of_the_motions_is_for_checking():
    share = sum(sentence.is_for_checking for sentence in sentences(2000)) / 2000
    assert 0.45 < share < 0.55


def test_shares_and_judgements(monkeypatch: pytest.MonkeyPatch):
    known, walk = "a person walks forward", parse("a person walks forward")

    def parsed(text: str, *, in_part: bool = False) -> MotionPlan:  # 8,000 sentences, of which there are two
        if text != known:
            raise InputError("unknown")
        return walk

    monkeypatch.setattr(kitml, "parse", parsed)
    some = sentences(4000)
    readings = understood(some)
    assert len(readings) == 2000
    checking = [sentence for sentence in some if sentence.is_for_checking]
    developed, drawn = fresh_draw(checking, ())
    assert len(drawn) == 300
    assert not set(developed) & set(drawn)
    assert not set(fresh_draw(checking, drawn[:5])[1]) & set(drawn[:5])
    names = [name for name in drawn if name in readings]
    verdicts = {
        name: {"reading": "walk forwards", "verdict": "wrong" if k < 3 else "right"} for k, name in enumerate(names)
    }
    verdicts[names[-1]]["reading"] = "another"
    row = result_row(some, verdicts, {"first": {}}, "digest")
    assert row["metrics"]["understood"]["value"] == 0.5
    assert row["evaluated_void"] == 1
    assert row["metrics"]["wrong"]["value"] == round(3 / len(names), 4)
    assert row["metrics"]["understood_frozen"]["value"] == round(len(names) / 300, 4)


def test_mirrored_motions_are_left_out(tmp_path: Path):
    path = tmp_path / "kitml_annotations.json"
    note = {"annotations": [{"seg_id": "1_0", "text": "a person waves"}]}
    path.write_text(json.dumps({"00001": note, "M00001": note}))
    assert [sentence.motion for sentence in sentences_of(path)] == ["00001"]


def test_a_reading_in_a_row():
    assert (
        reading_of(parse("walks 4 steps forward, then kicks with the left foot")) == "walk forwards x4 | kick left foot"
    )


def test_verdicts_of_today_hold_for_the_reading_they_were_given_for():
    old = {name: {"reading": name, "verdict": "right", "why": ""} for name in "ab"}
    since = {"b": {"reading": "other", "verdict": "wrong", "why": ""}}
    today = {"a": "a", "b": "other", "c": "new"}
    shares = kitml._seen_since(old, since, today)
    assert shares["wrong_seen_since"]["value"] == pytest.approx(2 / 3, abs=1e-3)  # b is wrong, c has no verdict
    assert kitml._seen_since(old, {}, today) == {}
