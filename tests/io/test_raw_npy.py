"""Raw ADC arrays with their axes named."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from mmweaver.core.boards import AWR1843, BGT60
from mmweaver.core.errors import InputError
from mmweaver.core.seeding import stream
from mmweaver.io.raw_npy import read_adc_npy

SMALL = replace(AWR1843, num_loops=5, num_samples=8, num_range_bins=4, first_range_bin=0)


def saved(tmp_path: Path, values: np.ndarray) -> Path:
    np.save(tmp_path / "adc.npy", values)
    return tmp_path / "adc.npy"


@pytest.fixture
def truth() -> np.ndarray:
    draw = stream(0, "test npy")
    return (draw.standard_normal((2, 5, 3, 4, 8)) + 1j * draw.standard_normal((2, 5, 3, 4, 8))).astype(np.complex64)


def in_firing_order(samples: np.ndarray) -> np.ndarray:
    return samples[:, :, list(SMALL.tx_order)]


@pytest.mark.parametrize(
    ("axes", "change"),
    [
        ("frame,loop,tx,rx,sample", lambda fired: fired),
        ("frame, sample, rx, tx, loop", lambda fired: fired.transpose(0, 4, 3, 2, 1)),
        ("frame,loop,antenna,sample", lambda fired: fired.reshape(2, 5, 12, 8)),
        ("sample,vrx,loop,frame", lambda fired: fired.reshape(2, 5, 12, 8).transpose(3, 2, 1, 0)),
        ("frame,chirp,rx,sample", lambda fired: fired.reshape(2, 15, 4, 8)),
        ("rx,chirp,frame,sample", lambda fired: fired.reshape(2, 15, 4, 8).transpose(2, 1, 0, 3)),
    ],
)
def test_any_order_of_axes(tmp_path: Path, truth: np.ndarray, axes: str, change):
    adc = read_adc_npy(saved(tmp_path, change(in_firing_order(truth))), SMALL, axes)
    assert np.array_equal(adc.samples, truth)
    assert np.isnan(adc.scale)


def test_missing_axes_have_size_one(tmp_path: Path, truth: np.ndarray):
    fired = in_firing_order(truth)
    assert np.array_equal(read_adc_npy(saved(tmp_path, fired[0]), SMALL, "loop,tx,rx,sample").samples, truth[:1])
    single = replace(SMALL, tx_position_m=SMALL.tx_position_m[:1], rx_position_m=SMALL.rx_position_m[:1], tx_order=(0,))
    adc = read_adc_npy(saved(tmp_path, truth[0, :, 0, 0]), single, "loop,sample")
    assert np.array_equal(adc.samples, truth[:1, :, :1, :1])


def test_the_mean_of_real_samples_is_removed(tmp_path: Path):
    counts = stream(0, "test npy real").integers(0, 4096, (3, 3, 8, 64)).astype(np.uint16)
    adc = read_adc_npy(saved(tmp_path, counts), BGT60, "frame,rx,loop,sample")
    assert adc.samples.shape == (3, 8, 1, 3, 64)
    assert not adc.samples.imag.any()
    wanted = counts[2, 1, 5] - counts[2, 1, 5].mean()
    assert adc.samples.real[2, 5, 0, 1] == pytest.approx(wanted, abs=1e-3)


def test_int16_stored_as_uint16_is_converted_back(tmp_path: Path):
    counts = stream(0, "test npy wrap").integers(-2000, 2000, (8, 3, 64)).astype(np.int16)
    path = saved(tmp_path, counts.view(np.uint16))
    wrapped = read_adc_npy(path, BGT60, "loop,rx,sample").samples
    assert np.array_equal(wrapped, read_adc_npy(saved(tmp_path, counts), BGT60, "loop,rx,sample").samples)


@pytest.mark.parametrize(
    ("shape", "axes", "words"),
    [
        ((2, 5, 3, 4, 8), "frame,loop,tx,rx", ["lack sample", "8"]),
        ((2, 5, 3, 4, 8), "frame,loop,rx,tx,sample", ["(2, 5, 3, 4, 8)", "rx 4, tx 3"]),
        ((2, 5, 3, 4, 8), "frame,loop,antenna,sample", ["antenna 12", "frame any"]),
        ((2, 5, 12, 8), "frame,loop,antennas,sample", ["unknown axis 'antennas'", "vrx"]),
        ((2, 5, 12, 8), "frame,loop,tx,antenna", ["twice"]),
        ((0, 5, 12, 8), "frame,loop,antenna,sample", ["empty"]),
        ((5, 12, 8), "loop,rx,sample", ["lack tx", "vrx is tx and rx"]),
        ((5, 12, 8), "", ["unknown axis ''"]),
    ],
)
def test_wrong_axes_are_refused(tmp_path: Path, shape: tuple, axes: str, words: list[str]):
    with pytest.raises(InputError) as caught:
        read_adc_npy(saved(tmp_path, np.zeros(shape, np.complex64)), SMALL, axes)
    for word in words:
        assert word in str(caught.value)
