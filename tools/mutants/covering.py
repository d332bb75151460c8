"""Which tests execute a line: one run of the fast tests with a coverage context per test, kept until a file changes."""

import hashlib
import json
import re
from collections import defaultdict
from collections.abc import Iterable, Iterator
from functools import cached_property
from itertools import zip_longest
from pathlib import Path
from typing import Any

from coverage import CoverageData

from tools.mutants.copies import BUILD, copy_tree, digest, run_command, tracked_files
from tools.mutants.places import PACKAGE, Place

_SPENT = re.compile(r"^ *([\d.]+) s  (\S.*::.*)$", re.MULTILINE)  # as tests/cpu_summary.py prints it
_PASSED = re.compile(r"^PASSED (\S.*)$", re.MULTILINE)
_LITTLE_S = 0.05  # of the tests that it does not print
_DATA, _STATE = BUILD / "coverage.db", BUILD / "coverage.json"


def measured(copy: Path) -> "Covering":
    """Runs what has changed since the last measurement: all tests if a source has, else the test files that have."""
    copy_tree(copy)
    files = tracked_files()
    sources = digest(copy, [name for name in files if name.startswith("src/") and name.endswith(".py")])
    tests = {name: digest(copy, [name]) for name in files if re.fullmatch(r"tests/.*test_\w+\.py", name)}
    state: dict[str, Any] = json.loads(_STATE.read_text()) if _STATE.exists() else {}
    if state.get("sources") != sources:
        _DATA.unlink(missing_ok=True)
        state = {"sources": sources, "tests": {}, "cpu_s": {}}
    changed = [name for name, now in tests.items() if state["tests"].get(name) != now]
    if changed:
        print(f"tests of {len(changed)} files run with coverage; all of them take an hour", flush=True)
        spent = _run(copy, changed if _DATA.exists() else [])
        gone = {*changed, *(set(state["tests"]) - set(tests))}
        kept = {name: cpu_s for name, cpu_s in state["cpu_s"].items() if name.partition("::")[0] not in gone}
        _STATE.write_text(json.dumps({"sources": sources, "tests": tests, "cpu_s": kept | spent}))
    return Covering(copy)


def _run(copy: Path, files: list[str]) -> dict[str, float]:
    """Adds what these files execute, all files where none is named; returns the CPU seconds of their tests."""
    new = BUILD / "coverage.new"
    arguments = [
        "-n2", "--dist=loadfile", "--no-loadscope-reorder", "-rp",
        f"--cov={PACKAGE}", "--cov-context=test", "--cov-report=", *files,
    ]  # fmt: skip
    printed = run_command(copy, arguments, COVERAGE_FILE=str(new), CPU_LINES="1000000")
    (BUILD / "coverage.log").write_text(printed)
    added, data = CoverageData(str(new)), CoverageData(str(_DATA))
    for one in (added, data):
        one.read()  # else it would be begun anew
    data.update(added)
    data.close()
    spent = {name: float(seconds) for seconds, name in _SPENT.findall(printed)}
    return {name: spent.get(name, _LITTLE_S) for name in _PASSED.findall(printed)}


def _kept() -> CoverageData:
    """Opened anew each time: what another process opened before it forked would be emptied."""
    data = CoverageData(str(_DATA))
    data.read()
    return data


class Covering:
    """Which tests run a line, and in which order they are likely to notice that it is broken."""

    def __init__(self, copy: Path) -> None:
        self.copy = copy
        state = json.loads(_STATE.read_text())
        self.cpu_s: dict[str, float] = state["cpu_s"]
        self.state = hashlib.sha256(json.dumps([state["sources"], state["tests"]]).encode()).hexdigest()[:16]
        data = _kept()
        if not data.measured_contexts():
            raise SystemExit(f"{_DATA} is empty: see {BUILD / 'coverage.log'}, and delete {_STATE}")
        self.names = set(self.cpu_s)  # of the tests that pass
        self.measured = {name[name.index(str(PACKAGE)) :]: name for name in data.measured_files()}
        self._lines: dict[str, dict[int, set[str]]] = {}

    @cached_property
    def texts(self) -> dict[str, list[str]]:
        return {name: (self.copy / name).read_text(encoding="utf-8").splitlines() for name in self.measured}

    def tests(self, place: Place) -> set[str]:
        """Those that execute the statement; of one executed at import, those that read a name it binds."""
        found = set().union(*(self._of(place.file).get(line, ()) for line in place.mutation.lines))
        for name in () if found else place.mutation.bound:
            word = re.compile(rf"\b{name}\b")
            for file, lines in self.texts.items():
                if file == place.file or not name.startswith("_"):
                    read = [number for number, line in enumerate(lines, 1) if word.search(line)]
                    found |= set().union(*(self._of(file).get(number, ()) for number in read))
        if place.mutation.bound and not found:  # read at import too, as a default or within another constant
            found = set().union(*self._of(place.file).values())
        return found

    def _of(self, file: str) -> dict[int, set[str]]:
        if file not in self._lines:
            contexts = _kept().contexts_by_lineno(self.measured[file]) if file in self.measured else {}
            self._lines[file] = {line: self._tests_of(found) for line, found in contexts.items()}
        return self._lines[file]

    def _tests_of(self, contexts: Iterable[str]) -> set[str]:
        """What a test sets up, others of its file may share: a fixture runs in the context of the first."""
        found: set[str] = set()
        for context in contexts:
            name, _, phase = context.rpartition("|")
            found |= {name} if phase != "setup" else self._by_file[name.partition("::")[0]]
        return found & self.names

    @cached_property
    def _by_file(self) -> dict[str, set[str]]:
        found: dict[str, set[str]] = defaultdict(set)
        for name in self.names:
            found[name.partition("::")[0]].add(name)
        return found

    def spent_s(self, name: str) -> float:
        """CPU seconds of a test, coverage included."""
        return self.cpu_s[name]

    def in_order(self, place: Place) -> list[str]:
        """The mirrored file first, then the others of its folder, then the fastest test of each other file by turns."""
        within = Path(place.file).relative_to(PACKAGE)
        folder = Path("tests") / within.parent
        mirror = f"{(folder / f'test_{within.name}').as_posix()}::"
        tests = self.tests(place) | {name for name in self.names if name.startswith(mirror)}
        fastest = sorted(tests, key=lambda name: (self.spent_s(name), name))
        near = [name for name in fastest if Path(name.partition("::")[0]).parent == folder]
        by_file: dict[str, list[str]] = {}
        for name in fastest:
            if name not in near:
                by_file.setdefault(name.partition("::")[0], []).append(name)
        turns: Iterator[tuple[str | None, ...]] = zip_longest(*by_file.values())
        far = [name for turn in turns for name in turn if name is not None]
        return sorted(near, key=lambda name: not name.startswith(mirror)) + far
