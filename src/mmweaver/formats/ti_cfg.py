"""The .cfg of TI's mmWave SDK: one command per line, % for comments.

Reference: mmWave SDK User Guide, "Configuration (.cfg) File Format".
"""

import math
from dataclasses import dataclass
from pathlib import Path

from mmweaver.core.errors import InputError
from mmweaver.core.radar_config import RadarConfig
from mmweaver.formats.ti_chirps import TiChirps, radar_from_ti

# command: minimum count of numbers that follow it (later SDKs append more)
NEEDED = {"channelCfg": 2, "adcCfg": 2, "profileCfg": 14, "chirpCfg": 8, "frameCfg": 6}
OPTIONAL = {"adcbufCfg": 4}
REFUSED = {
    "advFrameCfg": "advanced frames",
    "subFrameCfg": "subframes",
    "bpmCfg": "BPM-MIMO (bpmCfg)",
}
ADC_FORMATS = {0: False, 1: True, 2: True}  # adcCfg's second number: real, complex 1x, complex 2x
CHIRP_VARIATIONS = ("start frequency", "slope", "idle time", "ADC start time")


@dataclass(frozen=True)
class Line:
    """The numbers of a command, and its line number in the file."""

    number: int
    values: tuple[float, ...]


def read_ti_cfg(path: Path | str) -> RadarConfig:
    """The radar that a .cfg configures, named after the file.

    Raises InputError where the file cannot be read, lines are missing or have too few numbers, chirps differ or do not
    fire one transmitter after the other, or the radar could not exist.
    """
    path = Path(path)
    lines = ti_cfg_lines(path)
    try:
        return radar_from_ti(_chirps(path.stem, lines))
    except InputError as error:
        text = str(error)
        raise InputError(text if text.startswith(str(path)) else f"{path}: {text}") from None


def read_ti_cfg_iq_order(path: Path | str) -> str:
    """The I/Q order of a recording with this .cfg, "iq" or "qi", from adcbufCfg's SampleSwap ("iq" without it)."""
    lines = ti_cfg_lines(Path(path)).get("adcbufCfg")
    if not lines:
        return "iq"
    values = lines[-1].values
    # SDK 1 has four numbers (format, swap, interleave, threshold); later versions put the subframe before them
    swap = values[1] if len(values) == 4 else values[2]
    return "qi" if swap == 1 else "iq"


def ti_cfg_lines(path: Path, more: dict[str, int] | None = None) -> dict[str, list[Line]]:
    """The lines of the radar's commands and of those in `more` (with their minimum count of numbers), by command.

    Raises InputError as `read_ti_cfg` does.
    """
    counts = {**NEEDED, **OPTIONAL, **(more or {})}
    try:
        text = path.read_text(encoding="utf-8", errors="replace")
    except OSError as error:
        raise InputError(f"cannot read {path}: {error.strerror or error}") from None
    found: dict[str, list[Line]] = {}
    for number, raw in enumerate(text.splitlines(), 1):
        words = raw.split("%")[0].split()
        if not words:
            continue
        command, *rest = words
        if command in REFUSED and not _is_off(command, rest):
            raise InputError(
                f"{path}, line {number}: {REFUSED[command]} cannot be read; use one legacy frame of TDM chirps"
            )
        if command in counts:
            found.setdefault(command, []).append(Line(number, _numbers(path, number, command, rest, counts[command])))
    if missing := [command for command in NEEDED if command not in found]:
        raise InputError(f"{path} lacks {', '.join(missing)}; is it a mmWave SDK .cfg?")
    return found


def _is_off(command: str, words: list[str]) -> bool:
    """bpmCfg <subframe> <enabled> ...: the demos' files have it disabled."""
    return command == "bpmCfg" and len(words) > 1 and words[1] == "0"


def _numbers(path: Path, number: int, command: str, words: list[str], needed: int) -> tuple[float, ...]:
    try:
        values = tuple(float(word) for word in words)
    except ValueError:
        raise InputError(
            f"{path}, line {number}: {command} holds something that is not a number: {' '.join(words)}"
        ) from None
    if len(values) < needed:
        raise InputError(f"{path}, line {number}: {command} has {len(values)} numbers, it needs {needed}")
    if not all(math.isfinite(value) for value in values):
        raise InputError(f"{path}, line {number}: {command} holds a number that is not finite")
    return values


def _chirps(name: str, lines: dict[str, list[Line]]) -> TiChirps:
    channel, adc, frame = (lines[command][-1] for command in ("channelCfg", "adcCfg", "frameCfg"))
    first, last, num_loops = (whole(frame, "frameCfg", at) for at in range(3))
    masks, profile_ids = _fired(lines["chirpCfg"], first, last)
    if len(profile_ids) != 1:
        raise InputError(f"the frame's chirps use profiles {sorted(profile_ids)}; only one profile can be read")
    profiles = {whole(line, "profileCfg", 0): line for line in lines["profileCfg"]}
    profile = profiles.get(min(profile_ids))
    if profile is None:
        raise InputError(f"the chirps use profile {min(profile_ids)}, which no profileCfg defines")
    adc_format = whole(adc, "adcCfg", 1)
    if adc_format not in ADC_FORMATS:
        raise InputError(
            f"line {adc.number}: adcCfg has ADC format {adc_format}; known are 0 (real), 1 and 2 (complex)"
        )
    return TiChirps(
        name=name,
        start_frequency_ghz=profile.values[1],
        idle_time_us=profile.values[2],
        adc_start_time_us=profile.values[3],
        ramp_end_time_us=profile.values[4],
        slope_mhz_per_us=profile.values[7],
        num_samples=whole(profile, "profileCfg", 9),
        sample_rate_ksps=profile.values[10],
        rx_gain_db=float(whole(profile, "profileCfg", 13) & 0x3F),
        rx_mask=whole(channel, "channelCfg", 0),
        tx_mask=whole(channel, "channelCfg", 1),
        chirp_tx_masks=masks,
        num_loops=num_loops,
        frame_period_ms=frame.values[4],
        complex_samples=ADC_FORMATS[adc_format],
    )


def _fired(lines: list[Line], first: int, last: int) -> tuple[tuple[int, ...], set[int]]:
    """Transmitter mask of each chirp from first to last, and the profiles they use."""
    masks: dict[int, int] = {}
    profiles: dict[int, int] = {}
    for line in lines:
        start, end, profile, mask = (whole(line, "chirpCfg", at) for at in (0, 1, 2, 7))
        if not 0 <= start <= end <= 511:
            raise InputError(f"line {line.number}: chirpCfg runs from chirp {start} to {end}; it must lie in 0 to 511")
        for what, value in zip(CHIRP_VARIATIONS, line.values[3:7], strict=True):
            if value != 0:
                raise InputError(
                    f"line {line.number}: chirpCfg varies the {what} ({value:g}); all chirps must be identical"
                )
        for chirp in range(start, end + 1):
            masks[chirp], profiles[chirp] = mask, profile
    if not 0 <= first <= last <= 511:
        raise InputError(f"frameCfg runs from chirp {first} to {last}; it must lie in 0 to 511")
    wanted = range(first, last + 1)
    if missing := [chirp for chirp in wanted if chirp not in masks]:
        raise InputError(f"frameCfg uses chirp {missing[0]}, which no chirpCfg defines")
    return tuple(masks[chirp] for chirp in wanted), {profiles[chirp] for chirp in wanted}


def whole(line: Line, command: str, at: int) -> int:
    """Number `at` of a line as an integer. Raises InputError where it is not one."""
    value = line.values[at]
    if value != int(value):
        raise InputError(f"line {line.number}: number {at + 1} of {command} must be whole, not {value:g}")
    return int(value)
