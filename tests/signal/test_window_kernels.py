import numpy as np
import pytest
import torch

from mmweaver.signal.windows import WindowKernel, doppler_window, doppler_window_middle, hann


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


def test_it_can_be_differentiated():
    kernel = WindowKernel(hann(32))
    x = torch.tensor([0.3, -1.7, 4.2], dtype=torch.float64, requires_grad=True)
    value, slope = kernel(x)
    value.sum().backward()
    assert x.grad is not None
    assert torch.allclose(x.grad, slope.detach(), atol=1e-5)


def test_a_lopsided_window_is_refused():
    with pytest.raises(ValueError, match="symmetric"):
        WindowKernel(np.arange(8.0))


@pytest.mark.parametrize("window", [hann(32), np.ones(9), np.ones(8)])
def test_bins_one_apart_have_the_same_response(window: np.ndarray):
    """Over several periods, on either side."""
    kernel = WindowKernel(window)
    place = np.array([[0.0, 3.3, -41.25], [77.77, 8.5, 1e-7]])
    bins = -5 + np.arange(40)
    expected = kernel(torch.from_numpy(bins - place[..., None]))
    ours = kernel.bin_values(-5.0, 40, place)
    for one, other in zip(ours, expected, strict=True):
        assert np.allclose(one, other.numpy(), atol=1e-4)
    assert np.allclose(ours[0], expected[0].numpy(), atol=5e-6)
