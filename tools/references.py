"""Freezes what must stay while the code is restructured, and compares: python tools/references.py freeze OUT.json

    python tools/references.py freeze OUT.json [PART ...] [--data DIR]    # resumable: what is there is kept
    python tools/references.py compare OUT.json [PART ...]                # made anew into NEW.json, then compared

Parts: cubes, steps, mmw, placements, radhar, files; cubes/bundled are the entries of one that begin so. Next to
OUT.json a folder of its name holds what the digests were made of: sentences with their steps (one JSON line each),
cubes that are encoded. `compare` takes sentences and cubes from there, so that sources that change
do not change the question, and prints what differs; sentences that are read otherwise stand side by side in
build/references/steps_*_differing.txt. Everything runs in one process on one core; set OMP_NUM_THREADS=1.
reference_parts.py makes the parts; reference_adapter.py alone names modules.
"""

import argparse
import gzip
import json
import shutil
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from reference_adapter import InputError
from reference_parts import PARTS, ROOT, Folders


def freeze(path: Path, parts: list[str], folders: Folders) -> dict[str, Any]:
    """Adds what is missing of the parts to the file, one entry after the other, and returns all of it."""
    folders.own.mkdir(parents=True, exist_ok=True)
    state = json.loads(path.read_text(encoding="utf-8")) if path.exists() else {}
    for part, _, prefix in (one.partition("/") for one in parts):
        entries, began = state.setdefault(part, {}), time.monotonic()
        for name, make in PARTS[part](folders):
            is_there = not str(entries.get(name, "failed")).startswith("failed")
            if is_there or not name.startswith(prefix):
                continue
            try:
                entries[name] = make()
            except InputError:
                entries[name] = "refused"
                print(f"{part}/{name}: refused", flush=True)
            except Exception as error:  # a part that fails is a finding, not the end of the run
                entries[name] = f"failed: {type(error).__name__}: {error}"[:300]
                print(f"{part}/{name}: {entries[name]}", flush=True)
            path.with_suffix(".new").write_text(json.dumps(state, indent=1), encoding="utf-8")
            path.with_suffix(".new").replace(path)
        print(f"{part}: {len(entries)} entries, {time.monotonic() - began:.0f} s", flush=True)
    return state


def compare(before: dict[str, Any], now: dict[str, Any], parts: list[str], folders: Folders) -> int:
    """Prints what differs, part by part; returns how many parts do."""
    differing = 0
    for part, _, prefix in (one.partition("/") for one in parts):
        old = {name: value for name, value in before.get(part, {}).items() if name.startswith(prefix)}
        new = now.get(part, {})
        same = [name for name in old if as_compared(part, old[name]) == as_compared(part, new.get(name))]
        others = [name for name in old if name not in same]
        print(f"{part}: {len(same)} of {len(old)} equal")
        for name in others if part not in ("placements", "steps") else ():
            print(f"  {name}:" + "".join(f"\n    {line}" for line in differences(old[name], new.get(name))[:6]))
        if part == "steps":
            counts = {name: compare_steps(name, folders) for name in old}
            equal, number = np.sum([[0, 0], *(one for name, one in counts.items() if name != "kitml")], axis=0)
            print(f"  all but kitml ({number}): steps equal {100 * equal / max(number, 1):.2f} %")
        elif part == "mmw":
            print_ratios(old, new)
        elif part == "placements":
            print_shares(old, new)
        elif part == "radhar":
            for name in old:
                print(f"  {name}: {old[name]} -> {new.get(name)}")
        differing += bool(others)
    return differing


def as_compared(part: str, value: Any) -> Any:
    """An entry without seconds, which no run repeats."""
    return {key: one for key, one in value.items() if key != "seconds"} if isinstance(value, dict) else value


def differences(old: Any, new: Any, where: str = "") -> list[str]:
    """Lines 'place: old -> new' of two JSON values."""
    if isinstance(old, dict) and isinstance(new, dict):
        return [line for key in {**old, **new} for line in differences(old.get(key), new.get(key), f"{where}/{key}")]
    if isinstance(old, list) and isinstance(new, list) and len(old) == len(new):
        return [
            line for k, pair in enumerate(zip(old, new, strict=True)) for line in differences(*pair, f"{where}/{k}")
        ]
    return [] if old == new or where.endswith("/seconds") else [f"{where}: {old} -> {new}"]


def compare_steps(name: str, folders: Folders) -> tuple[int, int]:
    """Prints shares of equal steps, writes those that differ side by side; returns how many are equal, of how many."""
    file = f"steps_{name.replace('/', '_')}"
    if not (folders.own / f"{file}.jsonl.gz").exists():
        return 0, 0
    old, new = (
        [json.loads(line) for line in gzip.decompress((folder / f"{file}.jsonl.gz").read_bytes()).decode().split("\n")]
        for folder in (folders.base, folders.own)
    )
    pairs = list(zip(old, new, strict=True))

    def share(same: Callable[[Any, Any], bool]) -> str:
        return f"{100 * sum(same(*pair) for pair in pairs) / len(pairs):.2f} %"

    def statuses(one: Any) -> list[str]:
        return [clause["status"] for clause in one.get("clauses", ())]

    lines = []
    for one, other in pairs:
        if one["steps"] != other["steps"] or one["read"] != other["read"]:
            lines += [one["text"], f"  read {one['read']} -> {other['read']}"]
            lines += [f"  - {step}" for step in one["steps"]] + [f"  + {step}" for step in other["steps"]]
            lines += [
                f"  now: {clause['clause']!r} {clause['status']}: {clause['how']}"
                for clause in other.get("clauses", ())
            ]
    (folders.own / f"{file}_differing.txt").write_text("\n".join(lines), encoding="utf-8")
    print(
        f"  {name} ({len(pairs)}): steps equal {share(lambda a, b: a['steps'] == b['steps'])},"
        f" read so {share(lambda a, b: a['read'] == b['read'])},"
        f" statuses {share(lambda a, b: statuses(a) == statuses(b))},"
        f" records to the letter {share(lambda a, b: a.get('clauses') == b.get('clauses'))},"
        f" person {share(lambda a, b: a.get('person') == b.get('person'))},"
        f" seconds {share(lambda a, b: a.get('seconds') == b.get('seconds'))}"
    )
    return sum(one["steps"] == other["steps"] for one, other in pairs), len(pairs)


def print_ratios(old: dict[str, Any], new: dict[str, Any]) -> None:
    """Decibels of error and seconds of all encodings, then and now."""
    names = [name for name, one in old.items() if isinstance(one, dict) and isinstance(new.get(name), dict)]
    for key in ("bytes", "signal_error_db", "all_error_db", "seconds"):
        pairs = [(old[name][key], new[name][key]) for name in names if key in old[name]]
        mean, worst = np.mean(pairs, axis=0), max(b - a for a, b in pairs)
        print(f"  {key}: mean {mean[0]:.3f} -> {mean[1]:.3f}, most more {worst:.3f}")


def print_shares(old: dict[str, Any], new: dict[str, Any]) -> None:
    """Shares of all rooms with Wilson's interval of the frozen ones."""
    for key in ("clear", "arms_clear", "seats", "false_seats"):
        (part, whole), (other, of) = (
            np.sum([one[key] for one in state.values() if isinstance(one, dict) and key in one], axis=0)
            for state in (old, new)
        )
        share, z = part / whole, 1.96
        middle = (share + z**2 / (2 * whole)) / (1 + z**2 / whole)
        half = z / (1 + z**2 / whole) * np.sqrt(share * (1 - share) / whole + (z / (2 * whole)) ** 2)
        print(f"  {key}: {share:.4f} ({middle - half:.4f} to {middle + half:.4f}, of {whole}) -> {other / of:.4f}")
    for key in ("refused", "stools", "sitters"):
        print(f"  {key}:", *(sum(one.get(key, 0) for one in state.values()) for state in (old, new)))


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("what", choices=("freeze", "compare"))
    parser.add_argument("file", type=Path, metavar="OUT.json")
    parser.add_argument("parts", nargs="*", metavar="PART", help=f"of {', '.join(PARTS)} (default: all)")
    parser.add_argument("--data", type=Path, default=ROOT.parent / "shared" / "data", help="folder of real data")
    parser.add_argument("--new", type=Path, help="compare: file of this run (default: build/references.json)")
    parser.add_argument("--resume", action="store_true", help="compare: keep what an interrupted comparison has made")
    options = parser.parse_args()
    parts = options.parts or list(PARTS)
    if unknown := {one.partition("/")[0] for one in parts} - set(PARTS):
        parser.error(f"no such part: {', '.join(sorted(unknown))}")
    base, data = options.file.with_suffix(""), options.data.resolve()
    if options.what == "freeze":
        freeze(options.file, parts, Folders(data=data, base=base, own=base))
        return 0
    if not base.is_dir():
        parts = [one for one in parts if one.partition("/")[0] not in ("steps", "mmw")]
        print(f"{base} is absent, which steps and mmw need: they are left out")
    before = json.loads(options.file.read_text(encoding="utf-8"))
    path = options.new or ROOT / "build" / "references.json"
    if not options.resume:
        for one in (path.with_suffix(""), path):
            shutil.rmtree(one) if one.is_dir() else one.unlink(missing_ok=True)
    folders = Folders(data=data, base=base, own=path.with_suffix(""))
    return min(compare(before, freeze(path, parts, folders), parts, folders), 1)


if __name__ == "__main__":
    raise SystemExit(main())
