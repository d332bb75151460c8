"""Recipe activity on a tiny data set: it resumes exactly, shares its batches, and its files are read back."""

import json
import shutil
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import torch

from mmweaver.core.boards import AWR1843
from mmweaver.core.errors import InputError
from mmweaver.models.activity_network import ActivityNetwork
from mmweaver.training.activity_training import (
    TRAIN_MAPS,
    TRAIN_SPLITS,
    VALIDATION_MAPS,
    ActivityLearner,
    ActivityRecipe,
    activity_examples,
    train_activity,
)
from mmweaver.training.device import ComputeDevice, moved
from mmweaver.training.trainer import Progress
from tests.training.tiny_data import StoppedError

pytest.importorskip("zarr")
RECIPE = ActivityRecipe(steps=4, batch_size=2, validate_every=2)


@pytest.fixture(scope="module")
def maps(tiny_geometry: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The cached log maps of the data set, which cost more than a training of four steps."""
    folder = tmp_path_factory.mktemp("maps")
    activity_examples(tiny_geometry, ("validation",), folder / VALIDATION_MAPS)
    activity_examples(tiny_geometry, TRAIN_SPLITS, folder / TRAIN_MAPS)
    return folder


def with_maps(maps: Path, out: Path) -> Path:
    """A folder for a training that finds its maps there."""
    return Path(shutil.copytree(maps, out, dirs_exist_ok=True))


def stop_at_three(progress: Progress) -> None:
    if progress.step == 3:
        raise StoppedError


@pytest.mark.slow  # test_network_training.py interrupts the same loop
@pytest.mark.usefixtures("blank_training_pictures")
def test_it_resumes_where_it_stopped(tiny_geometry: Path, maps: Path, tmp_path: Path):
    for name in ("whole", "parts"):
        with_maps(maps, tmp_path / name)
    whole = train_activity(tiny_geometry, tmp_path / "whole", RECIPE, save_every_s=0.0)
    with pytest.raises(StoppedError):
        train_activity(tiny_geometry, tmp_path / "parts", RECIPE, listener=stop_at_three, save_every_s=0.0)
    parts = train_activity(tiny_geometry, tmp_path / "parts", RECIPE, save_every_s=0.0)
    for (name, one), two in zip(whole.learner.state_dict().items(), parts.learner.state_dict().values(), strict=True):
        assert torch.equal(one, two), name
    assert whole.best.figures == parts.best.figures
    assert set(whole.best.figures) == {"wrong"}
    rows = [json.loads(line) for line in (tmp_path / "parts" / "log.jsonl").read_text().splitlines()]
    assert [row["step"] for row in rows] == [2, 4]
    assert len(list((tmp_path / "whole" / "pictures").glob("*.png"))) == 2


def test_maps_are_computed_once_per_data_set(
    tiny_geometry: Path, tiny_signals: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
):
    train_activity(tiny_geometry, tmp_path, replace(RECIPE, steps=1))

    def none_more(*words: object) -> None:
        raise AssertionError("made again")

    monkeypatch.setattr("mmweaver.training.activity_training.compute_log_maps", none_more)
    again = train_activity(tiny_geometry, tmp_path, replace(RECIPE, steps=1))
    assert again.step == 1
    with pytest.raises(InputError, match="other settings"):
        train_activity(tiny_geometry, tmp_path, replace(RECIPE, steps=2))
    (tmp_path / "checkpoint.pt").unlink()
    with pytest.raises(AssertionError, match="made again"):
        train_activity(tiny_signals, tmp_path, replace(RECIPE, steps=1))


def test_sequences_can_be_picked_by_label(tiny_geometry: Path):
    every = activity_examples(tiny_geometry, TRAIN_SPLITS)
    some = activity_examples(tiny_geometry, TRAIN_SPLITS, pick=lambda label: np.flatnonzero(label == label[0]))
    assert set(some.label.tolist()) == {int(every.label[0])}
    assert torch.equal(some.doppler[0], every.doppler[0])


def test_two_shares_have_the_gradient_of_the_whole_batch(tiny_geometry: Path, maps: Path, tmp_path: Path):
    initial = train_activity(tiny_geometry, with_maps(maps, tmp_path), replace(RECIPE, steps=0, batch_size=4))
    learner = initial.learner.eval()  # nothing dropped by chance
    gradients = []
    for shares in ([(0, 1)], [(0, 2), (1, 2)]):
        learner.zero_grad()
        for share in shares:
            loss = learner(initial._train(3, share))["cross_entropy"] / len(shares)
            loss.backward()
        gradients.append(torch.cat([p.grad.flatten() for p in learner.parameters() if p.grad is not None]))
    assert torch.allclose(*gradients, atol=1e-6)


@pytest.mark.slow  # test_network_training.py: the same loop in mixed precision and on another device
def test_bf16_and_another_device_take_part(tiny_geometry: Path, maps: Path, tmp_path: Path):
    trainer = train_activity(tiny_geometry, with_maps(maps, tmp_path), RECIPE, compute=ComputeDevice(precision="bf16"))
    assert torch.isfinite(torch.tensor(trainer.best.value))
    learner = ActivityLearner(ActivityNetwork(AWR1843)).to("meta")
    terms = learner(moved(trainer._train(0, (0, 1)), torch.device("meta")))
    terms["cross_entropy"].backward()
    assert {parameter.grad.device.type for parameter in learner.parameters() if parameter.grad is not None} == {"meta"}


def test_a_folder_without_data_is_refused(tmp_path: Path):
    with pytest.raises(InputError, match="no data set"):
        train_activity(tmp_path, tmp_path / "out", RECIPE)
