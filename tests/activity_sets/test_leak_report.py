"""A leak that is there is found; matched circumstances are at chance."""

import numpy as np

from mmweaver.activity_sets.leak_report import leak_report
from mmweaver.core.seeding import stream

LABEL = np.tile(np.arange(4), 30)
DRAW = np.repeat(np.arange(30), 4)


def test_a_place_that_tells_the_label_leaks():
    place = LABEL[:, None] + stream(0, "test").normal(size=(120, 2)) * 0.1
    report = leak_report({"start_place": place}, LABEL, DRAW)
    assert report["verdict"] == "leaks: start_place"
    assert report["of"]["start_place"]["accuracy"] > 0.9


def test_matched_places_are_at_chance():
    place = np.repeat(stream(0, "test").normal(size=(30, 2)), 4, axis=0)
    report = leak_report({"start_place": place}, LABEL, DRAW)
    assert report["verdict"] == "leaks: none found"
    assert abs(report["of"]["start_place"]["accuracy"] - 0.25) < 0.01


def test_what_is_equal_everywhere_is_at_chance():
    report = leak_report({"duration": np.full((120, 1), 20.0)}, LABEL, DRAW)
    assert report["of"]["duration"]["accuracy"] == 0.25


def test_what_cannot_be_avoided_is_said_and_does_not_count():
    report = leak_report({"energy": LABEL[:, None].astype(float)}, LABEL, DRAW)
    assert report["of"]["energy"]["leaks"]
    assert report["of"]["energy"]["cannot_be_avoided"]
    assert report["verdict"] == "leaks: none found"


def test_noise_is_inside_its_interval():
    noise = stream(0, "test").normal(size=(120, 3))
    row = leak_report({"start_place": noise}, LABEL, DRAW)["of"]["start_place"]
    assert row["interval_99"][0] < 0.25 < row["interval_99"][1]
