"""mmWave Studio's .mmwave.json: radar configuration of a DCA1000 recording.

mmWave Studio's Lua scripts: the ar1 calls that configure a radar, converted to lines of a .cfg.

Arguments are numbers, or names to which the script assigns a number. Reference: TI mmWave Studio User Guide and its
example scripts (DataCaptureDemo_xWR.lua).
"""

import math
import re
from dataclasses import replace
from pathlib import Path
from typing import Any

from mmweaver.core.errors import InputError, file_named
from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.safe_files.safe_text import read_json, read_text
from mmweaver.io.radar_options import RadarOptions
from mmweaver.io.ti_cfg import MAX_NAME, Line, Lines, setup_of_lines
from mmweaver.io.ti_chirps import MAX_TX, SHIFTER_DEG, TiChirp, TiFrame, TiProfile, TiSetup, radar_from_ti

MAX_BYTES = 2**20
CALL = re.compile(r"\bar1\.(\w+)\s*\(([^()]*)\)")
ASSIGNMENT = re.compile(
    r"^[ \t]*(?:local[ \t]+)?([A-Za-z_]\w*)[ \t]*=[ \t]*(-?\d+(?:\.\d*)?(?:[eE]-?\d{1,2})?)[ \t]*;?[ \t\r]*$",
    re.MULTILINE,
)
# number of arguments used per call
NEEDED = {"ChanNAdcConfig": 10, "ProfileConfig": 15, "ChirpConfig": 10, "FrameConfig": 5}
OPTIONAL = {"LVDSLaneConfig": 5, "LvdsLaneConfig": 5}
REFUSED = {
    "AdvanceFrameConfig": "an advanced frame",
    "AdvanceChirpConfig": "advanced chirps",
    "ContStrConfig": "continuous mode",
    "ChanNAdcConfig_mult": "a cascade of several chips",
    "SetPerChirpPhaseShifterConfig": "phase shifters of each chirp",
}
TX, FIRST_RX, NUM_RX = 3, 3, 4


def read_studio_script(path: Path | str, options: RadarOptions | None = None) -> RadarConfig:
    """Reads the radar that a script configures; the last call of a kind counts, except for chirps, of which all count.

    Args:
        path: The file, after which the radar is named.
        options: Antennas and lanes of the board. Default: as in the script.

    Returns:
        The radar.

    Raises:
        InputError: If calls are missing or have non-numeric arguments, chirps differ or cannot be separated, or the
            radar is impossible.
    """
    path = Path(path)
    text = _strip_comments(read_text(path, max_bytes=MAX_BYTES, errors="replace"))
    names = {name: float(number) for name, number in ASSIGNMENT.findall(text)}
    calls: dict[str, list[Line]] = {}
    for found in CALL.finditer(text):
        if found[1] in REFUSED:
            raise InputError(
                f"{path}: {REFUSED[found[1]]} (ar1.{found[1]}) cannot be read; use plain frames of one chip"
            )
        if (needed := {**NEEDED, **OPTIONAL}.get(found[1])) is not None:
            number = text.count("\n", 0, found.start()) + 1
            calls.setdefault(found[1], []).append(Line(number, found[1], _numbers(path, found, names, needed)))
    if missing := [name for name in NEEDED if name not in calls]:
        raise InputError(f"{path} lacks ar1.{', ar1.'.join(missing)}; is it a script of mmWave Studio?")
    lane = [*calls.get("LVDSLaneConfig", []), *calls.get("LvdsLaneConfig", [])][-1:]
    with file_named(path):
        setup = setup_of_lines(path.stem[:MAX_NAME], _cfg_lines(calls))
        setup = replace(setup, lvds_lanes=4 if lane and all(lane[0].values[1:5]) else 2)
        return radar_from_ti(setup, options or RadarOptions())


def _strip_comments(text: str) -> str:
    """Removes -- and --[[ ]] comments; line numbers are kept."""
    kept, at = [], 0
    while (start := text.find("--", at)) >= 0:
        kept.append(text[at:start])
        is_long = text.startswith("--[[", start)
        end = text.find("]]" if is_long else "\n", start)
        end = len(text) if end < 0 else end + 2 * is_long
        kept.append("\n" * text.count("\n", start, end))
        at = end
    return "".join([*kept, text[at:]])


def _numbers(path: Path, found: re.Match[str], names: dict[str, float], needed: int) -> tuple[float, ...]:
    words = [word.strip() for word in found[2].split(",")]
    try:
        values = tuple(names[word] if word in names else float(word) for word in words[: max(needed, 18)])
    except ValueError:
        raise InputError(f"{path}: ar1.{found[1]} takes something that is no number: {found[2].strip()[:80]}") from None
    if not all(map(math.isfinite, values)):
        raise InputError(f"{path}: ar1.{found[1]} takes a number that is not finite")
    if len(values) < needed:
        raise InputError(f"{path}: ar1.{found[1]} has {len(values)} numbers, it needs {needed}")
    return values


def _cfg_lines(calls: dict[str, list[Line]]) -> Lines:
    """Converts calls to commands of a .cfg."""
    channels, frame = calls["ChanNAdcConfig"][-1], calls["FrameConfig"][-1]
    tx_mask, rx_mask = _mask(channels.values[:TX]), _mask(channels.values[FIRST_RX : FIRST_RX + NUM_RX])
    bits, samples, swap = channels.values[FIRST_RX + NUM_RX : FIRST_RX + NUM_RX + 3]
    first, last, frames, loops, period_ms = frame.values[:5]
    commands = {
        "channelCfg": [(channels, (rx_mask, tx_mask))],
        "adcCfg": [(channels, (bits, samples))],
        "adcbufCfg": [(channels, (-1.0, 0.0, swap, 1.0, 1.0))],
        "profileCfg": [(line, _studio_profile(line.values)) for line in calls["ProfileConfig"]],
        "chirpCfg": [(line, (*line.values[:7], _mask(line.values[7:10]))) for line in calls["ChirpConfig"]],
        "frameCfg": [(frame, (first, last, loops, frames, period_ms, 1.0, 0.0))],
    }
    return {
        command: [Line(line.number, command, values) for line, values in found] for command, found in commands.items()
    }


def _studio_profile(values: tuple[float, ...]) -> tuple[float, ...]:
    """profileCfg: id, GHz, idle, ADC start, ramp end in us, back-off, phases, slope, TX start, samples, rate, gain."""
    code = sum(round(degrees / SHIFTER_DEG) % 64 << (8 * tx + 2) for tx, degrees in enumerate(values[8:11]))
    gain_db = values[17] if len(values) > 17 else 30.0
    return (*values[:5], 0.0, float(code), *values[11:15], 0.0, 0.0, gain_db)


def _mask(enabled: tuple[float, ...]) -> float:
    return float(sum(1 << index for index, one in enumerate(enabled) if one))


PLAIN_FRAMES = ("legacyFrameChirp", "singleFrameChirp")
VARIATIONS = ("startFreqVar_MHz", "freqSlopeVar_KHz_usec", "idleTimeVar_usec", "adcStartTimeVar_usec")


def read_mmwave_studio(path: Path | str, options: RadarOptions | None = None) -> RadarConfig:
    """Reads the radar of the first device in a .mmwave.json.

    Args:
        path: The file, after which the radar is named.
        options: Sub-frame of an advanced frame, antennas and lanes of the board. Default: as in the file.

    Returns:
        The radar.

    Raises:
        InputError: If the file cannot be read, a key is missing or malformed, chirps differ or cannot be separated, or
            the radar is impossible.
    """
    path = Path(path)
    values = read_json(path)
    with file_named(path):
        try:
            return radar_from_ti(
                _setup(path.name.split(".")[0][:MAX_NAME], values["mmWaveDevices"][0]), options or RadarOptions()
            )
        except InputError:
            raise
        except KeyError as error:
            raise InputError(f"{path} lacks {error.args[0]}; is it an mmWave Studio .mmwave.json?") from None
        except (AttributeError, TypeError, ValueError, IndexError, OverflowError) as error:
            raise InputError(f"{path} is not an mmWave Studio .mmwave.json ({error})") from None


def is_mmwave_studio(values: Any) -> bool:
    """Whether decoded JSON looks like mmWave Studio's."""
    return isinstance(values, dict) and "mmWaveDevices" in values


def _setup(name: str, device: Any) -> TiSetup:
    setup, capture = device["rfConfig"], device.get("rawDataCaptureConfig", {})
    if _whole(setup["rlChanCfg_t"].get("cascading", 0)) != 0:
        raise InputError("it is a cascade of several chips, which cannot be read; use one chip")
    frames, period_ms = _frames(setup)
    profiles = [entry["rlProfileCfg_t"] for entry in setup["rlProfiles"]]
    lanes = _whole(capture.get("rlDevLaneEnable_t", {}).get("laneEn", 0))
    swap = _whole(capture.get("rlDevDataFmtCfg_t", {}).get("iqSwapSel", 0))
    found = TiSetup(
        name=name,
        profiles={_whole(profile["profileId"]): _profile(profile) for profile in profiles},
        frames=frames,
        has_sub_frames=len(frames) > 1,
        frame_period_ms=period_ms,
        rx_mask=_whole(setup["rlChanCfg_t"]["rxChannelEn"]),
        tx_mask=_whole(setup["rlChanCfg_t"]["txChannelEn"]),
        complex_samples=_whole(setup["rlAdcOutCfg_t"]["fmt"]["b2AdcOutFmt"]) != 0,
        lvds_iq_order="qi" if swap == 1 else "iq",
        lvds_lanes=4 if lanes.bit_count() == 4 else 2,
    )
    for entry in setup["rlChirps"]:
        chirp = entry["rlChirpCfg_t"]
        if varied := [key for key in VARIATIONS if float(chirp[key]) != 0]:
            raise InputError(
                f"chirp {chirp['chirpStartIdx']} has {varied[0]} {chirp[varied[0]]}; all must be identical"
            )
        one = TiChirp(profile=_whole(chirp["profileId"]), tx_mask=_whole(chirp["txEnable"]))
        found.add_chirps(*_span(chirp), one)
    for entry in setup.get("rlBpmChirps") or []:  # odd bits of constBpmVal invert a transmitter
        chirp = entry["rlBpmChirpCfg_t"]
        bits = _whole(chirp["constBpmVal"])
        _turn(found, chirp, [180.0 * (bits >> (2 * tx + 1) & 1) for tx in range(MAX_TX)])
    for entry in setup.get("rlRfPhaseShiftCfgs") or []:
        chirp = entry["rlRfPhaseShiftCfg_t"]
        _turn(found, chirp, [-SHIFTER_DEG * _whole(chirp.get(f"tx{tx}PhaseShift", 0)) for tx in range(MAX_TX)])
    return found


def _turn(setup: TiSetup, entry: Any, phase_deg: list[float]) -> None:
    """Adds transmitter phases to a span of chirps."""
    first, last = _span(entry)
    for number, chirp in setup.chirps.items():
        if first <= number <= last:
            added = tuple(map(sum, zip(chirp.phase_deg, phase_deg, strict=True)))
            setup.chirps[number] = replace(chirp, phase_deg=added)


def _profile(profile: Any) -> TiProfile:
    return TiProfile(
        start_frequency_ghz=float(profile["startFreqConst_GHz"]),
        idle_time_us=float(profile["idleTimeConst_usec"]),
        adc_start_time_us=float(profile["adcStartTimeConst_usec"]),
        ramp_end_time_us=float(profile["rampEndTime_usec"]),
        slope_mhz_per_us=float(profile["freqSlopeConst_MHz_usec"]),
        num_samples=_whole(profile["numAdcSamples"]),
        sample_rate_ksps=float(profile["digOutSampleRate"]),
        rx_gain_db=float(_whole(profile["rxGain_dB"]) & 0x3F),
        phase_code=_whole(profile.get("txPhaseShifter", 0)),
    )


def _frames(setup: Any) -> tuple[list[TiFrame], float]:
    """The plain frame or the sub-frames of an advanced one, and the period of the entire frame in ms."""
    waveform = setup.get("waveformType", PLAIN_FRAMES[0])  # omitted by writers other than mmWave Studio
    if waveform in PLAIN_FRAMES:
        frame = setup["rlFrameCfg_t"]
        first, last = _span(frame)
        frames = [TiFrame(first=first, last=last, num_loops=_whole(frame["numLoops"]))]
        return frames, float(frame["framePeriodicity_msec"])
    if waveform != "advancedFrameChirp":
        raise InputError(f"waveform {waveform!r} cannot be read; use frames of chirps")
    sequence = setup["rlAdvFrameCfg_t"]["frameSeq"]
    entries = [entry["rlSubFrameCfg_t"] for entry in sequence["subFrameCfg"]][: _whole(sequence["numOfSubFrames"])]
    frames = []
    for index, entry in enumerate(entries):
        if _whole(entry["numOfBurst"]) != 1 or _whole(entry["numOfBurstLoops"]) != 1:
            raise InputError(f"sub-frame {index} has several bursts, which cannot be read; use one")
        first, count, loops = (_whole(entry[key]) for key in ("chirpStartIdx", "numOfChirps", "numLoops"))
        frames.append(TiFrame(first=first, last=first + count - 1, num_loops=loops))
    return frames, sum(float(entry["subFramePeriodicity_msec"]) for entry in entries)


def _span(entry: Any) -> tuple[int, int]:
    return _whole(entry["chirpStartIdx"]), _whole(entry["chirpEndIdx"])


def _whole(value: Any) -> int:
    """An integer, or a hexadecimal string, the format of mmWave Studio's masks."""
    if isinstance(value, str):
        return int(value, 0)
    if isinstance(value, bool) or value != int(value):
        raise InputError(f"{value!r} must be a whole number")
    return int(value)
