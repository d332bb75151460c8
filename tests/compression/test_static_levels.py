import numpy as np
import torch

from mmweaver.compression.entropy import Decoder, Encoder
from mmweaver.compression.static_levels import code_static, static_bits, static_levels, static_of
from mmweaver.compression.transforms import beams_of
from mmweaver.core.seeding import stream
from mmweaver.fields.scatterers.fit_window import FitWindow
from tests.fields.echoes import SMALL


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
        assert abs(static_bits(levels) / 8 / len(data) - 1) < 0.1
        errors.append(float((static_of(again, window, beams, step) - static).abs().square().mean().sqrt()))
        sizes.append(len(data))
    assert 5 < errors[0] / errors[1] < 20
    assert sizes[0] < sizes[1]
