"""A recording in parts: what was written is read again as one cube, and a kill in between loses no whole part."""

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from mmweaver.core.boards import AWR1843
from mmweaver.core.errors import InputError
from mmweaver.core.records import AdcCube, CubeGrid, PointCloud, PoseSequence, RadarCube
from mmweaver.io.dca1000 import read_bin
from mmweaver.io.stream_folder import StreamFolder, sentences_of
from mmweaver.recordings.read_recording import read_recording

SMALL = replace(AWR1843, num_loops=4, num_range_bins=8)


def add(folder: StreamFolder, first: int, count: int) -> np.ndarray:
    rng = np.random.default_rng(first)
    values = rng.normal(size=(count, 8, 4, 12, 2)).astype(np.float32).view(np.complex64)[..., 0]
    cube = RadarCube(values=values, grid=CubeGrid.of(SMALL, count, first), config=SMALL, scale=1.0)
    nothing = np.zeros(0)
    points = PointCloud(
        frame=nothing.astype(int), x_m=nothing, y_m=nothing, z_m=nothing, radial_velocity_mps=nothing, snr_db=nothing
    )
    unit = SMALL.adc_count_sqrt_mw
    samples = np.full((count, 4, SMALL.num_tx, SMALL.num_rx, SMALL.num_samples), (first + 1) * unit, np.complex64)
    adc = AdcCube(samples=samples, config=SMALL, scale=1.0)
    time_s = cube.grid.frame_time_s
    pose = PoseSequence(time_s=time_s, joints_m=np.zeros((count, 22, 3)), height_m=1.7)
    folder.add(cube, points, (pose,), adc, {"text": f"from {first}"})
    return values


def test_parts_are_read_as_one_recording(tmp_path: Path):
    folder = StreamFolder(tmp_path / "live", {"seed": 0})
    written = np.concatenate([add(folder, 0, 3), add(folder, 3, 2)])
    assert folder.finish()["frames"] == 5
    read = read_recording(tmp_path / "live").cube
    np.testing.assert_array_equal(read.values, written)
    np.testing.assert_allclose(read.grid.frame_time_s, np.arange(5) / 10)
    counts = read_bin(tmp_path / "live" / "adc_data.bin", SMALL).samples
    np.testing.assert_allclose(np.abs(counts[:, 0, 0, 0, 0]), [1, 1, 1, 4, 4])
    lines = (tmp_path / "live" / "parts.jsonl").read_text().splitlines()
    assert [json.loads(line)["text"] for line in lines] == ["from 0", "from 3"]


def test_a_kill_leaves_what_was_whole(tmp_path: Path):
    folder = StreamFolder(tmp_path / "live", {"seed": 0})
    written = add(folder, 0, 3)
    with (tmp_path / "live" / "adc_data.bin").open("ab") as file:
        file.write(b"0123")  # of a frame that was being written
    (tmp_path / "live" / "parts" / ".00000003.part").mkdir()
    np.testing.assert_array_equal(read_recording(tmp_path / "live").cube.values, written)
    assert len(read_bin(tmp_path / "live" / "adc_data.bin", SMALL).samples) == 3


def test_a_missing_part_is_noticed(tmp_path: Path):
    folder = StreamFolder(tmp_path / "live", {"seed": 0})
    add(folder, 0, 3)
    add(folder, 3, 2)
    (tmp_path / "live" / "parts" / "00000000").rename(tmp_path / "elsewhere")
    with pytest.raises(InputError, match="frame 0"):
        read_recording(tmp_path / "live")


def test_sentences_come_line_by_line():
    assert list(sentences_of(["# list\n", "a person waves\n", "\n"])) == ["a person waves"]
