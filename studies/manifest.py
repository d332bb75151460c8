"""A run of a study: writes results with their manifest (inputs and outputs with sha256, wall and CPU seconds)."""

import hashlib
import json
import os
import platform
import subprocess
import sys
import time
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

import mmweaver
from mmweaver.core.atomic_files import atomic_file
from mmweaver.core.constants import __version__
from studies.schema import SCHEMA_VERSION, check_record

ROOT = Path(__file__).resolve().parents[1]
MEASURED = ("src", "studies", "benchmarks")  # folders whose files decide what is measured


class StudyRun:
    """Knows what a study reads and writes, and since when it runs.

    Args:
        study: name of the study.
        out: folder of results; a result becomes `out`/<experiment>/<method>.json.
        inputs: files and folders that the study reads.
        options: what the study was asked to do, JSON values; paths by their last part.
    """

    def __init__(self, study: str, out: Path, *, inputs: Iterable[Path] = (), options: Mapping[str, Any] | None = None):
        self.study, self.out = study, Path(out)
        self.options = dict(options or {})
        self.written: list[Path] = []
        self._inputs = [Path(path) for path in inputs]
        self._hashed: dict[Path, dict[str, Any]] = {}
        self._started = _clocks()

    def reads(self, path: Path) -> Path:
        """Adds a file or folder to the inputs of the results that follow; returns it."""
        if path not in self._inputs:
            self._inputs.append(path)
        return path

    def write(
        self,
        experiment: str,
        method: str,
        *,
        config: Mapping[str, Any],
        rows: list[dict[str, Any]],
        unknown: Mapping[str, str] | None = None,
    ) -> Path:
        """Writes a result and returns its path. Raises InputError for rows that do not follow `studies.schema`.

        Seconds in the manifest are those since the run began or wrote its previous result.
        """
        wall_s, cpu_s = (now - then for now, then in zip(_clocks(), self._started, strict=True))
        path = self.out / experiment / f"{method}.json"
        record = {
            "schema_version": SCHEMA_VERSION, "origin": "measured", "study": self.study, "experiment": experiment,
            "method": method, "config": dict(config), "provenance": provenance(), "hardware": hardware(),
            "manifest": {
                "options": self.options,
                "inputs": [self._input(path) for path in self._inputs],
                "outputs": [{"name": f"{experiment}/{method}.json", "rows_sha256": rows_sha256(rows)}],
                "wall_s": round(wall_s, 2), "cpu_s": round(cpu_s, 2),
            },
            **({} if unknown is None else {"unknown": dict(unknown)}),
            "rows": rows,
        }  # fmt: skip
        text = json.dumps(record, indent=1, allow_nan=False) + "\n"
        check_record(json.loads(text), str(path))
        with atomic_file(path) as temporary:
            temporary.write_text(text, encoding="utf-8")
        self.written.append(path)
        self._started = _clocks()
        return path

    def _input(self, path: Path) -> dict[str, Any]:
        if path not in self._hashed:
            self._hashed[path] = {"name": path.resolve().name, **content_of(path)}
        return self._hashed[path]


def rows_sha256(rows: list[dict[str, Any]]) -> str:
    """The sha256 of a result's rows, which tells whether anyone has edited them since."""
    return hashlib.sha256(json.dumps(rows, sort_keys=True).encode()).hexdigest()


def content_of(path: Path) -> dict[str, Any]:
    """sha256, bytes and number of files of a file or folder; of a folder, over names and contents of all its files."""
    if path.is_file():
        return {"sha256": _file_sha256(path), "bytes": path.stat().st_size, "files": 1}
    files = sorted(file for file in path.rglob("*") if file.is_file())
    digest = hashlib.sha256()
    for file in files:
        digest.update(f"{file.relative_to(path).as_posix()} {_file_sha256(file)}\n".encode())
    return {"sha256": digest.hexdigest(), "bytes": sum(file.stat().st_size for file in files), "files": len(files)}


def _file_sha256(file: Path) -> str:
    with file.open("rb") as stream:
        return hashlib.file_digest(stream, "sha256").hexdigest()


def _clocks() -> tuple[float, float]:
    """Wall and CPU seconds; CPU of this process and of the child processes that have ended."""
    times = os.times()
    return time.perf_counter(), times.user + times.system + times.children_user + times.children_system


# where a result comes from --------------------------------------------------------------------------------------------
def provenance(root: Path = ROOT, package: Path | None = None) -> dict[str, Any]:
    """Version and commit of the code that is measured.

    `commit` is that of the repository at `root`, and only if it is mmWeaver's own and the imported mmweaver (`package`)
    lies in it; otherwise it is None and `commit_unknown` says why. `dirty`: whether any file of `MEASURED` differs from
    the commit, untracked files included.
    """
    package = Path(mmweaver.__file__).resolve().parent if package is None else package.resolve()
    record: dict[str, Any] = {"mmweaver_version": __version__, "commit": None, "dirty": None}
    reason = _why_no_commit(root, package)
    if reason is not None:
        return {**record, "commit_unknown": reason}
    changes = _git(root, "status", "--porcelain", "--untracked-files=all", "--", *MEASURED)
    return {**record, "commit": _git(root, "rev-parse", "--short=12", "HEAD"), "dirty": bool(changes)}


def _why_no_commit(root: Path, package: Path) -> str | None:
    """Why the commit cannot be known; None where it can."""
    top = _git(root, "rev-parse", "--show-toplevel")
    if top is None:
        return "not in a git repository, or git is not installed"
    is_ours = Path(top).resolve() == root.resolve() and _git(
        root, "ls-files", "--error-unmatch", "studies/__init__.py", "src/mmweaver/__init__.py"
    )
    if not is_ours:
        return "the enclosing git repository is not mmWeaver's"
    if package != (root / "src" / "mmweaver").resolve():
        return "the imported mmweaver is not the one of this repository"
    if _git(root, "rev-parse", "HEAD") is None:
        return "the repository has no commit yet"
    return None


def _git(root: Path, *words: str) -> str | None:
    """What git prints, None where it fails; variables such as GIT_DIR must not point it elsewhere."""
    environment = {name: value for name, value in os.environ.items() if not name.startswith("GIT_")}
    try:
        done = subprocess.run(["git", *words], cwd=root, env=environment, capture_output=True, text=True)
    except OSError:
        return None
    return done.stdout.strip() if done.returncode == 0 else None


def hardware() -> dict[str, Any]:
    """Machine, interpreter, and the threads and device that numpy and torch use in this process."""
    from threadpoolctl import threadpool_info

    threads = {f"{pool['user_api']} ({pool['internal_api']})": pool["num_threads"] for pool in threadpool_info()}
    device = "cpu"
    torch: Any = sys.modules.get("torch")
    if torch is not None:
        threads["torch"] = torch.get_num_threads()
        if torch.cuda.is_initialized():
            device = torch.cuda.get_device_name()
    return {
        "machine": platform.machine(),
        "cores": os.cpu_count(),
        "python": platform.python_version(),
        "threads": max(threads.values(), default=1),
        "threads_by_library": threads,
        "device": device,
    }
