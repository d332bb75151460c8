"""The lines of an mmWave SDK .cfg that configure the demo's point cloud.

Reference: mmWave SDK User Guide, "Configuration (.cfg) File Format": cfarCfg, peakGrouping, clutterRemoval,
multiObjBeamForming.
"""

import math
from dataclasses import dataclass
from pathlib import Path

from mmweaver.core.errors import InputError
from mmweaver.core.firmware_settings import AVERAGE_MODES, SDK3_MOST_OBJECTS, FirmwareCfar, FirmwareSettings
from mmweaver.core.radar_config import RadarConfig
from mmweaver.formats.ti_cfg import Line, read_ti_cfg, ti_cfg_lines, whole

# SDK 2 and later put the subframe before these numbers, so lines have one more than in SDK 1.
PLAIN_LENGTH = {"cfarCfg": 7, "peakGrouping": 5, "clutterRemoval": 1, "multiObjBeamForming": 2}
SDK3_CFAR_LENGTH = 9
DB_PER_OCTAVE = 20 * math.log10(2)


def read_ti_firmware(path: Path | str) -> FirmwareSettings:
    """The settings of the point cloud; those that the file does not hold are the demo's defaults.

    The device follows from adcbufCfg: the IWR1443's demo uses interleaved channels (0), those of other devices do
    not (1); without the line it is the IWR1443. SDK 3 has thresholds in dB, grouping in each cfarCfg and a longer list
    of points. Raises InputError where the file cannot be read, has no cfarCfg, or a number is out of range.
    """
    path = Path(path)
    lines = ti_cfg_lines(path, PLAIN_LENGTH)
    if "cfarCfg" not in lines:
        raise InputError(
            f"{path} has no cfarCfg, so its firmware's point cloud is unknown; add the line or use --points cfar"
        )
    config = read_ti_cfg(path)
    device = _device(lines)
    try:
        grouping = _grouping(lines)
        cfars = {line.values[_start(line, "cfarCfg")]: line for line in lines["cfarCfg"]}
        if unknown := sorted(set(cfars) - {0.0, 1.0}):
            raise InputError(f"cfarCfg is for direction {unknown[0]:g}; known are 0 (range) and 1 (Doppler)")
        in_range, in_doppler = (_own_grouping(cfars.get(direction)) for direction in (0.0, 1.0))
        return FirmwareSettings(
            device=device,
            range_cfar=_cfar(cfars.get(0.0), device, config),
            doppler_cfar=_cfar(cfars.get(1.0), device, config),
            group_range=grouping.in_range if in_range is None else in_range,
            group_doppler=grouping.in_doppler if in_doppler is None else in_doppler,
            first_range_bin=grouping.first_bin,
            last_range_bin=grouping.last_bin,
            static_removal=_is_on(lines, "clutterRemoval"),
            second_peak=_second_peak(lines),
            most_objects=SDK3_MOST_OBJECTS if any(map(_is_of_sdk3, cfars.values())) else None,
        )
    except InputError as error:
        text = str(error)
        raise InputError(text if text.startswith(str(path)) else f"{path}: {text}") from None


def _device(lines: dict[str, list[Line]]) -> str:
    if "adcbufCfg" not in lines:
        return "xwr14xx"
    values = lines["adcbufCfg"][-1].values
    interleave = values[2] if len(values) == 4 else values[3]
    return "xwr16xx" if interleave == 1 else "xwr14xx"


def _start(line: Line, command: str) -> int:
    """Index of a line's own first number: after the subframe, if it has one."""
    return 1 if len(line.values) > PLAIN_LENGTH[command] else 0


def _cfar(line: Line | None, device: str, config: RadarConfig) -> FirmwareCfar | None:
    if line is None:
        return None
    start = _start(line, "cfarCfg")
    average, window, guard, shift, cyclic = (whole(line, "cfarCfg", start + at) for at in range(1, 6))
    if not 0 <= average < len(AVERAGE_MODES):
        raise InputError(f"line {line.number}: cfarCfg has average mode {average}; known are 0, 1 and 2")
    in_db = _is_of_sdk3(line)
    if in_db and average != 0:
        shift += 1  # SDK 3 divides the one side that CASO and CAGO take by 2^shift, older ones by half of that
    return FirmwareCfar(
        average=AVERAGE_MODES[average],
        window=window,
        guard=guard,
        noise_shift=shift,
        cyclic=cyclic == 1,
        threshold=_counts(line.values[start + 6], device, config) if in_db else whole(line, "cfarCfg", start + 6),
    )


def _is_of_sdk3(line: Line) -> bool:
    return len(line.values) >= SDK3_CFAR_LENGTH


def _own_grouping(line: Line | None) -> bool | None:
    """Whether an SDK 3 line groups peaks in its direction; None for older ones."""
    if line is None or not _is_of_sdk3(line):
        return None
    return whole(line, "cfarCfg", SDK3_CFAR_LENGTH - 1) == 1


def _counts(threshold_db: float, device: str, config: RadarConfig) -> int:
    """Converts a threshold in dB to the units of the detection matrix."""
    num = config.num_antennas
    per_octave = 256 * num if device == "xwr16xx" else 512 * num / 2 ** (num - 1).bit_length()
    return round(threshold_db / DB_PER_OCTAVE * per_octave)


@dataclass(frozen=True, kw_only=True)
class _Grouping:
    in_range: bool
    in_doppler: bool
    first_bin: int
    last_bin: int


def _grouping(lines: dict[str, list[Line]]) -> _Grouping:
    if "peakGrouping" not in lines:
        default = FirmwareSettings()
        return _Grouping(
            in_range=default.group_range, in_doppler=default.group_doppler, first_bin=default.first_range_bin,
            last_bin=default.last_range_bin,
        )  # fmt: skip
    line = lines["peakGrouping"][-1]
    start = _start(line, "peakGrouping")
    in_range, in_doppler, first, last = (whole(line, "peakGrouping", start + at) for at in range(1, 5))
    return _Grouping(in_range=in_range == 1, in_doppler=in_doppler == 1, first_bin=first, last_bin=last)


def _is_on(lines: dict[str, list[Line]], command: str) -> bool:
    if command not in lines:
        return False
    line = lines[command][-1]
    return line.values[_start(line, command)] == 1


def _second_peak(lines: dict[str, list[Line]]) -> float | None:
    if not _is_on(lines, "multiObjBeamForming"):
        return None
    line = lines["multiObjBeamForming"][-1]
    return float(line.values[_start(line, "multiObjBeamForming") + 1])
