"""adc_data.bin, read and written, against a reader written from the format's description alone."""

import struct
from dataclasses import replace
from itertools import permutations
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

from mmweaver.core.boards import AWR1843
from mmweaver.core.errors import InputError
from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.records import AdcCube
from mmweaver.core.seeding import stream
from mmweaver.core.transmit_code import tx_code_of
from mmweaver.io.dca1000 import read_bin, write_bin
from mmweaver.signal.windows import hann

SMALL = replace(AWR1843, num_loops=2, num_samples=8, num_range_bins=4, first_range_bin=0)


def counts_adc(config: RadarConfig, num_frames: int = 2) -> AdcCube:
    """Whole counts, all different from their neighbours."""
    draw = stream(0, "test bin")
    shape = (num_frames, config.num_loops, config.num_tx, config.num_rx, config.num_samples)
    counts = draw.integers(-32767, 32768, (2, *shape))
    return AdcCube(samples=(counts[0] + 1j * counts[1]).astype(np.complex64), config=config, scale=float("nan"))


def described_reader(data: bytes, config: RadarConfig, tx_order: tuple[int, ...], iq_order: str) -> dict:
    """From the description: int16 little-endian; frame, loop, chirp of the loop, receiver, then two samples in four
    words, I0 I1 Q0 Q1, Q0 Q1 I0 I1 or I0 Q0 I1 Q1. Gives {(frame, loop, physical tx, rx, sample): complex}."""
    found, at, frame = {}, 0, 0
    while at < len(data):
        for loop in range(config.num_loops):
            for tx in tx_order:
                for rx in range(config.num_rx):
                    for sample in range(0, config.num_samples, 2):
                        words = struct.unpack_from("<4h", data, at)
                        at += 8
                        if iq_order == "interleaved":
                            i0, q0, i1, q1 = words
                        else:
                            i0, i1, q0, q1 = (*words[2:], *words[:2]) if iq_order == "qi" else words
                        found[frame, loop, tx, rx, sample] = complex(i0, q0)
                        found[frame, loop, tx, rx, sample + 1] = complex(i1, q1)
        frame += 1
    return found


def described_four_lanes(data: bytes, config: RadarConfig, tx_order: tuple[int, ...], q_first: bool) -> dict:
    """From the description: each sample is I of receivers 0 to 3, then Q of them; all four lanes are always there."""
    found, at, frame = {}, 0, 0
    while at < len(data):
        for loop in range(config.num_loops):
            for tx in tx_order:
                for sample in range(config.num_samples):
                    words = struct.unpack_from("<8h", data, at)
                    at += 16
                    real, imaginary = (words[4:], words[:4]) if q_first else (words[:4], words[4:])
                    for index, lane in enumerate(config.rx_channels or range(4)):
                        found[frame, loop, tx, index, sample] = complex(real[lane], imaginary[lane])
        frame += 1
    return found


@pytest.mark.parametrize("iq_order", ["iq", "qi"])
@pytest.mark.parametrize("receivers", [(), (0, 2)], ids=["four receivers", "two of four"])
def test_four_lanes_follow_their_format(tmp_path: Path, iq_order: str, receivers: tuple[int, ...]):
    """xWR12xx and xWR14xx; with an odd number of samples, which two lanes cannot have."""
    rx = tuple(SMALL.rx_position_m[one] for one in receivers) or SMALL.rx_position_m
    config = replace(SMALL, lvds_lanes=4, num_samples=7, rx_position_m=rx, rx_channels=receivers)
    adc = counts_adc(config)
    path = tmp_path / "adc_data.bin"
    write_bin(path, adc, iq_order=iq_order, counts_per_unit=1.0)
    assert path.stat().st_size == 2 * 2 * 3 * 4 * 7 * 4
    found = described_four_lanes(path.read_bytes(), config, config.tx_order, iq_order == "qi")
    assert len(found) == adc.samples.size
    for index, value in found.items():
        assert adc.samples[index] == value
    assert np.array_equal(read_bin(path, config, iq_order=iq_order).samples, adc.samples)


def test_a_sub_frame_is_cut_out_of_each_frame(tmp_path: Path):
    """Two sub-frames follow each other in each frame; written, the other one is zero."""
    config = replace(SMALL, frame_words_before=10, frame_words_after=6)
    adc = counts_adc(config, 3)
    path = tmp_path / "adc_data.bin"
    write_bin(path, adc, counts_per_unit=1.0)
    words = np.fromfile(path, "<i2").reshape(3, -1)
    assert not words[:, :10].any()
    assert not words[:, -6:].any()
    write_bin(tmp_path / "alone.bin", replace(adc, config=SMALL), counts_per_unit=1.0)
    assert np.array_equal(words[:, 10:-6].ravel(), np.fromfile(tmp_path / "alone.bin", "<i2"))
    assert np.array_equal(read_bin(path, config).samples, adc.samples)
    with pytest.raises(InputError, match="32 of other"):
        path.write_bytes(path.read_bytes()[: words[0].nbytes - 2])
        read_bin(path, config)


def test_receivers_fed_from_the_other_side_are_turned_back(tmp_path: Path):
    """An AOP board records two receivers inverted: read and written so, the cube knows nothing of it."""
    config = replace(SMALL, rx_inverted=(1, 3))
    adc = counts_adc(config)
    write_bin(tmp_path / "adc_data.bin", adc, counts_per_unit=0.5)
    on_file = read_bin(tmp_path / "adc_data.bin", SMALL).samples
    assert np.abs(on_file[:, :, :, 1] * 2 + adc.samples[:, :, :, 1]).max() < 2
    assert np.abs(read_bin(tmp_path / "adc_data.bin", config).samples * 2 - adc.samples).max() < 2


def test_chirps_of_a_code_stay_in_their_order(tmp_path: Path):
    code = tx_code_of(np.array([[1, 1, 1], [1, -1, 1], [1, 1, -1]]))
    config = replace(SMALL, tx_order=(0, 1, 2), tx_code=code)
    adc = counts_adc(config)
    write_bin(tmp_path / "adc_data.bin", adc, counts_per_unit=1.0)
    assert np.array_equal(read_bin(tmp_path / "adc_data.bin", config).samples, adc.samples)


@pytest.mark.parametrize("iq_order", ["iq", "qi", "interleaved"])
@pytest.mark.parametrize("tx_order", list(permutations(range(3))))
def test_the_file_follows_the_format(tmp_path: Path, iq_order: str, tx_order: tuple[int, ...]):
    adc = counts_adc(replace(SMALL, tx_order=tx_order))
    path = tmp_path / "adc_data.bin"
    assert write_bin(path, adc, iq_order=iq_order, counts_per_unit=1.0) == 1.0
    assert path.stat().st_size == 2 * 2 * 3 * 4 * 8 * 4
    found = described_reader(path.read_bytes(), SMALL, tx_order, iq_order)
    for index, value in found.items():
        assert adc.samples[index] == value
    assert len(found) == adc.samples.size
    again = read_bin(path, adc.config, iq_order=iq_order)
    assert np.array_equal(again.samples, adc.samples)
    assert again.samples.dtype == np.complex64
    assert np.isnan(again.scale)


def test_the_wrong_iq_order_reverses_the_range_axis(tmp_path: Path):
    config = replace(AWR1843, num_loops=1, num_range_bins=256, first_range_bin=0)
    tone = np.exp(2j * np.pi * 40 * np.arange(256) / 256)
    samples = np.broadcast_to(tone, (1, 1, 3, 4, 256)).astype(np.complex64)
    write_bin(tmp_path / "a.bin", AdcCube(samples=samples, config=config, scale=1.0), iq_order="qi")
    for iq_order, peak in (("qi", 40), ("iq", 256 - 40)):
        read = read_bin(tmp_path / "a.bin", config, iq_order=iq_order).samples[0, 0, 0, 0]
        assert np.argmax(np.abs(np.fft.fft(read))) == peak


@settings(max_examples=40, deadline=None)
@given(
    values=hnp.arrays(np.float32, (1, 2, 3, 4, 8, 2), elements=st.floats(-1e3, 1e3, width=32)),
    iq_order=st.sampled_from(["iq", "qi", "interleaved"]),
    tx_order=st.permutations(range(3)),
    exponent=st.integers(-12, 6),
)
def test_any_signal_is_restored_to_half_a_count(tmp_path_factory, values, iq_order, tx_order, exponent: int):
    config = replace(SMALL, tx_order=tuple(tx_order))
    samples = (values * np.float32(10.0**exponent)).view(np.complex64)[..., 0]
    path = tmp_path_factory.mktemp("bin") / "adc_data.bin"
    counts = write_bin(path, AdcCube(samples=samples, config=config, scale=1.0), iq_order=iq_order)
    again = read_bin(path, config, iq_order=iq_order).samples
    off = again.astype(np.complex128) - samples.astype(np.complex128) * counts
    assert max(np.abs(off.real).max(), np.abs(off.imag).max()) <= 0.5 + 1e-6
    peak = max(np.abs(again.real).max(), np.abs(again.imag).max())
    assert peak <= 16384
    assert peak >= 16383 or not samples.any()


@pytest.mark.parametrize(
    ("size", "words"),
    [(0, ["empty"]), (767, ["767", "768"])],
)
def test_less_than_a_frame_is_refused(tmp_path: Path, size: int, words: list[str]):
    path = tmp_path / "adc_data.bin"
    path.write_bytes(bytes(size))
    with pytest.raises(InputError) as caught:
        read_bin(path, SMALL)
    for word in words:
        assert word in str(caught.value)


@pytest.mark.parametrize("lanes", [2, 4])
def test_real_samples_have_one_word_each(tmp_path: Path, lanes: int):
    """As an AWR2944 sends them, against TI's description: two lanes a receiver after the other, four lanes together."""
    config = replace(SMALL, complex_samples=False, num_range_bins=4, lvds_lanes=lanes, num_samples=9)
    draw = stream(0, "test real bin")
    counts = draw.integers(-2000, 2000, (2, config.num_loops, config.num_tx, config.num_rx, config.num_samples))
    adc = AdcCube(samples=counts.astype(np.complex64), config=config, scale=float("nan"))
    path = tmp_path / "adc_data.bin"
    write_bin(path, adc, counts_per_unit=1.0)
    fired = counts[:, :, list(config.tx_order)]
    assert path.read_bytes() == (fired if lanes == 2 else fired.swapaxes(-1, -2)).astype("<i2").tobytes()
    samples = read_bin(path, config).samples
    assert np.allclose(np.diff(samples), np.diff(counts), atol=1e-2)  # all but the converter's offset
    assert np.abs((samples * hann(config.num_samples)).sum(axis=-1)).max() < 1e-1


@pytest.mark.parametrize(
    ("value", "counts", "word"),
    [
        (np.nan, None, "finite"), (np.inf, 1.0, "finite"), (40000.0, 1.0, "int16"), (1.0, 0.0, "above 0"),
        (1.0, float("nan"), "finite"),
    ],
)  # fmt: skip
def test_samples_beyond_int16_are_not_written(tmp_path: Path, value: float, counts: float | None, word: str):
    adc = counts_adc(SMALL)
    adc.samples[0, 0, 0, 0, 0] = value
    with pytest.raises(InputError, match=word):
        write_bin(tmp_path / "a.bin", adc, counts_per_unit=counts)
    assert not list(tmp_path.iterdir())


def test_a_clipped_converter_is_written_as_it_is(tmp_path: Path):
    """int16 has -32768 but only +32767: a saturated receiver writes both."""
    adc = counts_adc(SMALL)
    samples = adc.samples.copy()
    samples.flat[0], samples.flat[1] = -32768 - 32768j, 32767 + 32767j
    write_bin(tmp_path / "a.bin", replace(adc, samples=samples), counts_per_unit=1.0)
    assert np.array_equal(read_bin(tmp_path / "a.bin", SMALL).samples, samples)
    samples.flat[1] = 32768
    with pytest.raises(InputError, match="int16"):
        write_bin(tmp_path / "b.bin", replace(adc, samples=samples), counts_per_unit=1.0)
    assert not (tmp_path / "b.bin").exists()
