"""Runs the commands that write with faults, and says what was not survived.

What a fault costs is kept small without leaving any out: long computations are done once (`FaultedCommand.computes`),
and of faults that leave the same files only the first is followed by a second run.
"""

import contextlib
import functools
import hashlib
import importlib
import io
import mmap
import shutil
from collections.abc import Iterator
from dataclasses import fields, is_dataclass, replace
from pathlib import Path
from typing import Any
from unittest import mock

import numpy as np

from mmweaver.compression.mmw_codec import read_cube
from mmweaver.compression.mmw_container import MmwFile
from tests.faults.fault_injection import (
    HIDDEN_COMMITTED,
    Fault,
    Outcome,
    run_in_child,
    small_disk,
    tree,
    what_a_run_finds,
)
from tests.faults.faulted_commands import FaultedCommand

NOTHING = "interrupted; nothing was written"


class FaultedRuns:
    """Runs one command with faults, and says what was not survived."""

    def __init__(self, command: FaultedCommand, work: Path):
        """Runs it without a fault first: the files of that run are what every other must end with."""
        self.command, self.work = command, work
        self.computed: dict[str, Any] = {}
        self.second_runs: dict[frozenset[tuple[str, str]], list[str]] = {}  # by what they began with
        emptied(work / "first")
        with contextlib.redirect_stdout(io.StringIO()):
            status = self._main(work / "first")  # in this process: children need not import anything
        if status != 0:
            raise RuntimeError(f"{command.name} fails without a fault")
        self.old = work / "old"
        emptied(self.old)
        if command.before is not None:
            self._run(self.old, line=command.before)
        self.before = tree(self.old)
        outcome = self._run(self._fresh())
        assert outcome.status == 0, f"{command.name}: {outcome}"
        self.events = outcome.events
        self.expected = tree(work / "out", command.varying)
        self.pages = _pages(work / "out")

    def _fresh(self) -> Path:
        out = self.work / "out"
        emptied(out)
        shutil.copytree(self.old, out, dirs_exist_ok=True)
        return out

    def _run(self, out: Path, fault: Fault | None = None, *, line: str | None = None) -> Outcome:
        return run_in_child(lambda: self._main(out, line), out, fault)

    def _main(self, out: Path, line: str | None = None) -> int:
        with computed_once(self.command.computes, self.computed), stopped_clocks():
            return self.command.run(out, line)

    def problems(self, fault: Fault) -> list[str]:
        """What is wrong after a fault and, once more, after the command is run again; nothing where all is survived."""
        if fault.kind == "disk":
            return self._problems_of_small_disk(fault.number)
        out = self._fresh()
        outcome = self._run(out, fault)
        is_interrupted = fault.kind == "interrupt"
        found = [] if fault.kind == "kill" else self._after_failure(outcome, out, is_interrupted=is_interrupted)
        if fault.kind == "kill" and outcome.status is not None:
            found.append(f"was not killed but ended with {outcome.status}")
        state = what_a_run_finds(out)
        if state not in self.second_runs:  # from the same files the same command does the same
            self.second_runs[state] = self._of_second_run(out)
        return found + self.second_runs[state]

    def _problems_of_small_disk(self, pages: int) -> list[str]:
        """What is wrong where the result lies on a disk that it does not fit on, and after space is made there."""
        out = self.work / "out"
        emptied(out)
        with small_disk(out, _pages(self.old) + pages) as make_space:
            shutil.copytree(self.old, out, dirs_exist_ok=True)
            found = self._after_failure(self._run(out), out)
            make_space()
            return found + self._of_second_run(out)

    def _of_second_run(self, out: Path) -> list[str]:
        second, found = self._run(out), []
        if self.command.appends:
            return [f"run again: {second.status} {second.stderr[-200:]}"] * (second.status != 0) + self._of_appended(
                out
            )
        now = tree(out, self.command.varying)
        if self.command.grows and second.status == 2 and "holds a stream already" in second.stderr:
            return _of_parts(now, self.expected)
        is_there = second.status == 2 and "exists" in second.stderr and now == self.expected
        if second.status != 0 and not is_there:
            found.append(f"run again: {second.status} {second.stderr[-200:]}")
        if now != self.expected:
            different = sorted(name for name in {*now, *self.expected} if now.get(name) != self.expected.get(name))
            found.append(f"run again: other files: {different[:4]}")
        return found

    def _of_appended(self, out: Path) -> list[str]:
        """What is wrong with files that were appended to, perhaps by both runs."""
        found = []
        for old in self.old.rglob("*.mmw"):
            new = out / old.relative_to(self.old)
            if not new.read_bytes().startswith(old.read_bytes()):
                found.append(f"{new.name} no longer begins with what it held")
                continue
            held, total = MmwFile(old).num_frames, len(read_cube(new).values)
            if total not in (2 * held, 3 * held):
                found.append(f"{new.name} holds {total} frames after appending to {held}")
        return found

    def _after_failure(self, outcome: Outcome, out: Path, *, is_interrupted: bool = False) -> list[str]:
        now = tree(out)
        if outcome.status == 0:  # an event that may fail, or a file that never grew so large
            return [] if tree(out, self.command.varying) == self.expected else ["status 0 without the result"]
        found = []
        lines = [line for line in outcome.stderr.splitlines() if line.strip()]
        if outcome.status != (130 if is_interrupted else 2):
            found.append(f"status {outcome.status}")
        elif is_interrupted and NOTHING in outcome.stderr and now != self.before:
            found.append(f"not true: {outcome.stderr[:200]!r}")
        elif len(lines) != 1 or len(lines[0]) > 500 or not lines[0].startswith("mmweaver: error: "):
            found.append(f"not one line: {outcome.stderr[:200]!r}")
        if any(HIDDEN_COMMITTED in name for name in now):
            return found  # complete new files are there, and the next run moves them into place
        litter = [name for name in now if Path(name).name.startswith(".")]
        if litter:
            found.append(f"left over: {litter[:3]}")
        is_whole = tree(out, self.command.varying) == self.expected  # a name that could not be synced is reported
        is_kept = self.command.is_resumable or self.command.grows
        if not is_kept and not is_whole and now != self.before:
            changed = sorted(name for name in {*now, *self.before} if now.get(name) != self.before.get(name))
            found.append(f"half-written: {changed[:4]}")
        return found


def _pages(folder: Path) -> int:
    """Pages that a tmpfs gives to a folder: each file has its own, and the root one."""
    return 1 + sum(-(-path.stat().st_size // mmap.PAGESIZE) for path in folder.rglob("*") if path.is_file())


def _of_parts(now: dict[str, str], expected: dict[str, str]) -> list[str]:
    """What is wrong with the parts that are there, and what is left over."""
    wrong = [name for name, digest in now.items() if "/parts/" in name and expected.get(name) != digest]
    hidden = [name for name in now if Path(name).name.startswith(".")]
    return [f"not whole, or left over: {names[:4]}" for names in (sorted({*wrong, *hidden}),) if names]


@contextlib.contextmanager
def stopped_clocks() -> Iterator[None]:
    """No time passes that commands write into their files."""
    with mock.patch("time.process_time", float), mock.patch("mmweaver.core.stages.perf_counter", float):
        yield


@contextlib.contextmanager
def computed_once(names: tuple[str, ...], results: dict[str, Any]) -> Iterator[None]:
    """Functions, given as "module:function", take their results from `results` by their arguments, or add them."""
    with contextlib.ExitStack() as patches:
        for name in names:
            module, path = name.split(":")
            *owners, function = path.split(".")
            owner = functools.reduce(getattr, owners, importlib.import_module(module))
            patches.enter_context(_taken_from(results, owner, function))
        yield


def _taken_from(results: dict[str, Any], owner: Any, name: str) -> Any:
    function = getattr(owner, name)

    def remembered(*arguments: Any, **options: Any) -> Any:
        take_cube = options.pop("take_cube", None)  # of generate_room: called with each cube, which is remembered, too
        key = _key_of((name, arguments, options))
        if key not in results:
            results[key] = function(*arguments, **options)
        if take_cube is not None:
            for sequence in results[key].sequences:
                take_cube(sequence.cube)
            bare = tuple(replace(one, cube=None) for one in results[key].sequences)
            return replace(results[key], sequences=bare)
        return results[key]

    return mock.patch.object(owner, name, remembered)


def _key_of(value: Any) -> str:
    """The same text for equal arguments: records by their fields, without what they cache, and arrays by values."""
    if is_dataclass(value) and not isinstance(value, type):
        return f"{type(value).__name__}{[_key_of(getattr(value, field.name)) for field in fields(value)]}"
    if type(value).__name__ == "Tensor":
        value = value.detach().numpy()
    if isinstance(value, np.ndarray):
        return f"{value.dtype} {value.shape} {hashlib.sha256(value.tobytes()).hexdigest()}"
    if isinstance(value, (tuple, list)):
        return str([_key_of(one) for one in value])
    if isinstance(value, dict):
        return str([(name, _key_of(one)) for name, one in value.items()])
    return repr(value)


def emptied(folder: Path) -> None:
    """Makes a folder that is there and empty."""
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
