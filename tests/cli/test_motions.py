import json

import pytest

from mmweaver.cli.main import main


def test_the_list_names_every_activity(capsys: pytest.CaptureFixture[str]):
    assert main(["motions"]) == 0
    text = capsys.readouterr().out
    assert "a person falls down" in text
    assert main(["motions", "--json"]) == 0
    rows = json.loads(capsys.readouterr().out)
    assert len(rows) >= 30
    assert all(row["name"] in text and row["example"] in text for row in rows)
