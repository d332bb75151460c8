"""Breaks the line that keeps each promise of docs/security.md: does its test fail?

python -m tools.mutants.promises             # all of them
python -m tools.mutants.promises playlist    # those whose name contains a word
"""

import sys
import tomllib
from dataclasses import dataclass
from pathlib import Path

from tools.mutants.copies import BUILD, copy_tree, run_command
from tools.mutants.places import PACKAGE

FILE = Path(__file__).with_name("promises.toml")


@dataclass(frozen=True, kw_only=True)
class Promise:
    """A line that keeps a promise, the line that breaks it, and the test that then fails."""

    name: str
    file: str
    line: str
    broken: str
    test: str

    @property
    def path(self) -> Path:
        """The source file, relative to the repository."""
        return PACKAGE / self.file

    def break_in(self, root: Path) -> None:
        """Breaks the line in a copy of the tree."""
        text = (root / self.path).read_text(encoding="utf-8")
        assert text.count(f"{self.line}\n") == 1, f"{self.name}: the line is not there once"
        (root / self.path).write_text(text.replace(f"{self.line}\n", f"{self.broken}\n"), encoding="utf-8")


def read_promises() -> list[Promise]:
    """All of them."""
    return [Promise(**row) for row in tomllib.loads(FILE.read_text(encoding="utf-8"))["promise"]]


def unnoticed(promises: list[Promise], copy: Path) -> list[str]:
    """Names of promises whose test passes although their line is broken."""
    found = []
    for promise in promises:
        sound = (copy / promise.path).read_bytes()
        promise.break_in(copy)
        try:
            printed = run_command(copy, ["-n0", "-x", promise.test])
        finally:
            (copy / promise.path).write_bytes(sound)
        is_noticed = " failed" in printed or " error" in printed
        found += [] if is_noticed else [promise.name]
        print(f"{'noticed' if is_noticed else 'NOT NOTICED'}: {promise.name}", flush=True)
    return found


def main(words: list[str]) -> int:
    """Exit status 1 where a broken promise is not noticed."""
    chosen = [one for one in read_promises() if not words or any(word in one.name for word in words)]
    copy = BUILD / "promises"
    copy_tree(copy)
    missed = unnoticed(chosen, copy)
    print(f"{len(chosen) - len(missed)} of {len(chosen)} noticed")
    return int(bool(missed))


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
