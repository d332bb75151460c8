"""The frozen recogniser on recordings of real people: far over chance, as documented. Skipped where they are absent."""

import json
from pathlib import Path

import pytest

pytest.importorskip("sklearn")

from mmweaver.recognition.scoring import report
from studies.recognition.zero_shot_training import evaluate_recogniser, load_frozen, radhar_recordings

RESULTS = Path(__file__).resolve().parents[2] / "results" / "zero_shot"


@pytest.mark.slow  # tests/cli/test_evaluate.py trains the same with fewer trees
@pytest.mark.parametrize("name", ["blind", "development"])
def test_the_score_is_that_of_the_results(real_data: Path, name: str):
    frozen = load_frozen(name)
    people = radhar_recordings(real_data / "pointclouds" / "radhar")
    found = report(evaluate_recogniser(frozen.train(), people, frozen.window_s))
    told = json.loads((RESULTS / f"{name}.json").read_text())["rows"][0]["metrics"]
    for key in ("window", "three_windows", "recording"):
        assert abs(found[key]["balanced_accuracy"] - told[key]["value"]) < 0.01, key
