from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from mmweaver.core.records import AdcCube
from mmweaver.core.seeding import stream
from mmweaver.io.dca1000 import write_bin
from mmweaver.io.npz_files import write_radar_npz
from mmweaver.io.stream_folder import LIST, PARTS
from mmweaver.recordings.read_recording import read_recording
from mmweaver.recordings.recording_pieces import RecordingPieces
from tests.captures import packets_of, pcap_of
from tests.compression.echoes import SMALL

RADAR = replace(SMALL, num_loops=2, num_range_bins=4, num_samples=32)
AXES = "frame,loop,tx,rx,sample"


@pytest.fixture
def samples() -> np.ndarray:
    draw = stream(0, "samples").normal(size=(2, 7, 2, 3, 4, 32))
    return (100 * (draw[0] + 1j * draw[1])).astype(np.complex64)


@pytest.mark.parametrize("kind", ["bin", "pcap", "npy", "npy, frames not first", "npz", "stream"])
def test_a_stretch_of_frames_is_that_of_the_whole(kind: str, samples: np.ndarray, tmp_path: Path):
    how: dict = {}
    if kind == "bin":
        path = tmp_path / "adc_data.bin"
        write_bin(path, AdcCube(samples=samples, config=RADAR, scale=1.0))
    elif kind == "pcap":
        path = tmp_path / "dca.pcap"
        path.write_bytes(pcap_of(packets_of(tmp_path, AdcCube(samples=samples, config=RADAR, scale=1.0))))
        how["iq_order"] = "qi"
    elif kind.startswith("npy"):
        path = tmp_path / "adc.npy"
        is_first = kind == "npy"
        np.save(path, samples if is_first else np.moveaxis(samples, 0, -1))
        how["axes"] = AXES if is_first else "loop,tx,rx,sample,frame"
    else:
        np.save(tmp_path / "adc.npy", samples)
        cube = read_recording(tmp_path / "adc.npy", RADAR, axes=AXES).cube
        path = tmp_path / "stream"
        stretches = [range(7)] if kind == "npz" else [range(3), range(3, 5), range(5, 7)]
        for frames in stretches:
            part = path / PARTS / f"{frames.start:08d}" if kind == "stream" else path
            part.mkdir(parents=True)
            stretch = slice(frames.start, frames.stop)
            grid = replace(cube.grid, frame_time_s=cube.grid.frame_time_s[stretch])
            write_radar_npz(part / "radar.npz", replace(cube, values=cube.values[stretch], grid=grid))
            (part / "radar.json").write_text(RADAR.to_json())
        (path / LIST).touch()
    pieces = RecordingPieces(path, None if path.is_dir() else RADAR, **how)
    whole = read_recording(path, None if path.is_dir() else RADAR, **how).cube
    assert (pieces.num_frames, pieces.num_values_a_frame) == (7, 4 * 2 * 12)
    for frames in (range(4, 6), range(7)):
        part = pieces.cube(frames)
        assert np.array_equal(part.values, whole.values[frames.start : frames.stop])
        assert part.grid.frame_time_s == pytest.approx(whole.grid.frame_time_s[frames.start : frames.stop])
