"""Tables of costs: what was measured is shown, what is missing is said."""

import json
from pathlib import Path

import pytest

from mmweaver.core.errors import InputError
from studies.report.benchmark_tables import dataset_cost_table


def test_what_was_not_run_is_left_empty(tmp_path: Path):
    (tmp_path / "benchmark").mkdir()
    metrics = {"signals_kb_a_sequence": {"value": 1843.2}, "signals_cpu_s_a_room": {"value": 0.88}}
    (tmp_path / "benchmark" / "dataset.json").write_text(json.dumps({"rows": [{"metrics": metrics}]}))
    table = dataset_cost_table(tmp_path)
    assert "| a sequence on disk | 1843 kB |  |" in table
    assert "| a room with its photo, CPU | 0.9 s |  |" in table


def test_a_missing_result_is_said(tmp_path: Path):
    with pytest.raises(InputError, match="make bench"):
        dataset_cost_table(tmp_path)
