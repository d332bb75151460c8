"""mmweaver verify: whether files are unchanged since they were written, and which command regenerates damaged ones."""

from pathlib import Path

from mmweaver.cli.option_groups import Printed
from mmweaver.core.options import MISSING, option, options

EXAMPLES = """examples:
  mmweaver verify walk/                  # a result folder, or one of --texts, --stream, rooms or exports
  mmweaver verify data/ --json           # a data set, or a labelled set of activities
  mmweaver verify run/                   # a training run: weights and checkpoint
  mmweaver verify walk.mmw               # or any .mmwl, .npz or .zip
"""
DAMAGED, MAX_SHOWN = 1, 20


@options
class Options(Printed):
    """Reads all of a result folder, data set, training run, weight file or .mmw file, compares it with the checksums
    that were written with it, and says which command makes damaged files anew. Exit status: 0 all is as it was written,
    1 something is damaged or missing, 2 there is nothing that can be verified.
    """

    path: Path = option("what mmweaver has written", "DIR|FILE", default=MISSING, positional=True)


def run(asked: Options) -> int:
    """Prints what is damaged.

    Returns:
        0 if nothing is, otherwise 1.

    Raises:
        InputError: If nothing can be verified.
    """
    from mmweaver.datasets.verification import verify

    found = verify(asked.path)
    count = f"{found.checked} file{'' if found.checked == 1 else 's'}"
    damaged = len(found.damaged)
    lines = [*map(str, found.damaged[:MAX_SHOWN])]
    lines += [f"... and {damaged - MAX_SHOWN} more"] if damaged > MAX_SHOWN else []
    lines += [f"make it anew with: {command}" for command in found.commands]
    lines += [
        f"{name} has no checksums: {_why_unchecked(found.kind, Path(name) == asked.path)}"
        for name in found.unchecked[:MAX_SHOWN]
    ]
    verdict = f"{count} checked, all as written" if found.is_sound else f"{damaged} of {count} damaged or missing"
    asked.report(found.to_dict(), *lines, f"{asked.path} ({found.kind}): {verdict}")
    return 0 if found.is_sound else DAMAGED


def _why_unchecked(kind: str, is_whole: bool) -> str:
    if kind == "stream" and is_whole:
        return "the stream goes on or was killed; only its parts have some"
    return "an earlier version of mmweaver wrote it"
