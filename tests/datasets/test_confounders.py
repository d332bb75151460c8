"""A leak that is there is found; matched circumstances are at chance."""

import numpy as np
import pytest

from mmweaver.core.seeding import stream
from mmweaver.datasets.confounders import leak_report

LABEL = np.tile(np.arange(4), 30)
NAMES = ["walk", "wave", "sit", "box"]
DRAW = np.repeat(np.arange(30), 4)


def test_a_place_that_tells_the_label_leaks():
    place = LABEL[:, None] + stream(0, "test").normal(size=(120, 2)) * 0.1
    report = leak_report({"start_place": place}, LABEL, DRAW, NAMES)
    assert report["verdict"] == "leaks: start_place"
    assert report["of"]["start_place"]["accuracy"] > 0.9


def test_matched_places_are_at_chance():
    place = np.repeat(stream(0, "test").normal(size=(30, 2)), 4, axis=0)
    report = leak_report({"start_place": place}, LABEL, DRAW, NAMES)
    assert report["verdict"] == "leaks: none found"
    assert abs(report["of"]["start_place"]["accuracy"] - 0.25) < 0.01


def test_what_cannot_be_avoided_is_said_and_does_not_count():
    report = leak_report({"energy": LABEL[:, None].astype(float)}, LABEL, DRAW, NAMES)
    assert report["of"]["energy"]["leaks"]
    assert report["of"]["energy"]["cannot_be_avoided"]
    assert report["verdict"] == "leaks: none found"


def test_a_label_that_is_answered_for_all_others_too_does_not_leak():
    """The first label's places come in pairs; those of the two others lie around such a pair of other draws."""
    centre = np.repeat(stream(0, "test").normal(size=(15, 2)), 2, axis=0)
    around = 1e-3 * np.array([[(1, 0), (-1, 0)], [(0, 1), (0, -1)]])  # (draw of a pair, label)
    places = np.concatenate(
        [centre[:, None], np.roll(centre, 2, axis=0)[:, None] + np.tile(around, (15, 1, 1))], axis=1
    )
    label, draw = np.tile(np.arange(3), 30), np.repeat(np.arange(30), 3)
    row = leak_report({"start_place": places.reshape(-1, 2)}, label, draw, NAMES[:3])["of"]["start_place"]
    assert row["accuracy"] == pytest.approx(1 / 3, abs=1e-3)
    assert row["labels"] == {}


def test_one_label_that_faces_its_own_way_leaks():
    heading = np.repeat(stream(0, "test").uniform(-np.pi, np.pi, 60), 10)
    label, draw = np.tile(np.arange(10), 60), np.repeat(np.arange(60), 10)
    heading[label == 3] = 0.3
    facing = np.stack([np.cos(heading), np.sin(heading)], axis=1)
    row = leak_report({"heading": facing}, label, draw, list("abcdefghij"))["of"]["heading"]
    assert row["labels"] == {"d": 1.0}
    assert row["leaks"]
