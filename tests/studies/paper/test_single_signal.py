from dataclasses import replace

import numpy as np
import pytest

from mmweaver.core.errors import InputError
from mmweaver.core.records import RadarCube
from studies.paper.paper_inr import InrField
from studies.paper.single_signal import PAPER, PAPER_BASE, RECIPES, TUNED_SHORT, InrFitRecipe, _Draw, fit
from studies.scores.cube_scores import cells_of, nmse_db, peak_of
from tests.cubes import SMALL, point_cube


@pytest.fixture(scope="module")
def cube() -> RadarCube:
    return point_cube(replace(SMALL, num_range_bins=16), num_frames=3, noise=0.05)


def quick(recipe: InrFitRecipe, **changes) -> InrFitRecipe:
    return replace(recipe, **{"steps": 60, "points": 1_024, **changes})


def test_the_recipe_paper_is_the_papers():
    recipe = RECIPES["paper"]
    assert (recipe.steps, recipe.learning_rate, recipe.points) == (500, 1e-4, 16_384)
    assert (recipe.activation, recipe.favour) == ("relu", "active_ranges")
    assert recipe.highest_harmonic is None
    assert not recipe.is_centred
    assert not recipe.is_cosine
    assert not recipe.has_time_axis


def test_a_fit_is_a_field_of_the_cube(cube: RadarCube):
    result = fit(cube, quick(PAPER, steps=3))
    field = result.field
    assert isinstance(field, InrField)
    assert field.num_values == 4_898 + 3 * 256
    assert field.grid.shape == cube.grid.shape
    assert field.amplitude == pytest.approx(peak_of(cube.values), rel=1e-6)
    assert result.seconds > 0


def test_the_tuned_recipe_learns_what_the_papers_does_not(cube: RadarCube):
    """In the same number of steps: the paper's is at the floor (0 dB), the tuned one well below it."""
    where = cells_of(cube).is_active
    steps = {"steps": 250, "points": 2_048}
    paper, tuned = (
        nmse_db(fit(cube, quick(recipe, **steps)).field.cube().values, cube.values, where)
        for recipe in (PAPER, TUNED_SHORT)
    )
    assert paper > -1.0
    assert tuned < -5.0


def test_the_base_inr_is_fitted_too(cube: RadarCube):
    first, last = (fit(cube, quick(PAPER_BASE, steps=steps, learning_rate=3e-3)) for steps in (1, 80))
    assert last.field.num_values == 5_442
    assert last.last_loss < first.last_loss


def test_the_same_seed_gives_the_same_bits(cube: RadarCube):
    one, again, other = (fit(cube, quick(TUNED_SHORT, steps=5), seed=seed).field.cube().values for seed in (0, 0, 1))
    assert one.tobytes() == again.tobytes()
    assert one.tobytes() != other.tobytes()


def test_the_training_pass_is_the_field(cube: RadarCube):
    """Gathering, folding and padding in training are the same function as the field's plain evaluation."""
    import torch

    from studies.paper.single_signal import _Network

    network = _Network(cube, TUNED_SHORT, 0, "cpu")
    with torch.no_grad():
        network.gamma += 0.2 * torch.randn(network.gamma.shape, generator=torch.Generator().manual_seed(0))
        network.beta += 0.2
        every = torch.arange(int(np.prod(cube.grid.shape[1:]))).expand(3, -1)
        iq = network._at(every).numpy()
    field = network.field(replace(cube), 1.0)
    field.is_centred = False  # type: ignore
    values = field.cube().values.reshape(3, -1)
    assert np.allclose(iq[..., 0] + 1j * iq[..., 1], values, atol=1e-5 * np.abs(values).max())


def test_half_the_draws_favour_what_moves(cube: RadarCube):
    cells = cells_of(cube)
    for recipe, favoured in (
        (PAPER, np.broadcast_to(cells.is_moving.any(axis=2, keepdims=True), cells.is_moving.shape)),
        (TUNED_SHORT, cells.is_active),
    ):
        draw = _Draw(cube, recipe, seed=0)
        batch = draw.batch()
        real = batch.weight > 0
        assert real.sum() == 16_384
        frame, slot = np.nonzero(real)
        cell = batch.cell[frame, slot] // cube.grid.shape[3]
        share = favoured.reshape(3, -1)[frame, cell].mean()
        assert share == pytest.approx(0.5 + 0.5 * favoured.mean(), abs=0.02)


def test_weights_make_the_favoured_loss_that_of_even_draws(cube: RadarCube):
    """The weighted mean of any quantity over draws is its mean over all cells."""
    draw = _Draw(cube, TUNED_SHORT, seed=0)
    power = (np.abs(cube.values) ** 2).reshape(3, -1)
    estimates = []
    for _ in range(20):
        batch = draw.batch()
        estimates.append(float((np.take_along_axis(power, batch.cell, 1) * batch.weight).sum()))
    assert np.mean(estimates) == pytest.approx(power.mean(), rel=0.03)


def test_an_empty_cube_cannot_be_fitted(cube: RadarCube):
    with pytest.raises(InputError, match="all zeros"):
        fit(replace(cube, values=0 * cube.values), quick(PAPER))
