"""mmWave Studio's configuration files, from a small one written here."""

import copy
import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from mmweaver.core.errors import InputError
from mmweaver.core.transmit_code import weights_of
from mmweaver.io.mmwave_studio import read_mmwave_studio
from mmweaver.io.radar_options import RadarOptions


def chirp(start: int, end: int, mask: str) -> dict:
    zero = {"startFreqVar_MHz": 0.0, "freqSlopeVar_KHz_usec": 0.0, "idleTimeVar_usec": 0.0, "adcStartTimeVar_usec": 0.0}
    return {"rlChirpCfg_t": {"chirpStartIdx": start, "chirpEndIdx": end, "profileId": 0, "txEnable": mask, **zero}}


SETUP: dict[str, Any] = {
    "waveformType": "legacyFrameChirp",
    "rlChanCfg_t": {"rxChannelEn": "0xF", "txChannelEn": "0x7"},
    "rlAdcOutCfg_t": {"fmt": {"b2AdcBits": 2, "b2AdcOutFmt": 1}},
    "rlProfiles": [
        {
            "rlProfileCfg_t": {
                "profileId": 0, "startFreqConst_GHz": 77.0, "idleTimeConst_usec": 100.0, "adcStartTimeConst_usec": 6.0,
                "rampEndTime_usec": 60.0, "freqSlopeConst_MHz_usec": 60.0, "numAdcSamples": 128,
                "digOutSampleRate": 2500, "rxGain_dB": "0x1E",
            }
        }
    ],
    "rlChirps": [chirp(0, 0, "0x1"), chirp(1, 1, "0x4"), chirp(2, 2, "0x2")],
    "rlFrameCfg_t": {"chirpStartIdx": 0, "chirpEndIdx": 2, "numLoops": 64, "framePeriodicity_msec": 70.0},
    "rlBpmChirps": [],
}  # fmt: skip


def written(tmp_path: Path, setup: Any, swap: int = 0) -> Path:
    device = {"rfConfig": setup, "rawDataCaptureConfig": {"rlDevDataFmtCfg_t": {"iqSwapSel": swap}}}
    path = tmp_path / "capture.mmwave.json"
    path.write_text(json.dumps({"mmWaveDevices": [device]}))
    return path


def test_the_radar_of_a_file(tmp_path: Path):
    config = read_mmwave_studio(written(tmp_path, SETUP))
    assert config.name == "capture"
    assert (config.num_tx, config.num_rx, config.tx_order, config.num_loops) == (3, 4, (0, 2, 1), 64)
    assert config.range_resolution_m == pytest.approx(0.0488, abs=1e-4)
    assert config.loop_period_s == pytest.approx(480e-6)
    assert config.frame_period_s == pytest.approx(0.07)
    assert config.rx_gain_db == 30.0
    assert config.complex_samples


@pytest.mark.parametrize(("swap", "iq_order"), [(0, "iq"), (1, "qi")])
def test_the_iq_order(tmp_path: Path, swap: int, iq_order: str):
    assert read_mmwave_studio(written(tmp_path, SETUP, swap)).lvds_iq_order == iq_order


def changed(change: Callable[[Any], Any]) -> Any:
    setup = copy.deepcopy(SETUP)
    change(setup)
    return setup


@pytest.mark.parametrize(
    ("change", "word"),
    [
        (lambda setup: setup.update(waveformType="continuousWave"), "continuousWave"),
        (lambda setup: setup.update(rlBpmChirps=[{}]), "lacks rlBpmChirpCfg_t"),
        (lambda setup: setup.pop("rlFrameCfg_t"), "lacks rlFrameCfg_t"),
        (lambda setup: setup.update(rlChirps=7), "not an mmWave Studio"),
        (lambda setup: setup["rlChirps"].__setitem__(0, chirp(0, 10**9, "0x1")), "0 to 511"),
        (lambda setup: setup["rlChirps"][1]["rlChirpCfg_t"].update(idleTimeVar_usec=1.0), "idleTimeVar"),
        (lambda setup: setup["rlProfiles"][0]["rlProfileCfg_t"].update(numAdcSamples="many"), "not an mmWave Studio"),
        (lambda setup: setup["rlProfiles"][0]["rlProfileCfg_t"].update(numAdcSamples=128.5), "whole"),
    ],
)
def test_a_bad_file_is_refused(tmp_path: Path, change: Callable[[Any], Any], word: str):
    path = written(tmp_path, changed(change))
    with pytest.raises(InputError, match=word) as caught:
        read_mmwave_studio(path)
    assert str(path) in str(caught.value)


def test_bpm_and_phase_shifters(tmp_path: Path):
    """Bit 2 tx + 1 of constBpmVal inverts a transmitter that is on; a step of a phase shifter is 5.625 degrees, by
    which samples turn back."""
    setup = changed(lambda setup: None)
    setup["rlChirps"] = [chirp(0, 2, "0x7")]
    setup["rlFrameCfg_t"].update(chirpStartIdx=0, chirpEndIdx=2)
    shift = {"chirpStartIdx": 1, "chirpEndIdx": 1, "tx0PhaseShift": 0, "tx1PhaseShift": 16, "tx2PhaseShift": 32}
    setup["rlRfPhaseShiftCfgs"] = [{"rlRfPhaseShiftCfg_t": shift}]
    invert = {"chirpStartIdx": 2, "chirpEndIdx": 2, "constBpmVal": "0x8"}
    setup["rlBpmChirps"] = [{"rlBpmChirpCfg_t": invert}]
    config = read_mmwave_studio(written(tmp_path, setup))
    assert np.allclose(weights_of(config.tx_code), [[1, 1, 1], [1, -1j, -1], [1, -1, 1]])


def test_sub_frames_and_lanes(tmp_path: Path):
    setup = changed(lambda setup: None)
    one = {"chirpStartIdx": 0, "numOfChirps": 3, "numLoops": 8, "numOfBurst": 1, "numOfBurstLoops": 1,
           "subFramePeriodicity_msec": 20.0}  # fmt: skip
    other = {**one, "numOfChirps": 1, "numLoops": 32, "subFramePeriodicity_msec": 30.0}
    frames = [{"rlSubFrameCfg_t": frame} for frame in (one, other)]
    setup["waveformType"] = "advancedFrameChirp"
    setup["rlAdvFrameCfg_t"] = {"frameSeq": {"numOfSubFrames": 2, "subFrameCfg": frames}}
    path = written(tmp_path, setup)
    config = read_mmwave_studio(path, RadarOptions(sub_frame=1))
    assert (config.num_loops, config.num_slots, config.frame_period_s) == (32, 1, pytest.approx(0.05))
    assert config.frame_words_before == 3 * 8 * 4 * config.num_samples * 2
    with pytest.raises(InputError, match="--radar-set subframe="):
        read_mmwave_studio(path)
    values = json.loads(written(tmp_path, SETUP).read_text())
    values["mmWaveDevices"][0]["rawDataCaptureConfig"]["rlDevLaneEnable_t"] = {"laneEn": "0xF"}
    path.write_text(json.dumps(values))
    assert read_mmwave_studio(path).lvds_lanes == 4
    assert read_mmwave_studio(path, RadarOptions(lanes=2)).lvds_lanes == 2
