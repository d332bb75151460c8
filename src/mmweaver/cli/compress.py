"""mmweaver compress: a radar recording into a small .mmw file, or its raw samples into a .mmwl file without loss."""

import argparse
import json
import time
from pathlib import Path
from typing import Any

from mmweaver.cli.arguments import (
    add_board_options,
    add_range_options,
    add_sample_options,
    number,
    radar_of,
    whole,
)
from mmweaver.core.errors import InputError

NUM_STAGES = 4
EXAMPLES = """examples:
  mmweaver compress walk/radar.npz -o walk.mmw --bytes 10000
  mmweaver compress adc_data.bin --radar radar.json -o capture.mmw --quality 30
  mmweaver compress hour_2.bin --radar radar.json -o capture.mmw --quality 30 --append
  mmweaver compress adc_data.bin --radar radar.json -o capture.mmwl --lossless
  mmweaver compress adc_data.bin --radar radar.json -o capture.mmwl --max-error 2
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
    add_sample_options(source_options, brought="default: next to the .npz")
    add_range_options(source_options)
    add_board_options(source_options)
    size = parser.add_argument_group("size and quality")
    rate = size.add_mutually_exclusive_group()
    rate.add_argument(
        "--bytes", type=whole, metavar="N", help="size of the file at most; less where the cube is exact in fewer"
    )
    rate.add_argument("--quality", type=number, metavar="DB", help="signal-to-error ratio in the cells with signal")
    rate.add_argument(
        "--lossless",
        action="store_true",
        help="keep every bit of an adc_data.bin, or of the samples in a .pcap; decompress gives the same adc_data.bin",
    )
    rate.add_argument(
        "--max-error", type=whole, metavar="N", help="change no sample of an adc_data.bin by more than N counts"
    )
    size.add_argument(
        "--keep-noise", action="store_true", help="spend as much on cells of noise as on cells that hold signal"
    )
    size.add_argument("--effort", choices=("full", "fast"), default="full", help="fast: without the fit of scatterers")
    output = parser.add_argument_group("output")
    output.add_argument("-o", "--out", type=Path, metavar="FILE", help="the .mmw or .mmwl file to write")
    output.add_argument("--overwrite", action="store_true", help="replace the file if it exists")
    output.add_argument(
        "--append", action="store_true", help="add the frames to those of the .mmw file; --bytes are those added"
    )
    output.add_argument("--json", action="store_true", help="print a machine-readable summary on stdout")
    output.add_argument("--quiet", action="store_true", help="print nothing but errors")
    parser.set_defaults(run=run)
    return parser


def run(arguments: argparse.Namespace) -> int:
    """Compresses and writes the file. Raises InputError."""
    is_raw = arguments.lossless or arguments.max_error is not None
    if not is_raw and arguments.bytes is None and arguments.quality is None:
        raise InputError("say how small with --bytes, how good with --quality, or --lossless")
    if arguments.out is None:
        raise InputError("name the file to write with -o")
    from mmweaver.core.output_checks import check_output_file

    if arguments.append and (is_raw or arguments.overwrite):
        raise InputError("--append adds to a .mmw file; leave out --lossless, --max-error and --overwrite")
    may_exist = arguments.overwrite or arguments.append
    check_output_file(arguments.out, overwrite=may_exist, inputs=[arguments.file])
    return _compress_samples(arguments) if is_raw else _compress_cube(arguments)


def _compress_cube(arguments: argparse.Namespace) -> int:
    from mmweaver.cli.progress import StageBar

    start = time.monotonic()
    with StageBar(NUM_STAGES, quiet=arguments.quiet) as bar:
        bar("read the recording")
        from mmweaver.compression.long_recording import PIECE_VALUES, compress_recording
        from mmweaver.recordings.recording_pieces import RecordingPieces

        pieces = RecordingPieces(arguments.file, radar_of(arguments), **_how_read(arguments))
        frames, num_values = pieces.num_frames, pieces.num_frames * pieces.num_values_a_frame
        is_appended = arguments.append and arguments.out.exists()
        before = arguments.out.stat().st_size if is_appended else 0
        if is_appended or num_values > PIECE_VALUES:
            errors = compress_recording(
                pieces, arguments.out, num_bytes=arguments.bytes, quality_db=arguments.quality,
                keep_noise=arguments.keep_noise, effort=arguments.effort, append=is_appended, progress=bar,
            )  # fmt: skip
        else:
            errors = _compress_at_once(arguments, pieces.cube(range(frames)), bar)
    size = arguments.out.stat().st_size - before
    summary = {
        "out": str(arguments.out), "bytes": size, "cube_bytes": 8 * num_values,
        "ratio": round(8 * num_values / size, 1), "frames": frames, "seconds": round(time.monotonic() - start, 2),
        **errors,
    }  # fmt: skip
    if arguments.json:
        print(json.dumps(summary, indent=2))
    elif not arguments.quiet:
        print(
            f"{'added to' if is_appended else 'wrote'} {arguments.out}: {size:,} bytes for {frames} frames,"
            f" {summary['ratio']:,} times fewer than complex64, in {summary['seconds']:.1f} s;"
            f" {_said(errors, arguments.quality)}"
        )
    return 0


def _said(errors: dict[str, float], quality_db: float | None) -> str:
    from mmweaver.compression.mmw_codec import FLOAT32_DB
    from mmweaver.compression.optimiser import EXACT_DB, QUALITY_WITHIN_DB

    signal_db, all_db = errors["signal_error_db"], errors["all_error_db"]
    if all_db <= EXACT_DB:
        return "without loss: more bytes would change nothing"
    said = f"error {signal_db:.1f} dB in cells with signal, {all_db:.1f} dB in all"
    if all_db <= FLOAT32_DB:
        return said + ", the last digits of float32: more bytes would change nothing"
    if quality_db is not None and -signal_db > quality_db + QUALITY_WITHIN_DB:
        return said + "; better than asked for, as no smaller file was found"
    return said


def _compress_at_once(arguments: argparse.Namespace, cube: Any, bar: Any) -> dict[str, float]:
    """Writes the file of a recording that fits into one piece; returns its errors."""
    from mmweaver.compression.mmw_codec import compress_cube, errors_db, read_cube
    from mmweaver.core.atomic_files import atomic_file

    data = compress_cube(
        cube, num_bytes=arguments.bytes, quality_db=arguments.quality, keep_noise=arguments.keep_noise,
        effort=arguments.effort, progress=bar,
    )  # fmt: skip
    bar("check")
    with atomic_file(arguments.out) as temporary:
        temporary.write_bytes(data)
        return errors_db(read_cube(temporary).values, cube)


def _compress_samples(arguments: argparse.Namespace) -> int:
    """Raw samples without loss, or with a bounded error."""
    from mmweaver.cli.progress import StageBar

    if arguments.file.suffix not in (".bin", ".pcap", ".pcapng"):
        raise InputError(
            f"{arguments.file}: --lossless and --max-error are for the samples of a DCA1000 (.bin, .pcap or .pcapng);"
            " a cube has --quality, and is stored exactly where --bytes allow it"
        )
    radar = radar_of(arguments)
    if radar is None:
        raise InputError("which radar recorded it? give --radar, for example --radar awr1843")
    start = time.monotonic()
    with StageBar(NUM_STAGES, quiet=arguments.quiet) as bar:
        bar("read the radar")
        from mmweaver.compression.lossless_file import compress_bin
        from mmweaver.core.safe_files.regular_files import check_regular
        from mmweaver.formats.radar_file import load_radar

        size = compress_bin(
            arguments.file,
            arguments.out,
            load_radar(radar),
            max_error=arguments.max_error or 0,
            progress=bar,
        )
    before = check_regular(arguments.file)
    summary = {
        "out": str(arguments.out), "bytes": size, "raw_bytes": before, "ratio": round(before / size, 2),
        "max_error_counts": arguments.max_error or 0, "seconds": round(time.monotonic() - start, 2),
    }  # fmt: skip
    if arguments.json:
        print(json.dumps(summary, indent=2))
    elif not arguments.quiet:
        kept = f"every word within {arguments.max_error} counts" if arguments.max_error else "every bit kept"
        if arguments.file.suffix != ".bin":
            kept += " of the samples (zeros for lost packets), without the packets"
        print(
            f"wrote {arguments.out}: {size:,} bytes, {100 * size / before:.1f} % of {before:,}; {kept}, in"
            f" {summary['seconds']:.1f} s"
        )
    return 0


def _how_read(arguments: argparse.Namespace) -> dict[str, Any]:
    names = ("layout", "axes", "iq_order", "tx_order", "range_m", "range_bins")
    return {name: getattr(arguments, name) for name in names}
