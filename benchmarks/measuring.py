"""What the benchmarks share: the least of some runs, and a result that is written and shown."""

import argparse
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

from studies.report.result_files import write_result

RESULTS = Path(__file__).resolve().parents[1] / "results"


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
    metrics = {name: {"value": float(f"{value:.4g}")} for name, value in values.items()}
    row = {"dataset": dataset, "metrics": metrics}
    write_result(out, experiment="benchmark", method=method, config=config, rows=[row])
    for name, value in values.items():
        print(f"{name:34} {value:12.4g}")
