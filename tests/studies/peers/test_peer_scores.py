"""Parts of the peers' study: the fair gain, and thirds of rooms by clutter."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from studies.schema import metric
from tests.cubes import point_cube

pytest.importorskip("mitsuba")


def test_the_best_gain_is_found_whatever_the_scale():
    from studies.peers.peer_scores import with_best_gain

    truth = point_cube()
    found = with_best_gain(replace(truth, values=truth.values * np.complex64(1e-4)), truth)
    np.testing.assert_allclose(found.values, truth.values, rtol=1e-4)


def test_rooms_are_thirds_by_clutter(monkeypatch: pytest.MonkeyPatch):
    from studies.peers import peer_scores

    monkeypatch.setattr(peer_scores, "dataset_of", lambda data: {"name": "rooms", "sha256": "0"})
    clutter = np.array([0.9, 0.1, 0.5, 0.2, 0.6, 0.8])
    columns = (*peer_scores.COLUMNS, "cpu_s")
    each = [{row: dict.fromkeys(columns, share) for row in peer_scores.CLUTTER_ROWS} for share in clutter]
    names = [f"room_{index}" for index in range(len(clutter))]
    rows = peer_scores._clutter_rows("low", clutter, each, names, Path("data"))
    assert {row["method"] for row in rows} == set(peer_scores.CLUTTER_ROWS)
    assert rows[0]["share_of_floor_covered"] == [0.1, 0.2]
    assert rows[0]["metrics"]["ra_ssim"]["value"] == pytest.approx(0.15)
    assert set(metric(0.0, "1", "")) <= set(rows[0]["metrics"]["ra_ssim"])
