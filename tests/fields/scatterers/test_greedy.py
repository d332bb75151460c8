import torch

from mmweaver.dsp.point_response import PointResponse
from mmweaver.fields.scatterers.fit_window import FitWindow
from mmweaver.fields.scatterers.greedy import Beams, matched_power, next_points
from tests.fields.echoes import SMALL, direction_of, exact_point


def test_the_first_scatterer_is_within_a_cell_and_a_beam():
    fit_window = FitWindow.of(SMALL, 1, 0)
    towards = direction_of(0.35, 0.0)
    target = fit_window.working(exact_point(SMALL, 1.4, 1.1, towards)[None])
    response, axes = fit_window.response, fit_window.axes
    points = next_points(target, response, axes, Beams.over(axes, 2), count=1, least=0.0)
    assert abs(float(points.range_bin[0, 0]) - 1.4 / response.range_a_bin_m) < 1.0
    assert abs(float(points.doppler_bin[0, 0]) - 1.1 / response.velocity_a_bin_mps) < 1.0
    assert abs(float(points.direction[0, 0, 0]) - towards[0]) < 0.2


def test_weak_candidates_are_rejected():
    fit_window = FitWindow.of(SMALL, 2, 0)
    target = torch.zeros(2, 24, 16, 12, dtype=torch.complex64)
    target[1, 5, 5] = 1.0
    response, axes = fit_window.response, fit_window.axes
    beams = Beams.over(axes, 2)
    power, _ = matched_power(target, response, beams, count=9, least=0.0)
    found = next_points(target, response, axes, beams, count=9, least=0.5 * float(power.max()))
    assert (found.amplitude != 0).sum(dim=1).tolist() == [0, 1]
    none = next_points(target, response, axes, beams, count=9, least=2 * float(power.max()))
    assert none.amplitude.shape == (2, 0)


def test_an_array_without_aperture_has_one_beam():
    assert len(Beams.over(PointResponse(SMALL).axes(), 0).direction) == 1
