"""Is any codec ahead of .mmw on recordings that it was not developed with, cut in many ways?

python -m studies run codec_cuts --data <recordings>        (needs the extra `codecs`)
"""

import argparse
import json
from pathlib import Path

from studies.fields.codecs import CODECS, codec_row
from studies.fields.field_signals import SIGNALS, StudySignal
from studies.fields.recording_cuts import CUTS
from studies.manifest import StudyRun
from studies.result_rows import complete_rows, in_order, kept_rows
from studies.study import Reads

EXPERIMENT = "codec_cuts"
SIZES = (2504, 10018, 40072)
USUAL = ("mmw", "klt_context", "top_klt", "svd", "sperr", "jpegxl", "jpeg2000", "blosc2")


def add_options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "--data", type=Path, action=Reads, required=True, help="folder of recordings (with radar/ in it)"
    )
    parser.add_argument("--codecs", nargs="*", default=list(USUAL))
    parser.add_argument("--signals", nargs="*", default=[*CUTS, *SIGNALS])
    parser.add_argument("--keep", action="store_true", help="keep the rows of signals that are not measured now")


def run_study(options: argparse.Namespace, run: StudyRun) -> None:
    """Every codec on every cut, and on the cubes of study `codecs`; one file a codec."""
    signals = [(CUTS if name in CUTS else SIGNALS)[name](options.data) for name in options.signals]
    measure_signals(run, EXPERIMENT, options.codecs, signals, [*CUTS, *SIGNALS] if options.keep else None)


def measure_signals(
    run: StudyRun, experiment: str, codecs: list[str], signals: list[StudySignal], keep: list[str] | None = None
) -> None:
    """Every codec on every signal at every size that is less than the cube's; one file a codec.

    With `keep`, the names of all signals in order, rows of other signals are copied from the results of an earlier run.
    """
    for name in codecs:
        rows = []
        for signal in signals:
            # codecs without loss take any size: files larger than the cube say nothing
            sizes = [size for size in SIZES if size < signal.cube.values.nbytes]
            rows += [codec_row(CODECS[name](), signal, size) for size in sizes]
            print(json.dumps({"codec": name, "signal": signal.name}), flush=True)
        if keep is not None:
            kept = kept_rows(run.out / experiment / f"{name}.json", [signal.name for signal in signals])
            rows = in_order(rows + kept, keep)
        run.write(experiment, name, config={"sizes": list(SIZES)}, rows=complete_rows(rows))
