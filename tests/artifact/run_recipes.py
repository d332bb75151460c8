"""Runs recipes, one after the other in this process, as the installed package: [text, is_python, commands] on stdin.

Prints one line of JSON: what each command wrote on stdout.
"""

import contextlib
import io
import json
import os
import sys

from mmweaver.cli.main import main


def run() -> list[str]:
    """Stops at the first command that fails."""
    said = []
    for text, is_python, commands in json.load(sys.stdin):
        if is_python:
            exec(compile(text, "README.md", "exec"), {})
        for words in commands:
            if words[0] == "cd":
                os.chdir(words[1])
                continue
            out = io.StringIO()
            with contextlib.redirect_stdout(out):
                try:
                    status = main(words[1:])
                except SystemExit as ended:  # of --help
                    status = ended.code
            if status not in (0, None):
                sys.exit(f"{' '.join(words)}: status {status}")
            said.append(out.getvalue())
    return said


if __name__ == "__main__":
    sys.stdout.write(json.dumps(run()) + "\n")
