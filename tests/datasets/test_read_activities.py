"""The file of activities: what it says is understood, what it cannot say is refused in one line."""

from pathlib import Path

import pytest

from mmweaver.core.errors import InputError
from mmweaver.datasets.build_set import read_activities


def test_labels_keep_their_order(tmp_path: Path):
    file = tmp_path / "a.toml"
    file.write_text('[activities]\nwave = "a person waves"\nsit = ["a person sits down", "someone sits down"]\n')
    found = read_activities(file)
    assert tuple(found) == ("wave", "sit")
    assert found["sit"] == ("a person sits down", "someone sits down")


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "needs a table"), ("activities = 3", "needs a table"),
        ('[activities]\nwave = "a person waves"', "two or more"),
        ('[activities]\na = "a person waves"\nb = []', "list of 1 to"), ("[activities]\na = 1\nb = 2", "list of 1 to"),
        ('[activities]\na = "a person waves"\nb = "a person flies"', "b: "), ("[activities", "no TOML"),
    ],
)  # fmt: skip
def test_mistakes_are_named(text: str, message: str, tmp_path: Path):
    (tmp_path / "a.toml").write_text(text)
    with pytest.raises(InputError, match=message):
        read_activities(tmp_path / "a.toml")
