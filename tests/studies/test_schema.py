"""The schema of results: what is required, and what may be unknown."""

import copy
import json
from pathlib import Path
from typing import Any

import pytest

from mmweaver.core.errors import InputError
from studies.schema import check_record, metric, read_record, violations

ROOT = Path(__file__).resolve().parents[2]
RECORD: dict[str, Any] = {
    "schema_version": 2, "origin": "measured", "study": "one", "experiment": "one", "method": "two", "config": {},
    "provenance": {"mmweaver_version": "0.1.0", "commit": "abc", "dirty": False}, "hardware": {},
    "manifest": {"inputs": [], "outputs": [], "wall_s": 1.0, "cpu_s": 1.0},
    "rows": [{
        "dataset": {"name": "data", "sha256": "0"}, "n": 3, "seeds": [0], "seconds": {"all": 1.0},
        "metrics": {"ra_ssim": metric(0.4, "1", "similarity", baseline={"zeros": 0.0}, oracle={"realization": 0.6})},
    }],
}  # fmt: skip


def test_a_whole_record_is_valid():
    assert violations(RECORD) == []
    check_record(RECORD, "one")


@pytest.mark.parametrize("path", ["dataset.sha256", "n", "seeds", "seconds", "metrics.ra_ssim.value",
                                  "metrics.ra_ssim.unit", "metrics.ra_ssim.definition", "metrics.ra_ssim.version",
                                  "metrics.ra_ssim.baseline"])  # fmt: skip
def test_every_field_of_a_row_is_required_and_null_needs_a_reason(path: str):
    absent, null = copy.deepcopy(RECORD), copy.deepcopy(RECORD)
    *parents, last = path.split(".")
    for record, value in ((absent, ...), (null, None)):
        place = record["rows"][0]
        for parent in parents:
            place = place[parent]
        if value is ...:
            del place[last]
        else:
            place[last] = value
    assert any("is missing" in line for line in violations(absent))
    assert any("gives no reason" in line for line in violations(null))
    null["rows"][0]["unknown"] = {path: "nobody wrote it down"}
    assert violations(null) == []
    with pytest.raises(InputError, match=r"rows\[0\]"):
        check_record(absent, "one")


def test_names_of_schema_1_and_unknown_commits_are_refused():
    record = copy.deepcopy(RECORD)
    record["rows"][0]["metrics"]["ra_ssim"]["floor"] = {"zeros": 0.0}
    record["provenance"]["commit"] = None
    found = violations(record)
    assert any("schema 1" in line for line in found)
    assert any("commit is null" in line for line in found)
    record["provenance"]["commit_unknown"] = "not in a git repository"
    assert not any("commit" in line for line in violations(record))


def test_every_result_of_the_project_follows_it():
    paths = [path for path in sorted((ROOT / "results").glob("*/**/*.json")) if "judgements" not in path.name]
    assert len(paths) > 100
    for path in paths:
        record = read_record(path)
        assert violations(record) == [], path
        assert path.parent.name == record["experiment"]
        assert path.stem == record["method"]


def test_what_is_no_result_is_said_in_one_line(tmp_path: Path):
    with pytest.raises(InputError, match=r"none\.json"):
        read_record(tmp_path / "none.json")
    (tmp_path / "list.json").write_text(json.dumps([1]))
    with pytest.raises(InputError, match=r"list\.json.*rows"):
        read_record(tmp_path / "list.json")
