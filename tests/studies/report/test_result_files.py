import json

import pytest

from studies.report.result_files import write_result


def test_a_result_says_where_it_comes_from(tmp_path):
    rows = [{"dataset": {"name": "x"}, "metrics": {}}]
    path = write_result(tmp_path, experiment="one", method="two", config={"steps": 3}, rows=rows)
    assert path == tmp_path / "one" / "two.json"
    record = json.loads(path.read_text())
    assert record["origin"] == "measured"
    assert record["rows"] == rows
    assert {"schema_version", "experiment", "method", "config", "commit", "hardware"} <= set(record)


def test_numbers_that_are_none_are_refused(tmp_path):
    with pytest.raises(ValueError, match="JSON"):
        write_result(tmp_path, experiment="one", method="two", config={}, rows=[{"x": float("nan")}])
    assert not list(tmp_path.rglob("*.json"))
