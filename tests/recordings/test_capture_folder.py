"""A folder of a DCA1000 capture is a recording: its radar and its log are found in it."""

import json
from pathlib import Path

import numpy as np
import pytest

from mmweaver.core.errors import InputError
from mmweaver.io.dca1000 import write_bin
from mmweaver.recordings.processing import process_recording
from mmweaver.recordings.read_recording import read_recording
from tests import captures
from tests.fuzz.readers import STUDIO


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """Samples split into two parts, the .cfg, and the capture card's log."""
    config = captures.radar_of_cfg(tmp_path)
    (tmp_path / "made.cfg").unlink()
    place = tmp_path / "capture"
    place.mkdir()
    write_bin(place / "whole", captures.counts(config, 4), counts_per_unit=1.0)
    data = (place / "whole").read_bytes()
    (place / "whole").unlink()
    (place / "adc_data_Raw_0.bin").write_bytes(data[:20_000])
    (place / "adc_data_Raw_1.bin").write_bytes(data[20_000:])
    (place / "profile.cfg").write_text(captures.CFG)
    (place / "adc_data_Raw_LogFile.csv").write_text(
        "Number of received packets - 90\nNumber of zero filled packets - 7\n"
    )
    return place


def test_the_radar_of_the_folder_is_taken(folder: Path, tmp_path: Path):
    found = read_recording(folder)
    assert found.adc is not None
    assert np.array_equal(found.adc.samples, captures.counts(found.config, 4).samples)
    assert found.radar_source == str(folder / "profile.cfg")
    warnings = process_recording(folder, analyse=False).meta["warnings"]
    assert any("7 packets" in text for text in warnings)
    assert any("2 files" in text for text in warnings)


def test_what_is_ambiguous_is_refused(folder: Path):
    (folder / "other.cfg").write_text(captures.CFG)
    with pytest.raises(InputError, match=r"other\.cfg, profile\.cfg"):
        read_recording(folder)
    (folder / "setup.mmwave.json").write_text(json.dumps(STUDIO))  # of mmWave Studio, which recorded it
    (folder / "other.cfg").unlink()
    assert read_recording(folder, folder / "profile.cfg").radar_source == str(folder / "profile.cfg")
    (folder / "another.bin").write_bytes(bytes(100))
    with pytest.raises(InputError, match="several recordings"):
        read_recording(folder, folder / "profile.cfg")
