"""Point-cloud settings of mmWave SDK .cfg files of three generations."""

from pathlib import Path

import numpy as np
import pytest

from mmweaver.core.errors import InputError
from mmweaver.core.firmware_settings import FirmwareCfar, FirmwareSettings
from mmweaver.io.radar_file import load_firmware
from mmweaver.io.ti_firmware import read_ti_firmware
from mmweaver.signal.firmware_cfar import noise_level

# SDK 1: no subframe, channels interleaved, as the IWR1443's demo asks.
SDK1 = """channelCfg 15 7 0
adcCfg 2 1
adcbufCfg 0 1 0 1
profileCfg 0 77 267 7 57.14 0 0 70 1 240 4884 0 0 30
chirpCfg 0 0 0 0 0 0 0 1
chirpCfg 1 1 0 0 0 0 0 4
chirpCfg 2 2 0 0 0 0 0 2
frameCfg 0 2 16 0 100 1 0
cfarCfg 0 2 8 4 3 0 1280
peakGrouping 1 1 1 1 229
multiObjBeamForming 1 0.5
clutterRemoval 0
"""
# SDK 2: subframes, channels apart, range and Doppler.
SDK2 = """channelCfg 15 5 0
adcCfg 2 1
adcbufCfg -1 0 0 1 0
profileCfg 0 77 7 7 58 0 0 68 1 256 5500 0 0 30
chirpCfg 0 0 0 0 0 0 0 1
chirpCfg 1 1 0 0 0 0 0 4
frameCfg 0 1 32 0 100 1 0
cfarCfg -1 0 2 8 4 4 0 5120
cfarCfg -1 1 0 8 4 4 1 5120
peakGrouping -1 1 1 0 1 224
multiObjBeamForming -1 0 0.5
clutterRemoval -1 1
"""


def written(tmp_path: Path, text: str) -> Path:
    path = tmp_path / "demo.cfg"
    path.write_text(text)
    return path


def test_sdk_1(tmp_path: Path):
    settings = read_ti_firmware(written(tmp_path, SDK1))
    assert settings == FirmwareSettings(
        device="xwr14xx",
        range_cfar=FirmwareCfar(average="caso", window=8, guard=4, noise_shift=3, cyclic=False, threshold=1280),
        group_range=True, group_doppler=True, first_range_bin=1, last_range_bin=229, second_peak=0.5,
    )  # fmt: skip


def test_sdk_2(tmp_path: Path):
    settings = read_ti_firmware(written(tmp_path, SDK2))
    assert settings == FirmwareSettings(
        device="xwr16xx",
        range_cfar=FirmwareCfar(average="caso", window=8, guard=4, noise_shift=4, cyclic=False, threshold=5120),
        doppler_cfar=FirmwareCfar(average="ca", window=8, guard=4, noise_shift=4, cyclic=True, threshold=5120),
        group_range=True, group_doppler=False, first_range_bin=1, last_range_bin=224,
        static_removal=True, second_peak=None,
    )  # fmt: skip


def test_sdk_3_has_thresholds_in_db(tmp_path: Path):
    text = "\n".join(line for line in SDK2.splitlines() if not line.startswith("peakGrouping"))
    text = text.replace("4 4 0 5120", "4 3 1 15 1").replace("4 4 1 5120", "4 4 1 12.0 0")
    settings = read_ti_firmware(written(tmp_path, text))
    assert settings.range_cfar is not None
    assert settings.doppler_cfar is not None
    assert settings.range_cfar.threshold == round(15 / 6.0206 * 256 * 8)
    assert settings.doppler_cfar.threshold == round(12 / 6.0206 * 256 * 8)
    assert (settings.group_range, settings.group_doppler) == (True, False)
    assert settings.most_objects == load_firmware("iwr6843isk").most_objects == 500


@pytest.mark.parametrize("mode", [0, 1, 2])
def test_noise_of_an_sdk_3_cfar_is_the_mean_of_the_cells_it_takes(tmp_path: Path, mode: int):
    """TI: the divisor of CA counts both sides, that of CASO and CAGO the one side they take."""
    shift = 4 if mode == 0 else 3
    text = SDK2.replace("cfarCfg -1 0 2 8 4 4 0 5120", f"cfarCfg -1 0 {mode} 8 4 {shift} 0 15 1")
    cfar = read_ti_firmware(written(tmp_path, text)).range_cfar
    assert cfar is not None
    assert np.all(noise_level(np.full((64, 1), 30_000), cfar, cfar.window) == 30_000)


def test_boards_at_60_ghz_have_the_firmware_of_sdk_3():
    settings = load_firmware("iwr6843isk")
    assert settings.range_cfar is not None
    assert settings.device == "xwr16xx"
    assert settings.range_cfar.threshold == 7654  # 15 dB of 256 x 12 antennas counts an octave of 6.02 dB


def test_missing_lines_are_off_or_the_demos_defaults(tmp_path: Path):
    text = "\n".join(SDK1.splitlines()[:9]).replace("adcbufCfg 0 1 0 1\n", "")
    settings = read_ti_firmware(written(tmp_path, text))
    assert settings == FirmwareSettings(second_peak=None)


def test_settings_by_radar(tmp_path: Path):
    path = written(tmp_path, SDK2)
    assert load_firmware(str(path)).static_removal
    assert load_firmware("iwr1443_mars").static_removal
    assert not load_firmware("iwr1443_radhar").group_range
    assert load_firmware("awr1843") == FirmwareSettings()


PEOPLE_TRACKING = """dynamicRACfarCfg -1 4 4 2 2 8 12 4 8 5.00 8.00 0.40 1 1
staticRACfarCfg -1 6 2 2 2 8 8 6 4 8.00 15.00 0.30 0 0
dynamic2DAngleCfg -1 1.5 0.0300 1 0 1 0.30 0.85 8.00
"""


def test_a_cfg_without_cfar_has_a_stated_substitute(tmp_path: Path):
    bare = "\n".join(SDK1.splitlines()[:8])
    settings = read_ti_firmware(written(tmp_path, bare))
    assert settings.range_cfar is not None
    assert settings.range_cfar.threshold == round(15 / 6.0206 * 512 * 12 / 16)
    assert "without cfarCfg" in settings.substitute
    assert not read_ti_firmware(written(tmp_path, SDK1)).substitute


def test_people_tracking_has_the_windows_of_its_own_cfar(tmp_path: Path):
    text = "\n".join(line for line in SDK2.splitlines() if not line.startswith(("cfarCfg", "clutterRemoval")))
    settings = read_ti_firmware(written(tmp_path, text + "\n" + PEOPLE_TRACKING))
    cfar = settings.range_cfar
    assert cfar is not None
    assert (cfar.window, cfar.guard, settings.doppler_cfar, settings.static_removal) == (8, 4, None, True)
    assert cfar.threshold == pytest.approx(10 * np.log10(5.0) / 6.0206 * 256 * 8, abs=1)
    assert "3D People Tracking" in settings.substitute
    level = np.full((200, 4), 20_000)
    assert noise_level(level, cfar, cfar.window)[100].tolist() == [20_000] * 4  # a flat floor is its own noise


def test_the_cfar_of_people_counting_is_no_cfar_of_the_out_of_box_demo(tmp_path: Path):
    text = SDK1.replace("cfarCfg 0 2 8 4 3 0 1280", "cfarCfg 6 4 4 4 4 8 12 4 8 20 33 0\ndoaCfg 600 1875 30 1 1 0")
    assert "2D People Counting" in read_ti_firmware(written(tmp_path, text)).substitute


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("cfarCfg 0 2 8", "cfarCfg 2 2 8", ["direction 2"]),
        ("cfarCfg 0 2 8", "cfarCfg 0 5 8", ["line 9", "average mode 5"]),
        ("cfarCfg 0 2 8 4 3 0 1280", "cfarCfg 0 2 8 4", ["line 9", "cfarCfg has 4 numbers", "needs 7"]),
        ("cfarCfg 0 2 8", "cfarCfg 0 2 1", ["window 1"]),
        ("0 1280", "0 1280.5", ["line 9", "whole"]),
        ("peakGrouping 1 1 1 1 229", "peakGrouping 1 1 1 30 20", ["30 to 20"]),
        ("multiObjBeamForming 1 0.5", "multiObjBeamForming 1 1.5", ["multiObjBeamForming", "1.5"]),
        ("clutterRemoval 0", "clutterRemoval on", ["line 12", "not a number"]),
    ],
)
def test_a_bad_line_is_refused_with_the_reason(tmp_path: Path, old: str, new: str, words: list[str]):
    assert old in SDK1
    path = written(tmp_path, SDK1.replace(old, new))
    with pytest.raises(InputError) as caught:
        read_ti_firmware(path)
    text = str(caught.value)
    assert "\n" not in text
    assert text.startswith(str(path))
    for word in words:
        assert word in text
