"""Which number of ours stands for which table or figure of the paper, and what measures it?

    python -m studies run paper                                    # all items, with their numbers
    python -m studies run paper --table har_unseen_environment     # one, with its command
    python -m studies run paper --table signal --measure --data data/

`--measure` runs the item's study anew; all options after it are the study's own. Items are declared in
`studies/report/paper_items.toml`, and docs/paper.md shows them.
"""

import argparse
import shlex

from mmweaver.core.errors import InputError
from studies.manifest import StudyRun
from studies.report.paper_items import HEADS, paper_items


def add_options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "--table", metavar="NAME", choices=[item.name for item in paper_items()], help="one item (default: all)"
    )
    parser.add_argument("--measure", nargs=argparse.REMAINDER, help="measure it anew, with these options of its study")


def run_study(options: argparse.Namespace, run: StudyRun) -> None:
    from studies.run import run_named

    chosen = [item for item in paper_items() if options.table in (None, item.name)]
    if options.measure is not None:
        if options.table is None or not chosen[0].study:
            raise InputError("--measure needs the --table of an item that a study measures; without it, all are shown")
        study, *_ = shlex.split(chosen[0].study)
        run.written += run_named(study, options.measure)
        return
    for item in chosen:
        print(f"{item.name}:")
        for head, text in zip(HEADS, item.cells(options.results), strict=True):
            print(f"  {head + ':':18} {text}")
