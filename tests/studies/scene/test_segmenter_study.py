"""The experiment on the built-in segmenter."""

import json
from pathlib import Path

import numpy as np
from studies.report.segmenter_table import segmenter_affordances_table, segmenter_table

from mmweaver.scene.sample_photo import sample_photo
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


def test_a_run_gives_the_tables(tmp_path: Path):
    measure(StudyRun("segmenter_study", tmp_path), [], 1, 1)
    text = segmenter_table(tmp_path)
    assert "the built-in network" in text
    assert text.count("\n") == 3
    assert "mask by the network" in segmenter_affordances_table(tmp_path)
