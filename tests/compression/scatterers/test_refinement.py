import pytest
import torch

from mmweaver.compression.scatterers.refinement import Damping, refined
from mmweaver.signal.point_response import PointResponse, Points
from tests.compression.echoes import SMALL

RESPONSE = PointResponse(SMALL)
AXES = RESPONSE.axes()


def random_points(num_points: int, seed: int = 0, num_frames: int = 2) -> Points:
    generator = torch.Generator().manual_seed(seed)

    def uniform(low: float, high: float, *more: int) -> torch.Tensor:
        return low + (high - low) * torch.rand(num_frames, num_points, *more, generator=generator)

    return Points(
        range_bin=uniform(12.0, 31.0), doppler_bin=uniform(-6.0, 6.0), direction=uniform(-0.5, 0.5, 2),
        amplitude=torch.polar(uniform(0.3, 1.0), uniform(0.0, 6.28)),
    )  # fmt: skip


def shaken(points: Points, by: float) -> Points:
    other = random_points(points.amplitude.shape[1], seed=9)
    return Points(
        range_bin=points.range_bin + by * (other.range_bin - 21) / 10,
        doppler_bin=points.doppler_bin + by * other.doppler_bin / 6,
        direction=points.direction + by * other.direction / 2,
        amplitude=points.amplitude * (1 + by * other.amplitude),
    )


@pytest.mark.parametrize("largest", [100, 4])
def test_perturbed_points_are_recovered(largest: int):
    """All together, and in groups of neighbours."""
    truth = random_points(9)
    target = RESPONSE.render(truth, AXES)
    found, residual = refined(shaken(truth, 0.25), target, RESPONSE, AXES, Damping.fresh(2), steps=40, largest=largest)
    left = residual.abs().square().sum() / target.abs().square().sum()
    assert 10 * torch.log10(left) < -50
    assert torch.allclose(target - RESPONSE.render(found, AXES), residual, atol=1e-5)


def test_frames_of_few_scatterers_and_of_none_are_refined_as_if_alone():
    truth = random_points(14, num_frames=10)
    counts = [0, 0, 0, 0, 0, 2, 3, 14, 13, 14]
    for frame, count in enumerate(counts):
        truth.amplitude[frame, count:] = 0
    target = RESPONSE.render(truth, AXES)
    start = truth.map(lambda tensor: tensor.clone())
    start.range_bin.add_(0.1)
    found, residual = refined(start, target, RESPONSE, AXES, Damping.fresh(10), steps=2, largest=50)
    for frame, count in enumerate(counts):
        alone, left = refined(start[[frame]], target[[frame]], RESPONSE, AXES, Damping.fresh(1), steps=2, largest=50)
        assert torch.allclose(found.amplitude[[frame]], alone.amplitude, atol=1e-4)
        assert torch.allclose(residual[[frame]], left, atol=1e-4)
        assert (found.amplitude[frame] != 0).sum() == count


def test_a_step_equals_that_of_the_explicit_jacobian():
    """One nearly undamped step against least squares on a Jacobian by finite differences.

    Ours leaves out the slow turns (TDM, migration, squint), so it is near, not equal.
    """

    half_bins = [float(axis[-1] - axis[0]) / 2 for axis in (AXES.range_bin, AXES.doppler_bin)]

    def packed(points: Points) -> torch.Tensor:
        """Scatterers (frame, point) as vectors of their parameters; bins in half axes, so that all are of order 1."""
        bins = [points.range_bin / half_bins[0], points.doppler_bin / half_bins[1]]
        parts = [*bins, *points.direction.unbind(-1), points.amplitude.real, points.amplitude.imag]
        return torch.stack(parts, dim=-1).flatten(-2)

    def points_of(row: torch.Tensor) -> Points:
        parts = row.unflatten(-1, (3, 6))
        return Points(
            range_bin=half_bins[0] * parts[..., 0], doppler_bin=half_bins[1] * parts[..., 1],
            direction=parts[..., 2:4],
            amplitude=torch.complex(parts[..., 4], parts[..., 5]),
        )  # fmt: skip

    truth = random_points(3, num_frames=1)
    start = packed(truth).double()[0] + 0.002
    target = RESPONSE.render(truth, AXES)[0]

    def left(row: torch.Tensor) -> torch.Tensor:
        return torch.view_as_real(target - RESPONSE.render(points_of(row.float()), AXES)).flatten().double()

    step = 1e-3
    columns = [(left(start + step * unit) - left(start - step * unit)) / (2 * step) for unit in torch.eye(18).double()]
    exact = start - torch.linalg.lstsq(torch.stack(columns, 1), left(start)).solution
    damping = Damping.fresh(1)
    damping.value = torch.full((1,), 1e-5)
    rows = points_of(start[None].float())
    ours, _ = refined(rows, target[None], RESPONSE, AXES, damping, steps=1, largest=50)
    moved = packed(ours)[0].double() - start
    assert torch.linalg.norm(moved - (exact - start)) < 0.3 * torch.linalg.norm(exact - start)
