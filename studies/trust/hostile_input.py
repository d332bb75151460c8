"""Does any damaged file end in a traceback, a hang or gigabytes? Cases of a seed that nobody used, over every reader.

Damage, limits and measures are those of `tests/fuzz`: a case may take 20 CPU seconds and 1 GB more than the process
held before it, is refused in one line, or gives a record that is finite and possible. Rows name the exception and the
line of failures; `python -m tests.fuzz --keep DIR` with the same seed writes the files.
"""

import argparse

from studies.manifest import StudyRun
from studies.result_rows import complete_rows
from studies.schema import metric


def add_options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--total", type=int, default=100_000, help="cases of all readers (default 100,000)")
    parser.add_argument("--seed", type=int, required=True, help="one that was never used before")
    parser.add_argument("--only", nargs="+", help="names of readers (default: all)")


def run_study(options: argparse.Namespace, run: StudyRun) -> None:
    from tests.fuzz.campaign import in_all, limit_process
    from tests.fuzz.campaign import run as fuzzed

    limit_process()
    reports = fuzzed(options.seed, total=options.total, only=options.only)
    whole = in_all(reports)
    rows = [
        {
            "dataset": {"name": one.name}, "n": one.cases, "seeds": [options.seed],
            "seconds": {"cpu": round(one.cpu_s, 1)}, "failures": dict(one.failures),
            "metrics": {
                "refused": metric(one.refused, "cases", "refused in one line of at most 500 characters"),
                "accepted": metric(one.accepted, "cases", "read as a record; impossible ones count as failed, too"),
                "failed": metric(one.failures.total(), "cases", "a traceback, a hang, too much memory, a wrong record"),
                "slowest_s": metric(round(one.slowest_s, 3), "s", "CPU seconds of the slowest case"),
                "largest_mb": metric(round(one.peak_mb, 1), "MB", "largest memory during a case, less that before it"),
                "process_mb": metric(round(one.process_mb), "MB", "largest memory of the process, libraries included"),
            },
            "unknown": {
                "metrics.*.baseline": "counts that should be 0, and costs",
                "dataset.sha256": "the cases are made from the seed",
            },
        }
        for one in [*reports, whole]
    ]  # fmt: skip
    run.write("trust", "hostile_input", config={"total": options.total}, rows=complete_rows(rows))
