"""Recipes activity and paper on a tiny data set: they go on exactly, and what they write is read."""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import torch

from mmweaver.core.errors import InputError
from mmweaver.core.presets import AWR1843
from mmweaver.data.generate import generate
from mmweaver.data.plan import DatasetPlan
from mmweaver.models.activity_network import load_activity
from mmweaver.models.paper_method import load_paper
from mmweaver.training.activity_training import ActivityRecipe, train_activity
from mmweaver.training.paper_examples import draw_paper_batch, paper_rooms
from mmweaver.training.paper_training import PaperRecipe, train_paper
from mmweaver.training.recipe_loop import RecipeLoop, StepReport, write_recipe_weights

pytest.importorskip("zarr")
pytest.importorskip("transformers")
ACTIVITY = ActivityRecipe(steps=4, batch_size=2, validate_every=2)
PAPER = PaperRecipe(steps=4, batch_size=2, validate_every=2)
Train = Callable[..., RecipeLoop]


class StoppedError(Exception):
    pass


@pytest.fixture(scope="module")
def data(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("data") / "set"
    plan = DatasetPlan(
        kinds=("office", "dining_room"), lightings=("day",), num_layouts=1, sequences_a_room=3, num_frames=4
    )
    generate(folder, plan, AWR1843)
    return folder


@pytest.fixture(scope="module")
def features(data: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    out = tmp_path_factory.mktemp("activity")
    return write_recipe_weights(out, data, train_activity(data, out, ACTIVITY))


def _stop_after_two(report: StepReport) -> None:
    if report.step == 3:
        raise StoppedError


def _same(one: RecipeLoop, two: RecipeLoop) -> None:
    pairs = zip(one.network.state_dict().items(), two.network.state_dict().values(), strict=True)
    for (name, first), second in pairs:
        assert torch.equal(first, second), name
    assert one.best.figures == two.best.figures


def test_activity_goes_on_where_it_stopped(data: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr("mmweaver.training.resuming.SAVE_EVERY_S", 0.0)
    whole = train_activity(data, tmp_path / "whole", ACTIVITY)
    with pytest.raises(StoppedError):
        train_activity(data, tmp_path / "parts", ACTIVITY, _stop_after_two)
    _same(whole, train_activity(data, tmp_path / "parts", ACTIVITY))
    assert load_activity(write_recipe_weights(tmp_path / "whole", data, whole), AWR1843) is not None


def test_paper_goes_on_where_it_stopped(data: Path, features: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr("mmweaver.training.resuming.SAVE_EVERY_S", 0.0)
    whole = train_paper(data, tmp_path / "whole", PAPER, features=features)
    with pytest.raises(StoppedError):
        train_paper(data, tmp_path / "parts", PAPER, features=features, listener=_stop_after_two)
    _same(whole, train_paper(data, tmp_path / "parts", PAPER, features=features))
    network = load_paper(write_recipe_weights(tmp_path / "whole", data, whole))
    weight = "hypernetwork.theta.weight"
    assert torch.allclose(network.state_dict()[weight], whole.network.state_dict()[weight], atol=1e-3)


def test_a_longer_run_goes_on_at_a_constant_rate_and_no_other_setting_may_change(
    data: Path, features: Path, tmp_path: Path
):
    train_paper(data, tmp_path, replace(PAPER, steps=1), features=features)
    steps: list[int] = []
    train_paper(data, tmp_path, replace(PAPER, steps=2), features=features, listener=lambda r: steps.append(r.step))
    assert steps == [2]
    with pytest.raises(InputError, match="other settings"):
        train_paper(data, tmp_path, replace(PAPER, steps=3, learning_rate=1e-3), features=features)
    train_activity(data, tmp_path / "a", replace(ACTIVITY, steps=1))
    with pytest.raises(InputError, match="other settings"):
        train_activity(data, tmp_path / "a", replace(ACTIVITY, steps=2))


def test_patches_hold_what_the_cube_holds_at_those_coordinates(data: Path):
    (room,) = paper_rooms(data, "train")
    batch = draw_paper_batch([room], 0, 0, size=1)
    assert batch.truth[0].shape == (2, 21, 32, 12)
    assert batch.encoded[0].shape == (21 * 32 * 12, 51)
    r, d, a = (batch.encoded[0, :, at] for at in (0, 17, 34))
    cell = torch.stack([(r + 1) / 2 * 63, (d + 1) / 2 * 31, (a + 1) / 2 * 11]).round().long()
    from mmweaver.models.paper_method import unit_sqrt_mw

    cubes = [room.room.cube(index).values for index in room.indices]
    there = [cube[int(batch.frames[0, 0])][tuple(cell.numpy())] / unit_sqrt_mw(AWR1843) for cube in cubes]
    assert any(np.allclose(one, batch.truth[0, 0].flatten(), rtol=1e-3) for one in there)


def test_weights_of_another_recipe_are_refused(data: Path, features: Path, tmp_path: Path):
    with pytest.raises(InputError, match="mmweaver train paper"):
        load_paper(features)
    with pytest.raises(InputError, match="no data set"):
        train_activity(tmp_path, tmp_path / "out", ACTIVITY)
