"""Each mutant in a copy of the tree: do the tests that cover its line notice it? Verdicts are kept as they come."""

import json
import os
from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path
from typing import Any, Protocol

from tools.mutants.copies import run_tests
from tools.mutants.places import Place

MOST_S = 60.0  # CPU seconds of tests for one mutant; what they do not notice counts as survived
FIRST_S = 5.0  # of the first run; most are noticed here, before the modules of farther tests are imported
START_S = 30.0
CONFIRM_S = 3600.0
SLOWER = 4.0  # a test that takes so many times as long is stopped


class TestsOfLines(Protocol):
    state: str  # another one where tests have changed

    def tests(self, place: Place) -> set[str]: ...
    def in_order(self, place: Place) -> list[str]: ...
    def spent_s(self, name: str) -> float: ...


class Trials:
    """Verdicts on mutants, in a file that a second run continues; what survived is tried again with other tests."""

    def __init__(self, copy: Path, covering: TestsOfLines, log: Path, unsound: Iterable[str] = ()) -> None:
        """`unsound`: tests that fail on the unbroken copy, which notice nothing."""
        self.copy, self.covering, self.log, self.unsound = copy, covering, log, set(unsound)
        kept = log.read_text(encoding="utf-8").splitlines() if log.exists() else []
        self.verdicts: dict[str, dict[str, Any]] = {
            line["key"]: line for line in map(json.loads, kept) if line["noticed_by"] or line["tests"] == covering.state
        }

    def verdict(self, place: Place) -> dict[str, Any]:
        """Of one mutant: `noticed_by` a test, or None; `is_covered` says whether any test executes the line."""
        source, mutation = (self.copy / place.file).read_bytes(), place.mutation
        text = source.splitlines()[mutation.line - 1].decode().strip()
        key = f"{place.file}:{mutation.start}:{mutation.before}:{mutation.after}:{text}"
        if key in self.verdicts:
            return self.verdicts[key]
        tests = [name for name in self.covering.in_order(place) if name not in self.unsound]
        noticed_by = None
        with _broken(self.copy / place.file, mutation.apply(source)):
            for batch, spent_s in self._batches(tests):
                failed = run_tests(self.copy, batch, START_S + SLOWER * spent_s)
                if failed:
                    noticed_by = failed[0]
                    break
        verdict = {
            "key": key, "part": place.part, "file": place.file, "line": mutation.line, "kind": mutation.kind,
            "text": text, "before": mutation.before, "after": mutation.after,
            "is_covered": bool(self.covering.tests(place)), "noticed_by": noticed_by, "tests": self.covering.state,
        }  # fmt: skip
        self._keep(verdict)
        return verdict

    def dropped(self, places: Sequence[Place]) -> set[str]:
        """The tests that noticed a mutant and fail on the unbroken copy, too; their verdicts are dropped."""
        verdicts = [self.verdict(place) for place in places]
        noticing = {verdict["noticed_by"] for verdict in verdicts if "::" in (verdict["noticed_by"] or "")}
        failed = set(run_tests(self.copy, sorted(noticing), CONFIRM_S, stops_at_first=False)) if noticing else set()
        for verdict in verdicts:
            if verdict["noticed_by"] in failed:
                del self.verdicts[verdict["key"]]
        self.log.write_text("".join(json.dumps(verdict) + "\n" for verdict in self.verdicts.values()), encoding="utf-8")
        return failed

    def _batches(self, tests: list[str]) -> Iterator[tuple[list[str], float]]:
        for limit_s in (FIRST_S, MOST_S - FIRST_S):
            batch, spent_s = [], 0.0
            while tests and spent_s < limit_s:
                batch.append(tests.pop(0))
                spent_s += self.covering.spent_s(batch[-1])
            if batch:
                yield batch, spent_s

    def _keep(self, verdict: dict[str, Any]) -> None:
        self.verdicts[verdict["key"]] = verdict
        with self.log.open("a", encoding="utf-8") as file:
            file.write(json.dumps(verdict) + "\n")


def try_all(trials: Trials, places: Sequence[Place]) -> None:
    """Verdicts on all places, which are printed as they come."""
    for number, place in enumerate(places, 1):
        verdict = trials.verdict(place)
        print(
            f"{number}/{len(places)} {verdict['file']}:{verdict['line']} {verdict['kind']}: {_outcome(verdict)}",
            flush=True,
        )


def _outcome(verdict: dict[str, Any]) -> str:
    if verdict["noticed_by"]:
        return f"noticed by {verdict['noticed_by']}"
    return "SURVIVED" if verdict["is_covered"] else "UNCOVERED"


class _broken:  # noqa: N801  (reads as a statement)
    """A file with other contents, restored with its date, so that no compiled module of one is taken for the other."""

    def __init__(self, path: Path, contents: bytes) -> None:
        self.path, self.contents = path, contents

    def __enter__(self) -> None:
        self.original, self.times = self.path.read_bytes(), self.path.stat()
        self.path.write_bytes(self.contents)
        changed_ns = self.times.st_mtime_ns + 10**9 * (1 + hash(self.contents) % 10**6)
        os.utime(self.path, ns=(changed_ns, changed_ns))

    def __exit__(self, *_: object) -> None:
        self.path.write_bytes(self.original)
        os.utime(self.path, ns=(self.times.st_atime_ns, self.times.st_mtime_ns))
