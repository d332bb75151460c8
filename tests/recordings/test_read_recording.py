"""The same samples in every file that is understood give the same cube; what cannot be read is refused."""

from pathlib import Path

import numpy as np
import pytest

from mmweaver.core.errors import InputError
from mmweaver.core.records import AdcCube
from mmweaver.io.dca1000 import write_bin
from mmweaver.io.npz_files import write_radar_npz
from mmweaver.recordings.processing import process_recording
from mmweaver.recordings.read_recording import read_recording
from mmweaver.signal.cube import radar_cube
from tests.captures import counts, radar_of_cfg, write_radar


@pytest.fixture
def adc(tmp_path: Path) -> AdcCube:
    """Three frames of whole counts, stored in a capture folder, a .bin, a .npy and a radar.npz."""
    config = radar_of_cfg(tmp_path)
    adc = counts(config, 3)
    write_radar(tmp_path / "capture" / "iwr1843", adc)
    write_bin(tmp_path / "adc_data.bin", adc, counts_per_unit=1.0)
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


def test_the_iq_order_is_the_radars_unless_it_is_given(adc: AdcCube, tmp_path: Path):
    """adcbufCfg's SampleSwap of the .cfg: the SDK's demo sends Q first."""
    cfg = tmp_path / "made.cfg"
    found = read_recording(tmp_path / "adc_data.bin", cfg)
    assert (adc.config.lvds_iq_order, found.iq_order) == ("qi", "qi")
    write_bin(tmp_path / "studio.bin", adc, iq_order="iq", counts_per_unit=1.0)
    again = read_recording(tmp_path / "studio.bin", cfg, iq_order="iq")
    assert np.array_equal(again.cube.values, found.cube.values)
    assert not np.array_equal(read_recording(tmp_path / "studio.bin", cfg).cube.values, found.cube.values)


def test_samples_with_headers_are_refused(adc: AdcCube, tmp_path: Path):
    cfg = tmp_path / "headers.cfg"
    cfg.write_text((tmp_path / "made.cfg").read_text().replace("lvdsStreamCfg -1 0", "lvdsStreamCfg -1 1"))
    with pytest.raises(InputError, match="HSI headers"):
        read_recording(tmp_path / "adc_data.bin", cfg)
    assert read_recording(tmp_path / "adc.npy", cfg, axes="frame,loop,tx,rx,sample").adc is not None


def test_a_cube_is_processed_without_samples(adc: AdcCube, tmp_path: Path):
    from_cube = process_recording(tmp_path / "processed")
    from_samples = process_recording(tmp_path / "adc_data.bin", adc.config)
    assert from_cube.adc is None
    assert np.array_equal(from_cube.points.x_m, from_samples.points.x_m)
    assert from_cube.save(tmp_path / "out")["iq_order"] is None


def test_a_range_of_samples_and_of_a_stored_cube_is_the_same(adc: AdcCube, tmp_path: Path):
    """A .cfg keeps all; a window in metres or in bins cuts samples before the transform, and a cube after it."""
    whole = read_recording(tmp_path / "adc_data.bin", tmp_path / "made.cfg")
    assert whole.cube.values.shape[1] == adc.config.num_samples
    step_m = adc.config.range_resolution_m
    chosen = {"range_m": (10 * step_m, 20.4 * step_m)}
    from_samples = read_recording(tmp_path / "adc_data.bin", tmp_path / "made.cfg", **chosen).cube
    from_cube = read_recording(tmp_path / "processed", **chosen).cube
    assert np.allclose(from_samples.grid.range_m, step_m * np.arange(10, 21))
    assert np.array_equal(from_samples.values, whole.cube.values[:, 10:21])
    assert np.array_equal(from_samples.values, from_cube.values)
    assert np.array_equal(from_cube.grid.range_m, from_samples.grid.range_m)
    by_bins = read_recording(tmp_path / "processed", range_bins=(10, 20)).cube
    assert np.array_equal(by_bins.values, from_cube.values)


def test_a_cube_that_lacks_the_range_is_refused(adc: AdcCube, tmp_path: Path):
    cube = read_recording(tmp_path / "processed", range_bins=(10, 20)).cube
    (tmp_path / "cropped").mkdir()
    write_radar_npz(tmp_path / "cropped" / "radar.npz", cube)
    (tmp_path / "cropped" / "radar.json").write_text(cube.config.to_json())
    with pytest.raises(InputError, match=r"0\.00 to 2\.61 m"):
        read_recording(tmp_path / "cropped", range_bins=(0, 15))
