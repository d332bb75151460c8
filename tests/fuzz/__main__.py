"""Damages files of every reader for as long as asked, and reports what became of them.

make fuzz SECONDS=3600 SEED=7
python -m tests.fuzz --cases 4000 --seed 7 --out results/hostile_input.json
"""

import argparse
import json
import platform
import resource
import sys
import time
from pathlib import Path

import torch

from tests.fuzz.harness import Report, fuzz
from tests.fuzz.readers import fuzz_folder, make_readers

ADDRESS_SPACE = 6 * 2**30  # torch alone maps several gigabytes
BATCH = 200


def main() -> int:
    """Fuzzes; exit status 1 where a case failed."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seconds", type=float, default=float("inf"), help="at most so long")
    parser.add_argument("--cases", type=int, default=10**9, help="at most so many of each reader")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--only", nargs="*", help="names of readers")
    parser.add_argument("--out", type=Path, help="the report as JSON")
    parser.add_argument("--keep", type=Path, help="folder for one file of each kind of failure")
    arguments = parser.parse_args()
    torch.set_num_threads(1)
    resource.setrlimit(resource.RLIMIT_AS, (ADDRESS_SPACE, ADDRESS_SPACE))
    reports = run(arguments.seed, arguments.cases, time.monotonic() + arguments.seconds, arguments.only)
    print(table(reports))
    for report in reports:
        for failure, count in report.failures.most_common():
            print(f"{report.name}: {count} x {failure}")
        if arguments.keep:
            arguments.keep.mkdir(parents=True, exist_ok=True)
            for number, data in enumerate(report.examples.values()):
                (arguments.keep / f"{report.name.replace(' ', '_')}_{number}").write_bytes(data)
    if arguments.out:
        arguments.out.parent.mkdir(parents=True, exist_ok=True)
        arguments.out.write_text(json.dumps(as_values(reports, arguments.seed), indent=1) + "\n")
    return int(any(report.failures for report in reports))


def run(seed: int, cases: int, until: float, only: list[str] | None = None) -> list[Report]:
    """The readers in turn, in batches, so that a time limit is shared among them."""
    with fuzz_folder() as name:
        folder = Path(name)
        readers = [reader for reader in make_readers(folder) if not only or reader.name in only]
        reports = {reader.name: Report(name=reader.name) for reader in readers}
        first = 0
        while first < cases and time.monotonic() < until:
            for reader in readers:
                part = fuzz(reader, folder, seed=seed, cases=range(first, min(first + BATCH, cases)), until=until)
                reports[reader.name].add(part)
            first += BATCH
            print(f"{first} cases of each reader", file=sys.stderr)
    return list(reports.values())


def table(reports: list[Report]) -> str:
    """The report as a Markdown table."""
    lines = [
        "| reader | cases | refused | accepted | failures | slowest, CPU s | peak memory, MB |",
        "| --- | --- | --- | --- | --- | --- | --- |",
    ]
    total = Report(name="all")
    for report in reports:
        total.add(report)
    for one in [*reports, total]:
        lines.append(
            f"| {one.name} | {one.cases:,} | {one.refused:,} | {one.accepted:,} | {one.failures.total():,} |"
            f" {one.slowest_s:.2f} | {one.peak_mb:.0f} |"
        )
    return "\n".join(lines)


def as_values(reports: list[Report], seed: int) -> dict[str, object]:
    """The report as JSON values."""
    rows = [
        {
            "reader": one.name, "cases": one.cases, "refused": one.refused, "accepted": one.accepted,
            "failures": dict(one.failures), "slowest_cpu_s": round(one.slowest_s, 3), "peak_mb": round(one.peak_mb),
        }
        for one in reports
    ]  # fmt: skip
    return {"seed": seed, "python": platform.python_version(), "readers": rows}


if __name__ == "__main__":
    sys.exit(main())
