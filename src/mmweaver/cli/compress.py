"""mmweaver compress: a radar recording into a small .mmw file, or its raw samples into a .mmwl file without loss."""

import math
import time
from pathlib import Path
from typing import Any, Literal

from mmweaver.cli.option_groups import Ranges, Samples, Written
from mmweaver.core.errors import InputError
from mmweaver.core.options import MISSING, option, options

NUM_STAGES = 4
EXAMPLES = """examples:
  mmweaver compress walk/radar.npz -o walk.mmw --bytes 10000
  mmweaver compress adc_data.bin --radar radar.json -o capture.mmw --quality 30
  mmweaver compress hour_2.bin --radar radar.json -o capture.mmw --quality 30 --append
  mmweaver compress adc_data.bin --radar radar.json -o capture.mmwl --quality lossless
  mmweaver compress HuPR/single_1/hori -o single_1.mmw --bytes 400000
  mmweaver compress radar_frames.npy --layout rf_genesis -o walk.mmw --quality 40
  mmweaver compress adc.npy --radar profile.cfg --layout frame,loop,tx,rx,sample -o capture.mmw --bytes 40072
"""


def quality(word: str) -> float:
    """'30' -> 30 dB, 'lossless' -> infinity."""
    value = math.inf if word == "lossless" else float(word)
    if math.isnan(value):
        raise ValueError
    return value


@options
class Options(Written, Samples, Ranges):
    """Stores a radar cube as moving scatterers, a static layer and their residual, in a .mmw file."""

    file: Path = option(
        "radar.npz or its folder, adc_data.bin of a DCA1000, raw ADC samples as .npy, a HuPR, mmMesh or RF-Genesis"
        " array, or a capture folder of mmwave-capture-std",
        "FILE|DIR",
        default=MISSING,
        positional=True,
    )
    out: Any = option("the .mmw or .mmwl file to write", "FILE", short="-o", kind=Path)
    bytes: int | None = option(
        "largest size of the file in bytes; it is smaller where fewer bytes hold the cube exactly",
        "N",
        group="size and quality",
    )
    quality: float | None = option(
        "signal-to-error ratio in dB in the cells with signal; or lossless: every bit of an adc_data.bin,"
        " or of the samples in a .pcap; decompress gives the same adc_data.bin",
        "DB|lossless",
        kind=quality,
    )
    preset: Literal["full", "fast"] = option("fast: without the fit of scatterers", default="full")
    append: bool = option(
        "add the frames to those of the .mmw file; --bytes counts those that are added", default=False, group="output"
    )


def run(asked: Options) -> int:
    """Compresses a recording and writes the file.

    Raises:
        InputError: For options or a recording that cannot be used.
    """
    is_raw = asked.quality == math.inf
    if (asked.bytes is None) == (asked.quality is None):
        raise InputError("say how small with --bytes, or how good with --quality DB or --quality lossless")
    if asked.out is None:
        raise InputError("name the file to write with -o")
    from mmweaver.core.output_checks import check_output_file

    if asked.append and (is_raw or asked.overwrite):
        raise InputError("--append adds to a .mmw file; leave out --quality lossless and --overwrite")
    may_exist = asked.overwrite or (asked.append and asked.out.exists())
    check_output_file(asked.out, overwrite=may_exist, inputs=[asked.file])
    return _compress_samples(asked) if is_raw else _compress_cube(asked)


def _compress_cube(asked: Options) -> int:
    from mmweaver.core.locks import locked

    if not (asked.append and asked.out.exists()):
        return _write_cube(asked, is_appended=False)
    with locked(asked.out):  # another command may be appending
        return _write_cube(asked, is_appended=True)


def _write_cube(asked: Options, *, is_appended: bool) -> int:
    from mmweaver.cli.progress import StageBar

    start = time.monotonic()
    with StageBar(NUM_STAGES, quiet=asked.quiet) as bar:
        bar("read the recording")
        from mmweaver.compression.long_recording import PIECE_VALUES, compress_recording
        from mmweaver.recordings.recording_pieces import RecordingPieces

        pieces = RecordingPieces(
            asked.file, asked.radar_name(), range_m=asked.range_m, range_bins=asked.range_bins, **asked.reading()
        )
        frames, num_values = pieces.num_frames, pieces.num_frames * pieces.num_values_a_frame
        before = asked.out.stat().st_size if is_appended else 0
        if is_appended or num_values > PIECE_VALUES:
            errors = compress_recording(
                pieces,
                asked.out,
                num_bytes=asked.bytes,
                quality_db=asked.quality,
                effort=asked.preset,
                append=is_appended,
                progress=bar,
            )
        else:
            errors = _compress_at_once(asked, pieces.cube(range(frames)), bar)
    size = asked.out.stat().st_size - before
    summary = {
        "out": str(asked.out),
        "bytes": size,
        "cube_bytes": 8 * num_values,
        "ratio": round(8 * num_values / size, 1),
        "frames": frames,
        "seconds": round(time.monotonic() - start, 2),
        **errors,
    }
    return asked.report(
        summary,
        f"{'added to' if is_appended else 'wrote'} {asked.out}: {size:,} bytes for {frames} frames,"
        f" {summary['ratio']:,} times fewer than complex64, in {summary['seconds']:.1f} s;"
        f" {_said(errors, asked.quality)}",
    )


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


def _compress_at_once(asked: Options, cube: Any, bar: Any) -> dict[str, float]:
    """Writes the file of a recording that fits into one piece; returns its errors."""
    from mmweaver.compression.mmw_codec import compress_cube, errors_db, read_cube
    from mmweaver.core.atomic_files import atomic_file

    data = compress_cube(
        cube,
        num_bytes=asked.bytes,
        quality_db=asked.quality,
        effort=asked.preset,
        progress=bar,
    )
    bar("check")
    with atomic_file(asked.out) as temporary:
        temporary.write_bytes(data)
        return errors_db(read_cube(temporary).values, cube)


def _compress_samples(asked: Options) -> int:
    """Compresses raw samples without loss, or with a bounded error."""
    from mmweaver.cli.progress import StageBar

    if asked.file.suffix not in (".bin", ".pcap", ".pcapng"):
        raise InputError(
            f"{asked.file}: --quality lossless is for the samples of a DCA1000 (.bin, .pcap or .pcapng);"
            " a cube has --quality, and is stored exactly where --bytes allow it"
        )
    radar = asked.radar_name()
    if radar is None:
        raise InputError("which radar recorded it? give --radar, for example --radar awr1843")
    start = time.monotonic()
    with StageBar(NUM_STAGES, quiet=asked.quiet) as bar:
        bar("read the radar")
        from mmweaver.compression.lossless_file import compress_bin
        from mmweaver.core.safe_files.regular_files import check_regular
        from mmweaver.io.radar_file import load_radar

        size = compress_bin(
            asked.file,
            asked.out,
            load_radar(radar),
            progress=bar,
        )
    before = check_regular(asked.file)
    summary = {
        "out": str(asked.out),
        "bytes": size,
        "raw_bytes": before,
        "ratio": round(before / size, 2),
        "max_error_counts": 0,
        "seconds": round(time.monotonic() - start, 2),
    }
    kept = "every bit kept"
    if asked.file.suffix != ".bin":
        kept += " of the samples (zeros for lost packets), without the packets"
    return asked.report(
        summary,
        f"wrote {asked.out}: {size:,} bytes, {100 * size / before:.1f} % of {before:,}; {kept}, in"
        f" {summary['seconds']:.1f} s",
    )
