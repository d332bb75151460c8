"""The study of recognisers from a page of text: MARS cut into exercises, rows that follow the schema."""

from pathlib import Path

import numpy as np
import pytest

pytest.importorskip("sklearn")

from mmweaver.recognition.task_file import read_task
from mmweaver.recognition.training_windows import generated_windows
from studies.recognition import blind_recognition
from studies.recognition.blind_recognition import TASKS, recordings_of, result_row, scored
from studies.schema import _row_violations
from tests.recognition.small_recogniser import OPTIONS, drawn_sequences
from tests.recognition.test_train_recogniser import TASK


def test_mars_is_cut_into_its_exercises(tmp_path: Path):
    for split in ("validate", "test"):
        rows = np.zeros((2400, 8))
        rows[:, 0] = np.arange(2400) + 926
        np.savetxt(tmp_path / f"radar_data_{split}.csv", rows, delimiter=",", header="names", comments="")
    task = read_task(TASKS / "mars_exercises.toml")
    found = recordings_of("mars_exercises", tmp_path, task)
    assert len(found) == 20
    assert {one.label for one in found} == set(task.activities)
    assert found[0].num_frames == 179


@pytest.mark.parametrize("adapted", [False, True])
def test_a_row_has_scores_chance_and_distance(adapted: bool, tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    (tmp_path / "task.toml").write_text(TASK.format(more=""))
    task = read_task(tmp_path / "task.toml")
    monkeypatch.setattr(blind_recognition, "TrainingOptions", lambda: OPTIONS)
    made = generated_windows(drawn_sequences(task.recordings), task, OPTIONS)
    scores = scored(made, drawn_sequences(task.recordings, 2, first=40), task, adapted=adapted)
    row = result_row(scores, {"name": "drawn", "sha256": "0"}, "alone", "blind", 1.0)
    assert not _row_violations(row)
    assert row["metrics"]["window"]["baseline"] == {"chance": 0.5}
    assert (row["self_training"] is not None) == adapted
