import json
from dataclasses import replace

import pytest

from mmweaver.core.boards import AWR1843
from mmweaver.core.records import CubeGrid
from mmweaver.inr import PAPER, InrField, ModulatedINR
from studies.fields import field_fidelity
from studies.fields.field_signals import simulated
from studies.manifest import StudyRun
from studies.scores.scorecard import METRICS


@pytest.mark.slow  # a whole study
def test_every_row_has_its_floors_its_size_and_its_seconds(tmp_path, monkeypatch):
    signal = simulated("walking", is_alone=True, num_frames=2)
    monkeypatch.setattr(field_fidelity, "SIGNALS", {"walking_alone": lambda data: signal})
    monkeypatch.setitem(field_fidelity.INRS, "quick", ("modulated", replace(PAPER, steps=2, points=256)))
    (path,) = field_fidelity.measure_inr(StudyRun("field_fidelity", tmp_path), ("quick",), ("walking_alone",), None)
    record = json.loads(path.read_text())
    assert record["config"]["steps"] == 2
    (row,) = record["rows"]
    assert set(row["metrics"]) == set(METRICS)
    assert all(set(entry["baseline"]) == {"zeros", "static_mean"} for entry in row["metrics"].values())
    assert row["seconds"]["fit"] >= 0
    assert row["dataset"]["sha256"] == signal.digest
    size = row["size"]
    assert 9_000 < size["values"] <= 10_018
    assert size["ratio"] == pytest.approx(2 * 64 * 32 * 12 * 8 / (4 * size["values"]), rel=1e-3)


@pytest.mark.parametrize(("frames", "ratio"), [(20, 98.13), (10, 65.91)])
def test_compression_of_the_papers_inr_in_matched_frames(frames: int, ratio: float):
    """The paper's 49.06 divides 10 frames by the parameters of 20."""
    grid = CubeGrid.of(AWR1843, frames)
    field = InrField(ModulatedINR(frames), config=AWR1843, grid=grid, scale=1.0, amplitude=1.0, is_centred=False)
    size = field_fidelity.size_of(field)
    assert size["ratio"] == pytest.approx(ratio, abs=0.01)
    assert size["bytes"] == 4 * (4_898 + 256 * frames)
    assert pytest.approx(49.06, abs=0.01) == 10 * 64 * 32 * 12 * 2 / 10_018
