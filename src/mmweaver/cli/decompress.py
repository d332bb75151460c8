"""mmweaver decompress: a .mmw file, or some of its frames, back into radar.npz."""

import argparse
from pathlib import Path
from typing import Any

from mmweaver.cli.compress import check_output_file
from mmweaver.core.errors import InputError

NUM_STAGES = 2
EXAMPLES = """examples:
  mmweaver decompress walk.mmw -o walk/radar.npz
  mmweaver decompress capture.mmw --frames 100:120 -o part/radar.npz
"""


def add_command(commands: Any) -> argparse.ArgumentParser:
    """Declares the command and its options."""
    parser = commands.add_parser(
        "decompress", help="read a .mmw file back into radar.npz", epilog=EXAMPLES,
        description="Reads a .mmw file back; with --frames only the chunks that hold them are read.",
    )  # fmt: skip
    parser.add_argument("file", type=Path, metavar="FILE", help="a .mmw file")
    parser.add_argument(
        "-o",
        "--out",
        type=Path,
        required=True,
        metavar="FILE",
        help="the .npz to write, with radar.json next to it",
    )
    parser.add_argument(
        "--frames", type=frames, default=slice(None), metavar="A:B", help="frames A to B-1 (default all)"
    )
    parser.add_argument("--scatterers", action="store_true", help="scatterers and static layer only, no residual")
    parser.add_argument("--overwrite", action="store_true", help="replace files that exist")
    parser.add_argument("--quiet", action="store_true", help="print nothing but errors")
    parser.set_defaults(run=run)
    return parser


def run(arguments: argparse.Namespace) -> int:
    """Decompresses and writes radar.npz and radar.json. Raises InputError."""
    from mmweaver.cli.progress import StageBar
    from mmweaver.core.atomic_files import atomic_file
    from mmweaver.formats.npz_files import write_radar_npz

    radar_out = arguments.out.with_name("radar.json")
    if arguments.out.name == radar_out.name:
        raise InputError(f"{arguments.out}: the radar goes into radar.json; name the cube otherwise, as radar.npz")
    for out in (arguments.out, radar_out):
        check_output_file(out, overwrite=arguments.overwrite)
    with StageBar(NUM_STAGES, quiet=arguments.quiet) as bar:
        bar("read")
        from mmweaver.compression.mmw_codec import read_cube

        cube = read_cube(arguments.file, arguments.frames, with_residual=not arguments.scatterers)
        bar("write")
        with atomic_file(arguments.out) as temporary:
            write_radar_npz(temporary, cube)
        with atomic_file(radar_out) as temporary:
            temporary.write_text(cube.config.to_json(), encoding="utf-8")
    if not arguments.quiet:
        print(f"wrote {arguments.out}: {len(cube.values)} frames of radar {cube.config.name!r}; and {radar_out}")
    return 0


def frames(word: str) -> slice:
    """'3:7' -> slice(3, 7); either side may be left out.

    >>> frames("3:")
    slice(3, None, None)
    """
    first, colon, last = word.partition(":")
    try:
        if not colon:
            raise ValueError
        return slice(int(first) if first else None, int(last) if last else None)
    except ValueError:
        raise argparse.ArgumentTypeError(f"{word!r} is no span of frames; write A:B, for example 0:20") from None
