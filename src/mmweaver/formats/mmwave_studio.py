"""mmWave Studio's .mmwave.json: the radar configuration of a DCA1000 recording."""

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any, TypeVar

from mmweaver.core.errors import InputError
from mmweaver.core.radar_config import RadarConfig
from mmweaver.formats.ti_chirps import TiChirps, radar_from_ti

Answer = TypeVar("Answer")
VARIATIONS = ("startFreqVar_MHz", "freqSlopeVar_KHz_usec", "idleTimeVar_usec", "adcStartTimeVar_usec")


def read_mmwave_studio(path: Path | str) -> RadarConfig:
    """The radar of the file's first device, named after the file.

    Raises InputError where the file cannot be read, a key is missing or of the wrong type, the frame is not a legacy
    frame of identical TDM chirps, or the radar could not exist.
    """
    path = Path(path)
    return _query(path, lambda device: radar_from_ti(_chirps(path.name.split(".")[0], device["rfConfig"])))


def read_mmwave_studio_iq_order(path: Path | str) -> str:
    """The I/Q order of a recording with this configuration, "iq" or "qi", from iqSwapSel."""
    swap = _query(Path(path), lambda device: _whole(device["rawDataCaptureConfig"]["rlDevDataFmtCfg_t"]["iqSwapSel"]))
    return "qi" if swap == 1 else "iq"


def is_mmwave_studio(values: Any) -> bool:
    """Whether this JSON looks like mmWave Studio's."""
    return isinstance(values, dict) and "mmWaveDevices" in values


def _query(path: Path, query: Callable[[Any], Answer]) -> Answer:
    try:
        values = json.loads(path.read_text(encoding="utf-8"))
        return query(values["mmWaveDevices"][0])
    except OSError as error:
        raise InputError(f"cannot read {path}: {error.strerror or error}") from None
    except InputError as error:
        raise InputError(f"{path}: {error}") from None
    except (UnicodeDecodeError, json.JSONDecodeError) as error:
        raise InputError(f"{path} is not JSON ({error})") from None
    except KeyError as error:
        raise InputError(f"{path} lacks {error.args[0]}; is it an mmWave Studio .mmwave.json?") from None
    except (TypeError, ValueError, IndexError, OverflowError) as error:
        raise InputError(f"{path} is not an mmWave Studio .mmwave.json ({error})") from None


def _chirps(name: str, setup: Any) -> TiChirps:
    if setup["waveformType"] != "legacyFrameChirp":
        raise InputError(f"waveform {setup['waveformType']!r} cannot be read; use legacyFrameChirp")
    if setup.get("rlBpmChirps"):
        raise InputError("BPM-MIMO chirps cannot be read; use TDM")
    frame = setup["rlFrameCfg_t"]
    masks, profile_ids = _fired(setup["rlChirps"], _whole(frame["chirpStartIdx"]), _whole(frame["chirpEndIdx"]))
    if len(profile_ids) != 1:
        raise InputError(f"the frame's chirps use profiles {sorted(profile_ids)}; only one profile can be read")
    profiles = {_whole(entry["rlProfileCfg_t"]["profileId"]): entry["rlProfileCfg_t"] for entry in setup["rlProfiles"]}
    profile = profiles.get(min(profile_ids))
    if profile is None:
        raise InputError(f"the chirps use profile {min(profile_ids)}, which rlProfiles does not define")
    return TiChirps(
        name=name,
        start_frequency_ghz=float(profile["startFreqConst_GHz"]),
        idle_time_us=float(profile["idleTimeConst_usec"]),
        adc_start_time_us=float(profile["adcStartTimeConst_usec"]),
        ramp_end_time_us=float(profile["rampEndTime_usec"]),
        slope_mhz_per_us=float(profile["freqSlopeConst_MHz_usec"]),
        num_samples=_whole(profile["numAdcSamples"]),
        sample_rate_ksps=float(profile["digOutSampleRate"]),
        rx_gain_db=float(_whole(profile["rxGain_dB"]) & 0x3F),
        rx_mask=_whole(setup["rlChanCfg_t"]["rxChannelEn"]),
        tx_mask=_whole(setup["rlChanCfg_t"]["txChannelEn"]),
        chirp_tx_masks=masks,
        num_loops=_whole(frame["numLoops"]),
        frame_period_ms=float(frame["framePeriodicity_msec"]),
        complex_samples=_whole(setup["rlAdcOutCfg_t"]["fmt"]["b2AdcOutFmt"]) != 0,
    )


def _fired(entries: Any, first: int, last: int) -> tuple[tuple[int, ...], set[int]]:
    """Transmitter mask of each chirp from first to last, and the profiles they use."""
    chirps: dict[int, tuple[int, int]] = {}
    for entry in entries:
        chirp = entry["rlChirpCfg_t"]
        if varied := [key for key in VARIATIONS if float(chirp[key]) != 0]:
            raise InputError(
                f"chirp {chirp['chirpStartIdx']} has {varied[0]} {chirp[varied[0]]}; all must be identical"
            )
        start, end = _whole(chirp["chirpStartIdx"]), _whole(chirp["chirpEndIdx"])
        if not 0 <= start <= end <= 511:
            raise InputError(f"chirps {start} to {end} must lie in 0 to 511")
        for index in range(start, end + 1):
            chirps[index] = _whole(chirp["txEnable"]), _whole(chirp["profileId"])
    if not 0 <= first <= last <= 511:
        raise InputError(f"the frame's chirps {first} to {last} must lie in 0 to 511")
    if missing := [index for index in range(first, last + 1) if index not in chirps]:
        raise InputError(f"the frame uses chirp {missing[0]}, which rlChirps does not define")
    wanted = [chirps[index] for index in range(first, last + 1)]
    return tuple(mask for mask, _ in wanted), {profile for _, profile in wanted}


def _whole(value: Any) -> int:
    """An integer, or a hexadecimal string as mmWave Studio writes masks."""
    if isinstance(value, str):
        return int(value, 0)
    if isinstance(value, bool) or value != int(value):
        raise InputError(f"{value!r} must be a whole number")
    return int(value)
