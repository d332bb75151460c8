"""mmweaver calibrate: the board that made some recordings."""

from pathlib import Path

from mmweaver.cli.option_groups import Ranges, Samples, Written
from mmweaver.core.errors import InputError
from mmweaver.core.options import MISSING, option, options

EXAMPLES = """examples:
  mmweaver calibrate empty.bin --radar profile.cfg --out board.json        # your room, nobody in it, some seconds
  mmweaver calibrate walk/ sit/ empty/ --out board.json                    # folders of mmweaver process: any recordings
  mmweaver calibrate adc.npy --radar radar.json --layout frame,loop,tx,rx,sample --out board.json
  mmweaver calibrate reflector.bin --radar profile.cfg --target 2.50,-3.2 --out board.json    # a corner reflector
  mmweaver generate --demo --radar profile.cfg --board board.json --out like_mine/
"""


@options
class Options(Written, Samples, Ranges):
    """Finds what recordings show of the board that made them: IF response, noise figure, leakage, antenna gains and
    phases, first chirps, drift. Nothing need be known of the room. Reports what it could not see and why;
    generate --board takes the file.
    """

    recordings: list[Path] = option(
        "raw samples, or a folder of mmweaver process", "RECORDING", default=MISSING, positional=True
    )
    out: Path = option("the board.json to write", "JSON", default=MISSING, is_setting=False)
    target: tuple[float, ...] | None = option(
        "true distance in metres of the strongest echo near it, straight ahead, and its radar cross section in dBsm:"
        " range bias, and gain, follow",
        "RANGE[,DBSM]",
    )


def run(asked: Options) -> int:
    """Calibrates, writes and prints. Raises InputError."""
    from mmweaver.core.output_checks import check_output_file
    from mmweaver.evaluation.calibrate import calibrate
    from mmweaver.evaluation.target_fits import KnownTarget

    check_output_file(asked.out, overwrite=asked.overwrite, inputs=asked.recordings)
    if len(asked.target or ()) > 2:
        raise InputError("--target is RANGE or RANGE,DBSM")
    found = calibrate(
        *asked.recordings,
        radar=asked.radar_name(),
        range_m=asked.range_m,
        range_bins=asked.range_bins,
        name=asked.out.stem,
        **asked.reading(),
        target=None if asked.target is None else KnownTarget(*asked.target),
    )
    found.board.save(asked.out)
    return asked.report(found.to_values(), found.text(), f"wrote {asked.out}")
