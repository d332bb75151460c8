import numpy as np
import pytest

from mmweaver.compression.noise_layer import NoiseLayer, from_noise, signal_filled, to_noise
from mmweaver.core.seeding import stream

BEAMS = np.eye(2, dtype=complex)


def windowed_noise(frames: int = 2, num: int = 32) -> np.ndarray:
    """White noise after FFTs with Hann windows, in centred phase: (frame, range, doppler, antenna)."""
    draw = stream(0, "noise").normal(size=(2, frames, num, num, 2))
    window = np.cos(np.pi * (np.arange(num) / num - 0.5)) ** 2
    spectrum = np.fft.fft2((draw[0] + 1j * draw[1]) * (window[:, None] * window)[..., None], axes=(1, 2), norm="ortho")
    centred = np.exp(1j * np.pi * np.arange(num))
    return (spectrum * (centred[:, None] * centred)[..., None]).astype(np.complex64)


def test_the_transform_is_unitary_and_compacts_noise():
    values = windowed_noise()
    coefficients = to_noise(values, BEAMS)
    assert np.allclose(from_noise(coefficients, BEAMS), values, atol=1e-5)
    power = np.sort(np.abs(coefficients).ravel() ** 2)[::-1]
    flat = np.sort(np.abs(values).ravel() ** 2)[::-1]
    tenth = len(power) // 10
    assert power[:tenth].sum() / power.sum() > 1.5 * flat[:tenth].sum() / flat.sum()


def test_a_decoder_has_the_values_of_the_encoder():
    values = windowed_noise()
    layer = NoiseLayer.of(to_noise(values, BEAMS), 0.3, BEAMS)
    again = NoiseLayer.unpack(layer.packed + b"more", values.shape, BEAMS, 5)
    assert np.array_equal(again.values, layer.values)
    assert again.packed == layer.packed
    error = np.mean(np.abs(layer.values - values) ** 2)
    assert error < 0.5 * np.mean(np.abs(values) ** 2)


def test_cells_with_signal_continue_the_noise_around_them():
    values = windowed_noise()
    is_active = np.zeros(values.shape[:3], bool)
    is_active[:, 10:12, 5] = is_active[:, 20, 20] = True
    loud = np.where(is_active[..., None], 1000, values)
    quiet = signal_filled(loud, is_active)
    assert np.array_equal(quiet[~is_active], values[~is_active])
    missed = np.mean(np.abs(quiet - values)[is_active] ** 2)
    assert missed < 0.7 * np.mean(np.abs(values[is_active]) ** 2)  # zeros would miss all of it


@pytest.mark.parametrize("data", [b"", b"\0" * 9, b"\xff" * 40])
def test_malformed_layers_are_refused(data: bytes):
    with pytest.raises(Exception, match=r"noise|buffer"):
        NoiseLayer.unpack(data, (1, 4, 4, 2), BEAMS, 5)
