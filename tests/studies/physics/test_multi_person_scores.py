"""The study on one pair of people."""

from dataclasses import replace

import pytest

from mmweaver.core.boards import AWR1843
from mmweaver.propagation.ray_traced import Simulator
from studies.fields.field_signals import sample_scene
from studies.physics import multi_person_scores
from studies.physics.multi_person_scores import ARRANGEMENTS, Pair, make_pair, row_of, scores_of


@pytest.fixture(scope="module")
def behind() -> Pair:
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(multi_person_scores, "NUM_FRAMES", 8)
        return make_pair(Simulator(sample_scene(), AWR1843), ARRANGEMENTS["one behind the other"], 0)


def test_who_stands_behind_is_dimmed_and_the_plain_sum_does_not_know_it(behind: Pair):
    scores = scores_of(behind)
    assert scores["second_dimmed_db"]["superposition"] < -0.5
    assert scores["nmse_active_db"]["superposition"] > scores["nmse_active_db"]["other_noise"] + 10
    assert scores["ra_ssim"]["other_noise"] > 0.95 > scores["ra_ssim"]["superposition"]
    row = row_of("behind", ARRANGEMENTS["one behind the other"], {0: scores}, refused=0)
    assert row["n"] == 1
    assert row["metrics"]["rd_ssim"]["baseline"].keys() == {"without_second"}
    assert row["metrics"]["rd_ssim"]["oracle"].keys() == {"other_noise", "realization"}


def test_a_prediction_that_is_the_truth_has_a_finite_score(behind: Pair):
    scores = scores_of(replace(behind, plain=behind.mutual))
    assert scores["nmse_active_db"]["superposition"] == multi_person_scores.EXACT_DB
