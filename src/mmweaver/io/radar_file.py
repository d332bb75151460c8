"""Loads a radar by name or from any supported file, and describes it in a table."""

import math
from collections.abc import Callable
from pathlib import Path

from mmweaver.core.boards import PRESETS
from mmweaver.core.errors import InputError, file_named
from mmweaver.core.firmware_settings import FIRMWARE, FirmwareSettings
from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.safe_files.safe_text import read_json
from mmweaver.core.virtual_array import azimuth_resolution_rad, has_elevation
from mmweaver.io.infineon import is_infineon, read_infineon_config
from mmweaver.io.mmwave_studio import is_mmwave_studio, read_mmwave_studio, read_studio_script
from mmweaver.io.peer_arrays import is_rf_genesis, read_rf_genesis_config
from mmweaver.io.radar_options import RadarOptions, split_radar
from mmweaver.io.ti_cfg import cfg_path, read_ti_cfg, ti_cfg_lines
from mmweaver.io.ti_firmware import read_ti_firmware


def load_radar(name_or_path: str) -> RadarConfig:
    """Loads a radar by preset name or from a file.

    Args:
        name_or_path: Name of a preset, or path of a TI .cfg, an mmWave Studio .json or .lua, or the .json of a
            RadarConfig, of Infineon's Radar SDK or of RF-Genesis. Options may follow:
            "profile.cfg#subframe=1;antennas=aop;lanes=4" (`io.radar_options`).

    Returns:
        The radar.

    Raises:
        InputError: If it is none of these, or the file describes an impossible radar.
    """
    name_or_path, options = split_radar(name_or_path)
    if name_or_path in PRESETS:
        return options.applied(PRESETS[name_or_path])
    path = Path(name_or_path)
    if path.is_file() and path.suffix.lower() in RADAR_FILES:
        return options.with_pattern(RADAR_FILES[path.suffix.lower()](path, options))
    what = "is neither .cfg nor .json" if path.is_file() else "is neither a radar preset nor a file"
    raise InputError(
        f"{name_or_path!r} {what}; presets: {', '.join(PRESETS)}; or give a TI .cfg, an mmWave Studio .json or"
        " .lua, or a .json from: mmweaver radar awr1843 --json > radar.json"
    )


def load_firmware(name_or_path: str) -> FirmwareSettings:
    """Loads the point-cloud settings of the firmware.

    Args:
        name_or_path: As in `load_radar`.

    Returns:
        Settings of the TI .cfg or of the preset; otherwise the defaults of the IWR1443 demo.

    Raises:
        InputError: If a .cfg lacks them.
    """
    path = None if name_or_path in PRESETS else cfg_path(name_or_path)
    return FIRMWARE.get(split_radar(name_or_path)[0], FirmwareSettings()) if path is None else read_ti_firmware(path)


def announced_frames(name_or_path: str) -> int | None:
    """Number of frames that the board was configured to send.

    Args:
        name_or_path: As in `load_radar`.

    Returns:
        The number in frameCfg or advFrameCfg of a .cfg, or in mmWave Studio's JSON; None if it is endless or unknown.
    """
    path = Path(split_radar(name_or_path)[0])
    try:
        if name_or_path in PRESETS or not path.is_file():
            return None
        if path.suffix.lower() == ".cfg":
            lines = ti_cfg_lines(path, {"advFrameCfg": 3})
            one = lines["frameCfg"][-1].whole(3) if "frameCfg" in lines else lines["advFrameCfg"][-1].whole(2)
        else:
            device = read_json(path)["mmWaveDevices"][0]["rfConfig"]
            frames = device.get("rlFrameCfg_t") or device["rlAdvFrameCfg_t"]["frameSeq"]
            one = int(frames["numFrames"])
    except (InputError, KeyError, IndexError, TypeError, ValueError, AttributeError):
        return None
    return one or None


def _read_json_radar(path: Path, options: RadarOptions) -> RadarConfig:
    values = read_json(path)
    if is_mmwave_studio(values):
        return read_mmwave_studio(path, options)
    if is_infineon(values):
        return read_infineon_config(path, options)
    if is_rf_genesis(values):
        return options.applied(read_rf_genesis_config(path, values))
    if not isinstance(values, dict) or "schema_version" not in values:
        raise InputError(
            f"{path} is no radar that is known: neither a radar.json (mmweaver radar awr1843 --json > radar.json), nor"
            " JSON of mmWave Studio, of Infineon's Radar SDK or of RF-Genesis"
        )
    with file_named(path):
        return options.applied(RadarConfig.from_values(values))


# reader per file suffix, (path, options) -> radar
RADAR_FILES: dict[str, Callable[[Path, RadarOptions], RadarConfig]] = {
    ".cfg": read_ti_cfg,
    ".json": _read_json_radar,
    ".lua": read_studio_script,
}


def describe_radar(config: RadarConfig) -> str:
    """Formats chirp, array, resolutions and limits of a radar as a table in customary units.

    Args:
        config: The radar.

    Returns:
        Text of several lines.
    """
    rows = [*_chirp_rows(config), *_array_rows(config), *_limit_rows(config), *_data_rows(config)]
    rows += [("note", text) for text in config.notes]
    width = max(len(name) for name, _ in rows)
    return "\n".join([f"radar {config.name}", *(f"  {name:<{width}}  {value}" for name, value in rows)])


def _chirp_rows(config: RadarConfig) -> list[tuple[str, str]]:
    end_hz = config.start_frequency_hz + config.chirp_slope_hz_per_s * config.ramp_end_time_s
    kind = "complex" if config.complex_samples else "real"
    times_s = (config.idle_time_s, config.adc_start_time_s, config.ramp_end_time_s)
    return [
        ("sweep", f"{config.start_frequency_hz / 1e9:.3f} to {end_hz / 1e9:.3f} GHz"),
        ("slope", f"{config.chirp_slope_hz_per_s / 1e12:.3f} MHz/us"),
        ("idle, ADC start, ramp end", ", ".join(f"{time_s * 1e6:.2f}" for time_s in times_s) + " us"),
        ("samples per chirp", f"{config.num_samples} {kind} at {config.sample_rate_hz / 1e6:.3f} Msps"),
        ("sampled bandwidth", f"{config.bandwidth_hz / 1e9:.3f} GHz around {config.centre_frequency_hz / 1e9:.3f} GHz"),
        ("loops per frame", f"{config.num_loops}, each {config.loop_period_s * 1e6:.1f} us"),
        (
            "frames",
            f"every {config.frame_period_s * 1e3:.1f} ms, {1 / config.frame_period_s:.2f} per second,"
            f" {100 * config.active_time_s / config.frame_period_s:.1f} % of the time chirping",
        ),
    ]


def _array_rows(config: RadarConfig) -> list[tuple[str, str]]:
    resolution = math.degrees(azimuth_resolution_rad(config))
    return [
        ("array", f"{config.num_tx} TX x {config.num_rx} RX = {config.num_antennas} virtual antennas"),
        ("transmitters", _scheme(config)),
        ("azimuth resolution", "none, one column" if math.isnan(resolution) else f"{resolution:.1f} deg at broadside"),
        ("elevation", "yes" if has_elevation(config) else "no"),
    ]


def _scheme(config: RadarConfig) -> str:
    if not config.is_coded:
        return "fire in order " + ", ".join(str(tx) for tx in config.tx_order)
    if config.num_virtual_tx < config.num_tx:
        return f"{config.num_tx} at once, {config.num_virtual_tx} beam{'s' if config.num_virtual_tx > 1 else ''}"
    return f"{config.num_tx} coded over {config.num_slots} chirps of a loop"


def _limit_rows(config: RadarConfig) -> list[tuple[str, str]]:
    low_m, high_m = config.range_m[0], config.range_m[-1]
    last_bin = config.first_range_bin + config.num_range_bins - 1
    return [
        ("range resolution", f"{config.range_resolution_m * 100:.2f} cm"),
        ("range", f"up to {config.max_range_m:.2f} m"),
        ("range kept", f"{low_m:.2f} to {high_m:.2f} m (bins {config.first_range_bin} to {last_bin})"),
        ("velocity resolution", f"{config.velocity_resolution_mps:.3f} m/s"),
        ("velocity", f"+-{config.max_velocity_mps:.2f} m/s"),
    ]


def _data_rows(config: RadarConfig) -> list[tuple[str, str]]:
    cube = (config.num_range_bins, config.num_loops, config.num_antennas)
    words = 2 if config.complex_samples else 1
    adc_kb = 2 * words * config.num_loops * config.num_slots * config.num_rx * config.num_samples / 1e3
    shape = f"{cube[0]} range x {cube[1]} Doppler x {cube[2]} antennas"
    return [
        ("cube per frame", f"{shape}, {8 * math.prod(cube) / 1e3:.1f} kB"),
        ("ADC data per frame", f"{adc_kb:.1f} kB ({adc_kb / config.frame_period_s / 1e3:.2f} MB per second)"),
    ]
