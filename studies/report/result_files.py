"""results/<experiment>/<method>.json: one schema for everything that was measured."""

import json
import os
import platform
import subprocess
from pathlib import Path
from typing import Any

from mmweaver.core.atomic_files import atomic_file

SCHEMA_VERSION = 1


def write_result(
    folder: Path, *, experiment: str, method: str, config: dict[str, Any], rows: list[dict[str, Any]]
) -> Path:
    """Writes one method's rows; each row names its dataset (with hash), n, seeds, seconds and metrics.

    Every metric is an object with value, unit, definition, version and its floor. Returns the file's path.
    """
    record = {
        "schema_version": SCHEMA_VERSION,
        "origin": "measured",
        "experiment": experiment,
        "method": method,
        "config": config,
        "commit": commit(),
        "hardware": hardware(),
        "rows": rows,
    }
    path = folder / experiment / f"{method}.json"
    with atomic_file(path) as temporary:
        temporary.write_text(json.dumps(record, indent=1, allow_nan=False) + "\n", encoding="utf-8")
    return path


def hardware() -> dict[str, Any]:
    """What the seconds were measured on; one thread."""
    return {
        "machine": platform.machine(),
        "cores": os.cpu_count(),
        "python": platform.python_version(),
        "threads": 1,
        "device": "cpu",
    }


def commit() -> str | None:
    """The commit of the working tree, with "+" where files differ from it; None outside a repository."""
    here = Path(__file__).parent
    try:
        name = subprocess.run(["git", "rev-parse", "--short=12", "HEAD"], cwd=here, capture_output=True, text=True)
        changed = subprocess.run(["git", "status", "--porcelain", "--", "."], cwd=here, capture_output=True, text=True)
    except OSError:
        return None
    return name.stdout.strip() + ("+" if changed.stdout.strip() else "") if name.returncode == 0 else None
