"""The table of docs/limits.md that holds the library's micro-Doppler beside that of recorded people."""

import json
from pathlib import Path
from typing import Any

from mmweaver.core.errors import InputError

METHODS = ("recorded", "library")


def micro_doppler_table(folder: Path) -> str:
    """One row a gait and figure: recorded, ours, the floor, and on which side ours lies outside."""
    recorded, library = (_rows(folder / "micro_doppler" / f"{method}.json") for method in METHODS)
    lines = [
        "| gait (clips, ours) | figure | recorded: median (95 %) | their 5 to 95 % | ours: median (95 %) |"
        " frozen body | outside | ours inside |",
        "|" + " --- |" * 8,
    ]
    for theirs, ours in zip(recorded, library, strict=True):
        name = f"{theirs['dataset']['name'].removeprefix('CMU ')} ({theirs['n']}, {ours['n']})"
        for figure, own in ours["metrics"].items():
            other = theirs["metrics"][figure]
            low, high = other["percentiles_5_95"]
            outside = "" if own["inside"] else "below" if own["value"] < low else "above"
            unit = f", {own['unit']}" if own["unit"] else ""
            floor = f"{own['floor']['frozen']:.2f}" if own["floor"] else ""
            text = figure.rsplit("_", 1)[0] if figure.endswith(("_mps", "_hz")) else figure
            lines.append(
                f"| {name} | {text.replace('_', ' ')}{unit} | {_told(other)} | {low:.2f} to {high:.2f} | {_told(own)} |"
                f" {floor} | {outside} | {100 * own['share_inside']:.0f} % |"
            )
    return "\n".join(lines)


def _told(metric: dict[str, Any]) -> str:
    low, high = metric["interval"]
    return f"{metric['value']:.2f} ({low:.2f} to {high:.2f})"


def _rows(path: Path) -> list[dict[str, Any]]:
    if not path.exists():
        raise InputError(f"{path} is missing; run the experiment first")
    return json.loads(path.read_text(encoding="utf-8"))["rows"]
