"""Recordings of Infineon's Radar SDK, written here with its keys and axes."""

import json
from pathlib import Path

import numpy as np
import pytest

from mmweaver.core.errors import InputError
from mmweaver.io.infineon import infineon_folder, read_infineon, read_infineon_config
from mmweaver.signal.cube import radar_cube

CHIRP = {
    "rx_antennas": [1, 3],
    "tx_antennas": [1],
    "start_frequency_Hz": 58_000_000_000,
    "end_frequency_Hz": 63_000_000_000,
    "num_chirps_per_frame": 16,
    "num_samples_per_chirp": 64,
    "chirp_repetition_time_s": 0.00059,
    "frame_repetition_time_s": 0.05,
    "sample_rate_Hz": 2_000_000,
}
RANGE_BIN = 9


def recording(folder: Path, chirp: dict = CHIRP) -> Path:
    """Three frames of one echo in bin 9, as the SDK writes them: uint16 around half of 12 bits, (frame, rx, chirp,
    sample)."""
    place = folder / "BGT60TR13C_record" / "RadarIfxAvian_00"
    place.mkdir(parents=True)
    (place / "config.json").write_text(json.dumps({"device_config": {"fmcw_single_shape": chirp}}))
    tone = 2048 + 300 * np.cos(2 * np.pi * RANGE_BIN * np.arange(64) / 64)
    np.save(place / "radar.npy", np.broadcast_to(np.rint(tone), (3, 2, 16, 64)).astype(np.uint16))
    return place.parent


def test_chirp_is_that_of_the_file_and_the_echo_lies_at_its_range(tmp_path: Path):
    folder = infineon_folder(recording(tmp_path))
    assert folder is not None
    adc = read_infineon(folder)
    config = adc.config
    assert (config.num_tx, config.num_rx, config.num_loops, config.num_samples) == (1, 2, 16, 64)
    assert config.bandwidth_hz == pytest.approx(5e9)
    assert config.frame_period_s == 0.05
    assert config.loop_period_s == pytest.approx(0.00059)
    assert config.range_resolution_m == pytest.approx(299_792_458 / 2 / 5e9)
    power = np.abs(radar_cube(adc).values[:, :, 8]) ** 2
    assert (power.sum(axis=(0, 2)).argmax()) == RANGE_BIN
    assert adc.samples.shape == (3, 16, 1, 2, 64)


def test_older_names_of_the_sweep_are_known(tmp_path: Path):
    older = {key: value for key, value in CHIRP.items() if "frequency" not in key}
    older |= {"lower_frequency_Hz": 58e9, "upper_frequency_Hz": 63e9}
    folder = infineon_folder(recording(tmp_path, older))
    assert folder is not None
    assert read_infineon_config(folder / "config.json").bandwidth_hz == pytest.approx(5e9)


@pytest.mark.parametrize(
    ("change", "message"),
    [({"tx_antennas": [1, 2]}, "transmitters"), ({"rx_antennas": [7]}, "receivers"), ({"sample_rate_Hz": 0}, "SDK")],
)
def test_other_boards_are_refused_by_name(tmp_path: Path, change: dict, message: str):
    folder = infineon_folder(recording(tmp_path, CHIRP | change))
    assert folder is not None
    with pytest.raises(InputError, match=message):
        read_infineon(folder)
