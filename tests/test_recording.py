"""Real recordings go through the same door as signals that were made."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from mmweaver.core.errors import InputError
from mmweaver.core.presets import BGT60
from mmweaver.core.seeding import stream
from mmweaver.recording import process_recording


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
    assert list(recording.stages.seconds) == ["read the recording", "range, Doppler, antennas", "point cloud"]


def test_the_radar_may_be_named_or_given(samples: Path):
    named = process_recording(samples, "bgt60", axes="frame,rx,loop,sample")
    given = process_recording(samples, replace(BGT60, name="mine"), axes="frame,rx,loop,sample")
    assert np.array_equal(named.cube.values, given.cube.values)


def test_a_folder_is_written_once(samples: Path, tmp_path: Path):
    recording = process_recording(samples, BGT60, axes="frame,rx,loop,sample")
    meta = recording.save(tmp_path / "out")
    assert set(meta["files"]) == {file.name for file in (tmp_path / "out").iterdir()}
    with pytest.raises(InputError, match="--overwrite"):
        recording.save(tmp_path / "out")
    recording.save(tmp_path / "out", overwrite=True)
