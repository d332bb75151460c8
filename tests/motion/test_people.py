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


def test_running_is_running_where_there_is_room():
    pelvis = act_out("a person runs to the left", seed=1).pose.joints_m[:, 0, :2]
    fastest = np.linalg.norm(np.diff(pelvis, axis=0), axis=1).max() * 120
    assert 2.5 < fastest < 4.0


def test_who_is_held_is_not_who_holds():
    assert described_person("she rocks a baby").age == ""
    assert described_person("a baby crawls").age == "child"
