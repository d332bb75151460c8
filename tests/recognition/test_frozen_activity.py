"""The frozen recognisers are reproducible and come from generated windows only."""

import json
from pathlib import Path

import numpy as np
import pytest

from mmweaver.core import repository_files
from mmweaver.core.errors import InputError
from mmweaver.recognition.frozen_activity import NAMES, load_frozen, save_frozen, settings_file
from mmweaver.recognition.zero_shot import COPIES


@pytest.mark.parametrize("name", NAMES)
def test_a_frozen_recogniser_is_complete(name):
    frozen = load_frozen(name)
    held = json.loads(settings_file(name).read_text())
    windows = sum(source["windows"] for source in held["sources"])
    assert len(frozen.training.labels) == len(frozen.training.features) == frozen.provenance["with_disturbed_copies"]
    assert len(frozen.training.labels) == windows * (1 + (COPIES if name == "development" else 0))
    assert frozen.provenance["generated_windows"] == windows
    assert frozen.training.features.shape[1] == len(frozen.training.names) == len(set(frozen.training.names))
    assert frozen.labels == ("boxing", "jack", "jump", "squats", "walk")
    assert all(source["commit"] and "+" not in source["commit"] for source in held["sources"])
    counts = np.bincount(np.unique(frozen.training.labels, return_inverse=True)[1])
    assert counts.min() > 0.8 * counts.max()


def test_an_unknown_name_is_refused(tmp_path):
    with pytest.raises(InputError, match="known: blind, development"):
        load_frozen("none")
    save_frozen("copy", load_frozen("blind").training, {"classifier": {}, "sources": []}, folder=tmp_path)
    assert (tmp_path / "copy.npz").read_bytes() == settings_file("blind").with_suffix(".npz").read_bytes()


def test_without_a_clone_the_packaged_one_remains(monkeypatch: pytest.MonkeyPatch, tmp_path: Path):
    monkeypatch.setattr(repository_files, "WEIGHTS", tmp_path)
    assert load_frozen("development").labels
    with pytest.raises(InputError, match="'blind' is in the repository, not in the installed package; take 'develop"):
        load_frozen("blind")
