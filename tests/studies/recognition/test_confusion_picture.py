"""The largest confusions, by the share of a label's windows."""

from dataclasses import replace
from pathlib import Path

import pytest

from mmweaver.core.errors import InputError
from studies.recognition.confusion_picture import confusion_picture, largest_confusions
from tests.recognition.small_recogniser import drawn_sequences, small_recogniser


def test_confusions_are_shares_of_the_true_label():
    truth, guess = "a" * 10 + "b" * 4 + "c" * 5, "a" * 7 + "b" * 3 + "bbcc" + "c" * 5
    assert largest_confusions(truth, guess, 5) == [("b", "c"), ("a", "b")]
    assert largest_confusions(truth, guess, 1) == [("b", "c")]
    assert largest_confusions(truth, truth, 5) == []


def test_windows_that_are_mistaken_are_drawn(tmp_path: Path):
    """Recordings of people who move are labelled as at rest, so they are mistaken."""
    pytest.importorskip("sklearn")
    task = tmp_path / "task.toml"
    task.write_text('radar = "awr1843"\n[activities]\nrest = "a person stands"\nwalk = "a person walks"\n')
    model = small_recogniser(task)
    made = drawn_sequences(model.settings, 2)
    people = [replace(one, label="rest") for one in drawn_sequences(model.settings, 2, first=30) if one.label == "walk"]
    assert confusion_picture(model, made, people, tmp_path / "seen.png") == [("rest", "walk")]
    assert (tmp_path / "seen.png").read_bytes()[:4] == b"\x89PNG"
    with pytest.raises(InputError):
        confusion_picture(model, made, drawn_sequences(model.settings, 2, first=30), tmp_path / "seen.png")
