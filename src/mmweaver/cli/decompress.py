"""mmweaver decompress: a .mmw file back into radar.npz, a .mmwl file into its .bin, or some of their frames."""

import argparse
import sys
from pathlib import Path
from typing import Any

from mmweaver.core.errors import InputError
from mmweaver.core.safe_files.safe_text import read_text

NUM_STAGES = 2
EXAMPLES = """examples:
  mmweaver decompress walk.mmw -o walk/radar.npz
  mmweaver decompress capture.mmwl -o adc_data.bin
  mmweaver decompress capture.mmw --frames 100:120 -o part/radar.npz
"""


def add_command(commands: Any) -> argparse.ArgumentParser:
    """Declares the command and its options."""
    parser = commands.add_parser(
        "decompress", help="read a .mmw file back into radar.npz", epilog=EXAMPLES,
        description="Reads a .mmw file back; with --frames only the chunks that hold them are read.",
    )  # fmt: skip
    parser.add_argument("file", type=Path, metavar="FILE", help="a .mmw or .mmwl file")
    parser.add_argument(
        "-o",
        "--out",
        type=Path,
        required=True,
        metavar="FILE",
        help="the .npz to write, with radar.json next to it; of a .mmwl file, the .bin",
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
    """Decompresses and writes radar.npz and radar.json, or the samples of a .mmwl file. Raises InputError."""
    from mmweaver.compression.lossless_file import is_lossless_file

    return _samples(arguments) if is_lossless_file(arguments.file) else _cube(arguments)


def _samples(arguments: argparse.Namespace) -> int:
    from mmweaver.cli.progress import StageBar
    from mmweaver.compression.lossless_file import LosslessFile
    from mmweaver.core.output_checks import check_output_file

    check_output_file(arguments.out, overwrite=arguments.overwrite, inputs=[arguments.file])
    file = LosslessFile(arguments.file)
    with StageBar(NUM_STAGES, quiet=arguments.quiet) as bar:
        size = file.decompress(arguments.out, arguments.frames, bar)
    _warn_of_cut(file.cut_short, arguments.file)
    if not arguments.quiet:
        print(f"wrote {arguments.out}: {size:,} bytes of samples of radar {file.header.config.name!r}")
    return 0


def _warn_of_cut(cut_short: int, file: Path) -> None:
    if cut_short:
        print(
            f"mmweaver: {file} was cut short; these are the frames before its last {cut_short:,} bytes", file=sys.stderr
        )


def _cube(arguments: argparse.Namespace) -> int:
    from mmweaver.cli.progress import StageBar
    from mmweaver.core.atomic_files import atomic_files
    from mmweaver.formats.npz_files import write_radar_npz

    radar_out = arguments.out.with_name("radar.json")
    if arguments.out.name == radar_out.name:
        raise InputError(f"{arguments.out}: the radar goes into radar.json; name the cube otherwise, as radar.npz")
    _check_outputs(arguments, radar_out)
    with StageBar(NUM_STAGES, quiet=arguments.quiet) as bar:
        bar("read")
        from mmweaver.compression.mmw_codec import read_cube
        from mmweaver.compression.mmw_container import MmwFile

        cube = read_cube(arguments.file, arguments.frames, with_residual=not arguments.scatterers)
        bar("write")
        with atomic_files(radar_out, arguments.out) as (radar, archive):
            radar.write_text(cube.config.to_json(), encoding="utf-8")
            write_radar_npz(archive, cube)
    _warn_of_cut(MmwFile(arguments.file).cut_short, arguments.file)
    if not arguments.quiet:
        print(f"wrote {arguments.out}: {len(cube.values)} frames of radar {cube.config.name!r}; and {radar_out}")
    return 0


def _check_outputs(arguments: argparse.Namespace, radar_out: Path) -> None:
    """Raises InputError where an output may not be written; a radar.json with the same radar may be there."""
    from mmweaver.compression.mmw_container import MmwFile
    from mmweaver.core.output_checks import check_output_file

    check_output_file(arguments.out, overwrite=arguments.overwrite, inputs=[arguments.file])
    config = MmwFile(arguments.file).header.config
    try:
        is_same = read_text(radar_out) == config.to_json()
    except InputError:
        is_same = False
    check_output_file(radar_out, overwrite=arguments.overwrite or is_same, inputs=[arguments.file])


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
