"""The same samples in every file that is understood give the same cube; what cannot be read is refused."""

from pathlib import Path

import numpy as np
import pytest

from mmweaver.core.errors import InputError
from mmweaver.core.records import AdcCube
from mmweaver.dsp.cube import radar_cube
from mmweaver.formats.dca1000 import write_bin
from mmweaver.formats.npz_files import write_radar_npz
from mmweaver.recordings.processing import process_recording
from mmweaver.recordings.read_recording import read_recording
from tests.captures import counts, radar_of_cfg, write_radar


@pytest.fixture
def adc(tmp_path: Path) -> AdcCube:
    """Three frames of whole counts, stored in a capture folder, a .bin, a .npy and a radar.npz."""
    config = radar_of_cfg(tmp_path)
    adc = counts(config, 3)
    write_radar(tmp_path / "capture" / "iwr1843", adc)
    write_bin(tmp_path / "adc_data.bin", adc, iq_order="iq", counts_per_unit=1.0)
    np.save(tmp_path / "adc.npy", adc.samples)
    (tmp_path / "processed").mkdir()
    write_radar_npz(tmp_path / "processed" / "radar.npz", radar_cube(adc))
    (tmp_path / "processed" / "radar.json").write_text(config.to_json())
    return adc


def test_every_kind_gives_the_same_cube(adc: AdcCube, tmp_path: Path):
    cfg, wanted = tmp_path / "made.cfg", radar_cube(adc).values
    for one in (
        read_recording(tmp_path / "capture"),
        read_recording(tmp_path / "adc_data.bin", cfg),
        read_recording(tmp_path / "adc.npy", adc.config, axes="frame,loop,tx,rx,sample"),
        read_recording(tmp_path / "processed"),
        read_recording(tmp_path / "processed" / "radar.npz"),
    ):
        assert np.array_equal(one.cube.values, wanted), one.path
        assert one.cube.config.start_frequency_hz == adc.config.start_frequency_hz
        assert all(file.is_file() for file in one.files.values())


def test_a_cube_is_processed_without_samples(adc: AdcCube, tmp_path: Path):
    from_cube = process_recording(tmp_path / "processed")
    from_samples = process_recording(tmp_path / "adc_data.bin", adc.config)
    assert from_cube.adc is None
    assert np.array_equal(from_cube.points.x_m, from_samples.points.x_m)
    assert from_cube.save(tmp_path / "out")["iq_order"] is None


def test_firmware_settings_are_checked_before_samples_are_read(adc: AdcCube, tmp_path: Path):
    (tmp_path / "adc_data.bin").write_bytes(b"")
    with pytest.raises(InputError, match=r"made\.cfg"):  # it sets no CFAR
        process_recording(tmp_path / "adc_data.bin", tmp_path / "made.cfg", points="firmware")


@pytest.mark.parametrize(
    ("name", "options", "says"),
    [
        ("nowhere", {}, "does not exist"),
        ("adc_data.bin", {}, "--radar"),
        ("adc.npy", {"radar": "awr1843"}, "--axes"),
        ("adc.npy", {"layout": "hupr", "axes": "frame,loop"}, "not both"),
        ("capture", {"iq_order": "iq"}, "leave out --iq-order"),
        ("empty", {}, "not a capture folder.*neither radar.npz"),
    ],
)
def test_what_cannot_be_read_is_refused(adc: AdcCube, tmp_path: Path, name: str, options: dict[str, str], says: str):
    (tmp_path / "empty").mkdir()
    with pytest.raises(InputError, match=says):
        read_recording(tmp_path / name, **options)
