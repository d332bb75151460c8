"""The curve with labelled recordings: what trains is no test, and without generated windows it trains alone."""

import numpy as np
import pytest

pytest.importorskip("sklearn")

from mmweaver.recognition.training_windows import TrainingWindows
from studies.recognition import labelled_recognition
from studies.recognition.labelled_recognition import curve, gain, row_of
from studies.schema import _row_violations


def test_a_curve_begins_with_what_was_generated_alone(monkeypatch: pytest.MonkeyPatch):
    """One feature; what was generated is shifted, so labelled recordings help, and the more the better."""
    monkeypatch.setattr(labelled_recognition, "TREES", 5)
    rng = np.random.default_rng(0)
    kinds = np.repeat([0, 1], 7)
    owner, labels = np.repeat(np.arange(14), 4), np.repeat(kinds, 4)
    features = (labels + rng.normal(0, 0.1, 56))[:, None]
    made = TrainingWindows(
        features=np.repeat([[1.2], [2.2]], 40, axis=0) + rng.normal(0, 0.1, (80, 1)), label=np.repeat([0, 1], 40),
        person=np.arange(80), is_copy=np.zeros(80, bool), names=("one",),
    )  # fmt: skip
    rows = [row_of(row, {"name": "drawn", "sha256": "0"}, 2) for row in curve(made, features, labels, owner, kinds)]
    assert [(row["real_recordings_each"], row["generated"]) for row in rows] == [
        (0, True), (1, False), (1, True), (5, False), (5, True)
    ]  # fmt: skip
    values = [row["metrics"]["window"]["value"] for row in rows]
    assert values[0] < 0.8 < values[4]
    assert values[3] > 0.9
    assert not [line for row in rows for line in _row_violations(row)]


def test_only_what_may_train_does_and_the_others_are_tested(monkeypatch: pytest.MonkeyPatch):
    """Those that may train have their labels exchanged: trees on them alone are wrong on all others."""
    monkeypatch.setattr(labelled_recognition, "TREES", 5)
    kinds = np.tile([0, 1], 10)
    may_train = np.arange(20) < 10
    owner, labels = np.repeat(np.arange(20), 3), np.repeat(kinds, 3)
    features = np.where(may_train[owner], 1 - labels, labels)[:, None].astype(float)
    made = TrainingWindows(
        features=np.array([[0.0], [1.0]] * 9), label=np.array([0, 1] * 9), person=np.arange(18),
        is_copy=np.zeros(18, bool), names=("one",),
    )  # fmt: skip
    rows = curve(made, features, labels, owner, kinds, may_train, seeds=(3, 4))
    assert [row["seeds"] for row in rows][:2] == [[3], [3, 4]]
    assert [(row["real_recordings_each"], row["generated"]) for row in rows][-2:] == [(5, False), (5, True)]
    assert np.mean(rows[0]["scores"]) == 1.0
    assert [np.mean(row["scores"]) for row in rows if not row["generated"]] == [0.0, 0.0]


def test_a_difference_is_paired_by_samples():
    """The spread of the samples is not that of the difference."""
    found = gain(np.array([0.01, 0.02, 0.03]))
    assert found["value"] == 0.02
    assert found["interval_95"] == pytest.approx([0.02 - 0.0248, 0.02 + 0.0248], abs=1e-4)
    rows = [
        {"real_recordings_each": 1, "generated": generated, "seeds": [0, 1], "n": 2, "seconds": {"all": 0.0},
         "scores": scores, "alone": alone}
        for generated, scores, alone in ((False, [0.5, 0.9], []), (True, [0.6, 0.9], [0.5, 0.9]))
    ]  # fmt: skip
    alone, both = (row_of(row, {"name": "drawn", "sha256": "0"}, 2)["metrics"] for row in rows)
    assert "gain" not in alone
    assert both["gain"]["value"] == pytest.approx(0.05)
