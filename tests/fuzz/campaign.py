"""Many cases of every reader, until a number of them is done or the time is over."""

import resource
import sys
import time
from pathlib import Path

import torch

from tests.fuzz.harness import Reader, Report, fuzz
from tests.fuzz.readers import fuzz_folder, make_readers

ADDRESS_SPACE = 6 * 2**30  # torch alone maps several gigabytes
BATCH = 200
FIRST = 20  # cases of each reader, by whose seconds a total is spread


def limit_process() -> None:
    """One thread, and no more address space than a case may need."""
    torch.set_num_threads(1)
    resource.setrlimit(resource.RLIMIT_AS, (ADDRESS_SPACE, ADDRESS_SPACE))


def run(
    seed: int,
    *,
    cases: int = 10**9,
    total: int | None = None,
    seconds: float = float("inf"),
    only: list[str] | None = None,
) -> list[Report]:
    """Runs at most `cases` of each reader, or `total` of all: fewer of slow readers, but as many CPU seconds or more.

    The readers take turns, in batches, so that a limit of `seconds` is shared among them. A case is damaged in the same
    way whatever the limits are.
    """
    until = time.monotonic() + seconds
    with fuzz_folder() as name:
        folder = Path(name)
        readers = [reader for reader in make_readers(folder) if not only or reader.name in only]
        reports = {reader.name: Report(name=reader.name) for reader in readers}
        wanted = dict.fromkeys(reports, cases)
        first = 0 if total is None else FIRST
        if total is not None:
            for reader in readers:
                reports[reader.name].add(fuzz(reader, folder, seed=seed, cases=range(FIRST), until=until))
            wanted = spread(total, {name: report.cpu_s / FIRST for name, report in reports.items()})
        while first < max(wanted.values()) and time.monotonic() < until:
            for reader in readers:
                numbers = range(first, min(first + BATCH, wanted[reader.name]))
                reports[reader.name].add(_part(reader, folder, seed, numbers, until))
            first += BATCH
            sys.stderr.write(f"{in_all(list(reports.values())).cases} cases\n")
    return list(reports.values())


def _part(reader: Reader, folder: Path, seed: int, numbers: range, until: float) -> Report:
    return fuzz(reader, folder, seed=seed, cases=numbers, until=until)


def spread(total: int, seconds_a_case: dict[str, float]) -> dict[str, int]:
    """{reader: cases} that add up to `total`: fewer of slow readers, by the fourth root of a case's time."""
    weights = {name: max(seconds, 1e-4) ** -0.25 for name, seconds in seconds_a_case.items()}
    scale = total / sum(weights.values())
    counts = {name: max(FIRST, int(scale * weight)) for name, weight in weights.items()}
    cheapest = max(weights, key=lambda name: weights[name])
    counts[cheapest] += total - sum(counts.values())
    return counts


def in_all(reports: list[Report]) -> Report:
    """All readers together."""
    total = Report(name="all")
    for report in reports:
        total.add(report)
    return total


def table(reports: list[Report]) -> str:
    """The reports as a Markdown table."""
    lines = [
        "| reader | cases | refused | accepted | failures | CPU s | slowest case, CPU s | largest case, MB |",
        "| --- | --- | --- | --- | --- | --- | --- | --- |",
    ]
    lines += [
        f"| {one.name} | {one.cases:,} | {one.refused:,} | {one.accepted:,} | {one.failures.total():,} |"
        f" {one.cpu_s:.0f} | {one.slowest_s:.2f} | {one.peak_mb:.0f} |"
        for one in [*reports, in_all(reports)]
    ]
    return "\n".join(
        [*lines, "", f"largest memory of the process, libraries included: {in_all(reports).process_mb:.0f} MB"]
    )
