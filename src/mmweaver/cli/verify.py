"""mmweaver verify: whether files are still as they were written, and which command makes damaged ones anew."""

import json
from pathlib import Path

from mmweaver.cli.option_groups import Printed
from mmweaver.core.options import MISSING, option, options

EXAMPLES = """examples:
  mmweaver verify walk/                  # a result folder, or one of --texts, --stream, rooms or exports
  mmweaver verify data/ --json           # a data set, or a labelled set of activities
  mmweaver verify run/                   # a training run: weights and checkpoint
  mmweaver verify walk.mmw               # or any .mmwl, .npz or .zip
"""
DAMAGED, MOST_SHOWN = 1, 20


@options
class Options(Printed):
    """Reads all of a result folder, data set, training run, weight file or .mmw file, compares it with the checksums
    that were written with it, and says which command makes damaged files anew. Exit status: 0 all is as it was written,
    1 something is damaged or missing, 2 there is nothing that can be verified.
    """

    path: Path = option("what mmweaver has written", "DIR|FILE", default=MISSING, positional=True)


def run(asked: Options) -> int:
    """Prints what is damaged; returns 0 or 1. Raises InputError where nothing can be verified."""
    from mmweaver.weaver.verification import verify

    found = verify(asked.path)
    if asked.json:
        print(json.dumps(found.to_dict(), indent=2))
    elif not asked.quiet:
        for damage in found.damaged[:MOST_SHOWN]:
            print(damage)
        if len(found.damaged) > MOST_SHOWN:
            print(f"... and {len(found.damaged) - MOST_SHOWN} more")
        for command in found.commands:
            print(f"make it anew with: {command}")
        for name in found.unchecked[:MOST_SHOWN]:
            print(f"{name} has no checksums: {_why_unchecked(found.kind, Path(name) == asked.path)}")
        count = f"{found.checked} file{'' if found.checked == 1 else 's'}"
        if found.is_sound:
            print(f"{asked.path} ({found.kind}): {count} checked, all as written")
        else:
            print(f"{asked.path} ({found.kind}): {len(found.damaged)} of {count} damaged or missing")
    return 0 if found.is_sound else DAMAGED


def _why_unchecked(kind: str, is_whole: bool) -> str:
    if kind == "stream" and is_whole:
        return "the stream goes on or was killed; only its parts have some"
    return "an earlier version of mmweaver wrote it"
