"""Part of the signals measured again, with the rows of the others kept in their order."""

import json
from pathlib import Path

from studies.fields.codec_cuts import SIZES, measure_signals
from studies.fields.field_signals import StudySignal
from studies.manifest import StudyRun
from tests.compression.echoes import crowd


def test_other_signals_keep_their_rows_and_their_place(tmp_path: Path):
    first, second = (
        StudySignal(name=name, origin="simulated", cube=crowd(), realization=None) for name in ("first", "second")
    )
    run, file = StudyRun("codec_cuts", tmp_path), tmp_path / "cuts" / "top_klt.json"
    measure_signals(run, "cuts", ["top_klt"], [first, second])
    before = json.loads(file.read_text())["rows"]
    measure_signals(run, "cuts", ["top_klt"], [second], ["first", "second"])
    rows = json.loads(file.read_text())["rows"]
    names = [row["dataset"]["name"] for row in rows]
    assert names == sorted(names)
    assert len(rows) == len(before) <= 2 * len(SIZES)
    assert [row["metrics"] for row in rows if "commit" in row] == [row["metrics"] for row in before[: len(before) // 2]]
    measure_signals(run, "cuts", ["top_klt"], [second])  # without keep
    assert {row["dataset"]["name"] for row in json.loads(file.read_text())["rows"]} == {"second"}
