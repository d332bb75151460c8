import pytest
import torch

from mmweaver.dsp.point_response import PointResponse
from mmweaver.fields.scatterers.layout_vector import ScattererLayout
from tests.fields.echoes import SMALL


def test_vector_to_points_and_back():
    layout = ScattererLayout.of(PointResponse(SMALL), 5)
    row = torch.rand(2, layout.num_values, generator=torch.Generator().manual_seed(0)) * 2 - 1
    points = layout.points(row)
    assert points.amplitude.shape == (2, 5)
    assert torch.allclose(layout.packed(points), row, atol=1e-6)
    wider = ScattererLayout.of(PointResponse(SMALL), 7)
    assert wider.packed(points)[:, -12:].abs().max() <= 2.0
    with pytest.raises(ValueError, match="do not fit"):
        ScattererLayout.of(PointResponse(SMALL), 4).packed(points)


def test_axes_are_scaled_to_one_at_their_ends():
    layout = ScattererLayout.of(PointResponse(SMALL), 1)
    points = layout.points(torch.tensor([-1.0, 1.0, 0.2, 0.1, 1.0, 0.0]))
    assert points.range_bin.item() == pytest.approx(10.0)
    assert points.doppler_bin.item() == pytest.approx(7.0)


def test_gradients_flow_through_the_layout():
    response = PointResponse(SMALL)
    layout = ScattererLayout.of(response, 2)
    row = torch.zeros(layout.num_values, requires_grad=True)
    cells = response.render(layout.points(row + 0.1), response.axes())
    cells.abs().square().sum().backward()
    assert row.grad is not None
    assert torch.isfinite(row.grad).all()
    assert row.grad.abs().max() > 0
