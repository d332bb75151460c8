"""Copies of the working tree under build/mutants, where tests run and lines are broken."""

import hashlib
import json
import math
import multiprocessing
import os
import shutil
import signal
import subprocess
import sys
from collections.abc import Iterable, Sequence
from pathlib import Path

import pytest

from tools.mutants import selection

ROOT = Path(__file__).resolve().parents[2]
BUILD = ROOT / "build" / "mutants"
PRELOADED = ["torch", "scipy.signal", "scipy.spatial", "matplotlib.figure", "zarr", "beartype"]  # 3 s for each mutant
WALL_LIMIT = 30  # seconds of the clock per CPU second allowed: what waits for ever ends, a busy machine does not matter


def tracked_files() -> list[str]:
    """Those that git keeps or would keep, as they lie in the working tree."""
    listed = subprocess.run(
        ["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard"],
        cwd=ROOT,
        check=True,
        capture_output=True,
    )
    return sorted(name for name in listed.stdout.decode().split("\0") if name and (ROOT / name).is_file())


def digest(root: Path, files: Iterable[str]) -> str:
    total = hashlib.sha256()
    for name in files:
        total.update(name.encode() + b"\0" + hashlib.sha256((root / name).read_bytes()).digest())
    return total.hexdigest()


def copy_tree(copy: Path) -> None:
    """Brings a copy up to date; files whose size and date have not changed are left, so compiled modules stay valid."""
    wanted = set(tracked_files())
    for path in [path for path in copy.rglob("*") if path.is_file() and "__pycache__" not in path.parts]:
        if path.relative_to(copy).as_posix() not in wanted:
            path.unlink()
    for name in wanted:
        source, target = ROOT / name, copy / name
        one = source.stat()
        other = target.stat() if target.exists() else None
        if other is None or (one.st_size, one.st_mtime_ns) != (other.st_size, other.st_mtime_ns):
            target.parent.mkdir(parents=True, exist_ok=True)
            shutil.copy2(source, target)
    real_data = copy.parent / "shared"  # beside the tree, where tests look for recordings
    if (ROOT.parent / "shared").is_dir() and not real_data.exists():
        real_data.symlink_to((ROOT.parent / "shared").resolve(), target_is_directory=True)


def run_command(copy: Path, arguments: Sequence[str], **variables: str) -> str:
    """What pytest prints when it runs in a copy, on the package of the copy."""
    command = [sys.executable, "-m", "pytest", "-q", *arguments]
    environment = os.environ | _variables(copy) | variables
    ran = subprocess.run(
        command, cwd=copy, env=environment, capture_output=True, text=True, errors="replace", check=False
    )
    return ran.stdout + ran.stderr


def run_tests(copy: Path, tests: Sequence[str], cpu_limit_s: float, *, stops_at_first: bool = True) -> list[str]:
    """Runs tests in a copy, in their order, within one process that is forked with the large libraries imported.

    Returns:
        The names of those that failed; of the file where it could not be imported; "time limit" where the process took
        `cpu_limit_s`, "crash" where it ended in another way than pytest does.
    """
    selected, failed = copy.parent / f"{copy.name}-selected.json", copy.parent / f"{copy.name}-failed.txt"
    selected.write_text(json.dumps(tests))
    failed.write_text("")
    context = multiprocessing.get_context("forkserver")
    context.set_forkserver_preload(PRELOADED)
    process = context.Process(target=_run_forked, args=(copy, selected, failed, cpu_limit_s, stops_at_first))
    process.start()
    process.join(WALL_LIMIT * cpu_limit_s)
    is_late = process.is_alive() or process.exitcode == -signal.SIGXCPU
    if process.is_alive() and process.pid is not None:
        os.killpg(process.pid, signal.SIGKILL)
        process.join()
    names = list(dict.fromkeys(failed.read_text().splitlines()))
    if not names and (is_late or process.exitcode not in (pytest.ExitCode.OK, pytest.ExitCode.NO_TESTS_COLLECTED)):
        names = ["time limit" if is_late else "crash"]
    return names


def _run_forked(copy: Path, selected: Path, failed: Path, cpu_limit_s: float, stops_at_first: bool) -> None:
    import resource  # which Windows lacks

    os.setsid()
    resource.setrlimit(resource.RLIMIT_CPU, (math.ceil(cpu_limit_s), math.ceil(cpu_limit_s) + 5))
    os.environ |= _variables(copy) | {selection.SELECTED: str(selected), selection.FAILED: str(failed)}
    os.chdir(copy)
    sys.path[:0] = [str(copy / "src"), str(copy)]
    printed = os.open(copy.parent / f"{copy.name}-printed.txt", os.O_CREAT | os.O_WRONLY | os.O_TRUNC)
    os.dup2(printed, 1)
    os.dup2(printed, 2)
    files = dict.fromkeys(name.partition("::")[0] for name in json.loads(selected.read_text()))
    arguments = ["-q", "-n0", *(["-x"] if stops_at_first else []), f"--basetemp={copy.parent / f'{copy.name}-files'}"]
    present = [name for name in files if (copy / name).exists()]
    os._exit(pytest.main([*arguments, *present], plugins=[selection]))


def _variables(copy: Path) -> dict[str, str]:
    path = os.pathsep.join([str(copy / "src"), str(copy)])
    return {"PYTHONPATH": path, "OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}
