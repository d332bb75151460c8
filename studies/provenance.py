"""Where a result comes from: commit of this repository, version of mmweaver, machine, threads and device."""

import os
import platform
import subprocess
import sys
from pathlib import Path
from typing import Any

import mmweaver
from mmweaver.core.constants import __version__

ROOT = Path(__file__).resolve().parents[1]
MEASURED = ("src", "studies", "benchmarks")  # folders whose files decide what is measured


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
