"""Runs damaged inputs through readers: every case is refused in one line or gives a sound record, quickly, in little
memory, and without a word on stderr.

The memory of a case is the most that the process held in physical memory while the case ran, less what it held before:
Linux counts the former anew when asked to (proc(5), clear_refs). Elsewhere it is the growth of the largest ever held.
"""

import contextlib
import io
import random
import resource
import signal
import time
import traceback
import warnings
from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from mmweaver.core.errors import MAX_CHARACTERS, InputError

CASE_LIMIT_S, CASE_LIMIT_MB = 20.0, 1000.0
OUT_OF_MEMORY = "needs more memory than there is"  # a refusal that the machine, not the reader, has decided
_RESET, _STATUS = Path("/proc/self/clear_refs"), Path("/proc/self/status")


@dataclass(frozen=True)
class Reader:
    """One reader: a damaged file of a case, how it is read, and what is wrong with a result (None: nothing)."""

    name: str
    suffix: str
    damaged: Callable[[random.Random], bytes]
    read: Callable[[Path], Any]
    wrong: Callable[[Any], str | None] = lambda _: None


def wrong_numbers(values: np.ndarray) -> str | None:
    """What is wrong with an array as a result: numbers that are not finite, or none at all."""
    return None if values.size and np.isfinite(values).all() else "numbers that are not finite, or none"


@dataclass(kw_only=True)
class Report:
    """What became of the cases of one reader."""

    name: str
    cases: int = 0
    refused: int = 0
    accepted: int = 0
    failures: Counter[str] = field(default_factory=Counter)
    examples: dict[str, bytes] = field(default_factory=dict)  # a file of each kind of failure
    slowest_s: float = 0.0
    cpu_s: float = 0.0
    peak_mb: float = 0.0  # of one case
    process_mb: float = 0.0  # of the process, libraries included, up to the end of this reader

    def add(self, other: "Report") -> None:
        """Adds the cases of another report."""
        self.cases, self.refused = self.cases + other.cases, self.refused + other.refused
        self.accepted, self.cpu_s = self.accepted + other.accepted, self.cpu_s + other.cpu_s
        self.failures += other.failures
        self.examples = {**other.examples, **self.examples}
        self.slowest_s, self.peak_mb = max(self.slowest_s, other.slowest_s), max(self.peak_mb, other.peak_mb)
        self.process_mb = max(self.process_mb, other.process_mb)


class _HangError(BaseException):
    pass


def _alarm(*_: Any) -> None:
    raise _HangError


def fuzz(reader: Reader, folder: Path, *, seed: int, cases: range, until: float = float("inf")) -> Report:
    """Runs the cases of these numbers, or until a time of `time.monotonic`; the same seed damages in the same way."""
    report = Report(name=reader.name)
    path = folder / f"{reader.name.replace(' ', '_')}{reader.suffix}"
    for number in cases:
        if time.monotonic() > until:
            break
        data = reader.damaged(random.Random(f"{seed} {reader.name} {number}"))
        try_case(reader, path, data, report)
    return report


def try_case(reader: Reader, path: Path, data: bytes, report: Report) -> None:
    """Reads one file and counts what became of it."""
    path.write_bytes(data)
    held_mb, written = _begin_memory(), io.StringIO()
    start, report.cases = time.process_time(), report.cases + 1
    previous = signal.signal(signal.SIGALRM, _alarm)
    signal.setitimer(signal.ITIMER_REAL, 6 * CASE_LIMIT_S)  # a loaded machine is no hang
    try:
        with warnings.catch_warnings(), contextlib.redirect_stderr(written):
            warnings.simplefilter("ignore")
            problem = reader.wrong(reader.read(path))
        report.accepted += 1
        failure = problem and f"wrong result: {problem}"
    except InputError as error:
        report.refused += 1
        failure = _wrong_refusal(str(error))
    except _HangError:
        failure = "hang"
    except MemoryError:
        failure = "memory"
    except Exception as error:
        own = [frame for frame in traceback.extract_tb(error.__traceback__) if "/mmweaver/" in frame.filename]
        where = f"{Path(own[-1].filename).name}:{own[-1].lineno}" if own else "?"
        failure = f"{type(error).__name__} at {where}: {str(error)[:100]}"
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, previous)
    took, (peak_mb, process_mb) = time.process_time() - start, _most_memory()
    report.cpu_s += took
    report.slowest_s, report.process_mb = max(report.slowest_s, took), max(report.process_mb, process_mb)
    report.peak_mb = max(report.peak_mb, peak_mb - held_mb)
    if took > CASE_LIMIT_S:
        failure = failure or "slow"
    if peak_mb - held_mb > CASE_LIMIT_MB:
        failure = failure or f"memory: {peak_mb - held_mb:.0f} MB"
    if written.getvalue():
        failure = failure or f"more than one line: {written.getvalue()[:100]!r}"
    if failure:
        kind = failure.partition(": ")[0] if "wrong" not in failure else failure
        report.failures[kind] += 1
        report.examples.setdefault(kind, data)


def _wrong_refusal(text: str) -> str | None:
    if len(text) > MAX_CHARACTERS or "\n" in text:
        return f"refusal of {len(text)} characters"
    return "memory" if OUT_OF_MEMORY in text else None


def _begin_memory() -> float:
    """Begins to count the most that is held in physical memory; returns what is held now, MB."""
    if _RESET.exists():
        _RESET.write_text("5")
    return _most_memory()[0]


def _most_memory() -> tuple[float, float]:
    """The most that was held since the count began, and the most ever, MB."""
    ever = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
    if not _RESET.exists():
        return ever, ever
    line = next(line for line in _STATUS.read_text().splitlines() if line.startswith("VmHWM"))
    return int(line.split()[1]) / 1024, ever
