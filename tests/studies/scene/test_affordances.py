import json
from pathlib import Path

import numpy as np

from mmweaver.scene.procedural.room_kinds import KINDS
from studies.manifest import StudyRun
from studies.scene.affordances import DEVELOP, REPORT, measure


def test_kinds_are_split_and_a_run_writes_shares(tmp_path: Path):
    assert set(DEVELOP) | set(REPORT) == set(KINDS)
    assert not set(DEVELOP) & set(REPORT)
    (path,) = measure(StudyRun("affordances", tmp_path), [], 1, ("depth",))
    rows = json.loads(path.read_text())["rows"]
    assert [row["dataset"]["name"] for row in rows] == ["procedural, report", "procedural, develop"]
    for row in rows:
        shares = [metric["value"] for metric in row["metrics"].values() if metric["unit"].startswith("share")]
        assert shares
        assert all(0 <= share <= 1 for share in shares)
        assert np.isfinite(row["metrics"]["floor_error_median_m"]["value"])
