"""mmweaver compare: two signals, recorded or simulated, feature by feature."""

import argparse
from pathlib import Path
from typing import Any

from mmweaver.cli.arguments import add_board_options, add_sample_options, radar_of, source, span_m

EXAMPLES = """examples:
  mmweaver compare recording/ simulated/ --out comparison/
  mmweaver compare adc_data.bin simulated/ --radar profile.cfg --tx-order 0,2,1 --out comparison/
  mmweaver compare adc.npy walk.mmw --radar radar.json --axes frame,loop,tx,rx,sample --json
  mmweaver compare board_a.bin board_b.bin --radar a.cfg --radar-b b.cfg --out boards/
  mmweaver compare recordings/ simulations/ --out all/    # folders of results: their spread is over recordings

A and B: a recording, a folder of mmweaver generate or process, a .mmw file, a folder of generate --stream, or a folder
of any of these. Simulate with --bin: raw samples show the whole band, the leakage and the first chirp.
"""


def add_command(commands: Any) -> argparse.ArgumentParser:
    """Declares the command and its options."""
    parser = commands.add_parser(
        "compare", help="compare two signals, recorded or simulated", epilog=EXAMPLES,
        description="Measures what tells signal B from signal A: energy behind a person, noise, leakage, clutter,"
        " antennas, chirps, points; ranked by effect size, with pictures on the same axes and decibels.",
    )  # fmt: skip
    parser.add_argument("a", type=Path, metavar="A", help="the signal to compare with, such as a recording")
    parser.add_argument("b", type=Path, metavar="B", help="the signal that is compared with it, such as a simulation")
    raw = parser.add_argument_group("raw samples, which do not bring their radar")
    add_sample_options(raw)
    raw.add_argument("--radar-b", type=source, metavar="NAME|FILE", help="that of B, where it is another")
    add_board_options(raw, rare=True)
    parser.add_argument(
        "--range", type=span_m, metavar="NEAR,FAR", dest="range_m",
        help="metres that are compared (default: all that both show)",
    )  # fmt: skip
    output = parser.add_argument_group("output")
    output.add_argument(
        "--out", type=Path, metavar="DIR",
        help="folder for comparison.png, comparison.json and comparison.html (default: print the numbers only)",
    )  # fmt: skip
    output.add_argument("--overwrite", action="store_true", help="replace files of an earlier comparison in --out")
    output.add_argument("--json", action="store_true", help="print comparison.json on stdout")
    parser.set_defaults(run=run)
    return parser


def run(arguments: argparse.Namespace) -> int:
    """Compares, writes and prints. Raises InputError."""
    import json

    from mmweaver.comparison.compare_signals import compare
    from mmweaver.comparison.comparison_page import check_comparison_folder

    if arguments.out is not None:
        check_comparison_folder(arguments.out, overwrite=arguments.overwrite, inputs=[arguments.a, arguments.b])
    found = compare(
        arguments.a, arguments.b, radar=radar_of(arguments),
        radar_b=None if arguments.radar_b is None else radar_of(arguments, option="radar_b"), layout=arguments.layout,
        axes=arguments.axes, iq_order=arguments.iq_order, tx_order=arguments.tx_order, range_m=arguments.range_m,
    )  # fmt: skip
    written = [] if arguments.out is None else found.save(arguments.out, overwrite=arguments.overwrite)
    if arguments.json:
        print(json.dumps(found.to_values(), indent=2, allow_nan=False, ensure_ascii=False))
        return 0
    print(found.text())
    if written:
        print(f"\nwrote {', '.join(str(path) for path in written)}")
    return 0
