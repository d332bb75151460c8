"""Runs commands that are to be refused, in this process, as the installed package: a list of lists of words on stdin.

Prints one line of JSON: of each the exit status, what it wrote on stderr, and the paths that it left behind.
"""

import contextlib
import io
import json
import sys
from pathlib import Path
from typing import Any

from mmweaver.cli.main import main


def run() -> list[Any]:
    """Each command in turn, whatever it does."""
    found = []
    for words in json.load(sys.stdin):
        before, said = set(Path().rglob("*")), io.StringIO()
        with contextlib.redirect_stderr(said), contextlib.redirect_stdout(io.StringIO()):
            status = main(words)
        left = sorted(map(str, set(Path().rglob("*")) - before))
        found.append([status, said.getvalue(), left])
    return found


if __name__ == "__main__":
    sys.stdout.write(json.dumps(run()) + "\n")
