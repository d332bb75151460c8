"""The radar of a capture folder."""

from pathlib import Path

import pytest

from mmweaver.core.errors import InputError
from mmweaver.io.capture_std import is_capture, radar_folder, read_radar_capture
from tests.captures import CFG, counts, radar_of_cfg, write_radar


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    write_radar(tmp_path / "capture_00000" / "iwr1843", counts(radar_of_cfg(tmp_path)))
    return tmp_path / "capture_00000"


def test_a_folder_read_back_bit_by_bit(folder: Path, tmp_path: Path):
    capture = read_radar_capture(folder)
    assert capture.config.lvds_iq_order == "qi"
    assert (capture.config.num_tx, capture.config.num_loops) == (2, 8)
    assert capture.packets.adc.samples.tobytes() == counts(capture.config).samples.tobytes()
    assert read_radar_capture(folder / "iwr1843").folder == folder / "iwr1843"


def test_recognition_of_a_capture_folder(folder: Path, tmp_path: Path):
    assert is_capture(folder)
    assert is_capture(folder / "iwr1843")
    assert not is_capture(tmp_path / "made.cfg")
    assert not is_capture(tmp_path / "none")


def test_folders_that_cannot_be_read(folder: Path, tmp_path: Path):
    radar = folder / "iwr1843"
    with pytest.raises(InputError, match="not a capture folder"):
        radar_folder(tmp_path / "none")
    (radar / "radar.cfg").write_text(CFG.replace("lvdsStreamCfg -1 0 1 0", "lvdsStreamCfg -1 1 1 0"))
    with pytest.raises(InputError, match="HSI headers"):
        read_radar_capture(folder)
    (radar / "radar.cfg").write_text("sensorStop\n")
    with pytest.raises(InputError, match="lacks"):
        read_radar_capture(folder)
    (radar / "radar.cfg").unlink()
    with pytest.raises(InputError, match=r"no radar\.cfg"):
        read_radar_capture(folder)
    write_radar(folder / "iwr1843_vert", counts(radar_of_cfg(tmp_path)))
    with pytest.raises(InputError, match=r"/iwr1843, .*/iwr1843_vert$"):
        read_radar_capture(folder)
