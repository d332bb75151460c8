"""Rows of the recognisers' study: gains over recordings alone, and the same answers by clutter."""

import pytest

pytest.importorskip("zarr")

from studies.recognition.recogniser_gain import ALONE, ORACLES, clutter_rows, rows_of

ROOMS = ["a", "a", "b", "c"]
FOUND = {
    ALONE: {"ours": {"unseen_room": [0.0, 0.0, 1.0, 0.0]}},
    "weaver": {"ours": {"unseen_room": [1.0, 0.0, 1.0, 0.0]}},
    "new_person": {"ours": {"unseen_room": [1.0, 1.0, 1.0, 1.0]}},
    ORACLES["unseen_room"]: {"ours": {"unseen_room": [1.0, 1.0, 1.0, 0.0]}},
}


def test_gains_are_means_over_rooms():
    alone, ours, *_, oracle = rows_of(FOUND, {"unseen_room": ROOMS})
    assert alone["metrics"]["gain"]["value"] == 0
    assert ours["metrics"]["gain"]["value"] == pytest.approx(0.5 / 3)  # half of the sequences of one room of three
    assert ours["metrics"]["accuracy"]["oracle"] == {oracle["method"]: pytest.approx(2 / 3)}


def test_answers_are_grouped_by_the_clutter_of_their_rooms():
    rows = clutter_rows(FOUND, ROOMS, {"a": 0.5, "b": 0.2, "c": 0.4})
    of = {(row["clutter"], row["method"]): row for row in rows}
    assert {method for _, method in of} == {ALONE, "weaver", ORACLES["unseen_room"]}
    assert [of[level, "weaver"]["metrics"]["accuracy"]["value"] for level in ("low", "medium", "high")] == [1, 0, 0.5]
    assert of["high", "weaver"]["n"] == 2
    assert of["high", "weaver"]["share_of_floor_covered"] == [0.5, 0.5]
