"""The Hann window is the periodic one."""

import numpy as np

from mmweaver.signal.windows import hann


def test_its_spectrum_is_three_bins():
    spectrum = np.fft.fft(hann(16)) / 16
    assert np.allclose(spectrum[[0, 1, 15]], [0.5, -0.25, -0.25])
    assert np.allclose(spectrum[2:15], 0)
