"""Sequences of a task: one person for every label, reproducible, resumed from a folder; nobody is an empty place."""

from pathlib import Path

import numpy as np
import pytest

from mmweaver.core.errors import InputError
from mmweaver.recognition import generated_sequences
from mmweaver.recognition.generated_sequences import (
    SequenceRecipe,
    generate_sequence,
    generate_sequences,
)
from mmweaver.recognition.subject_simulation import PerformancePrior, performer
from mmweaver.recognition.task_file import read_task

TASK = """radar = "iwr1443_mars"
window_s = 1.0
[activities]
empty = "nobody"
up = "a person lifts the right arm straight up and keeps it up"
[mount]
distance_m = [1.5, 2.0]
[recordings]
gap_frames = 5
"""


@pytest.fixture(scope="module")
def recipe(tmp_path_factory: pytest.TempPathFactory) -> SequenceRecipe:
    file = tmp_path_factory.mktemp("task") / "task.toml"
    file.write_text(TASK)
    return SequenceRecipe.of(read_task(file))


def test_sequences_are_kept_and_the_same_again(recipe: SequenceRecipe, tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(generated_sequences, "SHORTEST_S", 1.0)
    monkeypatch.setattr(generated_sequences, "SKIN_POINTS", 200)
    made = generate_sequences(recipe, 1, tmp_path)
    assert [one.label for one in made] == ["empty", "up"]
    by_label = {one.label: one for one in made}
    moving = {label: np.abs(one.cloud.radial_velocity_mps) > 0.1 for label, one in by_label.items()}
    assert moving["up"].sum() > 10
    assert moving["empty"].sum() < 0.2 * moving["up"].sum()
    assert by_label["up"].num_frames < 5 * by_label["up"].frame_rate_hz  # one performance
    heard = []
    (tmp_path / "001_00000.npz").unlink()
    again = generate_sequences(recipe, 1, tmp_path, lambda *counts: heard.append(counts))
    assert heard == [(1, 2), (2, 2)]
    for one, other in zip(made, again, strict=True):
        assert np.allclose(one.cloud.y_m, other.cloud.y_m, atol=1e-5)
        assert one.num_frames == other.num_frames
    monkeypatch.setattr(generated_sequences, "VERSION", 0)
    with pytest.raises(InputError, match="task or seed"):
        generate_sequences(recipe, 1, tmp_path)


def test_a_person_is_the_same_for_every_activity(recipe: SequenceRecipe):
    prior = PerformancePrior()
    one, again, other = (performer(prior, recipe.variation, index, 0) for index in (1, 1, 2))
    assert one == again
    assert one.subject != other.subject
    assert 1.5 <= one.surroundings.distance_m <= 2.0
    assert prior.on_way[0] <= min(one.on_way, other.on_way) < max(one.on_way, other.on_way) <= prior.on_way[1]


def test_what_cannot_be_carried_out_is_said(recipe: SequenceRecipe, monkeypatch: pytest.MonkeyPatch):
    def refuse(*_: object, **__: object):
        raise InputError("no room")

    monkeypatch.setattr(generated_sequences, "perform", refuse)
    with pytest.raises(InputError, match="no room"):
        generate_sequence(recipe, "up", 0)
