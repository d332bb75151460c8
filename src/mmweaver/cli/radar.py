"""mmweaver radar: the presets, or the chirp, the resolutions and the limits of one radar."""

import json

from mmweaver.cli.option_groups import RadarSettings, Ranges
from mmweaver.core.options import Source, option, options

EXAMPLES = """examples:
  mmweaver radar                                # lists the presets
  mmweaver radar awr1843
  mmweaver radar profile.cfg --json > radar.json
"""


@options
class Options(Ranges, RadarSettings):
    """Prints the chirp, the resolutions and the limits of a radar; without one, lists the presets."""

    radar: Source | None = option(
        "preset, TI .cfg or radar.json (default: list the presets)", "NAME|FILE", positional=True
    )
    json: bool = option("print what --radar reads back; of all presets by name", default=False)


def run(asked: Options) -> int:
    """Prints the radar on stdout. Raises InputError."""
    from mmweaver.core.range_window import chosen_range
    from mmweaver.io.radar_file import describe_radar, load_radar

    if asked.radar is None:
        print(_presets(as_json=asked.json))
        return 0
    config = chosen_range(load_radar(asked.radar_name() or ""), asked.range_m, asked.range_bins)
    text = config.to_json() if asked.json else describe_radar(config)
    print(text.rstrip("\n"))
    return 0


def _presets(*, as_json: bool) -> str:
    """All presets: one line each, or their RadarConfigs as one JSON object."""
    from mmweaver.core.boards import PRESETS

    if as_json:
        return json.dumps({name: config.to_values() for name, config in PRESETS.items()}, indent=2)
    head = ("preset", "GHz", "antennas", "range bin", "to", "velocity bin", "up to")
    rows = [
        (
            name,
            f"{config.centre_frequency_hz / 1e9:.1f}",
            f"{config.num_tx} x {config.num_rx}",
            f"{config.range_resolution_m * 100:.1f} cm",
            f"{config.max_range_m:.1f} m",
            f"{config.velocity_resolution_mps:.3f} m/s",
            f"{config.max_velocity_mps:.1f} m/s",
        )
        for name, config in PRESETS.items()
    ]
    widths = [max(map(len, column)) for column in zip(head, *rows, strict=True)]
    lines = ("  ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True)) for row in (head, *rows))
    return "\n".join(line.rstrip() for line in lines)
