import torch

from mmweaver.compression.quantised_cells import beams_of
from mmweaver.compression.scatterers.fit_window import FitWindow
from mmweaver.compression.scatterers.fitting import FitRecipe, fitted
from mmweaver.compression.scatterers.layers import rendered, static_cells
from tests.compression.echoes import SMALL, crowd


def left_db(working: torch.Tensor, fit_window: FitWindow, recipe: FitRecipe) -> tuple[float, torch.Tensor]:
    layers = fitted(working, fit_window, recipe)
    left = working - rendered(layers, fit_window.response, fit_window.axes)
    error = 10 * torch.log10(left.abs().square().sum() / working.abs().square().sum())
    return float(error), layers.counts()


def test_many_scatterers_are_fitted_down_to_the_noise():
    cube = crowd()
    fit_window = FitWindow.of(SMALL, 3, 0)
    working = fit_window.working(cube.values)
    noise_db = 10 * torch.log10(torch.tensor(2 * 2e-4**2) / working.abs().square().mean())
    error, counts = left_db(working, fit_window, FitRecipe(num_points=90, stages=10))
    assert error < -30
    assert error > noise_db - 1.0
    fewer, _ = left_db(working, fit_window, FitRecipe(num_points=20, stages=10))
    assert fewer > error + 3
    assert counts.sum() <= 90


def test_frames_of_noise_get_no_scatterers():
    parts = torch.randn(2, 2, 24, 16, 12, generator=torch.Generator().manual_seed(0))
    noise = torch.complex(parts[0], parts[1])
    recipe = FitRecipe(num_points=50, stages=5, with_static=False, least_gain=40.0)
    layers = fitted(noise, FitWindow.of(SMALL, 2, 0), recipe)
    assert int(layers.counts().sum()) == 0
    assert 0.8 < layers.noise_power / 2 < 1.2


def test_antenna_gains_are_learned():
    cube = crowd(num_points=20)
    gain = torch.ones(12, dtype=torch.complex64)
    gain[3], gain[7] = 1.2, torch.polar(torch.tensor(1.0), torch.tensor(0.3))
    fit_window = FitWindow.of(SMALL, 3, 0)
    working = fit_window.working(cube.values) * gain
    recipe = FitRecipe(num_points=80, stages=10, last_steps=12)
    plain, _ = left_db(working, fit_window, recipe)
    layers = fitted(working, fit_window, FitRecipe(num_points=80, stages=10, last_steps=12, with_calibration=True))
    left = working - rendered(layers, fit_window.response, fit_window.axes)
    error = float(10 * torch.log10(left.abs().square().sum() / working.abs().square().sum()))
    assert error < plain - 1
    assert abs(layers.calibration[3] / layers.calibration[4]) > 1.1


def test_the_parameter_budget_holds_and_useless_static_beams_are_dropped():
    """A wall straight ahead and many points: few beams represent the wall, and the points get the rest."""
    fit_window = FitWindow.of(SMALL, 3, 0)
    wall = torch.zeros(24, 12, dtype=torch.complex64)
    wall[6:10] = 0.3
    working = fit_window.working(crowd().values) + static_cells(wall, fit_window.response, fit_window.axes)
    left_db = {}
    for most in (600, 1200):
        layers = fitted(working, fit_window, FitRecipe(num_points=999, num_values=most, stages=10))
        assert 0.9 * most < layers.num_values(fit_window.response) <= most
        assert layers.active_beams is not None
        active = torch.from_numpy(layers.active_beams)
        assert 6 < int(active.sum()) < 0.8 * active.numel()
        beams = layers.static @ torch.from_numpy(beams_of(SMALL)).to(layers.static.dtype).T
        assert float(beams[~active].abs().max()) < 1e-5
        left = working - rendered(layers, fit_window.response, fit_window.axes)
        left_db[most] = float(10 * torch.log10(left.abs().square().sum() / working.abs().square().sum()))
    assert left_db[1200] < left_db[600] - 2
    assert left_db[1200] < -30
