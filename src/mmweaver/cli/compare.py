"""mmweaver compare: two signals, recorded or simulated, feature by feature."""

from pathlib import Path
from typing import Any, ClassVar

from mmweaver.cli.option_groups import Samples, Written, radar_name
from mmweaver.core.errors import InputError
from mmweaver.core.options import MISSING, Source, option, options

EXAMPLES = """examples:
  mmweaver compare recording/ simulated/ --out comparison/
  mmweaver compare adc_data.bin simulated/ --radar profile.cfg --tx-order 0,2,1 --out comparison/
  mmweaver compare adc.npy walk.mmw --radar radar.json --layout frame,loop,tx,rx,sample --json
  mmweaver compare board_a.bin board_b.bin --radar a.cfg --radar b.cfg --out boards/
  mmweaver compare recordings/ simulations/ --out all/    # folders of results: their spread is over recordings

A and B: a recording, a folder of mmweaver generate or process, a .mmw file, a folder of generate --stream, or a folder
of any of these. Simulate with --bin: raw samples show the whole band, the leakage and the first chirp.
"""


@options
class Options(Samples, Written):
    """Measures what tells signal B from signal A: energy behind a person, noise, leakage, clutter, antennas, chirps,
    points; ranked by effect size, with pictures on the same axes and decibels.
    """

    GROUPS: ClassVar[dict[str, str]] = {"overwrite": "output"}

    a: Path = option("the signal to compare with, such as a recording", "A", default=MISSING, positional=True)
    b: Path = option("the signal that is compared with it, such as a simulation", "B", default=MISSING, positional=True)
    range_m: tuple[float, float] | None = option(
        "ranges in metres that are compared (default: all that both show)", "NEAR,FAR", name="range"
    )
    out: Path | None = option(
        "folder for comparison.png, comparison.json and comparison.html (default: print the numbers only)", "DIR"
    )
    radar: Any = option(
        "preset, TI .cfg or radar.json; once more if B has another", "NAME|FILE", kind=Source, many=True
    )


def run(asked: Options) -> int:
    """Compares two signals, writes and prints the result.

    Raises:
        InputError: For signals that cannot be read or compared.
    """
    from mmweaver.evaluation.compare_signals import compare
    from mmweaver.evaluation.comparison_page import check_comparison_folder

    if asked.out is not None:
        check_comparison_folder(asked.out, overwrite=asked.overwrite, inputs=[asked.a, asked.b])
    radars = [radar_name(name, asked.radar_set) for name in asked.radar or [None]]
    if len(radars) > 2:
        raise InputError("--radar is that of A, and once more that of B")
    found = compare(
        asked.a,
        asked.b,
        radar=radars[0],
        radar_b=radars[1] if radars[1:] else None,
        range_m=asked.range_m,
        **asked.reading(),
    )
    written = [] if asked.out is None else found.save(asked.out, overwrite=asked.overwrite)
    files = [f"\nwrote {', '.join(map(str, written))}"] if written else []
    return asked.report(found.to_values(), found.text(), *files)
