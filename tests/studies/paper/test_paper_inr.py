import numpy as np
import pytest
import torch

from mmweaver.compression.signal_field import finer_grid
from mmweaver.core.boards import AWR1843
from mmweaver.core.records import CubeGrid
from mmweaver.core.seeding import stream
from studies.paper.paper_inr import (
    MODULATIONS_PER_FRAME,
    BaseInrField,
    InrField,
    InrShape,
    evaluate,
    evaluate_on_axes,
    fresh_modulation,
)
from studies.paper.positional_encoding import harmonics
from tests.cubes import SMALL


def random_field(config=SMALL, num_frames: int = 3, *, is_centred: bool = True, activation: str = "relu") -> InrField:
    """A field with weights and modulations drawn at random."""
    rng = stream(0, "test field")
    grid = CubeGrid.of(config, num_frames)
    shape = InrShape(activation=activation)
    gamma, beta = (
        torch.from_numpy((1 - offset + 0.3 * rng.standard_normal((num_frames, 4, 32))).astype(np.float32))
        for offset in (0, 1)
    )
    return InrField(
        config=config, grid=grid, scale=1.0, shape=shape, theta=shape.fresh(rng), gamma=gamma, beta=beta,
        amplitude=2.5, is_centred=is_centred,
    )  # fmt: skip


def test_the_papers_numbers():
    assert InrShape().sizes == (51, 32, 32, 32, 32, 2)
    assert InrShape().num_weights == 4_898
    assert MODULATIONS_PER_FRAME == 256
    field = random_field(AWR1843, num_frames=20)
    assert field.gamma.numel() + field.beta.numel() == 5_120
    assert field.num_values == 10_018


def test_theta_is_the_weights_of_an_ordinary_network():
    """The same numbers in torch's own layers give the same I and Q."""
    shape = InrShape()
    theta = shape.fresh(stream(1, "theta"))
    network = torch.nn.Sequential()
    for at, (fan_in, fan_out) in enumerate(zip(shape.sizes, shape.sizes[1:], strict=False)):
        network.append(torch.nn.Linear(fan_in, fan_out))
        if at < 4:
            network.append(torch.nn.ReLU())
    torch.nn.utils.vector_to_parameters(theta, network.parameters())
    x = torch.rand(50, 3) * 2 - 1
    parts = []
    for axis in range(3):
        parts.append(x[:, axis : axis + 1])
        parts += [torch.cos(2.0**i * x[:, axis : axis + 1]) for i in range(8)]
        parts += [torch.sin(2.0**i * x[:, axis : axis + 1]) for i in range(8)]
    assert torch.allclose(evaluate(shape, theta, x), network(torch.cat(parts, 1)), atol=1e-5)


def test_a_fresh_modulation_is_the_identity():
    shape = InrShape()
    theta, x = shape.fresh(stream(2, "theta")), torch.rand(40, 3)
    gamma, beta = fresh_modulation(40)
    assert torch.equal(evaluate(shape, theta, x, gamma, beta), evaluate(shape, theta, x))


def test_modulation_scales_and_shifts_before_the_activation():
    shape = InrShape()
    theta, x = shape.fresh(stream(2, "theta")), torch.rand(5, 3)
    gamma, beta = fresh_modulation(5)
    gamma[:, 3], beta[:, 3] = 0.0, -1.0  # ReLU of -1: the last layer sees nothing
    _, last_bias = shape.layers(theta)[-1]
    assert torch.allclose(evaluate(shape, theta, x, gamma, beta), last_bias.expand(5, 2))


@pytest.mark.parametrize("activation", ["relu", "gauss"])
@pytest.mark.parametrize("is_centred", [False, True])
def test_the_separable_first_layer_equals_the_plain_encoding(activation: str, is_centred: bool):
    field = random_field(activation=activation, is_centred=is_centred)
    fast = field.on_grid(field.grid)
    index = np.stack(np.meshgrid(*[np.arange(num) for num in field.grid.shape], indexing="ij"), -1).reshape(-1, 4)
    plain = field.sample(index.astype(np.float64)).reshape(field.grid.shape)
    assert np.abs(fast - plain).max() <= 1e-5 * np.abs(plain).max()


def test_harmonics_are_separable_too():
    shape = InrShape(frequencies=tuple(harmonics(num, 0.5) for num in (3, 32, 16, 12)))
    theta = shape.fresh(stream(3, "theta"))
    axes = [torch.linspace(-1, 1, num) for num in (5, 4, 3)]
    gamma, beta = fresh_modulation(1)
    points = torch.cartesian_prod(*axes)
    on_axes = evaluate_on_axes(shape, theta, gamma, beta, axes)[0]
    assert torch.allclose(on_axes, evaluate(shape, theta, points), atol=1e-5)


def test_half_precision_errs_by_about_a_percent():
    field = random_field(is_centred=False)
    exact = field.on_grid(field.grid)
    field.decode_dtype = torch.bfloat16
    error = np.abs(field.on_grid(field.grid) - exact)
    assert 0 < np.sqrt(np.mean(error**2) / np.mean(np.abs(exact) ** 2)) < 0.03


def test_threads_change_no_bit():
    field = random_field()
    alone = field.cube().values
    before = torch.get_num_threads()
    field.decode_threads = 3
    assert field.cube().values.tobytes() == alone.tobytes()
    assert torch.get_num_threads() == before


def test_finer_grids_contain_the_native_samples():
    field = random_field()
    native = field.cube().values
    finer = field.finer(n_r=2.0, n_d=2.0, n_a=2.0)
    assert finer.values.shape == (3, 64, 32, 23)
    assert np.allclose(finer.values[:, ::2, ::2, ::2], native, atol=2e-5 * np.abs(native).max())


def test_between_frames_modulations_are_interpolated():
    field = random_field()
    at = np.array([[0.0, 4, 4, 4], [0.5, 4, 4, 4], [1.0, 4, 4, 4]])
    halfway = InrField(
        config=field.config, grid=field.grid, scale=1.0, shape=field.shape, theta=field.theta,
        gamma=(field.gamma[:1] + field.gamma[1:2]) / 2, beta=(field.beta[:1] + field.beta[1:2]) / 2,
        amplitude=field.amplitude, is_centred=True,
    )  # fmt: skip
    assert np.allclose(field.sample(at)[1], halfway.sample(at[:1])[0], rtol=1e-4)
    assert not np.allclose(field.sample(at)[1], field.sample(at)[0], rtol=1e-4)


def test_the_base_inr_takes_time_as_a_coordinate():
    shape = InrShape(num_axes=4)
    grid = CubeGrid.of(SMALL, 3)
    field = BaseInrField(
        config=SMALL, grid=grid, scale=1.0, shape=shape, theta=shape.fresh(stream(4, "theta")), amplitude=1.0,
        is_centred=False,
    )  # fmt: skip
    assert field.num_values == 5_442
    values = field.cube().values
    assert values.shape == grid.shape
    assert not np.allclose(values[0], values[1])
    assert np.allclose(field.cube(finer_grid(grid, n_r=2.0)).values[:, ::2], values, atol=1e-5)
