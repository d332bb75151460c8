"""Bookkeeping of the study: which half a recording belongs to, and splits of generated windows."""

import pytest

pytest.importorskip("sklearn")

from studies.recognition.zero_shot_scores import digest, in_first_half


def test_the_two_groups_of_recordings():
    assert in_first_half("Train_boxing_boxing_20_1")
    assert in_first_half("Train_jump____jump_20_14")
    assert not in_first_half("Train_boxing_20_boxing_1")
    assert not in_first_half("Train_squats___20_squats_2")


def test_the_digest_is_of_the_recordings(tmp_path):
    (tmp_path / "a.txt").write_text("one")
    one = digest(tmp_path)
    (tmp_path / "notes.md").write_text("not a recording")
    assert digest(tmp_path) == one
    (tmp_path / "a.txt").write_text("two")
    assert digest(tmp_path) != one
