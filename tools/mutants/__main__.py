"""Breaks sampled lines one at a time, reports how many the fast tests notice, and writes results/mutants.json.

make mutants SEED=1 COUNT=100
python -m tools.mutants --seed 1 --count 100 --jobs 2 --out build/mutants/seed_1.json
"""

import argparse
import json
import math
import multiprocessing
import subprocess
import sys
from collections import Counter
from pathlib import Path
from typing import Any

from tools.mutants.copies import BUILD, ROOT, copy_tree
from tools.mutants.covering import measured
from tools.mutants.places import PARTS, sampled_places
from tools.mutants.trials import MOST_S, Trials, try_all


def main() -> int:
    """Exit status 1 where fewer than --least per cent are noticed."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--count", type=int, default=100)
    parser.add_argument("--jobs", type=int, default=1, help="mutants at a time")
    parser.add_argument("--least", type=float, default=85.0, help="per cent that must be noticed")
    parser.add_argument("--out", type=Path, default=ROOT / "results" / "mutants.json")
    arguments = parser.parse_args()
    BUILD.mkdir(parents=True, exist_ok=True)
    covering = measured(BUILD / "whole")
    places = sampled_places(BUILD / "whole", arguments.seed, arguments.count)
    log = BUILD / "verdicts.jsonl"
    copies = [BUILD / f"broken_{job}" for job in range(arguments.jobs)]
    for copy in copies:
        copy_tree(copy)
    unsound: set[str] = set()
    while True:
        apart = multiprocessing.get_context("spawn")  # what has forked before must not fork again
        workers = [
            apart.Process(target=try_all, args=(Trials(copy, covering, log, unsound), places[job :: len(copies)]))
            for job, copy in enumerate(copies)
        ]
        for worker in workers:
            worker.start()
        for worker in workers:
            worker.join()
        trials = Trials(copies[0], covering, log, unsound)
        failed = trials.dropped(places)
        if not failed:
            break
        unsound |= failed
    result = summary(arguments.seed, [trials.verdict(place) for place in places])
    arguments.out.write_text(json.dumps(result, indent=1) + "\n", encoding="utf-8")
    print(f"{result['noticed']} of {result['count']} noticed; 95 % interval {result['interval_percent']} %")
    return int(result["noticed"] < arguments.least / 100 * result["count"])


def summary(seed: int, verdicts: list[dict[str, Any]]) -> dict[str, Any]:
    noticed = [verdict for verdict in verdicts if verdict["noticed_by"]]
    by_commit = subprocess.run(["git", "rev-parse", "HEAD"], cwd=ROOT, capture_output=True, text=True, check=True)
    return {
        "definition": "lines of the package broken one at a time; noticed: a test of `make test` that executes the "
        f"line fails (at most {MOST_S:.0f} CPU seconds of tests per line; a line that no test executes is not noticed)",
        "seed": seed,
        "commit": by_commit.stdout.strip(),
        "count": len(verdicts),
        "noticed": len(noticed),
        "uncovered": sum(not (verdict["is_covered"] or verdict["noticed_by"]) for verdict in verdicts),
        "interval_percent": [round(100 * bound, 1) for bound in wilson(len(noticed), len(verdicts))],
        "by_kind": _shares(verdicts, "kind"),
        "by_part": _shares(verdicts, "part"),
        "pages": {name: part.pages for name, part in PARTS.items()},
        "mutants": [
            {name: value for name, value in verdict.items() if name not in ("key", "tests")} for verdict in verdicts
        ],
    }


def _shares(verdicts: list[dict[str, Any]], name: str) -> dict[str, str]:
    of = Counter(verdict[name] for verdict in verdicts)
    noticed = Counter(verdict[name] for verdict in verdicts if verdict["noticed_by"])
    return {value: f"{noticed[value]} of {of[value]}" for value in sorted(of)}


def wilson(noticed: int, count: int, z: float = 1.96) -> tuple[float, float]:
    """The 95 % interval of a share."""
    share = noticed / count
    middle = share + z**2 / (2 * count)
    half = z * math.sqrt(share * (1 - share) / count + z**2 / (4 * count**2))
    return (middle - half) / (1 + z**2 / count), (middle + half) / (1 + z**2 / count)


if __name__ == "__main__":
    sys.exit(main())
