"""mmweaver compress: a radar recording into a small .mmw file."""

import argparse
import json
import time
from pathlib import Path
from typing import Any

from mmweaver.cli.arguments import add_layout_options, number, source, whole
from mmweaver.core.errors import InputError

NUM_STAGES = 4
EXAMPLES = """examples:
  mmweaver compress walk/radar.npz -o walk.mmw --bytes 10000
  mmweaver compress adc_data.bin --radar radar.json -o capture.mmw --quality 30
  mmweaver compress HuPR/single_1/hori -o single_1.mmw --bytes 400000
  mmweaver compress radar_frames.npy --layout rf_genesis -o walk.mmw --quality 40
  mmweaver compress adc.npy --radar profile.cfg --axes frame,loop,tx,rx,sample -o capture.mmw --bytes 40072
"""


def add_command(commands: Any) -> argparse.ArgumentParser:
    """Declares the command and its options."""
    parser = commands.add_parser(
        "compress", help="store a recording in few bytes", epilog=EXAMPLES,
        description="Stores a radar cube as moving scatterers, a static layer and their residual, in a .mmw file.",
    )  # fmt: skip
    parser.add_argument(
        "file",
        type=Path,
        metavar="FILE|DIR",
        help="radar.npz or its folder, adc_data.bin of a DCA1000, raw ADC samples as .npy, a HuPR, mmMesh or RF-Genesis"
        " array, or a capture folder of mmwave-capture-std",
    )
    source_options = parser.add_argument_group("input")
    source_options.add_argument(
        "--radar", type=source, metavar="NAME|FILE", help="preset, TI .cfg or radar.json (default: next to the .npz)"
    )
    source_options.add_argument(
        "--axes", metavar="NAMES", help="axes of the .npy in their order: frame,loop,tx,rx,sample"
    )
    source_options.add_argument(
        "--layout", metavar="NAME", help="whose .npy it is: hupr (a frame or a folder of them), mmmesh, rf_genesis"
    )
    add_layout_options(source_options)
    size = parser.add_argument_group("size and quality")
    rate = size.add_mutually_exclusive_group(required=True)
    rate.add_argument("--bytes", type=whole, metavar="N", help="size of the file at most")
    rate.add_argument("--quality", type=number, metavar="DB", help="signal-to-error ratio in the cells with signal")
    size.add_argument(
        "--keep-noise", action="store_true", help="spend as much on cells of noise as on cells that hold signal"
    )
    output = parser.add_argument_group("output")
    output.add_argument("-o", "--out", type=Path, required=True, metavar="FILE", help="the .mmw file to write")
    output.add_argument("--overwrite", action="store_true", help="replace the file if it exists")
    output.add_argument("--json", action="store_true", help="print a machine-readable summary on stdout")
    output.add_argument("--quiet", action="store_true", help="print nothing but errors")
    parser.set_defaults(run=run)
    return parser


def run(arguments: argparse.Namespace) -> int:
    """Compresses and writes the file. Raises InputError."""
    from mmweaver.cli.progress import StageBar
    from mmweaver.core.atomic_files import atomic_file

    check_output_file(arguments.out, overwrite=arguments.overwrite)
    start = time.monotonic()
    with StageBar(NUM_STAGES, quiet=arguments.quiet) as bar:
        bar("read the recording")
        from mmweaver.recordings.read_recording import read_recording

        cube = read_recording(
            arguments.file, arguments.radar, layout=arguments.layout, axes=arguments.axes,
            iq_order=arguments.iq_order, tx_order=arguments.tx_order,
        ).cube  # fmt: skip
        from mmweaver.compression.mmw_codec import compress_cube, errors_db

        data = compress_cube(
            cube, num_bytes=arguments.bytes, quality_db=arguments.quality, keep_noise=arguments.keep_noise, progress=bar
        )
        bar("check")
        errors = errors_db(data, cube)
        with atomic_file(arguments.out) as temporary:
            temporary.write_bytes(data)
    before = cube.values.size * 8
    summary = {
        "out": str(arguments.out), "bytes": len(data), "cube_bytes": before, "ratio": round(before / len(data), 1),
        "frames": len(cube.values), "seconds": round(time.monotonic() - start, 2), **errors,
    }  # fmt: skip
    if arguments.json:
        print(json.dumps(summary, indent=2))
    elif not arguments.quiet:
        print(
            f"wrote {arguments.out}: {len(data):,} bytes for {len(cube.values)} frames, {summary['ratio']:,} times"
            f" fewer than complex64, in {summary['seconds']:.1f} s; error {errors['signal_error_db']:.1f} dB in cells"
            f" with signal, {errors['all_error_db']:.1f} dB in all"
        )
    return 0


def check_output_file(out: Path, *, overwrite: bool) -> None:
    """Raises InputError where a file may not be written, before long work."""
    if out.is_dir():
        raise InputError(f"{out} is a folder; name a file with -o")
    if out.exists() and not overwrite:
        raise InputError(f"{out} exists; choose another -o or allow it with --overwrite")
