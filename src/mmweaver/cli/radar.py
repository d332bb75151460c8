"""mmweaver radar: the presets, or the chirp, the resolutions and the limits of one radar."""

import argparse
import json
from typing import Any

from mmweaver.cli.arguments import add_board_options, add_range_options, radar_of

EXAMPLES = """examples:
  mmweaver radar                                # lists the presets
  mmweaver radar awr1843
  mmweaver radar profile.cfg --json > radar.json
"""


def add_command(commands: Any) -> argparse.ArgumentParser:
    """Declares the command and its options."""
    parser = commands.add_parser(
        "radar", help="print a radar's chirp, resolutions and limits", epilog=EXAMPLES,
        description="Prints the chirp, the resolutions and the limits of a radar; without one, lists the presets.",
    )  # fmt: skip
    parser.add_argument(
        "radar", nargs="?", metavar="NAME|FILE", help="preset, TI .cfg or radar.json (default: list the presets)"
    )
    add_range_options(parser)
    add_board_options(parser)
    parser.add_argument("--json", action="store_true", help="print what --radar reads back; of all presets by name")
    parser.set_defaults(run=run)
    return parser


def run(arguments: argparse.Namespace) -> int:
    """Prints the radar on stdout. Raises InputError."""
    from mmweaver.core.range_window import chosen_range
    from mmweaver.formats.radar_file import describe_radar, load_radar

    if arguments.radar is None:
        print(_presets(as_json=arguments.json))
        return 0
    config = chosen_range(load_radar(radar_of(arguments) or ""), arguments.range_m, arguments.range_bins)
    text = config.to_json() if arguments.json else describe_radar(config)
    print(text.rstrip("\n"))
    return 0


def _presets(*, as_json: bool) -> str:
    """All presets: one line each, or their RadarConfigs as one JSON object."""
    from mmweaver.core.presets import PRESETS

    if as_json:
        return json.dumps({name: config.to_values() for name, config in PRESETS.items()}, indent=2)
    head = ("preset", "GHz", "antennas", "range bin", "to", "velocity bin", "up to")
    rows = [
        (
            name, f"{config.centre_frequency_hz / 1e9:.1f}", f"{config.num_tx} x {config.num_rx}",
            f"{config.range_resolution_m * 100:.1f} cm", f"{config.max_range_m:.1f} m",
            f"{config.velocity_resolution_mps:.3f} m/s", f"{config.max_velocity_mps:.1f} m/s",
        )
        for name, config in PRESETS.items()
    ]  # fmt: skip
    widths = [max(map(len, column)) for column in zip(head, *rows, strict=True)]
    lines = ("  ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True)) for row in (head, *rows))
    return "\n".join(line.rstrip() for line in lines)
