from dataclasses import fields

import numpy as np
import pytest
import torch

from mmweaver.compression.entropy import Decoder, Encoder
from mmweaver.compression.quantised_cells import beams_of
from mmweaver.compression.scatterer_coder import (
    CodedPoints,
    PointCoder,
    PointSteps,
    code_static,
    dequantize,
    quantize,
    static_levels,
    static_of,
)
from mmweaver.compression.scatterers.fit_window import FitWindow
from mmweaver.core.seeding import stream
from tests.compression.echoes import SMALL
from tests.compression.scatterers.test_refinement import AXES, RESPONSE, random_points

SHAPE = (3, 24, 16)


def coded_at(step: float, num_points: int = 25) -> tuple[CodedPoints, PointSteps]:
    steps = PointSteps.of(step, RESPONSE, AXES)
    return quantize(random_points(num_points, num_frames=3), steps, AXES, 2, 1), steps


@pytest.mark.parametrize("step", [0.5, 0.05, 1e-4])
def test_quantized_points_round_trip(step: float):
    coded, steps = coded_at(step)
    writer = Encoder()
    PointCoder(SHAPE, steps, 2).code(writer, coded)
    again = PointCoder(SHAPE, steps, 2).code(Decoder(writer.to_bytes()), None)
    for field in fields(CodedPoints):
        if field.name not in ("size", "phase", "range_part", "doppler_part", "direction"):
            assert np.array_equal(getattr(again, field.name), getattr(coded, field.name)), field.name
    # scatterers of one cell may change places, not their numbers
    key = [np.lexsort((c.phase, c.size, c.doppler_cell, c.range_cell, c.frame)) for c in (coded, again)]
    for name in ("size", "phase", "range_part", "doppler_part", "direction"):
        assert np.array_equal(getattr(again, name)[key[1]], getattr(coded, name)[key[0]]), name


def test_every_parameter_follows_the_step():
    """The error of cells is a few times step / sqrt(12); ten times the step, ten times the error."""
    points = random_points(10, num_frames=3)
    truth = RESPONSE.render(points, AXES)
    errors = []
    for step in (0.02, 0.002):
        steps = PointSteps.of(step, RESPONSE, AXES)
        again = dequantize(quantize(points, steps, AXES, 2, 1), 3, steps, AXES, 2)
        energy = float((RESPONSE.render(again, AXES) - truth).abs().square().sum())
        errors.append(np.sqrt(energy / 30) / step)  # a scatterer, in steps
    assert all(0.2 < error < 2.0 for error in errors)


def test_a_static_layer_is_known_to_less_than_a_step():
    beams = beams_of(SMALL)
    window = FitWindow.of(SMALL, 3, 0)
    draw = stream(0, "static").normal(size=(2, SMALL.num_range_bins, SMALL.num_antennas))
    static = torch.from_numpy((draw[0] + 1j * draw[1]).astype(np.complex64))
    errors, sizes = [], []
    for step in (1.0, 0.1):
        levels, encoder = static_levels(static, window, beams, step), Encoder()
        code_static(encoder, levels)
        data, again = encoder.to_bytes(), np.zeros_like(levels)
        code_static(Decoder(data), again)
        assert np.array_equal(again, levels)
        errors.append(float((static_of(again, window, beams, step) - static).abs().square().mean().sqrt()))
        sizes.append(len(data))
    assert 5 < errors[0] / errors[1] < 20
    assert sizes[0] < sizes[1]
