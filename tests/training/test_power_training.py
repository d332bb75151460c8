"""Recipe paper_power on a tiny data set: targets are right, a step trains, and its weights are read back."""

from pathlib import Path

import numpy as np
import pytest
import torch

from mmweaver.core.errors import InputError
from mmweaver.core.presets import AWR1843
from mmweaver.core.seeding import stream
from mmweaver.models.power_network import RECIPE, PowerNetwork
from mmweaver.models.weights import load_network, load_weights
from mmweaver.paths.mean_echoes import MeanEchoes
from mmweaver.paths.radar_equation import points_of
from mmweaver.training import power_examples
from mmweaver.training.power_examples import person_targets, radar_of, raster_density, room_targets
from mmweaver.training.power_training import PowerRecipe, difference_of_levels, train_power, write_power_weights

pytest.importorskip("zarr")
TINY = PowerRecipe(steps=1, batch_size=1, frames=2, validate_every=1, validation_batches=1, warm_up_steps=1)


def test_one_step_trains_and_its_weights_are_read_back(
    tiny_geometry: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
):
    monkeypatch.setattr(power_examples, "ROOM_PLACES", 64)
    monkeypatch.setattr(power_examples, "PERSON_PLACES", 64)
    trainer = train_power(tiny_geometry, tmp_path, TINY)
    network, card = load_network(write_power_weights(tmp_path, tiny_geometry, trainer))
    assert isinstance(network, PowerNetwork)
    assert (card.recipe, card.steps) == (RECIPE, 1)
    own = trainer.learner.state_dict()["network.person.layers.0.weight"]
    assert torch.allclose(network.person.layers[0].weight, own, atol=1e-3)
    assert "this network" in (tmp_path / "README.md").read_text()
    with pytest.raises(InputError, match="give those of: mmweaver train weaver"):
        load_weights(tmp_path / "weights.safetensors")


def test_signals_instead_of_geometry_are_refused(tiny_signals: Path, tmp_path: Path):
    with pytest.raises(InputError, match="--geometry-only"):
        train_power(tiny_signals, tmp_path, TINY)


def _echo(count: int = 1) -> MeanEchoes:
    ones = torch.ones(count)
    return MeanEchoes(
        range_m=2.0 * ones, velocity_mps=0.6 * ones, direction=torch.tensor([[0.2, -0.1]]).expand(count, 2),
        cross_section_m2=0.5 * ones,
    )  # fmt: skip


@pytest.mark.parametrize("kind", ["room", "person"])
def test_the_true_field_costs_nothing_and_half_of_the_places_see_it(kind: str):
    radar, rng = radar_of(AWR1843), stream(0, "test")
    echo = _echo() if kind == "person" else MeanEchoes(**{**vars(_echo()), "velocity_mps": torch.zeros(1)})
    pelvis = torch.tensor([2.1, 0.5, 0.1, 0.0])
    made = person_targets(echo, pelvis, radar, rng) if kind == "person" else room_targets(echo, radar, rng)
    seen = made.power_mw > 0
    assert 0.4 < float(seen.float().mean()) < 0.6
    expected = float(points_of(echo, radar.response).amplitude.square())
    assert 0.3 * expected < float(made.power_mw.max()) <= 1.3 * expected
    true = (made.power_mw / made.gain_mw).clamp(min=1e-12).log()
    right = float(difference_of_levels(true, made))
    assert right < 1e-3
    assert min(float(difference_of_levels(true + step, made)) for step in (1, -1)) > 10 * right + 1e-3


def test_a_raster_shares_out_all_there_is():
    random = np.random.default_rng(0)
    place = random.uniform(0.3, 0.7, (20, 3))
    size = np.array([0.1, 0.2, 0.1])
    (held,) = raster_density(place, np.ones((1, 20)), np.zeros(3) + 0.02, size, (30, 20, 30))
    assert held.sum() == pytest.approx(20 * 2**3)  # nodes are half a size apart
