from dataclasses import replace

import numpy as np
import torch

from mmweaver.dsp.point_response import Points
from mmweaver.fields.scatterers.fit_window import FitWindow
from studies.fields.scatterer_tracks import TrackShape, fit_tracks
from tests.fields.echoes import SMALL

SHAPE = TrackShape(num_frames=2, range_degree=1, direction_degree=0)


def test_a_track_costs_less_than_its_points():
    assert SHAPE.num_values == 8 < 2 * 6
    assert TrackShape(num_frames=4, range_degree=2, direction_degree=1).num_values == 15


def test_echoes_that_do_live_on_are_held_by_tracks():
    """Two points at constant velocity over two frames, the tracks starting a little off them."""
    config = replace(SMALL, frame_period_s=0.02)
    fit_window = FitWindow.of(config, 2, 0)
    response = fit_window.response
    bins = response.velocity_a_bin_mps * config.frame_period_s / response.range_a_bin_m
    doppler = torch.tensor([[2.3, -3.1]])
    own = torch.tensor([[18.4, 25.7]])
    direction = torch.tensor([[[0.2, 0.1], [-0.3, 0.0]]])
    at = torch.tensor([[-0.5], [0.5]])
    truth = Points(
        range_bin=own + response.coupling * doppler + at * bins * doppler, doppler_bin=doppler.expand(2, 2),
        direction=direction.expand(2, 2, 2), amplitude=torch.tensor([[1.0, 0.5j], [0.3 + 0.4j, -1.0]]),
    )  # fmt: skip
    target = response.render(truth, fit_window.axes)
    start = Points(
        range_bin=truth.range_bin[1:] + 0.1, doppler_bin=truth.doppler_bin[1:] - 0.1,
        direction=truth.direction[1:] + 0.02, amplitude=truth.amplitude[1:],
    )  # fmt: skip
    left = fit_tracks(target, fit_window, SHAPE, config.frame_period_s, start)
    assert 10 * np.log10(left) < -40
