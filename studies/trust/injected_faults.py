"""Does every command that writes survive a kill, a full disk and one failed write, at each event of the file system?

A fault is survived when a failure is one line with exit status 2 and leaves nothing half-written, and when the same
command, run again, ends with the same bits and nothing left over (`faulted_runs.FaultedRuns`).
"""

import argparse
import tempfile
import time
from collections import Counter
from collections.abc import Iterator
from pathlib import Path

from mmweaver.core.errors import InputError
from studies.manifest import StudyRun
from studies.result_rows import complete_rows
from studies.schema import metric
from studies.trust.fault_injection import Fault, may_mount
from studies.trust.faulted_commands import faulted_commands, prepare_inputs
from studies.trust.faulted_runs import FaultedRuns

KINDS = {
    "kill": "the process is killed at an event",
    "full": "the disk is full from an event on",
    "once": "one event fails for want of room",
    "large": "no file may grow beyond a size (RLIMIT_FSIZE)",
    "disk": "a file system (tmpfs) has room for a part of the result",
}
LIMITS = (0, 100, 3_000, 20_000, 200_000)  # bytes of a file
PARTS = (0.0, 0.3, 0.6, 0.9)  # of the result, that a small file system has room for


def add_options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--commands", nargs="+", help="commands by name, such as 'generate --overwrite' (default: all)")
    parser.add_argument("--points", type=int, help="events of each command, evenly spread (default: all)")


def run_study(options: argparse.Namespace, run: StudyRun) -> None:
    with tempfile.TemporaryDirectory() as work:
        inputs = Path(work) / "inputs"
        prepare_inputs(inputs)
        commands = {command.name: command for command in faulted_commands(inputs)}
        unknown = set(options.commands or ()) - set(commands)
        if unknown:
            raise InputError(f"no command {sorted(unknown)[0]!r}; there are: {', '.join(commands)}")
        for name in options.commands or commands:
            started = time.process_time()
            runs = FaultedRuns(commands[name], Path(work) / "run")
            tried: Counter[str] = Counter()
            failed: dict[str, list[str]] = {}
            for fault in faults_of(runs.events, options.points, runs.pages):
                tried[fault.kind] += 1
                problems = runs.problems(fault)
                if problems:
                    failed[f"{fault.kind} {fault.number}"] = problems
            _write(run, name, runs.events, tried, failed, points=options.points, started=started)


def faults_of(events: int, points: int | None = None, pages: int = 0) -> Iterator[Fault]:
    """Faults of a command that makes so many events: at each, or at `points` of them from the first to the last.

    With the number of pages of its result there are small file systems too, where they can be mounted.
    """
    if points is None or points >= events:
        numbers = list(range(1, events + 1))
    else:
        numbers = sorted({1 + round(k * (events - 1) / max(1, points - 1)) for k in range(points)})
    for kind in ("kill", "full", "once"):
        yield from (Fault(kind=kind, number=number) for number in numbers)
    yield from (Fault(kind="large", number=limit) for limit in LIMITS)
    if pages and may_mount():
        yield from (Fault(kind="disk", number=1 + int(part * pages)) for part in PARTS)


def _write(
    run: StudyRun, name: str, events: int, tried: Counter[str], failed: dict[str, list[str]], *,
    points: int | None, started: float,
) -> None:  # fmt: skip
    bad = Counter(fault.split()[0] for fault in failed)
    row = {
        "dataset": {"name": name}, "n": tried.total(), "seeds": [], "events": events, "tried": dict(tried),
        "seconds": {"of_this_process_cpu": round(time.process_time() - started, 1)}, "failed": failed,
        "metrics": {
            kind: metric(tried[kind] - bad[kind], "faults", f"survived of those tried, where {meaning}")
            for kind, meaning in KINDS.items()
        },
        "unknown": {
            "metrics.*.baseline": "a count that should be that of all tried",
            "dataset.sha256": "no data is read; the inputs are made by the study",
        },
    }  # fmt: skip
    method = name.replace(" --", "_").replace(" ", "_")
    run.write("injected_faults", method, config={"points": points}, rows=complete_rows([row]))
