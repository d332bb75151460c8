"""mmweaver radar: the chirp, the resolutions and the limits of a radar."""

import argparse
from typing import Any

EXAMPLES = """examples:
  mmweaver radar awr1843
  mmweaver radar profile.cfg --json > radar.json
"""


def add_command(commands: Any) -> argparse.ArgumentParser:
    """Declares the command and its options."""
    parser = commands.add_parser(
        "radar", help="print a radar's chirp, resolutions and limits", epilog=EXAMPLES,
        description="Prints the chirp, the resolutions and the limits of a radar.",
    )  # fmt: skip
    parser.add_argument("radar", metavar="NAME|FILE", help="preset, TI .cfg or radar.json")
    parser.add_argument("--json", action="store_true", help="print the RadarConfig that --radar reads back")
    parser.set_defaults(run=run)
    return parser


def run(arguments: argparse.Namespace) -> int:
    """Prints the radar on stdout. Raises InputError."""
    from mmweaver.formats.radar_file import describe_radar, load_radar

    config = load_radar(arguments.radar)
    text = config.to_json() if arguments.json else describe_radar(config)
    print(text.rstrip("\n"))
    return 0
