"""What the benchmarks share: the least of some runs, and a result that is written and shown."""

import argparse
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

from studies.manifest import StudyRun
from studies.result_rows import COST, complete_rows

UNITS = (
    ("_cpu_s", "s"),
    ("_wall_s", "s"),
    ("_s", "s"),
    ("_gb", "GB"),
    ("_tb", "TB"),
    ("_db", "dB"),
    ("_core_days", "core-days"),
)
UNKNOWN = {
    "dataset.sha256": "made anew in every run",
    "seeds": "the least of several runs of the same",
    "seconds": "the metrics are the seconds",
    "metrics.*.baseline": COST,
}
RESULTS = Path(__file__).resolve().parents[1] / "results"


def meaning_of(name: str) -> dict[str, str]:
    """Unit and definition of a cost, from its name."""
    unit = next((unit for ending, unit in UNITS if name.endswith(ending)), "1")
    return {"unit": unit, "definition": name.replace("_", " ")}


def least_seconds(function: Callable[[], object], repeats: int = 5) -> float:
    """The least of some runs of wall time; the first, which warms up, does not count."""
    function()
    times = []
    for _ in range(repeats):
        start = time.perf_counter()
        function()
        times.append(time.perf_counter() - start)
    return min(times)


def least_cpu_seconds(function: Callable[[], object], repeats: int = 5) -> float:
    """The least of some runs of processor time, all threads together; other work on the machine hardly touches it."""
    function()
    times = []
    for _ in range(repeats):
        start = time.process_time()
        function()
        times.append(time.process_time() - start)
    return min(times)


def results_folder(description: str | None) -> Path:
    """Where --out says that results go."""
    parser = argparse.ArgumentParser(description=description)
    parser.add_argument("--out", type=Path, default=RESULTS)
    return parser.parse_args().out


def report(out: Path, method: str, dataset: dict[str, Any], values: dict[str, float], config: dict[str, Any]) -> None:
    """Writes results/benchmark/<method>.json in the project's schema and prints the same as a table."""
    metrics = {name: {"value": float(f"{value:.4g}"), **meaning_of(name)} for name, value in values.items()}
    row = {"dataset": dataset, "n": 1, "metrics": metrics}
    rows = complete_rows([row], unknown=UNKNOWN)
    StudyRun(f"benchmarks/{method}", out).write("benchmark", method, config=config, rows=rows)
    for name, value in values.items():
        print(f"{name:34} {value:12.4g}")
