"""mmWave Studio's .mmwave.json: the radar configuration of a DCA1000 recording."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, TypeVar

import numpy as np

from mmweaver.core.antenna_tables import AntennaTable
from mmweaver.core.errors import InputError
from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.safe_files.safe_text import read_json
from mmweaver.formats.ti_chirps import MOST_TX, SHIFTER_DEG, SubFrame, TiChirps, profile_phases_deg, radar_from_ti

Answer = TypeVar("Answer")
PLAIN_FRAMES = ("legacyFrameChirp", "singleFrameChirp")
VARIATIONS = ("startFreqVar_MHz", "freqSlopeVar_KHz_usec", "idleTimeVar_usec", "adcStartTimeVar_usec")


def read_mmwave_studio(
    path: Path | str, *, sub_frame: int | None = None, antennas: AntennaTable | None = None, lanes: int | None = None
) -> RadarConfig:
    """The radar of the file's first device, named after the file.

    `sub_frame`, `antennas` and `lanes` as in `formats.ti_cfg.read_ti_cfg`; lanes are otherwise those that the file
    enables. Raises InputError where the file cannot be read, a key is missing or of the wrong type, chirps differ or
    cannot be separated, or the radar could not exist.
    """
    path = Path(path)

    def radar(device: Any) -> RadarConfig:
        chirps = _chirps(path.name.split(".")[0], device["rfConfig"], sub_frame)
        return radar_from_ti(
            replace(chirps, antennas=antennas, lvds_lanes=lanes or _lanes(device), lvds_iq_order=_iq_order(device))
        )

    return _query(path, radar)


def _iq_order(device: Any) -> str:
    return (
        "qi"
        if _whole(device.get("rawDataCaptureConfig", {}).get("rlDevDataFmtCfg_t", {}).get("iqSwapSel", 0)) == 1
        else "iq"
    )


def is_mmwave_studio(values: Any) -> bool:
    """Whether this JSON looks like mmWave Studio's."""
    return isinstance(values, dict) and "mmWaveDevices" in values


def _query(path: Path, query: Callable[[Any], Answer]) -> Answer:
    values = read_json(path)
    try:
        return query(values["mmWaveDevices"][0])
    except InputError as error:
        raise InputError(f"{path}: {error}") from None
    except KeyError as error:
        raise InputError(f"{path} lacks {error.args[0]}; is it an mmWave Studio .mmwave.json?") from None
    except (AttributeError, TypeError, ValueError, IndexError, OverflowError) as error:
        raise InputError(f"{path} is not an mmWave Studio .mmwave.json ({error})") from None


def _lanes(device: Any) -> int:
    """2 or 4 LVDS lanes, of the mask laneEn; 2 without it."""
    lanes = device.get("rawDataCaptureConfig", {}).get("rlDevLaneEnable_t", {}).get("laneEn")
    return 4 if lanes is not None and _whole(lanes).bit_count() == 4 else 2


def _chirps(name: str, setup: Any, sub_frame: int | None) -> TiChirps:
    if _whole(setup["rlChanCfg_t"].get("cascading", 0)) != 0:
        raise InputError("it is a cascade of several chips, which cannot be read; use one chip")
    frames = _frames(setup)
    if sub_frame is None and len(frames) > 1:
        raise InputError(
            f"it has {len(frames)} sub-frames; choose one of 0 to {len(frames) - 1}: --radar-set subframe=N"
        )
    chosen = sub_frame or 0
    if not 0 <= chosen < len(frames):
        raise InputError(f"it has sub-frames 0 to {len(frames) - 1}, not {chosen}")
    fired = [_fired(setup["rlChirps"], one.first, one.last) for one in frames]
    profiles = [_profile(setup, profile_ids) for _, profile_ids in fired]
    counts = [
        len(masks) * one.num_loops * _whole(profile["numAdcSamples"])
        for one, (masks, _), profile in zip(frames, fired, profiles, strict=True)
    ]
    frame, masks, profile = frames[chosen], fired[chosen][0], profiles[chosen]
    return TiChirps(
        name=name if len(frames) == 1 else f"{name}_{chosen}",
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
        num_loops=frame.num_loops,
        frame_period_ms=frame.period_ms,
        complex_samples=_whole(setup["rlAdcOutCfg_t"]["fmt"]["b2AdcOutFmt"]) != 0,
        chirp_phase_deg=_phases(setup, frame.first, frame.last),
        profile_phase_deg=profile_phases_deg(_whole(profile.get("txPhaseShifter", 0))),
        sub_frame=SubFrame(index=chosen, samples_before=sum(counts[:chosen]), samples_after=sum(counts[chosen + 1 :])),
    )


@dataclass(frozen=True, kw_only=True)
class _ChirpFrame:
    """The chirps of a frame, or of one sub-frame; the period is that of the whole frame."""

    first: int
    last: int
    num_loops: int
    period_ms: float


def _frames(setup: Any) -> list[_ChirpFrame]:
    """The plain frame, or the sub-frames of an advanced one."""
    waveform = setup.get("waveformType", PLAIN_FRAMES[0])  # writers other than mmWave Studio leave it out
    if waveform in PLAIN_FRAMES:
        frame = setup["rlFrameCfg_t"]
        first, last, loops = (_whole(frame[key]) for key in ("chirpStartIdx", "chirpEndIdx", "numLoops"))
        return [_ChirpFrame(first=first, last=last, num_loops=loops, period_ms=float(frame["framePeriodicity_msec"]))]
    if waveform != "advancedFrameChirp":
        raise InputError(f"waveform {waveform!r} cannot be read; use frames of chirps")
    sequence = setup["rlAdvFrameCfg_t"]["frameSeq"]
    entries = [entry["rlSubFrameCfg_t"] for entry in sequence["subFrameCfg"]][: _whole(sequence["numOfSubFrames"])]
    period_ms = sum(float(entry["subFramePeriodicity_msec"]) for entry in entries)
    found = []
    for index, entry in enumerate(entries):
        if _whole(entry["numOfBurst"]) != 1 or _whole(entry["numOfBurstLoops"]) != 1:
            raise InputError(f"sub-frame {index} has several bursts, which cannot be read; use one")
        first, count, loops = (_whole(entry[key]) for key in ("chirpStartIdx", "numOfChirps", "numLoops"))
        found.append(_ChirpFrame(first=first, last=first + count - 1, num_loops=loops, period_ms=period_ms))
    return found


def _profile(setup: Any, profile_ids: set[int]) -> Any:
    if len(profile_ids) != 1:
        raise InputError(f"the frame's chirps use profiles {sorted(profile_ids)}; only one profile can be read")
    profiles = {_whole(entry["rlProfileCfg_t"]["profileId"]): entry["rlProfileCfg_t"] for entry in setup["rlProfiles"]}
    profile = profiles.get(min(profile_ids))
    if profile is None:
        raise InputError(f"the chirps use profile {min(profile_ids)}, which rlProfiles does not define")
    return profile


def _phases(setup: Any, first: int, last: int) -> tuple[tuple[float, ...], ...]:
    """Degrees of each transmitter in each chirp's samples: 180 by BPM (odd bits of constBpmVal), -5.625 a step of a
    shifter."""
    phases = np.zeros((512, MOST_TX))
    for entry in setup.get("rlBpmChirps") or []:
        chirp = entry["rlBpmChirpCfg_t"]
        bits = _whole(chirp["constBpmVal"])
        inverted = [180.0 * (bits >> (2 * tx + 1) & 1) for tx in range(MOST_TX)]
        phases[_whole(chirp["chirpStartIdx"]) : _whole(chirp["chirpEndIdx"]) + 1] += inverted
    for entry in setup.get("rlRfPhaseShiftCfgs") or []:
        chirp = entry["rlRfPhaseShiftCfg_t"]
        steps = [_whole(chirp.get(f"tx{tx}PhaseShift", 0)) for tx in range(MOST_TX)]
        phases[_whole(chirp["chirpStartIdx"]) : _whole(chirp["chirpEndIdx"]) + 1] -= SHIFTER_DEG * np.array(steps)
    return tuple(tuple(float(one) for one in row) for row in phases[first : last + 1])


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
