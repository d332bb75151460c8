"""Does a command that is killed (SIGKILL) at random moments, several times in a row, end with the same bits?

`generate`, `train`, and `dataset` with two worker processes. After each kill every process of the command must end, and
every file that has its final name must be complete.
"""

import argparse
import contextlib
import io
import os
import random
import signal
import tempfile
import time
from dataclasses import replace
from pathlib import Path

from mmweaver.weaver.verification import verify
from studies.manifest import StudyRun
from studies.result_rows import complete_rows
from studies.schema import metric
from studies.trust.fault_injection import run_in_child, tree
from studies.trust.faulted_commands import FaultedCommand, faulted_commands, prepare_inputs
from studies.trust.faulted_runs import emptied, stopped_clocks

DEADLINE_S = 60.0  # for workers to end after the process that started them
IN_A_ROW = 5
REPLACED = ("checkpoint.pt", "best.safetensors")  # while training goes on; they need only be sound
COMPLETED = ("data/zarr.json", "data/SHA256SUMS")  # of a data set, when its last room is there; before, only sound


def add_options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--kills", type=int, default=50, help="kills of each command (default 50)")
    parser.add_argument("--seed", type=int, default=0)


def run_study(options: argparse.Namespace, run: StudyRun) -> None:
    rows = []
    with tempfile.TemporaryDirectory() as work:
        inputs = Path(work) / "inputs"
        prepare_inputs(inputs, which=("data",))
        for name, command in killed_commands(inputs).items():
            killed = KilledRuns(command, Path(work) / command.name, random.Random(options.seed))
            failed = killed.problems(options.kills)
            rows.append(
                {
                    "dataset": {"name": name}, "n": killed.kills, "seeds": [options.seed], "seconds": None,
                    "failed": failed,
                    "metrics": {"survived": metric(killed.kills - len(failed), "kills", __doc__.splitlines()[0])},
                    "unknown": {
                        "metrics.*.baseline": "a count that should be that of all tried",
                        "dataset.sha256": "no data is read",
                        "seconds": "in the manifest",
                    },
                }
            )  # fmt: skip
    run.write("trust", "random_kills", config={"in_a_row": IN_A_ROW}, rows=complete_rows(rows))


def killed_commands(inputs: Path) -> dict[str, FaultedCommand]:
    """`generate` and `train` as they are, and `dataset` with two worker processes, by the names of the table."""
    commands = {command.name: command for command in faulted_commands(inputs)}
    alone = commands["dataset"]
    workers = replace(alone, line=f"{alone.line} --workers 2")
    return {"generate": commands["generate"], "train": commands["train"], "dataset --workers 2": workers}


class KilledRuns:
    """Kills one command at random moments."""

    def __init__(self, command: FaultedCommand, work: Path, rng: random.Random):
        """Runs it whole first: the files of that run are what all others must end with."""
        self.command, self.work, self.rng = command, work, rng
        self.kills = self.session = 0
        self.out = work / "out"  # files may name the folder that they lie in
        self._whole_run()  # in this process, so that those that are killed need not import anything
        started = time.perf_counter()
        self._whole_run()
        self.wall_s = time.perf_counter() - started
        self.expected = tree(self.out, command.varying)

    def problems(self, kills: int) -> list[str]:
        """What was not survived: at most one line a kill, and one a chain of kills."""
        found: list[str] = []
        while self.kills < kills:
            emptied(self.out)
            for _ in range(min(IN_A_ROW, kills - self.kills)):
                if not self._kill_one():
                    break  # it ended before
                self.kills += 1
                wrong = self._wrong()
                found += [f"kill {self.kills}: {wrong}"] if wrong else []
            outcome = run_in_child(self._run, self.out)
            is_there = outcome.status == 2 and "exists" in outcome.stderr
            if outcome.status != 0 and not is_there:
                found.append(f"run again after kill {self.kills}: {outcome.stderr[-200:]}")
            elif tree(self.out, self.command.varying) != self.expected:
                found.append(f"run again after kill {self.kills}, it ended with other files")
        return found

    def _whole_run(self) -> None:
        emptied(self.out)
        with contextlib.redirect_stdout(io.StringIO()):
            status = self._run()
        if status != 0:
            raise RuntimeError(f"{self.command.name} fails without a kill")

    def _run(self) -> int:
        with stopped_clocks():
            return self.command.run(self.out)

    def _kill_one(self) -> bool:
        """Starts the command in a session of its own and kills its first process, unless it ends before."""
        child = os.fork()
        if child == 0:
            os.setsid()
            nothing = os.open(os.devnull, os.O_WRONLY)
            os.dup2(nothing, 1)
            os.dup2(nothing, 2)
            os._exit(self._run())
        started = time.perf_counter()
        moment_s = self.rng.random() * self.wall_s
        while time.perf_counter() - started < moment_s:
            if os.waitpid(child, os.WNOHANG)[0]:
                self.wall_s = time.perf_counter() - started  # the first run had more to import
                return False
            time.sleep(0.01)
        os.kill(child, signal.SIGKILL)
        os.waitpid(child, 0)
        self.session = child
        return True

    def _wrong(self) -> str:
        """Processes that go on after a kill, and files with their final name that are not what they should be."""
        deadline = time.monotonic() + DEADLINE_S
        while left := _session(self.session):
            if time.monotonic() > deadline:
                return f"processes {left} still run"
            time.sleep(0.05)
        return self._incomplete()

    def _incomplete(self) -> str:
        """Files with their final name that are not what they should be."""
        now = tree(self.out, (*self.command.varying, *REPLACED))
        wrong = [
            name
            for name, digest in now.items()
            if not any(part.startswith(".") for part in Path(name).parts) and name not in COMPLETED
            and self.expected.get(name) != digest
        ]  # fmt: skip
        places = {file.parent for name in REPLACED for file in self.out.rglob(name)}
        places |= {(self.out / name).parent for name in COMPLETED if (self.out / name).is_file()}
        found = [damage for place in places for damage in verify(place).damaged]
        wrong += [str(damage) for damage in found if "missing" not in damage.what]  # rooms that are still to be made
        return f"not complete: {wrong[:3]}" if wrong else ""


def _session(leader: int) -> list[int]:
    """Processes of a session that still run."""
    found = []
    for stat in Path("/proc").glob("[0-9]*/stat"):
        try:
            state, _, _, session = stat.read_text().rpartition(")")[2].split()[:4]
        except (FileNotFoundError, ProcessLookupError):
            continue
        if int(session) == leader and state != "Z":
            found.append(int(stat.parent.name))
    return found
