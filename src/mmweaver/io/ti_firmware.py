"""Lines of an mmWave SDK .cfg that configure the point cloud of the demo.

Reference: mmWave SDK User Guide, "Configuration (.cfg) File Format": cfarCfg, peakGrouping, clutterRemoval,
multiObjBeamForming. Demos without cfarCfg of that form (3D People Tracking and Counting: dynamicRACfarCfg, a CFAR on a
Capon range-azimuth heatmap, "3D People Tracking Detection Layer Tuning Guide"; vital signs; gestures) have a
substitute.
"""

import math
from pathlib import Path
from typing import Any

from mmweaver.core.errors import InputError, file_named
from mmweaver.core.firmware_settings import AVERAGE_MODES, SDK3_MAX_OBJECTS, FirmwareCfar, FirmwareSettings
from mmweaver.core.radar_config import RadarConfig
from mmweaver.io.ti_cfg import Line, Lines, adc_buffer, read_ti_cfg, ti_cfg_lines

# Number of arguments in SDK 1; SDK 2 and later prepend the sub-frame.
PLAIN_LENGTH = {"cfarCfg": 7, "peakGrouping": 5, "clutterRemoval": 1, "multiObjBeamForming": 2}
SDK3_CFAR_LENGTH = 9
# Demos without cfarCfg of the out-of-box demo, by a command of their .cfg.
OTHER_DEMOS = {
    "dynamicRACfarCfg": "3D People Tracking",
    "staticRACfarCfg": "3D People Tracking",
    "dynamicRangeAngleCfg": "People Counting",
    "doaCfg": "2D People Counting",
    "vitalSignsCfg": "vital signs",
    "gestureCfg": "gestures",
}
SUBSTITUTE_DB = 15.0  # threshold of the out-of-box demo
COUNTING_CFAR_LENGTH = 12  # cfarCfg of 2D People Counting, which has other numbers
HEATMAP_LENGTH = 13  # dynamicRACfarCfg: windows, guards and thresholds in range and angle
DB_PER_OCTAVE = 20 * math.log10(2)


def read_ti_firmware(path: Path | str) -> FirmwareSettings:
    """Reads the point-cloud settings of a .cfg; missing ones are the demo's defaults.

    The device follows from adcbufCfg: the demo of the IWR1443 uses interleaved channels (0), those of other devices do
    not (1); without the line the IWR1443 is assumed. SDK 3 has thresholds in dB, grouping in each cfarCfg and a longer
    point list.

    Args:
        path: The file.

    Returns:
        The settings.

    Raises:
        InputError: If the file cannot be read, or a number is out of range.
    """
    path = Path(path)
    lines = ti_cfg_lines(path, PLAIN_LENGTH | dict.fromkeys(OTHER_DEMOS, 0))
    config = read_ti_cfg(path)
    device = "xwr16xx" if adc_buffer(lines)[1] == 1 else "xwr14xx"
    if "cfarCfg" not in lines or len(lines["cfarCfg"][-1].values) >= COUNTING_CFAR_LENGTH:
        with file_named(path):
            return _substitute(lines, config, device)
    own = {command: _drop_sub_frame(found[-1]) for command, found in lines.items() if command in PLAIN_LENGTH}
    with file_named(path):
        cfars = {line.values[0]: line for line in map(_drop_sub_frame, lines["cfarCfg"])}
        if unknown := sorted(set(cfars) - {0.0, 1.0}):
            raise InputError(f"cfarCfg is for direction {unknown[0]:g}; known are 0 (range) and 1 (Doppler)")
        values: dict[str, Any] = {}
        if "peakGrouping" in own:
            _, in_range, in_doppler, first, last = own["peakGrouping"].wholes(5)
            values = {"group_range": in_range == 1, "group_doppler": in_doppler == 1}
            values |= {"first_range_bin": first, "last_range_bin": last}
        for direction, name in ((0.0, "group_range"), (1.0, "group_doppler")):
            if direction in cfars and _is_of_sdk3(cfars[direction]):
                values[name] = cfars[direction].whole(SDK3_CFAR_LENGTH - 2) == 1
        beams = own.get("multiObjBeamForming")
        return FirmwareSettings(
            device=device,
            range_cfar=_cfar(cfars.get(0.0), device, config),
            doppler_cfar=_cfar(cfars.get(1.0), device, config),
            static_removal="clutterRemoval" in own and own["clutterRemoval"].values[0] == 1,
            second_peak=None if beams is None or beams.values[0] != 1 else float(beams.values[1]),
            most_objects=SDK3_MAX_OBJECTS if any(map(_is_of_sdk3, cfars.values())) else None,
            **values,
        )


def _substitute(lines: Lines, config: RadarConfig, device: str) -> FirmwareSettings:
    """The out-of-box demo's chain in place of another demo's.

    The dynamic chain of People Tracking removes static clutter, then applies a CFAR in range and in angle to the power
    of a Capon heatmap. Here the same windows, guards and thresholds in range apply to the detection matrix.
    """
    demo = next((name for command, name in OTHER_DEMOS.items() if command in lines), "")
    removes = "clutterRemoval" not in lines or lines["clutterRemoval"][-1].values[-1] == 1
    window, guard, threshold_db, words = 8, 4, SUBSTITUTE_DB, "its default CFAR"
    if "dynamicRACfarCfg" in lines and len(lines["dynamicRACfarCfg"][-1].values) >= HEATMAP_LENGTH:
        line = lines["dynamicRACfarCfg"][-1]
        window, guard = 1 << max(round(math.log2(max(line.whole(5), 1))), 1), max(line.whole(7), 0)
        threshold_db = 10 * math.log10(max(line.values[9], 1.0))
        words = f"the range CFAR of dynamicRACfarCfg ({threshold_db:.1f} dB)"
    what = f"the detection chain of TI's {demo} demo" if demo else "a firmware without cfarCfg"
    clutter = "static clutter removed" if removes else "static clutter kept"
    return FirmwareSettings(
        device=device,
        range_cfar=FirmwareCfar(
            average="caso",
            window=window,
            guard=guard,
            noise_shift=window.bit_length() - 1 + (device == "xwr16xx"),
            threshold=_counts(threshold_db, device, config),
        ),
        last_range_bin=config.num_samples,
        static_removal=removes,
        second_peak=None,
        most_objects=SDK3_MAX_OBJECTS,
        substitute=f"{what} is replaced by the out-of-box demo's with {words}, {clutter}; its points per frame differ",
    )


def _drop_sub_frame(line: Line) -> Line:
    """The line in the format of SDK 1."""
    return Line(line.number, line.command, line.values[len(line.values) > PLAIN_LENGTH[line.command] :])


def _is_of_sdk3(line: Line) -> bool:
    return len(line.values) >= SDK3_CFAR_LENGTH - 1


def _cfar(line: Line | None, device: str, config: RadarConfig) -> FirmwareCfar | None:
    if line is None:
        return None
    _, average, window, guard, shift, cyclic = line.wholes(6)
    if not 0 <= average < len(AVERAGE_MODES):
        raise InputError(f"line {line.number}: cfarCfg has average mode {average}; known are 0, 1 and 2")
    in_db = _is_of_sdk3(line)
    if in_db and average != 0:
        shift += 1  # SDK 3 divides the single side of CASO and CAGO by 2^shift, older SDKs by half of that
    return FirmwareCfar(
        average=AVERAGE_MODES[average],
        window=window,
        guard=guard,
        noise_shift=shift,
        cyclic=cyclic == 1,
        threshold=_counts(line.values[6], device, config) if in_db else line.whole(6),
    )


def _counts(threshold_db: float, device: str, config: RadarConfig) -> int:
    """Converts a threshold in dB to the units of the detection matrix."""
    num = config.num_antennas
    per_octave = 256 * num if device == "xwr16xx" else 512 * num / 2 ** (num - 1).bit_length()
    return round(threshold_db / DB_PER_OCTAVE * per_octave)
