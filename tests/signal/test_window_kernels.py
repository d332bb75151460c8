import numpy as np
import pytest
import torch

from mmweaver.signal.window_kernels import WindowKernel
from mmweaver.signal.windows import doppler_window, doppler_window_middle


@pytest.mark.parametrize("num", [1, 2, 3, 16, 85, 256])
def test_the_kernel_is_the_windows_spectrum_anywhere(num: int):
    """Against the sum over samples; some change sign from one period to the next. Fewer than four are a rectangle."""
    window = doppler_window(num)
    place = np.linspace(-1.6 * num, 1.6 * num, 1501)
    middle = np.arange(num) - doppler_window_middle(num)
    turns = np.outer(place, middle) / num
    value = np.cos(2 * np.pi * turns) @ window / window.sum()
    slope = -np.sin(2 * np.pi * turns) @ (window * 2 * np.pi * middle / num) / window.sum()
    ours = WindowKernel(window)(torch.from_numpy(place))
    assert np.abs(ours[0].numpy() - value).max() < 2e-6
    assert np.abs(ours[1].numpy() - slope).max() < 2e-4


def test_a_lopsided_window_is_refused():
    with pytest.raises(ValueError, match="symmetric"):
        WindowKernel(np.arange(8.0))
