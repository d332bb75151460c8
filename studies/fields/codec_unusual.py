"""Is any codec ahead of .mmw on cubes unlike any that it was developed with?

python -m studies run codec_unusual --data <recordings>        (needs the extra `codecs`)
"""

import argparse
from pathlib import Path

from studies.fields.codec_cuts import USUAL, measure_signals
from studies.fields.unusual_signals import UNUSUAL
from studies.manifest import StudyRun
from studies.study import Reads

EXPERIMENT = "codec_unusual"


def add_options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "--data", type=Path, action=Reads, required=True, help="folder of recordings (with radar/ in it)"
    )
    parser.add_argument("--codecs", nargs="*", default=list(USUAL))
    parser.add_argument("--signals", nargs="*", default=list(UNUSUAL))
    parser.add_argument("--keep", action="store_true", help="keep the rows of signals that are not measured now")


def run_study(options: argparse.Namespace, run: StudyRun) -> None:
    """Every codec on every cube; one file a codec."""
    signals = [UNUSUAL[name](options.data) for name in options.signals]
    measure_signals(run, EXPERIMENT, options.codecs, signals, list(UNUSUAL) if options.keep else None)
