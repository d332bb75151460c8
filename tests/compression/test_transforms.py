import numpy as np
import pytest

from mmweaver.compression.transforms import FULL_DCT, ChunkTransform, TransformChoice, transform_choices
from mmweaver.core.seeding import stream
from mmweaver.signal.windows import hann

SHAPES = [(1, 4, 8, 3), (5, 3, 1, 1), (6, 4, 2, 4), (4, 3, 32, 8)]


def values_of(shape: tuple[int, ...]) -> np.ndarray:
    parts = stream(1, "values").normal(size=(2, *shape))
    return parts[0] + 1j * parts[1]


@pytest.mark.parametrize("shape", SHAPES)
def test_every_choice_is_unitary_and_survives_its_bytes(shape: tuple[int, ...]):
    values, beams = values_of(shape), np.eye(shape[3], dtype=complex)
    for choice in transform_choices(shape):
        transform = ChunkTransform.of(choice, values, beams)
        coefficients = transform.forward(values)
        assert np.sum(np.abs(coefficients) ** 2) == pytest.approx(np.sum(np.abs(values) ** 2))
        again = ChunkTransform.unpack(transform.packed + b"more", beams, shape[2])
        assert again.choice == choice
        assert np.allclose(again.inverse(coefficients), values)


def test_two_loops_under_a_hann_window_are_one_coefficient():
    chirps = values_of((50, 16, 2, 3))
    spectrum = np.fft.fft(chirps * hann(2)[:, None], axis=2)
    transform = ChunkTransform.of(TransformChoice(time=FULL_DCT, doppler_klt=True), spectrum, np.eye(3, dtype=complex))
    power = np.mean(np.abs(transform.forward(spectrum)) ** 2, axis=(0, 1, 2))
    assert power[1] < 1e-8 * power[0]


def test_a_steady_signal_is_one_frame_after_the_dct():
    steady = np.broadcast_to(values_of((1, 8, 4, 2)), (30, 8, 4, 2))
    transform = ChunkTransform.of(TransformChoice(time=FULL_DCT), steady, np.eye(2, dtype=complex))
    power = np.sum(np.abs(transform.forward(steady)) ** 2, axis=(0, 2, 3))
    assert power[1:].sum() < 1e-20 * power[0]


def test_correlated_neighbours_are_noticed():
    rough = values_of((3, 40, 16, 2))
    smooth = rough[:, 1:] + rough[:, :-1]
    of = lambda values: ChunkTransform.of(TransformChoice(), values, np.eye(2, dtype=complex)).correlated  # noqa: E731
    assert of(rough) == (False, False)
    assert of(smooth) == (True, False)
