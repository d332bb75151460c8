"""mmWave Studio's Lua scripts, from calls as its user guide has them."""

from pathlib import Path

import numpy as np
import pytest

from mmweaver.core.boards import ANTENNAS
from mmweaver.core.errors import InputError
from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.transmit_code import weights_of
from mmweaver.io.radar_file import load_radar
from mmweaver.io.radar_options import RadarOptions
from mmweaver.io.ti_cfg import read_ti_cfg

SCRIPT = """
-- ar1.ChirpConfig(0, 0, 0, 0, 0, 0, 0, 0, 0, 0)  left out
local START_GHZ = 77
IDLE_US = 100.0
ar1.ChanNAdcConfig(1, 1, 1, 1, 1, 1, 1, 2, 1, 0)
if (ar1.LVDSLaneConfig(0, 1, 1, 0, 0, 1, 0, 0) == 0) then print("fine") end
ar1.ProfileConfig(0, START_GHZ, IDLE_US, 6, 60, 0, 0, 0, 0, 0, 0, 29.982, 0, 256, 10000, 0, 0, 30)
--[[ ar1.FrameConfig(0, 9, 9, 9, 9, 0, 0, 1)
]]
ar1.ChirpConfig(0, 0, 0, 0, 0, 0, 0, 1, 0, 0)
ar1.ChirpConfig(
    1, 1, 0, 0, 0, 0, 0, 0, 0, 1)
ar1.ChirpConfig(2, 2, 0, 0, 0, 0, 0, 0, 1, 0)
ar1.FrameConfig(0, 2, 8, 64, 40, 0, 0, 1)
"""
CFG = """channelCfg 15 7 0
adcCfg 2 1
adcbufCfg -1 0 0 1 1
profileCfg 0 77 100 6 60 0 0 29.982 0 256 10000 0 0 30
chirpCfg 0 0 0 0 0 0 0 1
chirpCfg 1 1 0 0 0 0 0 4
chirpCfg 2 2 0 0 0 0 0 2
frameCfg 0 2 64 8 40 1 0
"""


def read(folder: Path, text: str) -> RadarConfig:
    (folder / "capture.lua").write_text(text)
    return load_radar(str(folder / "capture.lua"))


def test_a_script_is_the_radar_of_the_same_cfg(tmp_path: Path):
    (tmp_path / "capture.cfg").write_text(CFG)
    read(tmp_path, SCRIPT)
    assert load_radar(f"{tmp_path / 'capture.lua'}#antennas=isk") == read_ti_cfg(
        tmp_path / "capture.cfg", RadarOptions(antennas=ANTENNAS["isk"])
    )


def test_lanes_order_and_beams(tmp_path: Path):
    text = SCRIPT.replace("(0, 1, 1, 0, 0, 1", "(0, 1, 1, 1, 1, 1").replace("1, 2, 1, 0)", "1, 2, 1, 1)")
    config = read(tmp_path, text)
    assert (config.lvds_lanes, config.lvds_iq_order) == (4, "qi")
    beam = SCRIPT.replace("0, 0, 0, 0, 0, 0, 29.982", "0, 0, 0, 0, 90, 180, 29.982")
    beam = beam.replace("(0, 0, 0, 0, 0, 0, 0, 1, 0, 0)\nar1", "(0, 0, 0, 0, 0, 0, 0, 1, 1, 1)\nar1")
    config = read(tmp_path, beam.replace("FrameConfig(0, 2", "FrameConfig(0, 0"))
    assert np.allclose(weights_of(config.tx_code), [[1, -1j, -1]])


@pytest.mark.parametrize(
    ("old", "new", "says"),
    [
        ("ar1.FrameConfig(0, 2", "ar1.Other(0, 2", "lacks ar1.FrameConfig"),
        ("START_GHZ, IDLE", "UNKNOWN, IDLE", "no number"),
        ("ar1.FrameConfig(0, 2, 8, 64, 40, 0, 0, 1)", "ar1.FrameConfig(0, 2)", r"2 numbers.*5"),
        ("ar1.FrameConfig(0, 2", "ar1.AdvanceFrameConfig(0, 2", "an advanced frame"),
        ("8, 64, 40", "8, nan, 40", "not finite"),
        ("IDLE_US = 100.0", "IDLE_US = 1..0", "no number"),
        ("]]", "", "lacks"),
        ("8, 64, 40", "8, 64, 4", r"4\.00 ms"),
        ("ar1.ChirpConfig(2, 2, 0, 0", "ar1.ChirpConfig(2, 2, 0, 5", "start frequency"),
    ],
)
def test_what_is_none_is_refused(tmp_path: Path, old: str, new: str, says: str):
    assert old in SCRIPT
    with pytest.raises(InputError, match=says):
        read(tmp_path, SCRIPT.replace(old, new))
