"""The tables of docs/motion.md: the activities, what of KIT-ML is understood, the library beside motion capture."""

import json
from pathlib import Path
from typing import Any

from mmweaver.core.errors import InputError
from mmweaver.motion.language.activities import BODY, HANDS

UNDERSTOOD = (
    ("understood", "understood, of all"),
    ("understood_checking_half", "understood, of the half not developed on"),
    ("understood_new_sentences", "understood, of those among them whose words occur in no sentence of the other half"),
    ("wrong_first_draw", "judged wrong, first draw (faults mended since)"),
    ("wrong_second_draw", "judged wrong, second draw (faults mended since)"),
    ("wrong_third_draw", "judged wrong, third draw (faults mended since)"),
    ("wrong", "judged wrong, fourth draw (as it is now)"),
)


def activities_table(folder: Path) -> str:
    """One row an activity, from the registry alone; `folder` is not read."""
    rows = [
        f"| {activity.name} | {activity.example} | {activity.natural_s:g} | {'yes' if activity.counted_s else ''} |"
        for activity in (*BODY, *HANDS)
    ]
    return "\n".join(["| activity | example | natural time, s | can be counted |", "| --- | --- | --- | --- |", *rows])


def kitml_table(folder: Path) -> str:
    """Shares understood and wrong with their 95 % intervals."""
    (row,) = _rows(folder / "kitml" / "reading.json")
    lines = ["| share | n | value | 95 % interval |", "| --- | --- | --- | --- |"]
    for name, text in UNDERSTOOD:
        metric = row["metrics"][name]
        low, high = metric["interval"]
        lines.append(
            f"| {text} | {metric['n']:,} | {100 * metric['value']:.1f} % | {100 * low:.1f} to {100 * high:.1f} % |"
        )
    return "\n".join(lines)


def realism_table(folder: Path) -> str:
    """Our median beside the spread of the recorded clips; what lies outside is said."""
    lines = ["| of | figure | ours | recorded: 5 %, middle, 95 % | |", "| --- | --- | --- | --- | --- |"]
    for row in _rows(folder / "motion_realism" / "library.json"):
        for name, metric in row["metrics"].items():
            low, middle, high = metric["recorded_5_50_95"]
            text = name.rsplit("_", 1)[0].replace("_", " ")
            unit = f" {metric['unit']}" if metric["unit"] else ""
            told = "" if metric["inside"] else "below" if metric["value"] < low else "above"
            lines.append(
                f"| {row['dataset']['name']} ({row['n']}) | {text} | {metric['value']:.3g}{unit} |"
                f" {low:.3g}, {middle:.3g}, {high:.3g} | {told} |"
            )
    return "\n".join(lines)


def _rows(path: Path) -> list[dict[str, Any]]:
    if not path.exists():
        raise InputError(f"{path} is missing; run the experiment first")
    return json.loads(path.read_text(encoding="utf-8"))["rows"]
