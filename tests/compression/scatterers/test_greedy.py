import numpy as np

from mmweaver.compression.scatterers.fit_window import FitWindow
from mmweaver.compression.scatterers.fitting import Greedy, peaks
from tests.compression.echoes import SMALL, direction_of, exact_point


def test_the_first_scatterer_is_within_a_cell_and_a_beam():
    fit_window = FitWindow.of(SMALL, 1, 0)
    towards = direction_of(0.35, 0.0)
    target = fit_window.working(exact_point(SMALL, 1.4, 1.1, towards)[None]).numpy()
    response = fit_window.response
    found = Greedy.of(response, fit_window.axes).next_points(target, count=1, least=0.0)
    assert abs(found.bins[0, 0] - 1.4 / response.range_a_bin_m) < 1.0
    assert abs(found.bins[1, 0] - 1.1 / response.velocity_a_bin_mps) < 1.0
    assert abs(found.direction[0, 0] - towards[0]) < 0.2


def test_weak_candidates_are_rejected():
    fit_window = FitWindow.of(SMALL, 2, 0)
    target = np.zeros((2, 24, 16, 12), np.complex64)
    target[1, 5, 5] = 1.0
    greedy = Greedy.of(fit_window.response, fit_window.axes)
    power, _ = greedy.matched_power(target, count=9, least=0.0)
    found = greedy.next_points(target, count=9, least=0.5 * float(power.max()))
    assert found.frame.tolist() == [1]
    assert len(greedy.next_points(target, count=9, least=2 * float(power.max()))) == 0


def test_beams_in_a_few_cells_find_what_beams_in_all_cells_do():
    fit_window = FitWindow.of(SMALL, 12, 0)
    parts = np.random.default_rng(0).standard_normal((12, 24, 16, 12, 2), np.float32)
    noise = 0.01 * np.ascontiguousarray(parts).view(np.complex64)[..., 0]
    noise[[1, 4, 9], [5, 9, 20], [5, 0, 15]] += 1
    greedy = Greedy.of(fit_window.response, fit_window.axes)
    some, _ = greedy.matched_power(noise, count=3, least=0.0)
    every, _ = greedy.matched_power(noise, count=noise.size, least=0.0)
    assert np.count_nonzero(some) < every.size
    top = np.sort(peaks(every).ravel())[-3:]
    assert np.allclose(np.sort(peaks(some).ravel())[-3:], top)
