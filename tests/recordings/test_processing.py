"""Real recordings are processed like generated signals."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from mmweaver.core.boards import BGT60
from mmweaver.core.errors import InputError
from mmweaver.core.records import CameraIntrinsics
from mmweaver.core.seeding import stream
from mmweaver.propagation.ray_traced import Simulator
from mmweaver.recordings.processing import process_recording
from mmweaver.signal.cube import radar_cube
from tests.captures import counts, packets_of, radar_of_cfg, write_camera, write_radar
from tests.rooms import back_wall, floor, scene_of, standing_person


@pytest.fixture
def samples(tmp_path: Path) -> Path:
    """Three frames of a radar with real samples, stored as its maker does: (frame, rx, loop, sample) uint16."""
    random = stream(0, "test")
    values = 2048 + 100 * random.normal(size=(3, BGT60.num_rx, BGT60.num_loops, BGT60.num_samples))
    np.save(tmp_path / "adc.npy", values.astype(np.uint16))
    return tmp_path / "adc.npy"


def test_a_radar_of_real_samples(samples: Path):
    recording = process_recording(samples, BGT60, axes="frame,rx,loop,sample")
    assert recording.cube.values.shape == (3, 32, 8, 3)
    assert recording.adc.samples.imag.max() == 0
    assert recording.meta["axes"] == "frame,rx,loop,sample"
    assert recording.meta["frames"] == 3
    assert list(recording.stages.seconds) == [
        "read the recording",
        "range, Doppler, antennas",
        "point cloud",
        "movement, people",
    ]


def test_a_simulated_capture_folder_round_trips_bit_by_bit(tmp_path: Path):
    """A simulated signal as packets of a DCA1000 with a RealSense, read by `process`."""
    config = radar_of_cfg(tmp_path)
    adc = Simulator(scene_of((floor(), back_wall())), config).run(
        standing_person((0.1, 2.0, -1.2), (0.0, -0.5, 0.0)), num_frames=3, seed=0
    ).adc  # fmt: skip
    whole = replace(adc, samples=np.round(adc.samples / config.adc_count_sqrt_mw).astype(np.complex64))
    write_radar(tmp_path / "capture_00000" / "iwr1843", whole)
    lens = CameraIntrinsics(fx=60.0, fy=60.0, cx=31.5, cy=23.5, width=64, height=48)
    write_camera(
        tmp_path / "capture_00000" / "realsense", lens, [np.full((48, 64), 2.0)], [np.zeros((48, 64, 3), np.uint8)]
    )
    recording = process_recording(tmp_path / "capture_00000")
    assert np.array_equal(recording.adc.samples, whole.samples)
    assert np.array_equal(recording.cube.values, radar_cube(replace(whole, scale=float("nan"))).values)
    meta = recording.save(tmp_path / "out")
    assert meta["iq_order"] == "qi"
    assert meta["packets"]["lost"] == 0
    assert meta["photo_of_frame"] == [0, 1, 3]  # photos 20 ms later, every 67 ms; frames every 100 ms
    assert meta["photo_minus_frame_s"] == pytest.approx([0.02, -0.0133, 0.02], abs=2e-3)
    assert np.diff(meta["frame_clock_s"]) == pytest.approx([0.1, 0.1], abs=2e-3)


def test_lost_packets_are_reported(tmp_path: Path):
    config = radar_of_cfg(tmp_path)
    packets = packets_of(tmp_path, counts(config))
    write_radar(tmp_path / "iwr1843", counts(config), packets[:5] + packets[7:])
    recording = process_recording(tmp_path / "iwr1843")
    assert any("2 packets were lost" in sentence for sentence in recording.meta["assumed"])
    assert "photo_of_frame" not in recording.meta


def test_only_a_capture_folder_needs_no_radar(tmp_path: Path):
    with pytest.raises(InputError, match="does not exist"):
        process_recording(tmp_path / "adc.bin", None)
    (tmp_path / "adc.bin").write_bytes(b"\0" * 64)
    with pytest.raises(InputError, match="--radar"):
        process_recording(tmp_path / "adc.bin", None)
