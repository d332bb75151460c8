"""mmweaver calibrate: the board that made some recordings."""

import argparse
from pathlib import Path
from typing import Any

from mmweaver.cli.arguments import (
    add_board_options,
    add_range_options,
    add_sample_options,
    number,
    radar_of,
)

EXAMPLES = """examples:
  mmweaver calibrate empty.bin --radar profile.cfg --out board.json        # your room, nobody in it, some seconds
  mmweaver calibrate walk/ sit/ empty/ --out board.json                    # folders of mmweaver process: any recordings
  mmweaver calibrate adc.npy --radar radar.json --axes frame,loop,tx,rx,sample --out board.json
  mmweaver calibrate reflector.bin --radar profile.cfg --target 2.50,-3.2 --out board.json    # a corner reflector
  mmweaver generate --demo --radar profile.cfg --board board.json --out like_mine/
"""


def add_command(commands: Any) -> argparse.ArgumentParser:
    """Declares the command and its options."""
    parser = commands.add_parser(
        "calibrate", help="find the errors of your board in its recordings", epilog=EXAMPLES,
        description="Finds what recordings show of the board that made them: IF response, noise figure, leakage,"
        " antenna gains and phases, first chirps, drift. Nothing need be known of"
        " the room. Says what it could not see and why; generate --board takes the file.",
    )  # fmt: skip
    parser.add_argument(
        "recordings", type=Path, nargs="+", metavar="RECORDING",
        help="raw samples, or a folder of mmweaver process",
    )  # fmt: skip
    raw = parser.add_argument_group("what recordings do not bring")
    add_sample_options(raw)
    add_board_options(raw, rare=True)
    add_range_options(raw, what="whose echoes show the antennas (default: all)")
    raw.add_argument(
        "--target", type=target, metavar="RANGE[,DBSM]",
        help="true distance in metres of the strongest echo near it, straight ahead, and its cross section: gives range"
        " bias, and gain",
    )  # fmt: skip
    output = parser.add_argument_group("output")
    output.add_argument("--out", type=Path, required=True, metavar="JSON", help="the board's file")
    output.add_argument("--overwrite", action="store_true", help="replace a file that is there")
    output.add_argument("--json", action="store_true", help="print what was found on stdout as JSON")
    parser.set_defaults(run=run)
    return parser


def target(word: str) -> tuple[float, ...]:
    """A range in metres, and perhaps a cross section in dBsm."""
    parts = tuple(map(number, word.split(",")))
    if len(parts) > 2:
        raise argparse.ArgumentTypeError(f"{word!r} is no RANGE or RANGE,DBSM")
    return parts


def run(arguments: argparse.Namespace) -> int:
    """Calibrates, writes and prints. Raises InputError."""
    import json

    from mmweaver.calibration.calibrate import calibrate
    from mmweaver.calibration.target_fits import KnownTarget
    from mmweaver.core.output_checks import check_output_file

    check_output_file(arguments.out, overwrite=arguments.overwrite, inputs=arguments.recordings)
    found = calibrate(
        *arguments.recordings,
        radar=radar_of(arguments),
        range_m=arguments.range_m,
        range_bins=arguments.range_bins,
        target=None if arguments.target is None else KnownTarget(*arguments.target),
        name=arguments.out.stem,
        **{key: getattr(arguments, key) for key in ("layout", "axes", "iq_order", "tx_order")},
    )
    found.board.save(arguments.out)
    if arguments.json:
        print(json.dumps(found.to_values(), indent=2, allow_nan=False, ensure_ascii=False))
    else:
        print(f"{found.text()}\nwrote {arguments.out}")
    return 0
