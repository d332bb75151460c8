from dataclasses import replace

import numpy as np
import pytest

from mmweaver.compression.quantised_cells import active_mask
from mmweaver.compression.signal_field import SignalField
from mmweaver.core.errors import InputError
from mmweaver.core.records import CubeGrid, RadarCube
from mmweaver.inr import FIELDS, PAPER, FitOptions, InrField, ModulatedINR, SeparableINR, fit, fit_many, load
from mmweaver.inr.fitting import _Sampler
from tests.compression.echoes import SMALL as ECHOES
from tests.compression.echoes import crowd, direction_of, error_db, exact_point
from tests.cubes import SMALL, point_cube

QUICK = FitOptions(steps=120)
LAYERS = FitOptions(is_separable=False, steps=250, points=2_048)


@pytest.fixture(scope="module")
def cube() -> RadarCube:
    return point_cube(replace(SMALL, num_range_bins=16), num_frames=3, noise=0.05)


@pytest.fixture(scope="module")
def fields(cube: RadarCube) -> dict[str, SignalField]:
    """One field of each kind and network."""
    layers = replace(LAYERS, steps=10)
    return {
        "separable": fit(cube, num_values=1_200, options=QUICK),
        "modulated": fit(cube, num_values=2_000, options=layers),
        "base": fit(cube, "base", num_values=2_000, options=layers),
        "paper": fit(cube, num_values=6_000, options=replace(PAPER, steps=3)),
        "scatterers": fit(cube, "scatterers", num_values=1_200),
    }


NAMES = ("separable", "modulated", "base", "paper", "scatterers")


def test_a_separable_inr_finds_points(cube: RadarCube):
    field = fit(cube, num_values=1_200, options=FitOptions(steps=300))
    assert isinstance(field, InrField)
    assert isinstance(field.network, SeparableINR)
    assert error_db(field.cube().values, cube.values) < -25
    assert field.num_values <= 1_200


def test_between_bins_it_is_what_the_radar_would_measure():
    """A point half a bin off, whose exact cube is known: the fit at whole bins, sampled at half a bin."""
    values = exact_point(ECHOES, 1.4, 0.5, direction_of(0.2, 0.1))[None]
    one = RadarCube(values=values, grid=CubeGrid.of(ECHOES, 1), config=ECHOES, scale=1.0)
    field = fit(one, num_values=200, options=FitOptions(steps=400))
    half = ECHOES.range_resolution_m / 2
    ours = field.values_on(replace(one.grid, range_m=one.grid.range_m + half))[0]
    moved = exact_point(ECHOES, 1.4 - half, 0.5, direction_of(0.2, 0.1))
    assert error_db(np.abs(ours), np.abs(moved)) < -20


def test_layers_learn_what_the_papers_recipe_does_not(cube: RadarCube):
    """In the same number of steps: the paper's stays at the level of zeros (0 dB), the working options are below."""
    where = active_mask(cube.values)
    paper, ours = (
        error_db(fit(cube, num_values=6_000, options=options).cube().values[where], cube.values[where])
        for options in (replace(PAPER, steps=250, points=2_048), LAYERS)
    )
    assert paper > -1.0
    assert ours < -5.0


def test_the_papers_counts_come_out_of_a_fit():
    """20 frames and 10,018 values: 4,898 shared and 5,120 of the frames."""
    (field,) = fit_many([point_cube(num_frames=20)], options=replace(PAPER, steps=1, points=400))
    assert field.num_values == 10_018
    assert isinstance(field.network, ModulatedINR)
    assert field.network.theta.numel() == 4_898


@pytest.mark.parametrize("name", NAMES)
def test_points_and_grids_agree(fields: dict[str, SignalField], name: str):
    field = fields[name]
    whole = field.values_on(replace(field.grid))
    index = np.stack([np.random.default_rng(0).integers(0, size, 200) for size in whole.shape], axis=1)
    points = field.sample(index.astype(float))
    assert np.allclose(points, whole[tuple(index.T)], atol=1e-4 * np.abs(whole).max())


@pytest.mark.parametrize("name", NAMES)
def test_finer_grids_contain_the_native_cells(fields: dict[str, SignalField], name: str):
    field = fields[name]
    finer, native = field.on_grid(n_r=2, n_d=2, n_a=2).values, field.cube().values
    assert finer.shape == (3, 32, 32, 23)
    assert np.allclose(finer[:, ::2, ::2, ::2], native, atol=1e-3 * np.abs(native).max())


@pytest.mark.parametrize("name", NAMES)
def test_a_file_gives_the_same_bits(fields: dict[str, SignalField], name: str, tmp_path):
    field = fields[name]
    field.save(tmp_path / "a.safetensors")
    again = load(tmp_path / "a.safetensors")
    assert again.cube().values.tobytes() == field.cube().values.tobytes()
    assert again.config == field.config
    assert again.num_values == field.num_values
    assert np.array_equal(again.grid.frame_time_s, field.grid.frame_time_s)


def test_a_foreign_or_damaged_file_is_no_field(fields: dict[str, SignalField], tmp_path):
    from mmweaver.core.tensor_files import read_tensors, write_tensors

    file = tmp_path / "a.safetensors"
    fields["separable"].save(file)
    tensors, header = read_tensors(file)
    write_tensors(tmp_path / "other.safetensors", tensors, {"format": "mmweaver weights"})
    tensors.pop("direction")
    write_tensors(tmp_path / "cut.safetensors", tensors, header)
    for name, reason in (("other", "holds no field"), ("cut", "does not fit"), ("none", "none.safetensors")):
        with pytest.raises(InputError, match=reason):
            load(tmp_path / f"{name}.safetensors")


def test_many_signals_are_fitted_as_each_alone(cube: RadarCube):
    other = replace(cube, values=np.roll(cube.values, 2, axis=1))
    together = fit_many([cube, other], num_values=1_200, options=QUICK)
    alone = fit(other, num_values=1_200, options=QUICK)
    assert abs(error_db(together[1].cube().values, other.values) - error_db(alone.cube().values, other.values)) < 3
    assert error_db(together[0].cube().values, cube.values) < -10


@pytest.mark.parametrize("options", [QUICK, replace(LAYERS, steps=5)])
def test_the_same_seed_gives_the_same_bits(cube: RadarCube, options: FitOptions):
    one, again = (fit(cube, num_values=1_200, options=options).cube().values for _ in range(2))
    assert one.tobytes() == again.tobytes()


def test_weights_make_the_favoured_loss_that_of_uniform_samples(cube: RadarCube):
    """The weighted mean of a quantity over samples is its mean over all cells."""
    sampler = _Sampler([cube], replace(LAYERS, points=3_000))
    power = (np.abs(cube.values) ** 2).reshape(1, 3, -1)
    estimates = []
    for _ in range(40):
        cell, weight = sampler.cells()
        estimates.append((np.take_along_axis(power, cell, 2) * weight.numpy()).mean())
    assert np.mean(estimates) == pytest.approx(power.mean(), rel=0.05)


def test_progress_reports_the_error_of_the_field(cube: RadarCube):
    seen = []
    field = fit(cube, num_values=1_200, options=QUICK, progress=lambda *state: seen.append(state))
    assert seen[-1][:2] == (120, 120)
    assert seen[-1][2] == pytest.approx(error_db(field.cube().values, cube.values), abs=1.0)
    assert seen[-1][2] < seen[0][2]


def test_what_cannot_be_fitted_is_refused(cube: RadarCube):
    for field in FIELDS:
        with pytest.raises(InputError, match="all zeros"):
            fit(replace(cube, values=0 * cube.values), field)
    with pytest.raises(InputError, match="too few"):
        fit(cube, num_values=20)
    with pytest.raises(InputError, match="no field 'points'"):
        fit(cube, "points")
    with pytest.raises(InputError, match="one number of frames"):
        fit_many([cube, crowd()])
