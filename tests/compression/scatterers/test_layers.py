import numpy as np
import torch

from mmweaver.compression.scatterers.layers import (
    Layers,
    compact,
    fit_static,
    static_cells,
    static_response,
    static_values,
    strongest,
    subtract_static,
)
from mmweaver.signal.point_response import PointResponse, Points
from tests.compression.echoes import SMALL


def some(amplitudes: list[list[float]]) -> Points:
    size = torch.tensor(amplitudes)
    return Points(range_bin=size * 10, doppler_bin=size, direction=torch.stack([size, -size], -1), amplitude=size + 0j)


def test_padding_is_moved_to_the_end_and_trimmed():
    points = compact(some([[0.0, 0.3, 0.0, 0.1], [0.0, 0.0, 0.2, 0.0]]))
    assert points.amplitude.real.tolist() == torch.tensor([[0.3, 0.1], [0.2, 0.0]]).tolist()
    assert points.range_bin[0].tolist() == torch.tensor([3.0, 1.0]).tolist()


def test_the_strongest_are_selected_over_all_frames():
    points = strongest(some([[0.5, 0.3, 0.1], [0.4, 0.05, 0.0]]), 3)
    assert (points.amplitude != 0).sum(dim=1).tolist() == [2, 1]


def test_a_static_layer_is_recovered():
    response = PointResponse(SMALL)
    axes = response.axes()
    parts = torch.randn(2, 24, 12, generator=torch.Generator().manual_seed(0))
    static = torch.complex(parts[0], parts[1])
    cells = static_cells(static, response, axes).expand(3, -1, -1, -1).numpy().copy()
    at_rest = static_response(response, axes)
    found = fit_static(cells, at_rest)
    assert np.allclose(found, static.numpy(), atol=1e-5)
    subtract_static(cells, found, at_rest)
    assert np.abs(cells).max() < 1e-4


def test_parameters_are_counted():
    size = torch.tensor([[0.5, 0.2]])
    points = Points(range_bin=size, doppler_bin=size, direction=torch.stack([size, size], -1), amplitude=size + 0j)
    gains = torch.full((12,), 2 + 0j)
    layers = Layers(points=points, static=torch.ones(24, 12) + 0j, calibration=gains, noise_power=1.0)
    assert layers.num_values(PointResponse(SMALL)) == 12 + 2 * 24 * 12 + 24 + 1
    mask = torch.zeros(64, 12, dtype=torch.bool).numpy()
    mask[3, :5] = True
    assert static_values(mask, mask.size) == 2 * 5 + 64 * 12 / 32
    assert static_values(~mask, mask.size) == 2 * 64 * 12  # cheaper without the marks
