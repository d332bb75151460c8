"""Tables of results/zero_shot for docs/zero_shot.md."""

import json
from pathlib import Path
from typing import Any

HEADER = ("recogniser", "recordings", "windows of 2 s", "6 s", "a recording", "chance")


def zero_shot_table(folder: Path) -> str:
    """One row a recogniser and group of recordings, then what the windows were taken for."""
    lines = [_line(*HEADER), _line(*["---"] * len(HEADER))]
    last: dict[str, Any] = {}
    for method, names in (("blind", ("blind",)), ("development", ("development", "first half", "second half"))):
        for name, row in zip(names, _record(folder, method)["rows"], strict=False):
            metrics = row["metrics"]
            scores = [_with_interval(metrics[key]) for key in ("window", "three_windows", "recording")]
            title = method if name == method else f"*{name}*"
            lines.append(_line(title, str(row["dataset"]["recordings"]), *scores, f"{metrics['window']['floor']:.2f}"))
            last = row if name == method else last
    kinds = last["classes"]
    if (folder / "zero_shot" / "nested.json").exists():
        lines += _nested_lines(_record(folder, "nested"))
    lines += ["", "Windows of 2 s after development, true in rows, recognised in columns:", ""]
    lines += [_line("", *kinds), _line(*["---"] * (1 + len(kinds)))]
    for kind, counts in zip(kinds, last["metrics"]["window"]["confusion"], strict=True):
        lines.append(_line(kind, *map(str, counts)))
    return "\n".join(lines)


def _nested_lines(record: dict[str, Any]) -> list[str]:
    """What is left where one half of the recordings chooses settings and the other is scored."""
    found = []
    for half, row in zip(("first", "second"), record["rows"], strict=True):
        metric = row["metrics"]["window"]
        found.append(f"{metric['chosen_on']:.3f} on the {half} half, which chose; {metric['value']:.3f} on the other")
    return ["", f"Features, copies and trees chosen out of {record['config']['candidates']}: {'; '.join(found)}."]


def curve_table(folder: Path) -> str:
    """One row a number of real recordings, with and without generated windows."""
    found: dict[int, dict[bool, str]] = {}
    for row in _record(folder, "curve")["rows"]:
        metric = row["metrics"]["window"]
        text = f"{metric['value']:.3f} ({metric['lowest']:.3f} to {metric['highest']:.3f})"
        found.setdefault(row["real_recordings_each"], {})[row["generated"]] = text
    lines = [_line("real recordings of each", "with generated windows", "without"), _line(*["---"] * 3)]
    lines += [_line(str(each), texts[True], texts.get(False, "0.200 (chance)")) for each, texts in found.items()]
    return "\n".join(lines)


def limbs_table(folder: Path) -> str:
    """One row a limb, one column a third of the generated windows by how bright the limb was drawn."""
    rows = _record(folder, "limbs")["rows"]
    lines = [_line("", "faintest third", "middle", "brightest"), _line(*["---"] * 4)]
    for limb in dict.fromkeys(row["limb"] for row in rows):
        cells = [
            f"{row['metrics']['window']['value']:.3f} ({row['from_db']:.1f} to {row['to_db']:.1f} dB)"
            for row in rows
            if row["limb"] == limb
        ]
        lines.append(_line(limb.removesuffix("_db"), *cells))
    return "\n".join(lines)


def _record(folder: Path, method: str) -> dict[str, Any]:
    return json.loads((folder / "zero_shot" / f"{method}.json").read_text(encoding="utf-8"))


def _with_interval(metric: dict[str, Any]) -> str:
    low, high = metric["interval_95"]
    return f"{metric['value']:.3f} ({low:.3f} to {high:.3f})"


def _line(*cells: str) -> str:
    return "| " + " | ".join(cells) + " |"
