"""mmWave Studio's Lua scripts: the ar1 calls that configure a radar, converted to lines of a .cfg.

Arguments are numbers, or names to which the script assigns a number. Reference: TI mmWave Studio User Guide and its
example scripts (DataCaptureDemo_xWR.lua).
"""

import math
import re
from dataclasses import replace
from pathlib import Path

from mmweaver.core.errors import InputError, file_named
from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.safe_files.safe_text import read_text
from mmweaver.io.radar_options import RadarOptions
from mmweaver.io.ti_cfg import Line, Lines, setup_of_lines
from mmweaver.io.ti_chirps import SHIFTER_DEG, radar_from_ti

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
        setup = setup_of_lines(path.stem, _cfg_lines(calls))
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
        "profileCfg": [(line, _profile(line.values)) for line in calls["ProfileConfig"]],
        "chirpCfg": [(line, (*line.values[:7], _mask(line.values[7:10]))) for line in calls["ChirpConfig"]],
        "frameCfg": [(frame, (first, last, loops, frames, period_ms, 1.0, 0.0))],
    }
    return {
        command: [Line(line.number, command, values) for line, values in found] for command, found in commands.items()
    }


def _profile(values: tuple[float, ...]) -> tuple[float, ...]:
    """profileCfg: id, GHz, idle, ADC start, ramp end in us, back-off, phases, slope, TX start, samples, rate, gain."""
    code = sum(round(degrees / SHIFTER_DEG) % 64 << (8 * tx + 2) for tx, degrees in enumerate(values[8:11]))
    gain_db = values[17] if len(values) > 17 else 30.0
    return (*values[:5], 0.0, float(code), *values[11:15], 0.0, 0.0, gain_db)


def _mask(enabled: tuple[float, ...]) -> float:
    return float(sum(1 << index for index, one in enumerate(enabled) if one))
