"""Runs commands that are to be refused, in this process, as the installed package: a list of lists of words on stdin.
A command is one of mmweaver, or `python CODE`.

Prints one line of JSON: of each the exit status, what it wrote on stderr, and the paths that it left behind.
"""

import contextlib
import io
import json
import sys
from pathlib import Path
from typing import Any

from mmweaver.cli.main import main
from mmweaver.core.errors import InputError


def run() -> list[Any]:
    """Each command in turn, whatever it does."""
    found = []
    for words in json.load(sys.stdin):
        before, said = set(Path().rglob("*")), io.StringIO()
        with contextlib.redirect_stderr(said), contextlib.redirect_stdout(io.StringIO()):
            status = _python(words[1]) if words[0] == "python" else main(words)
        left = sorted(map(str, set(Path().rglob("*")) - before))
        found.append([status, said.getvalue(), left])
    return found


def _python(code: str) -> int:
    """Runs code, as a user's script would; reports its error as the command does."""
    try:
        exec(code, {})
    except InputError as error:
        sys.stderr.write(f"mmweaver: error: {error}\n")
        return 2
    return 0


if __name__ == "__main__":
    sys.stdout.write(json.dumps(run()) + "\n")
