"""mmweaver verify: whether files are still as they were written, and which command makes damaged ones anew."""

import argparse
import json
from pathlib import Path
from typing import Any

EXAMPLES = """examples:
  mmweaver verify walk/                  # a result folder, or one of --texts, --stream, rooms or exports
  mmweaver verify data/ --json           # a data set, or a labelled set of activities
  mmweaver verify run/                   # a training run: weights and checkpoint
  mmweaver verify walk.mmw               # or any .mmwl, .npz or .zip
"""
DAMAGED, MOST_SHOWN = 1, 20


def add_command(commands: Any) -> argparse.ArgumentParser:
    """Declares the command and its options."""
    parser = commands.add_parser(
        "verify", help="check that nothing is damaged or missing", epilog=EXAMPLES,
        description="Reads all of a result folder, data set, training run, weight file or .mmw file, compares it with"
        " the checksums that were written with it, and says which command makes damaged files anew. Exit status: 0"
        " all is as it was written, 1 something is damaged or missing, 2 there is nothing that can be verified.",
    )  # fmt: skip
    parser.add_argument("path", type=Path, metavar="DIR|FILE", help="what mmweaver has written")
    parser.add_argument("--json", action="store_true", help="print it for machines")
    parser.add_argument("--quiet", action="store_true", help="print nothing but errors; the exit status says it")
    parser.set_defaults(run=run)
    return parser


def run(arguments: argparse.Namespace) -> int:
    """Prints what is damaged; returns 0 or 1. Raises InputError where nothing can be verified."""
    from mmweaver.verification import verify

    found = verify(arguments.path)
    if arguments.json:
        print(json.dumps(found.to_dict(), indent=2))
    elif not arguments.quiet:
        for damage in found.damaged[:MOST_SHOWN]:
            print(damage)
        if len(found.damaged) > MOST_SHOWN:
            print(f"... and {len(found.damaged) - MOST_SHOWN} more")
        for command in found.commands:
            print(f"make it anew with: {command}")
        for name in found.unchecked[:MOST_SHOWN]:
            print(f"{name} has no checksums: {_why_unchecked(found.kind, Path(name) == arguments.path)}")
        count = f"{found.checked} file{'' if found.checked == 1 else 's'}"
        if found.is_sound:
            print(f"{arguments.path} ({found.kind}): {count} checked, all as written")
        else:
            print(f"{arguments.path} ({found.kind}): {len(found.damaged)} of {count} damaged or missing")
    return 0 if found.is_sound else DAMAGED


def _why_unchecked(kind: str, is_whole: bool) -> str:
    if kind == "stream" and is_whole:
        return "the stream goes on or was killed; only its parts have some"
    return "an earlier version of mmweaver wrote it"
