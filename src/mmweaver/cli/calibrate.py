"""mmweaver calibrate: the board that made some recordings."""

from pathlib import Path
from typing import ClassVar

from mmweaver.cli.option_groups import Ranges, Samples, Written
from mmweaver.core.errors import InputError
from mmweaver.core.options import MISSING, option, options

EXAMPLES = """examples:
  mmweaver calibrate empty.bin --radar profile.cfg --out board.json        # your room, nobody in it, some seconds
  mmweaver calibrate walk/ sit/ empty/ --out board.json                    # folders of mmweaver process: any recordings
  mmweaver calibrate adc.npy --radar radar.json --layout frame,loop,tx,rx,sample --out board.json
  mmweaver calibrate near.csv middle.csv far.csv --radar iwr1443_mars --out board.json       # clouds of people
  mmweaver calibrate cloud.csv --radar iwr1443_mars --body-z -0.15 --out board.json
  mmweaver calibrate reflector.bin --radar profile.cfg --target 2.50,-3.2 --out board.json    # a corner reflector
  mmweaver calibrate squats.csv --radar iwr1443_mars --action "a person squats" --out board.json
  mmweaver generate --demo --radar profile.cfg --board board.json --out like_mine/
"""


@options
class Options(Written, Samples, Ranges):
    """Finds what recordings show of the board that made them: IF response, noise figure, leakage, antenna gains and
    phases, first chirps, drift; of point clouds the elevation offset. Nothing need be known of the room. Says what it
    could not see and why; generate --board takes the file.
    """

    GROUPS: ClassVar[dict[str, str]] = {"radar": "what recordings do not bring"}
    recordings: list[Path] = option(
        "raw samples, a folder of mmweaver process, or a point cloud", "RECORDING", default=MISSING, positional=True
    )
    out: Path = option("the board's file", "JSON", default=MISSING, is_setting=False)
    body_z_m: float | None = option(
        "the true mean height of the people in point clouds over the radar's level, in metres", "M", name="body-z"
    )
    action: str | None = option("a sentence that says what the people in point clouds did (default: they wave)", "TEXT")
    target: tuple[float, ...] | None = option(
        "true distance in metres of the strongest echo near it, straight ahead, and its cross section: gives range"
        " bias, and gain",
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
        body_z_m=asked.body_z_m,
        doing=asked.action,
        name=asked.out.stem,
        **asked.reading(),
        target=None if asked.target is None else KnownTarget(*asked.target),
    )
    found.board.save(asked.out)
    return asked.report(found.to_values(), found.text(), f"wrote {asked.out}")
