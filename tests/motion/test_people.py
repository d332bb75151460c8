"""The people that seeds and sentences draw."""

import numpy as np
import pytest

from mmweaver.core.errors import InputError
from mmweaver.motion.empty_floor import act_out
from mmweaver.motion.language.described_person import described_person
from mmweaver.motion.people import ADULT_M, person_of, subject_of


def drawn(words: str = "a person", count: int = 400) -> list:
    return [person_of(subject_of(seed), described_person(words)) for seed in range(count)]


def test_adults_have_the_heights_of_the_population():
    people = drawn()
    for sex, (mean, spread) in ADULT_M.items():
        heights = [one.height_m for one in people if one.sex == sex]
        assert 150 < len(heights) < 250
        assert np.mean(heights) == pytest.approx(mean, abs=0.015)
        assert np.std(heights) == pytest.approx(spread, abs=0.012)
    assert 0.05 < np.mean([one.hand == "left" for one in people]) < 0.16


def test_a_described_person_is_of_that_kind():
    assert {one.sex for one in drawn("a woman", 20)} == {"female"}
    assert min(one.height_m for one in drawn("a tall man", 50)) > 1.8
    assert max(one.height_m for one in drawn("a short man", 50)) < 1.7
    assert max(one.height_m for one in drawn("a child", 50)) < 1.53
    assert np.mean([one.pace for one in drawn("an old man", 50)]) == pytest.approx(0.75, abs=0.03)
    assert max(one.girth for one in drawn("a slim woman", 50)) < 1 < min(one.girth for one in drawn("a fat man", 50))
    assert drawn("an elderly woman", 1)[0].age == "old"
    assert drawn("she", 1)[0].sex == "female"
    assert described_person("she walks in a figure eight").words == "she"


def test_a_subject_is_always_the_same_person():
    one, again, other = person_of(7), person_of(7), person_of(8)
    assert one == again != other
    assert person_of(7, height_m=1.8).girth == one.girth
    with pytest.raises(InputError, match="0 to 9999"):
        person_of(-1)


def test_the_old_walk_slowly_and_it_is_said():
    def speed_mps(text: str) -> float:
        made = act_out(text, seed=3)
        pelvis = made.pose.joints_m[:, 0, :2]
        return float(np.linalg.norm(np.diff(pelvis, axis=0), axis=1).sum() / made.plan.duration_s)

    assert speed_mps("an old man walks to the left") < 0.85 * speed_mps("a man walks to the left")
    said = act_out("an old man walks", seed=3).assumptions
    assert any("'old man' is taken as" in sentence and "pace" in sentence for sentence in said)
    assert act_out("a person walks", seed=3).person.described == ""


@pytest.mark.parametrize(
    ("text", "height_m"),
    [
        ("a 1.6 m tall man waves", 1.6),
        ("a man, 1.6 m tall, waves", 1.6),
        ("a man who is 1.85 metres tall waves", 1.85),
        ("a 180 cm tall person waves", 1.8),
        ("a woman of 1.5 m waves", 1.5),
        ("a person of 1.6 m height waves", 1.6),
        ("he is 1.6 m tall and waves", 1.6),
        ("a man is 1.7 m tall and waves", 1.7),
        ("a six foot tall man waves", 1.829),
        ("a 5 foot 6 tall woman waves", 1.676),
    ],
)
def test_a_stated_height_is_kept_and_is_no_distance(text: str, height_m: float):
    made = act_out(text, seed=3)
    assert made.person.height_m == pytest.approx(height_m, abs=0.001)
    assert {record.status for record in made.clauses} == {"done"}
    assert f"{height_m:.2f} m tall" in made.person.note
    assert person_of(3, described_person(text), height_m=1.7).height_m == 1.7


def test_what_stands_elsewhere_is_no_height_of_the_person():
    for text in ("a person jumps over a 1 m tall wall", "a man walks 1.6 m to the left", "a person waves 2 m away"):
        assert described_person(text).height_m == 0.0
    with pytest.raises(InputError, match="a body height of 3 m"):
        act_out("a 3 m tall man waves")
    assert act_out("a 1.6 m tall man walks to the left").plan.steps[0].distance_m == 0.0


@pytest.mark.parametrize(
    ("words", "low_m", "high_m"),
    [
        ("a toddler", 0.79, 0.93),
        ("a baby", 0.79, 0.84),
        ("a small boy", 1.18, 1.27),
        ("a teenage girl", 1.44, 1.78),
        ("a giant", 1.88, 2.15),
        ("a giant man", 2.02, 2.15),
    ],
)
def test_ages_and_statures_show_and_are_said(words: str, low_m: float, high_m: float):
    people = drawn(words, 60)
    assert low_m <= min(one.height_m for one in people) < max(one.height_m for one in people) <= high_m
    made = act_out(f"{words} waves", seed=3)
    assert made.clauses[0].status == "done"
    assert any("is taken as" in note for note in made.assumptions)
