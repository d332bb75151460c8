"""The .cfg of TI's mmWave SDK: one command per line, % for comments.

Reference: mmWave SDK User Guide, "Configuration (.cfg) File Format".
"""

import math
from dataclasses import dataclass, replace
from pathlib import Path

from mmweaver.core.antenna_tables import AntennaTable
from mmweaver.core.errors import InputError
from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.safe_files.safe_text import read_text
from mmweaver.formats.radar_options import split_radar
from mmweaver.formats.ti_antennas import antennas_of_cfg, has_four_lanes
from mmweaver.formats.ti_chirps import MOST_TX, SHIFTER_DEG, SubFrame, TiChirps, profile_phases_deg, radar_from_ti

MAX_CFG_BYTES = 2**20
# command: minimum count of numbers that follow it (later SDKs append more)
NEEDED = {"channelCfg": 2, "adcCfg": 2, "profileCfg": 14, "chirpCfg": 8}
FRAMES = {"frameCfg": 6, "advFrameCfg": 5, "subFrameCfg": 10}  # one of the first two
OPTIONAL = {"adcbufCfg": 4, "bpmCfg": 4, "ddmPhaseShiftAntOrder": 2, "lvdsStreamCfg": 4}
REFUSED = {"contModeCfg": "continuous mode", "advChirpCfg": "advanced chirps", "LUTDataCfg": "advanced chirps"}
OTHER_DEVICES = {"chirpComnCfg": "a low-power xWRL device"}
ADC_FORMATS = {0: False, 1: True, 2: True}  # adcCfg's second number: real, complex 1x, complex 2x
MCU_FRAME_NUMBERS = 8  # of frameCfg in the MCU+ SDK, which has the number of samples before the period
CHIRP_VARIATIONS = ("start frequency", "slope", "idle time", "ADC start time")


@dataclass(frozen=True)
class Line:
    """The numbers of a command, and its line number in the file."""

    number: int
    values: tuple[float, ...]


def read_ti_cfg(
    path: Path | str, *, sub_frame: int | None = None, antennas: AntennaTable | None = None, lanes: int | None = None
) -> RadarConfig:
    """The radar that a .cfg configures, named after the file.

    `sub_frame` chooses one of an advanced frame; `antennas` and `lanes` replace the board's table and the lanes of its
    recordings. Raises InputError where the file cannot be read, lines are missing or have too few numbers, chirps
    differ or cannot be separated, or the radar could not exist.
    """
    path = Path(path)
    lines = ti_cfg_lines(path)
    text = read_text(path, max_bytes=MAX_CFG_BYTES, errors="replace")
    try:
        antennas = antennas or antennas_of_cfg(text)
    except InputError as error:
        raise InputError(f"{path}: {error}") from None
    lanes = lanes or (4 if has_four_lanes(text) or _is_interleaved(lines) else 2)
    return radar_of_lines(path, lines, sub_frame=sub_frame, antennas=antennas, lanes=lanes)


def radar_of_lines(
    path: Path, lines: dict[str, list[Line]], *, sub_frame: int | None, antennas: AntennaTable | None, lanes: int
) -> RadarConfig:
    """The radar of a file's commands, by command. Raises InputError as `read_ti_cfg` does."""
    try:
        chirps = _chirps(path.stem, lines, sub_frame)
        return radar_from_ti(replace(chirps, antennas=antennas, lvds_lanes=lanes, lvds_iq_order=_iq_order(lines)))
    except InputError as error:
        text = str(error)
        raise InputError(text if text.startswith(str(path)) else f"{path}: {text}") from None


def read_ti_cfg_iq_order(path: Path | str) -> str:
    """The I/Q order of a recording with this .cfg, "iq" or "qi", from adcbufCfg's SampleSwap ("iq" without it)."""
    return _iq_order(ti_cfg_lines(Path(path)))


def refuse_headers(name: str) -> None:
    """Raises InputError where a .cfg (options may follow its name) puts HSI headers between the recorded samples."""
    path = Path(split_radar(name)[0])
    if path.suffix.lower() != ".cfg" or not path.is_file():
        return
    for line in ti_cfg_lines(path).get("lvdsStreamCfg", [])[-1:]:
        if line.values[1] != 0:
            raise InputError(
                f"{path}, line {line.number}: the samples have HSI headers (lvdsStreamCfg's second number);"
                " record without them"
            )


def _iq_order(lines: dict[str, list[Line]]) -> str:
    if "adcbufCfg" not in lines:
        return "iq"
    values = lines["adcbufCfg"][-1].values
    # SDK 1 has four numbers (format, swap, interleave, threshold); later versions put the subframe before them
    swap = values[1] if len(values) == 4 else values[2]
    return "qi" if swap == 1 else "iq"


def ti_cfg_lines(path: Path, more: dict[str, int] | None = None) -> dict[str, list[Line]]:
    """The lines of the radar's commands and of those in `more` (with their minimum count of numbers), by command.

    Raises InputError as `read_ti_cfg` does.
    """
    counts = {**NEEDED, **FRAMES, **OPTIONAL, **(more or {})}
    text = read_text(path, max_bytes=MAX_CFG_BYTES, errors="replace")
    if text.lstrip().startswith("{"):
        raise InputError(f"{path} is JSON, as pymmw has it; give the commands that are sent to the board, one per line")
    found: dict[str, list[Line]] = {}
    for number, raw in enumerate(text.splitlines(), 1):
        words = raw.split("%")[0].split()
        if not words:
            continue
        command, *rest = words
        if command in REFUSED:
            raise InputError(
                f"{path}, line {number}: {REFUSED[command]} ({command}) cannot be read; use frames of chirps"
            )
        if command in OTHER_DEVICES:
            raise InputError(
                f"{path}, line {number}: {command} is for {OTHER_DEVICES[command]}, which cannot be read; describe its"
                " chirp in a radar.json (mmweaver radar iwr6843isk --json > radar.json)"
            )
        if command in counts:
            found.setdefault(command, []).append(Line(number, _numbers(path, number, command, rest, counts[command])))
    missing = [command for command in NEEDED if command not in found]
    if "frameCfg" not in found and not {"advFrameCfg", "subFrameCfg"} <= found.keys():
        missing.append("frameCfg")
    if missing:
        raise InputError(f"{path} lacks {', '.join(missing)}; is it a mmWave SDK .cfg?")
    return found


def _is_interleaved(lines: dict[str, list[Line]]) -> bool:
    """Whether receivers are interleaved in the ADC buffer (adcbufCfg), as xWR12xx and xWR14xx alone do."""
    if "adcbufCfg" not in lines:
        return False
    values = lines["adcbufCfg"][-1].values
    return (values[2] if len(values) == 4 else values[3]) == 0


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


def _chirps(name: str, lines: dict[str, list[Line]], sub_frame: int | None) -> TiChirps:
    channel, adc = lines["channelCfg"][-1], lines["adcCfg"][-1]
    frame = _frame(lines, sub_frame)
    masks, profile_ids = _fired(lines["chirpCfg"], frame.first, frame.last)
    profile = _profile(lines, profile_ids)
    adc_format = whole(adc, "adcCfg", 1)
    if adc_format not in ADC_FORMATS:
        raise InputError(
            f"line {adc.number}: adcCfg has ADC format {adc_format}; known are 0 (real), 1 and 2 (complex)"
        )
    return TiChirps(
        name=name if frame.index is None else f"{name}_{frame.index}",
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
        num_loops=frame.num_loops,
        frame_period_ms=frame.period_ms,
        complex_samples=ADC_FORMATS[adc_format],
        chirp_phase_deg=_ddm_phases(lines, masks) or _bpm_phases(lines, masks, frame),
        profile_phase_deg=profile_phases_deg(whole(profile, "profileCfg", 6)),
        sub_frame=_others(lines, frame),
    )


def fired_transmitters(lines: dict[str, list[Line]], sub_frame: int | None) -> list[int]:
    """Numbers of the board's transmitters that the frame, or a sub-frame, uses."""
    frame = _frame(lines, sub_frame)
    masks, _ = _fired(lines["chirpCfg"], frame.first, frame.last)
    return [tx for tx in range(MOST_TX) if any(mask >> tx & 1 for mask in masks)]


@dataclass(frozen=True, kw_only=True)
class Frame:
    """The chirps of a frame, or of one sub-frame of an advanced frame."""

    index: int | None  # of the sub-frame
    first: int
    last: int
    num_loops: int
    period_ms: float  # of the whole frame


def _frame(lines: dict[str, list[Line]], sub_frame: int | None) -> Frame:
    if "advFrameCfg" not in lines:
        if sub_frame is not None:
            raise InputError("it has one plain frame (frameCfg) and no sub-frames; leave out --radar-set subframe=N")
        line = lines["frameCfg"][-1]
        first, last, loops = (whole(line, "frameCfg", at) for at in range(3))
        period_ms = line.values[5 if len(line.values) >= MCU_FRAME_NUMBERS else 4]
        return Frame(index=None, first=first, last=last, num_loops=loops, period_ms=period_ms)
    frames = _sub_frames(lines)
    if sub_frame is None and len(frames) > 1:
        raise InputError(
            f"it has {len(frames)} sub-frames; choose one of 0 to {len(frames) - 1}: --radar-set subframe=N"
        )
    chosen = sub_frame or 0
    if not 0 <= chosen < len(frames):
        raise InputError(f"it has sub-frames 0 to {len(frames) - 1}, not {chosen}")
    return frames[chosen]


def _sub_frames(lines: dict[str, list[Line]]) -> list[Frame]:
    """subFrameCfg: number, forced profile, first chirp, chirps, loops, burst ms, offset, bursts, repeats, period ms."""
    period_ms = sum(line.values[9] for line in lines["subFrameCfg"])
    found: dict[int, Frame] = {}
    for line in lines["subFrameCfg"]:
        index, _, first, count, loops = (whole(line, "subFrameCfg", at) for at in range(5))
        if whole(line, "subFrameCfg", 7) != 1 or whole(line, "subFrameCfg", 8) != 1:
            raise InputError(f"line {line.number}: sub-frame {index} has several bursts, which cannot be read; use one")
        found[index] = Frame(index=index, first=first, last=first + count - 1, num_loops=loops, period_ms=period_ms)
    if sorted(found) != list(range(len(found))):
        raise InputError(f"its sub-frames are {sorted(found)}; they must be numbered from 0 on")
    return [found[index] for index in range(len(found))]


def _others(lines: dict[str, list[Line]], frame: Frame) -> SubFrame | None:
    """How many samples (of all receivers) the other sub-frames have in each frame of a recording."""
    if frame.index is None:
        return None
    counts = []
    for other in _sub_frames(lines):
        masks, profile_ids = _fired(lines["chirpCfg"], other.first, other.last)
        samples = whole(_profile(lines, profile_ids), "profileCfg", 9)
        counts.append(len(masks) * other.num_loops * samples)
    before, after = sum(counts[: frame.index]), sum(counts[frame.index + 1 :])
    return SubFrame(index=frame.index, samples_before=before, samples_after=after)


def _bpm_phases(lines: dict[str, list[Line]], masks: tuple[int, ...], frame: Frame) -> tuple[tuple[float, ...], ...]:
    """bpmCfg: sub-frame, enabled, first and second chirp. In the second the last of its transmitters is inverted."""
    phases = [[0.0] * MOST_TX for _ in masks]
    for line in lines.get("bpmCfg", []):
        index, enabled, _, second = (whole(line, "bpmCfg", at) for at in range(4))
        if enabled != 1 or index not in (-1, frame.index if frame.index is not None else 0):
            continue
        if not frame.first <= second <= frame.last:
            raise InputError(f"line {line.number}: bpmCfg names chirp {second}, which the frame does not send")
        mask = masks[second - frame.first]
        phases[second - frame.first][mask.bit_length() - 1] = 180.0
    return tuple(tuple(row) for row in phases)


def _ddm_phases(lines: dict[str, list[Line]], masks: tuple[int, ...]) -> tuple[tuple[float, ...], ...]:
    """Doppler-division MIMO (AWR2944, AWR2544): phases in the samples; () without ddmPhaseShiftAntOrder.

    The k-th transmitter of the line turns by k of N steps of 360/N degrees from chirp to chirp, N chirps a loop (more
    than transmitters, which leaves empty bands), as near as its shifter can. The demo counts chirps backwards, because
    samples turn against the shifter: they are the ramp times the conjugate echo. Source: the demo of TI's MCU+ SDK for
    the AWR294x and AWR2544, where it sets rlRfPhaseShiftCfg_t.
    """
    if "ddmPhaseShiftAntOrder" not in lines or len(set(masks)) != 1 or masks[0].bit_count() < 2:
        return ()
    line, count = lines["ddmPhaseShiftAntOrder"][-1], len(masks)
    order = [whole(line, "ddmPhaseShiftAntOrder", at) for at in range(len(line.values))]
    fired = [tx for tx in range(MOST_TX) if masks[0] >> tx & 1]
    if sorted(set(order)) != sorted(order) or not set(fired) <= set(order):
        raise InputError(f"line {line.number}: ddmPhaseShiftAntOrder must name each transmitter that fires once")
    if count < len(fired):
        raise InputError(
            f"line {line.number}: Doppler-division MIMO of {len(fired)} transmitters needs as many chirps in a loop,"
            f" not {count}"
        )
    multiple = {tx: place for place, tx in enumerate(one for one in order if one in fired)}
    step_deg = 360 / SHIFTER_DEG / count
    return tuple(
        tuple(-SHIFTER_DEG * round(-chirp * multiple.get(tx, 0) % count * step_deg) for tx in range(MOST_TX))
        for chirp in range(count)
    )


def _profile(lines: dict[str, list[Line]], profile_ids: set[int]) -> Line:
    if len(profile_ids) != 1:
        raise InputError(f"the frame's chirps use profiles {sorted(profile_ids)}; only one profile can be read")
    profiles = {whole(line, "profileCfg", 0): line for line in lines["profileCfg"]}
    profile = profiles.get(min(profile_ids))
    if profile is None:
        raise InputError(f"the chirps use profile {min(profile_ids)}, which no profileCfg defines")
    return profile


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
