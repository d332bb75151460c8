"""The frozen recogniser on recordings of real people: far over chance, as documented. Skipped where they are absent."""

import json
from pathlib import Path

import pytest

pytest.importorskip("sklearn")

from mmweaver.recognition.frozen_activity import load_frozen
from mmweaver.recognition.point_recording_files import read_point_recordings
from mmweaver.recognition.scoring import evaluate_recogniser, report

RESULTS = Path(__file__).resolve().parents[2] / "results" / "zero_shot"


@pytest.mark.slow  # tests/cli/test_evaluate.py trains the same with fewer trees
@pytest.mark.parametrize("name", ["blind", "development"])
def test_the_score_is_that_of_the_results(real_data: Path, name: str):
    frozen = load_frozen(name)
    people = read_point_recordings(real_data / "pointclouds" / "radhar", frozen.labels)
    found = report(evaluate_recogniser(frozen.train(), people, frozen.window_s))
    told = json.loads((RESULTS / f"{name}.json").read_text())["rows"][0]["metrics"]
    for key in ("window", "three_windows", "recording"):
        assert abs(found[key]["balanced_accuracy"] - told[key]["value"]) < 0.01, key
