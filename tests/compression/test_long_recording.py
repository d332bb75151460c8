from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from mmweaver.compression import long_recording
from mmweaver.compression.long_recording import compress_recording
from mmweaver.compression.mmw_codec import read_cube
from mmweaver.core.errors import InputError
from mmweaver.core.records import AdcCube
from mmweaver.core.seeding import stream
from mmweaver.io.dca1000 import write_bin
from mmweaver.recordings.recording_pieces import RecordingPieces
from tests.compression.echoes import SMALL, error_db

RADAR = replace(SMALL, num_loops=2, num_range_bins=4, num_samples=64)


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """adc_data.bin: 24 frames of an echo and noise, of which the second half is 20 dB louder."""
    place = tmp_path_factory.mktemp("long")
    draw = stream(0, "samples").normal(size=(2, 24, 2, 3, 4, 64))
    tone = 30 * np.exp(2j * np.pi * (12 * np.arange(64) / 64 + np.arange(24)[:, None, None, None, None] / 17))
    samples = (draw[0] + 1j * draw[1] + tone) * np.where(np.arange(24) < 12, 1, 10)[:, None, None, None, None]
    write_bin(
        place / "adc_data.bin", AdcCube(samples=samples.astype(np.complex64), config=RADAR, scale=1.0),
        counts_per_unit=10.0,
    )  # fmt: skip
    return place


@pytest.fixture
def short_pieces(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(long_recording, "PIECE_VALUES", 8 * 4 * 2 * 12)


@pytest.mark.usefixtures("short_pieces")
def test_pieces_share_the_bytes_as_one_step_would(folder: Path, tmp_path: Path):
    recording = RecordingPieces(folder / "adc_data.bin", RADAR)
    out = tmp_path / "a.mmw"
    errors = compress_recording(recording, out, num_bytes=3000)
    assert 0.97 * 3000 <= out.stat().st_size <= 3000
    truth, again = recording.cube(range(24)), read_cube(out)
    assert again.grid.frame_time_s == pytest.approx(np.arange(24) * RADAR.frame_period_s)
    assert errors["all_error_db"] == pytest.approx(error_db(again.values, truth.values), abs=0.01)
    quiet, loud = (np.abs(again.values - truth.values)[chosen] ** 2 for chosen in (slice(0, 8), slice(16, 24)))
    assert quiet.mean() > 0.01 * loud.mean()  # of one step; equal bytes would leave 20 dB less


@pytest.mark.usefixtures("short_pieces", "stored_exactly")
def test_a_recording_is_appended_or_nothing_is(folder: Path, tmp_path: Path):
    recording = RecordingPieces(folder / "adc_data.bin", RADAR)
    out = tmp_path / "a.mmw"
    for append in (False, True):
        compress_recording(recording, out, quality_db=20.0, append=append)
    again = read_cube(out)
    assert again.grid.frame_time_s == pytest.approx(np.arange(48) * RADAR.frame_period_s)
    assert np.array_equal(again.values, np.tile(recording.cube(range(24)).values, (2, 1, 1, 1)))
    before = out.read_bytes()
    other = RecordingPieces(folder / "adc_data.bin", replace(RADAR, num_range_bins=3))
    with pytest.raises(InputError, match="another radar"):
        compress_recording(other, out, quality_db=20.0, append=True)

    class Ends(RecordingPieces):
        def cube(self, frames: range):
            if frames.start:
                raise InputError("the disk is gone")
            return super().cube(frames)

    for name in ("a.mmw", "b.mmw"):
        with pytest.raises(InputError, match="gone"):
            broken = Ends(folder / "adc_data.bin", RADAR)
            compress_recording(broken, tmp_path / name, quality_db=20.0, append=name == "a.mmw")
    assert [path.name for path in tmp_path.iterdir()] == ["a.mmw"]
    assert out.read_bytes() == before
