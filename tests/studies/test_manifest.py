"""A run writes results with their manifest."""

import json
import time
from pathlib import Path

import pytest

from mmweaver.core.errors import InputError
from studies.manifest import StudyRun, content_of, rows_sha256
from studies.schema import metric

ROW = {
    "dataset": {"name": "data", "sha256": "0"}, "n": 1, "seeds": [0], "seconds": {"all": 0.1},
    "metrics": {"rd_ssim": metric(0.5, "1", "similarity", baseline={"zeros": 0.0}, interval_95=(0.4, 0.6))},
}  # fmt: skip


def test_a_result_has_inputs_outputs_and_seconds(tmp_path: Path):
    folder = tmp_path / "data"
    (folder / "sub").mkdir(parents=True)
    (folder / "sub" / "one.txt").write_text("1")
    file = tmp_path / "weights.bin"
    file.write_bytes(b"abc")
    run = StudyRun("some_study", tmp_path / "results", inputs=[folder], options={"seed": 0})
    run.reads(file)
    deadline = time.process_time() + 0.05
    while time.process_time() < deadline:
        pass
    path = run.write("some_experiment", "some_method", config={"steps": 3}, rows=[ROW])
    assert path == tmp_path / "results" / "some_experiment" / "some_method.json"
    assert run.written == [path]
    record = json.loads(path.read_text())
    manifest = record["manifest"]
    assert (record["study"], record["experiment"], record["method"]) == ("some_study", "some_experiment", "some_method")
    assert [one["name"] for one in manifest["inputs"]] == ["data", "weights.bin"]
    sha256 = "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad"
    assert manifest["inputs"][1] == {"name": "weights.bin", "sha256": sha256, "bytes": 3, "files": 1}
    assert manifest["outputs"][0]["rows_sha256"] == rows_sha256(record["rows"])
    assert manifest["wall_s"] >= 0.04
    assert manifest["cpu_s"] >= 0.04
    assert manifest["options"] == {"seed": 0}
    assert {"mmweaver_version", "commit", "dirty"} <= set(record["provenance"])
    again = json.loads(run.write("some_experiment", "next", config={}, rows=[ROW]).read_text())
    assert again["manifest"]["cpu_s"] <= manifest["cpu_s"] + 0.5  # counted since the previous result


def test_the_hash_of_a_folder_is_of_names_and_contents(tmp_path: Path):
    for name, text in (("a", "1"), ("b", "1"), ("c", "2")):
        (tmp_path / name).mkdir()
        (tmp_path / name / "file").write_text(text)
    assert content_of(tmp_path / "a") == content_of(tmp_path / "b")
    assert content_of(tmp_path / "a")["sha256"] != content_of(tmp_path / "c")["sha256"]
    (tmp_path / "b" / "file").rename(tmp_path / "b" / "renamed")
    assert content_of(tmp_path / "a")["sha256"] != content_of(tmp_path / "b")["sha256"]


def test_rows_that_do_not_follow_the_schema_are_not_written(tmp_path: Path):
    run = StudyRun("one", tmp_path)
    with pytest.raises(InputError, match=r"two\.json.*rows\[0\]: seeds"):
        run.write("one", "two", config={}, rows=[{name: value for name, value in ROW.items() if name != "seeds"}])
    with pytest.raises(ValueError, match="JSON"):
        run.write("one", "two", config={}, rows=[{**ROW, "more": float("nan")}])
    assert not list(tmp_path.rglob("*.json"))
