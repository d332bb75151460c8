"""Damages files of every reader for as long as asked, and reports what became of them.

make fuzz SECONDS=3600 SEED=7
python -m tests.fuzz --total 10000 --seed 7 --keep failures/
"""

import argparse
import sys
from pathlib import Path

from tests.fuzz.campaign import limit_process, run, table


def main() -> int:
    """Fuzzes; exit status 1 where a case failed."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seconds", type=float, default=float("inf"), help="at most so long")
    parser.add_argument("--cases", type=int, default=10**9, help="at most so many of each reader")
    parser.add_argument("--total", type=int, help="instead: so many of all readers, fewer of slow ones")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--only", nargs="*", help="names of readers")
    parser.add_argument("--keep", type=Path, help="folder for one file of each kind of failure")
    arguments = parser.parse_args()
    limit_process()
    reports = run(
        arguments.seed, cases=arguments.cases, total=arguments.total, seconds=arguments.seconds, only=arguments.only
    )
    print(table(reports))
    for report in reports:
        for failure, count in report.failures.most_common():
            print(f"{report.name}: {count} x {failure}")
        if arguments.keep:
            arguments.keep.mkdir(parents=True, exist_ok=True)
            for number, data in enumerate(report.examples.values()):
                (arguments.keep / f"{report.name.replace(' ', '_')}_{number}").write_bytes(data)
    return int(any(report.failures for report in reports))


if __name__ == "__main__":
    sys.exit(main())
