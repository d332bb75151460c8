import torch

from mmweaver.compression.beams import beams_of
from mmweaver.compression.scatterers.fit_window import FitWindow
from mmweaver.compression.scatterers.layers import Layers, rendered, static_cells
from mmweaver.signal.point_response import PointResponse, Points
from studies.fields.budgeted_fit import BudgetedFit, BudgetedRecipe, num_values, static_values
from tests.compression.echoes import SMALL, crowd


def test_the_parameter_budget_holds_and_useless_static_beams_are_dropped():
    """A wall straight ahead and many points: few beams represent the wall, and the points get the rest."""
    fit_window = FitWindow.of(SMALL, 3, 0)
    wall = torch.zeros(24, 12, dtype=torch.complex64)
    wall[6:10] = 0.3
    working = fit_window.working(crowd().values) + static_cells(wall, fit_window.response, fit_window.axes)
    left_db = {}
    for most in (600, 1200):
        with torch.no_grad():
            fit = BudgetedFit(working, fit_window, BudgetedRecipe(num_points=999, num_values=most, stages=10))
            layers = fit.run()
        assert 0.9 * most < num_values(layers, fit.active_beams, fit_window.response) <= most
        active = torch.from_numpy(fit.active_beams)
        assert 6 < int(active.sum()) < 0.8 * active.numel()
        beams = layers.static @ torch.from_numpy(beams_of(SMALL)).to(layers.static.dtype).T
        assert float(beams[~active].abs().max()) < 1e-5
        left = working - rendered(layers, fit_window.response, fit_window.axes)
        left_db[most] = float(10 * torch.log10(left.abs().square().sum() / working.abs().square().sum()))
    assert left_db[1200] < left_db[600] - 2
    assert left_db[1200] < -30


def test_parameters_are_counted():
    size = torch.tensor([[0.5, 0.2]])
    points = Points(range_bin=size, doppler_bin=size, direction=torch.stack([size, size], -1), amplitude=size + 0j)
    gains = torch.full((12,), 2 + 0j)
    layers = Layers(points=points, static=torch.ones(24, 12) + 0j, calibration=gains, noise_power=1.0)
    assert num_values(layers, None, PointResponse(SMALL)) == 12 + 2 * 24 * 12 + 24 + 1
    mask = torch.zeros(64, 12, dtype=torch.bool).numpy()
    mask[3, :5] = True
    assert static_values(mask, mask.size) == 2 * 5 + 64 * 12 / 32
    assert static_values(~mask, mask.size) == 2 * 64 * 12  # cheaper without the marks
