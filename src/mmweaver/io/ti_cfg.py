"""The .cfg of TI's mmWave SDK: one command per line, % for comments.

Reference: mmWave SDK User Guide, "Configuration (.cfg) File Format".

Antennas of the board of a TI .cfg: from its antenna lines, else from the platform named in its comments.

A platform is often just xWR68xx, which exists with four antenna layouts; channel phases (compRangeBiasAndRxChanPhase)
that invert the receivers of an AOP or ODS then identify it. Reference: TI, 3D People Tracking tuning guide
(antGeometry0, antGeometry1, antPhaseRot); mmWave MCU+ SDK (antGeometryCfg); header comments of TI's mmWave Demo
Visualizer.
"""

import math
import re
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from mmweaver.core.boards import ANTENNAS
from mmweaver.core.errors import InputError, file_named
from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.safe_files.safe_text import read_text
from mmweaver.core.virtual_array import AntennaTable, table_of_virtual_array
from mmweaver.io.radar_options import RadarOptions, split_radar
from mmweaver.io.ti_chirps import MAX_TX, SHIFTER_DEG, TiChirp, TiFrame, TiProfile, TiSetup, radar_from_ti

NUM_RX = 4
TURNED = tuple(ANTENNAS[board] for board in ("aop", "ods"))  # boards with inverted receivers


def antennas_of_cfg(values: dict[str, tuple[float, ...]], platform: str) -> AntennaTable | None:
    """Determines the antennas of a .cfg.

    Args:
        values: Numbers of each command.
        platform: Platform named in the comments, lower-case letters and digits only.

    Returns:
        Antenna table; None if the file does not identify it.

    Raises:
        InputError: If the antenna lines do not describe a board.
    """
    if "antGeometry0" in values and "antGeometry1" in values:
        column, row = np.array(values["antGeometry0"]), np.array(values["antGeometry1"])
        if len(column) != len(row):
            raise InputError("antGeometry0 and antGeometry1 differ in length")
        turned = values.get("antPhaseRot", (1.0,) * len(row))
        inverted = tuple(rx for rx, sign in enumerate(turned[:NUM_RX]) if sign < 0)
        if len(turned) >= NUM_RX and turned[0] < 0:  # a common sign is irrelevant
            inverted = tuple(rx for rx in range(NUM_RX) if rx not in inverted)
        places = np.stack([-column, row], axis=1)
        return table_of_virtual_array("antGeometry", places, NUM_RX, inverted, "antGeometry0/1 of the .cfg")
    if "antGeometryCfg" in values:
        numbers = values["antGeometryCfg"]
        if len(numbers) % 2:
            raise InputError("antGeometryCfg holds an odd number of numbers; it takes pairs and two distances")
        pairs, (across, up) = np.array(numbers[:-2]).reshape(-1, 2), numbers[-2:]
        places = np.stack([2 * across * pairs[:, 1], -2 * up * pairs[:, 0]], axis=1)
        return table_of_virtual_array("antGeometryCfg", places, NUM_RX, source="antGeometryCfg of the .cfg")
    if platform in ("", "xwr68xx", "xwr64xx") and (
        turned := _turned_receivers(values.get("compRangeBiasAndRxChanPhase", ()))
    ):
        return next((board for board in TURNED if board.rx_inverted == turned), None)
    named = [(len(part), name) for name in ANTENNAS for part in ANTENNAS[name].platforms if part in platform]
    return ANTENNAS[max(named)[1]] if named else None


def _turned_receivers(compensation: tuple[float, ...]) -> tuple[int, ...]:
    """Receivers inverted by the channel phases, equal for all transmitters; () for any other phases."""
    factors = np.array(compensation[1:])
    if not factors.size or factors.size % (2 * NUM_RX):
        return ()
    each = factors.reshape(-1, NUM_RX, 2)
    if not (np.abs(each[..., 0]) == 1).all() or each[..., 1].any() or (each != each[0]).any():
        return ()
    return tuple(int(rx) for rx in np.flatnonzero(each[0, :, 0] < 0))


MAX_CFG_BYTES = 2**20
# minimum number of arguments per command (later SDKs append more)
NEEDED = {"channelCfg": 2, "adcCfg": 2, "profileCfg": 14, "chirpCfg": 8}
OPTIONAL = {
    "frameCfg": 6,
    "advFrameCfg": 5,
    "subFrameCfg": 10,
    "adcbufCfg": 4,
    "bpmCfg": 4,
    "ddmPhaseShiftAntOrder": 2,
    "lvdsStreamCfg": 4,
    "antGeometry0": 0,
    "antGeometry1": 0,
    "antPhaseRot": 0,
    "antGeometryCfg": 2,
    "compRangeBiasAndRxChanPhase": 0,
}
REFUSED = {
    "contModeCfg": "continuous mode",
    "advChirpCfg": "advanced chirps",
    "LUTDataCfg": "advanced chirps",
}
OTHER_DEVICES = {"chirpComnCfg": "a low-power xWRL device"}
ADC_FORMATS = {0: False, 1: True, 2: True}  # adcCfg's second number: real, complex 1x, complex 2x
MAX_NAME = 100  # letters of a radar's name
MCU_FRAME_NUMBERS = 8  # frameCfg of the MCU+ SDK, which inserts the number of samples before the period
CHIRP_VARIATIONS = ("start frequency", "slope", "idle time", "ADC start time")
FOUR_LANE_PLATFORMS = ("12xx", "14xx", "1243", "1443")  # devices with four LVDS lanes


@dataclass(frozen=True)
class Line:
    """A command with its numbers and its line number in the file."""

    number: int
    command: str
    values: tuple[float, ...]

    def whole(self, at: int) -> int:
        """Number `at` as an integer.

        Raises:
            InputError: If it is not an integer.
        """
        value = self.values[at]
        if value != int(value):
            raise InputError(f"line {self.number}: number {at + 1} of {self.command} must be whole, not {value:g}")
        return int(value)

    def wholes(self, count: int) -> list[int]:
        """The first `count` numbers as integers.

        Raises:
            InputError: If one is not an integer.
        """
        return [self.whole(at) for at in range(count)]


Lines = dict[str, list[Line]]  # by command


def read_ti_cfg(path: Path | str, options: RadarOptions | None = None) -> RadarConfig:
    """Reads the radar that a .cfg configures.

    Args:
        path: The file, after which the radar is named.
        options: Sub-frame of an advanced frame, antennas and lanes of the board. Default: as in the file.

    Returns:
        The radar.

    Raises:
        InputError: If the file cannot be read, lines are missing or too short, chirps differ or cannot be separated, or
            the radar is impossible.
    """
    path = Path(path)
    lines, text = ti_cfg_lines(path), _text(path)
    platform = platform_of(text)
    with file_named(path):
        last = {command: found[-1].values for command, found in lines.items()}
        setup = setup_of_lines(path.stem[:MAX_NAME], lines)
        is_four = any(part in platform for part in FOUR_LANE_PLATFORMS) or adc_buffer(lines)[1] == 0
        setup = replace(setup, antennas=antennas_of_cfg(last, platform), lvds_lanes=4 if is_four else 2)
        return radar_from_ti(setup, options or RadarOptions())


def refuse_headers(name: str) -> None:
    """Refuses recordings with HSI headers between the samples.

    Args:
        name: Radar as in `load_radar`; only a .cfg is checked.

    Raises:
        InputError: If lvdsStreamCfg enables headers.
    """
    path = cfg_path(name)
    for line in [] if path is None else ti_cfg_lines(path).get("lvdsStreamCfg", [])[-1:]:
        if line.values[1] != 0:
            raise InputError(
                f"{path}, line {line.number}: the samples have HSI headers (lvdsStreamCfg's second number);"
                " record without them"
            )


def cfg_path(name: str) -> Path | None:
    """Path of the .cfg behind a radar's name (options may follow); None for a preset or another file."""
    path = Path(split_radar(name)[0])
    return path if path.suffix.lower() == ".cfg" and path.is_file() else None


def adc_buffer(lines: Lines) -> tuple[float, float]:
    """Reads SampleSwap and interleaving from adcbufCfg.

    SDK 1 has four numbers (format, swap, interleave, threshold); later versions prepend the sub-frame.

    Args:
        lines: Lines by command.

    Returns:
        SampleSwap (1: Q first) and interleaving (0: interleaved); -1 if the line is missing.
    """
    if "adcbufCfg" not in lines:
        return -1.0, -1.0
    values = lines["adcbufCfg"][-1].values
    swap, interleave = values[1:3] if len(values) == 4 else values[2:4]
    return swap, interleave


def platform_of(text: str) -> str:
    """Platform named in the comments, reduced to lower-case letters and digits; "" if there is none."""
    found = re.search(r"%\s*platform\s*:\s*(\S+)", text, re.IGNORECASE)
    return "" if found is None else re.sub(r"[^a-z0-9]", "", found[1].lower())


def _text(path: Path) -> str:
    return read_text(path, max_bytes=MAX_CFG_BYTES, errors="replace")


def ti_cfg_lines(path: Path, more: dict[str, int] | None = None) -> Lines:
    """Reads the lines of all known commands.

    Args:
        path: The file.
        more: Further commands with their minimum number of arguments. Default: none.

    Returns:
        Lines by command.

    Raises:
        InputError: As in `read_ti_cfg`.
    """
    counts, text = {**NEEDED, **OPTIONAL, **(more or {})}, _text(path)
    if text.lstrip().startswith("{"):
        raise InputError(f"{path} is JSON, as pymmw has it; give the commands that are sent to the board, one per line")
    found: Lines = {}
    for number, raw in enumerate(text.splitlines(), 1):
        command, *words = raw.split("%")[0].split() or [""]
        with file_named(f"{path}, line {number}"):
            if command in REFUSED:
                raise InputError(f"{REFUSED[command]} ({command}) cannot be read; use frames of chirps")
            if command in OTHER_DEVICES:
                raise InputError(
                    f"{command} is for {OTHER_DEVICES[command]}, which cannot be read; describe its chirp in a"
                    " radar.json (mmweaver radar iwr6843isk --json > radar.json)"
                )
            if command in counts:
                values = _numbers(command, words, counts[command])
                found.setdefault(command, []).append(Line(number, command, values))
    missing = [command for command in NEEDED if command not in found]
    if "frameCfg" not in found and not {"advFrameCfg", "subFrameCfg"} <= found.keys():
        missing.append("frameCfg")
    if missing:
        raise InputError(f"{path} lacks {', '.join(missing)}; is it a mmWave SDK .cfg?")
    return found


def _numbers(command: str, words: list[str], needed: int) -> tuple[float, ...]:
    try:
        values = tuple(map(float, words))
    except ValueError:
        raise InputError(f"{command} holds something that is not a number: {' '.join(words)}") from None
    if len(values) < needed:
        raise InputError(f"{command} has {len(values)} numbers, it needs {needed}")
    if not all(map(math.isfinite, values)):
        raise InputError(f"{command} holds a number that is not finite")
    return values


def setup_of_lines(name: str, lines: Lines) -> TiSetup:
    """Converts the commands of a file to a configuration in TI's units.

    Args:
        name: Name of the radar.
        lines: Lines by command.

    Returns:
        The configuration, without antennas.

    Raises:
        InputError: As in `read_ti_cfg`.
    """
    channel, adc = lines["channelCfg"][-1], lines["adcCfg"][-1]
    if adc.whole(1) not in ADC_FORMATS:
        raise InputError(
            f"line {adc.number}: adcCfg has ADC format {adc.whole(1)}; known are 0 (real), 1 and 2 (complex)"
        )
    frames, period_ms = _frames(lines)
    setup = TiSetup(
        name=name,
        profiles={line.whole(0): _profile(line) for line in lines["profileCfg"]},
        frames=frames,
        has_sub_frames="advFrameCfg" in lines,
        frame_period_ms=period_ms,
        rx_mask=channel.whole(0),
        tx_mask=channel.whole(1),
        complex_samples=ADC_FORMATS[adc.whole(1)],
        lvds_iq_order="qi" if adc_buffer(lines)[0] == 1 else "iq",
        lvds_lanes=2,
    )
    for line in lines["chirpCfg"]:
        for what, value in zip(CHIRP_VARIATIONS, line.values[3:7], strict=True):
            if value != 0:
                raise InputError(
                    f"line {line.number}: chirpCfg varies the {what} ({value:g}); all chirps must be identical"
                )
        first, last, profile = line.wholes(3)
        with file_named(f"line {line.number}"):
            setup.add_chirps(first, last, TiChirp(profile=profile, tx_mask=line.whole(7)))
    _add_bpm(lines, setup)
    for frame in frames:
        _add_ddm(lines, setup, frame)
    return setup


def _profile(line: Line) -> TiProfile:
    return TiProfile(
        start_frequency_ghz=line.values[1],
        idle_time_us=line.values[2],
        adc_start_time_us=line.values[3],
        ramp_end_time_us=line.values[4],
        phase_code=line.whole(6),
        slope_mhz_per_us=line.values[7],
        num_samples=line.whole(9),
        sample_rate_ksps=line.values[10],
        rx_gain_db=float(line.whole(13) & 0x3F),
    )


def _frames(lines: Lines) -> tuple[list[TiFrame], float]:
    """The plain frame or the sub-frames, and the period of the entire frame in ms.

    subFrameCfg: number, forced profile, first chirp, chirps, loops, burst ms, offset, bursts, repeats, period ms.
    """
    if "advFrameCfg" not in lines:
        line = lines["frameCfg"][-1]
        first, last, loops = line.wholes(3)
        period_ms = line.values[5 if len(line.values) >= MCU_FRAME_NUMBERS else 4]
        return [TiFrame(first=first, last=last, num_loops=loops)], period_ms
    found: dict[int, TiFrame] = {}
    for line in lines["subFrameCfg"]:
        index, _, first, count, loops = line.wholes(5)
        if line.whole(7) != 1 or line.whole(8) != 1:
            raise InputError(f"line {line.number}: sub-frame {index} has several bursts, which cannot be read; use one")
        found[index] = TiFrame(first=first, last=first + count - 1, num_loops=loops)
    if sorted(found) != list(range(len(found))):
        raise InputError(f"its sub-frames are {sorted(found)}; they must be numbered from 0 on")
    return [found[index] for index in range(len(found))], sum(line.values[9] for line in lines["subFrameCfg"])


def _add_bpm(lines: Lines, setup: TiSetup) -> None:
    """bpmCfg: sub-frame, enabled, first and second chirp. The second chirp inverts its last transmitter."""
    for line in lines.get("bpmCfg", []):
        index, enabled, _, second = line.wholes(4)
        frames = setup.frames if index == -1 else setup.frames[max(index, 0) :][:1]
        if enabled != 1:
            continue
        if not any(frame.first <= second <= frame.last for frame in frames):
            raise InputError(f"line {line.number}: bpmCfg names chirp {second}, which the frame does not send")
        if (chirp := setup.chirps.get(second)) is not None:
            phase_deg = [180.0 * (tx == chirp.tx_mask.bit_length() - 1) for tx in range(MAX_TX)]
            setup.chirps[second] = replace(chirp, phase_deg=tuple(phase_deg))


def _add_ddm(lines: Lines, setup: TiSetup, frame: TiFrame) -> None:
    """Doppler-division MIMO (AWR2944, AWR2544) by ddmPhaseShiftAntOrder, whose phases replace those of BPM.

    The k-th transmitter of the line advances by k of N steps of 360/N degrees from chirp to chirp, with N chirps per
    loop (more than transmitters, which leaves empty bands), rounded to the phase shifter's resolution. The demo counts
    chirps backwards, since samples (ramp times conjugate echo) rotate opposite to the shifter. Source: TI's MCU+ SDK
    demo for the AWR294x and AWR2544, where it sets rlRfPhaseShiftCfg_t.
    """
    numbers = [number for number in sorted(setup.chirps) if frame.first <= number <= frame.last]
    masks = {setup.chirps[number].tx_mask for number in numbers}
    if "ddmPhaseShiftAntOrder" not in lines or len(masks) != 1 or min(masks).bit_count() < 2:
        return
    line, count = lines["ddmPhaseShiftAntOrder"][-1], len(numbers)
    order = line.wholes(len(line.values))
    fired = [tx for tx in range(MAX_TX) if min(masks) >> tx & 1]
    if len(set(order)) < len(order) or not set(fired) <= set(order):
        raise InputError(f"line {line.number}: ddmPhaseShiftAntOrder must name each transmitter that fires once")
    if count < len(fired):
        raise InputError(
            f"line {line.number}: Doppler-division MIMO of {len(fired)} transmitters needs as many chirps in a loop,"
            f" not {count}"
        )
    multiple = {tx: place for place, tx in enumerate(one for one in order if one in fired)}
    step_deg = 360 / SHIFTER_DEG / count
    for at, number in enumerate(numbers):
        phase_deg = [-SHIFTER_DEG * round(-at * multiple.get(tx, 0) % count * step_deg) for tx in range(MAX_TX)]
        setup.chirps[number] = replace(setup.chirps[number], phase_deg=tuple(phase_deg))
