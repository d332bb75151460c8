import json
from dataclasses import replace

import pytest

from mmweaver.experiments import field_fidelity
from mmweaver.experiments.signals import simulated
from mmweaver.fields.paper_inr import InrShape
from mmweaver.metrics.scorecard import METRICS
from mmweaver.training.single_signal import PAPER


def test_every_row_has_its_floors_its_size_and_its_seconds(tmp_path, monkeypatch):
    signal = simulated("walking", is_alone=True, num_frames=2)
    monkeypatch.setattr(field_fidelity, "SIGNALS", {"walking_alone": lambda data: signal})
    monkeypatch.setattr(field_fidelity, "RECIPES", {"quick": replace(PAPER, name="quick", steps=2, points=256)})
    (path,) = field_fidelity.run(tmp_path, ("quick",), ("walking_alone",), None)
    record = json.loads(path.read_text())
    assert record["config"]["steps"] == 2
    (row,) = record["rows"]
    assert set(row["metrics"]) == set(METRICS)
    assert all(set(entry["floor"]) == {"zeros", "static_mean"} for entry in row["metrics"].values())
    assert row["seconds"]["fit"] >= 0
    assert row["dataset"]["sha256"] == signal.digest
    size = row["size"]
    assert size["values"] == InrShape().num_weights + 2 * 256
    assert size["ratio"] == pytest.approx(2 * 64 * 32 * 12 * 8 / (4 * size["values"]), rel=1e-3)
