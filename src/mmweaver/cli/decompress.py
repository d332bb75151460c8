"""mmweaver decompress: a .mmw file back into radar.npz, a .mmwl file into its .bin, or some of their frames."""

import sys
from pathlib import Path

from mmweaver.cli.option_groups import Quiet
from mmweaver.core.errors import InputError
from mmweaver.core.options import MISSING, option, options
from mmweaver.core.safe_files.safe_text import read_text

NUM_STAGES = 2
EXAMPLES = """examples:
  mmweaver decompress walk.mmw -o walk/radar.npz
  mmweaver decompress capture.mmwl -o adc_data.bin
  mmweaver decompress capture.mmw --frames 100:120 -o part/radar.npz
"""


def frames(word: str) -> slice:
    """'3:7' -> slice(3, 7); either side may be omitted.

    >>> frames("3:")
    slice(3, None, None)
    """
    first, colon, last = word.partition(":")
    try:
        if not colon:
            raise ValueError
        return slice(int(first) if first else None, int(last) if last else None)
    except ValueError:
        raise InputError(f"{word!r} is no span of frames; write A:B, for example 0:20") from None


@options
class Options(Quiet):
    """Reads a .mmw file back; with --frames only the chunks that hold them are read."""

    file: Path = option("a .mmw or .mmwl file", "FILE", default=MISSING, positional=True)
    out: Path = option(
        "the .npz to write, with radar.json next to it; of a .mmwl file, the .bin", "FILE", default=MISSING, short="-o"
    )
    frames: slice | None = option("frames A to B-1 (default all)", "A:B", kind=frames)


def run(asked: Options) -> int:
    """Decompresses a .mmw file to radar.npz and radar.json, or a .mmwl file to its samples.

    Raises:
        InputError: For a damaged file, or an output that cannot be written.
    """
    from mmweaver.compression.lossless_file import is_lossless_file

    return _samples(asked) if is_lossless_file(asked.file) else _cube(asked)


def _samples(asked: Options) -> int:
    from mmweaver.cli.progress import StageBar
    from mmweaver.compression.lossless_file import LosslessFile
    from mmweaver.core.output_checks import check_output_file

    check_output_file(asked.out, overwrite=asked.overwrite, inputs=[asked.file])
    file = LosslessFile(asked.file)
    with StageBar(NUM_STAGES, quiet=asked.quiet) as bar:
        size = file.decompress(asked.out, asked.frames or slice(None), bar)
    _warn_of_cut(file.cut_short, asked.file)
    if not asked.quiet:
        print(f"wrote {asked.out}: {size:,} bytes of samples of radar {file.header.config.name!r}")
    return 0


def _warn_of_cut(cut_short: int, file: Path) -> None:
    if cut_short:
        print(
            f"mmweaver: {file} was cut short; these are the frames before its last {cut_short:,} bytes", file=sys.stderr
        )


def _cube(asked: Options) -> int:
    from mmweaver.cli.progress import StageBar
    from mmweaver.core.atomic_files import atomic_files
    from mmweaver.io.npz_files import write_radar_npz

    radar_out = asked.out.with_name("radar.json")
    if asked.out.name == radar_out.name:
        raise InputError(f"{asked.out}: the radar goes into radar.json; name the cube otherwise, as radar.npz")
    _check_outputs(asked, radar_out)
    with StageBar(NUM_STAGES, quiet=asked.quiet) as bar:
        bar("read")
        from mmweaver.compression.mmw_codec import read_cube
        from mmweaver.compression.mmw_container import MmwFile

        cube = read_cube(asked.file, asked.frames or slice(None))
        bar("write")
        with atomic_files(radar_out, asked.out) as (radar, archive):
            radar.write_text(cube.config.to_json(), encoding="utf-8")
            write_radar_npz(archive, cube)
    _warn_of_cut(MmwFile(asked.file).cut_short, asked.file)
    if not asked.quiet:
        print(f"wrote {asked.out}: {len(cube.values)} frames of radar {cube.config.name!r}; and {radar_out}")
    return 0


def _check_outputs(asked: Options, radar_out: Path) -> None:
    """Checks the outputs; InputError if one cannot be written. A radar.json of the same radar may exist."""
    from mmweaver.compression.mmw_container import MmwFile
    from mmweaver.core.output_checks import check_output_file

    check_output_file(asked.out, overwrite=asked.overwrite, inputs=[asked.file])
    config = MmwFile(asked.file).header.config
    try:
        is_same = read_text(radar_out) == config.to_json()
    except InputError:
        is_same = False
    check_output_file(radar_out, overwrite=asked.overwrite or is_same, inputs=[asked.file], is_named=False)
