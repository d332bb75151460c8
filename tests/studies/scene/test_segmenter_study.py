"""The study of the built-in segmenter."""

import json
from pathlib import Path

import numpy as np
import pytest

from mmweaver.scene.photo_files import sample_photo
from mmweaver.scene.segmentation.builtin_segmenter import GROUP_NAMES
from studies.manifest import StudyRun
from studies.scene.segmenter_study import REAL_TRUTH, marked_right, measure


def test_marked_places_name_groups_and_lie_in_the_picture():
    for places in json.loads(REAL_TRUTH.read_text(encoding="utf-8")).values():
        for names, marked in places.items():
            assert set(names.split("|")) <= set(GROUP_NAMES)
            assert all(0 < u < 1 and 0 < v < 1 for u, v in marked)


def test_places_are_right_where_the_guess_is():
    photo, _ = sample_photo()
    floor = GROUP_NAMES.index("floor-other")
    marked = {"floor-other": [(0.5, 0.9)], "wall-other|cabinet": [(0.5, 0.1)]}

    def guess(features: np.ndarray) -> np.ndarray:
        return np.full(features.shape[1:], floor)

    assert marked_right(photo, guess, marked) == [True, False]


@pytest.mark.slow  # a whole study; its scores: test_segmenter_scores.py and the test above
def test_a_run_has_rows_of_cells_and_of_affordances(tmp_path: Path):
    path = measure(StudyRun("segmenter_study", tmp_path), [], 1, 1)
    rows = json.loads(path.read_text())["rows"]
    assert [row["dataset"]["split"] for row in rows] == ["network", "geometry", "none", "network", "true"]
    assert 0 < rows[0]["metrics"]["miou"]["value"] <= 1
    assert "table_found" in rows[2]["metrics"]
