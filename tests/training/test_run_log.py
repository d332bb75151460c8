"""Log files of a training run."""

import json
from pathlib import Path
from typing import Any

import numpy as np
from PIL import Image

from mmweaver.training.trainer import RunLog


def figures(step: int, validation: float | None = None) -> dict[str, Any]:
    return {"step": step, "steps": 200, "loss": 1.0 / step, "terms": {"a": 0.5}, "validation": validation}


def test_a_row_every_fifty_steps_and_at_validations(tmp_path: Path):
    log = RunLog(tmp_path, 0)
    for step in range(1, 121):
        log.row(figures(step, 2.0 if step == 70 else None))
    log.close()
    rows = [json.loads(line) for line in (tmp_path / "log.jsonl").read_text().splitlines()]
    assert [row["step"] for row in rows] == [50, 70, 100]
    assert [row["validation"] for row in rows] == [None, 2.0, None]


def test_pictures_are_complete_files_named_by_step(tmp_path: Path):
    image = np.arange(60, dtype=np.uint8).reshape(4, 5, 3)
    RunLog(tmp_path, 0).picture(250, image)
    (file,) = (tmp_path / "pictures").iterdir()
    assert file.name == "step_000250.png"
    assert np.array_equal(np.asarray(Image.open(file)), image)
