"""The half that is scored has no say in the choice."""

import numpy as np

from studies.recognition.zero_shot_nested import Candidate, nested

TRUTH = np.array(["a", "b"] * 10)
FIRST = np.arange(20) < 10


def candidate(name: str) -> Candidate:
    return Candidate(features=name, copies=0, trees="both")


def test_each_half_chooses_for_the_other():
    right, wrong = TRUTH.copy(), np.where(TRUTH == "a", "b", "a")
    found = {
        candidate("good on the first"): np.where(FIRST, right, wrong),
        candidate("good on the second"): np.where(FIRST, wrong, right),
        candidate("fair"): np.where(np.arange(20) % 5 == 0, wrong, right),
    }
    by_first, by_second = nested(found, TRUTH, FIRST)
    assert (by_first[0].features, by_first[1], by_first[2]) == ("good on the first", 1.0, 0.0)
    assert (by_second[0].features, by_second[1], by_second[2]) == ("good on the second", 1.0, 0.0)


def test_what_is_good_on_both_stays_good():
    found = {candidate("good"): TRUTH, candidate("poor"): np.full(20, "a")}
    for best, on_it, other in nested(found, TRUTH, FIRST):
        assert (best.features, on_it, other) == ("good", 1.0, 1.0)
