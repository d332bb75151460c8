"""Every kind of file and folder becomes signals; what is none of them is one line."""

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from mmweaver.compression.mmw_codec import compress_cube
from mmweaver.core.errors import InputError
from mmweaver.core.records import PointCloud, PoseSequence
from mmweaver.evaluation.compared_sides import signals_of
from mmweaver.io.dca1000 import write_bin
from mmweaver.io.npz_files import write_points_npz, write_radar_npz
from mmweaver.io.stream_folder import StreamFolder
from mmweaver.recordings.read_recording import RawReading
from mmweaver.signal.cube import radar_cube
from mmweaver.signal.points import point_cloud
from tests.evaluation.made_signals import RADAR, samples, still

ADC = samples([still(1.2), still(2.3, 0.5)], frames=2, config=replace(RADAR, num_loops=8))
CUBE = radar_cube(ADC)
POSE = PoseSequence(time_s=CUBE.grid.frame_time_s, joints_m=np.zeros((2, 22, 3)), height_m=1.7)


def write_result(folder: Path, points: PointCloud | None = None) -> Path:
    folder.mkdir(parents=True)
    write_radar_npz(folder / "radar.npz", CUBE)
    (folder / "radar.json").write_text(CUBE.config.to_json())
    write_points_npz(folder / "points.npz", point_cloud(CUBE) if points is None else points)
    return folder


def test_files_and_folders_of_every_kind(tmp_path: Path):
    result = write_result(tmp_path / "set" / "one")
    write_result(tmp_path / "set" / "two")
    (tmp_path / "set" / "walk.mmw").write_bytes(compress_cube(CUBE, num_bytes=4000))
    write_bin(tmp_path / "adc.bin", ADC, counts_per_unit=1000.0)
    np.save(tmp_path / "adc.npy", ADC.samples)
    stream = StreamFolder(tmp_path / "set" / "stream", {})
    stream.add(CUBE, point_cloud(CUBE), (POSE,), None, {})
    stream.finish()
    reading = RawReading(radar=ADC.config, axes="frame,loop,tx,rx,sample")
    for path in (result, result / "radar.npz", tmp_path / "set" / "walk.mmw", tmp_path / "set" / "stream"):
        (found,) = signals_of(path, RawReading(), "A")
        assert found.cube.values.shape == CUBE.values.shape, path
        assert found.adc is None
    for path in (tmp_path / "adc.bin", tmp_path / "adc.npy"):
        (found,) = signals_of(path, reading, "A")
        assert found.adc is not None
    names = [one.name for one in signals_of(tmp_path / "set", RawReading(), "A")]
    assert names == ["one", "stream", "two", "walk.mmw"]
    assert len(signals_of([CUBE, ADC, str(result)], RawReading(), "A")) == 3


def test_samples_of_a_result_are_in_the_scale_of_its_cube(tmp_path: Path):
    folder = write_result(tmp_path / "made")
    _, counts = write_bin(folder / "adc_data.bin", ADC, counts_per_unit=2000.0), 2000.0
    (folder / "meta.json").write_text(json.dumps({"adc_data_bin": {"iq_order": "iq", "counts_per_unit": counts}}))
    (found,) = signals_of(folder, RawReading(), "A")
    assert found.adc is not None
    again = radar_cube(found.adc)
    assert np.abs(again.values).max() * again.scale == pytest.approx(np.abs(CUBE.values).max() * CUBE.scale, rel=1e-2)


def test_what_is_no_signal_is_one_line(tmp_path: Path):
    (tmp_path / "raw.mmwl").write_bytes(b"x")
    for path, words in (
        (tmp_path / "absent", "does not exist"),
        (tmp_path, "neither"),
        (tmp_path / "raw.mmwl", "decompress"),
    ):
        with pytest.raises(InputError, match=words):
            signals_of(path, RawReading(), "A")
    with pytest.raises(InputError, match="cannot be compared"):
        signals_of(3, RawReading(), "B")
