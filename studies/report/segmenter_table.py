"""The tables of docs/photos.md: what the built-in segmenter gets right, and what its mask does for affordances."""

import json
from pathlib import Path
from typing import Any

_SCORES = {"network": "the built-in network", "geometry": "heights and slopes alone"}
_MASKS = {"none": "depth alone", "network": "mask by the network", "true": "true mask"}
_FOUND = ("seats_found", "false_seats", "table_found", "table_false", "door_found", "door_false", "window_found",
          "window_false")  # fmt: skip
_HEADS = ("seats found", "false seats", "tables found", "false tables", "doors found", "false doors", "windows found",
          "false windows")  # fmt: skip


def segmenter_table(folder: Path) -> str:
    """One row a guess: rendered rooms of unseen kinds, then each real photo's marked places."""
    rows = _rows(folder)
    real = [row for row in rows if "places_right" in row["metrics"]]
    names = list(dict.fromkeys(row["dataset"]["name"] for row in real))
    lines = [_line("", "mIoU, unseen kinds", "cells right", *(f"{name}, places right" for name in names))]
    lines.append(_line(*["---"] * (3 + len(names))))
    for method, words in _SCORES.items():
        metrics = next(row["metrics"] for row in rows if row["dataset"]["split"] == method and "miou" in row["metrics"])
        cells = [
            _share(row["metrics"]["places_right"])
            for name in names for row in real
            if (row["dataset"]["name"], row["dataset"]["split"]) == (name, method)
        ]  # fmt: skip
        lines.append(_line(words, f"{metrics['miou']['value']:.2f}", _share(metrics["right"]), *cells))
    return "\n".join(lines)


def segmenter_affordances_table(folder: Path) -> str:
    """One row a mask."""
    rows = {row["dataset"]["split"]: row for row in _rows(folder) if "seats_found" in row["metrics"]}
    lines = [_line("", *_HEADS), _line(*["---"] * (1 + len(_HEADS)))]
    for method, words in _MASKS.items():
        metrics = rows[method]["metrics"]
        lines.append(_line(words, *(_share(metrics[name]) if name in metrics else "-" for name in _FOUND)))
    return "\n".join(lines)


def _rows(folder: Path) -> list[dict[str, Any]]:
    return json.loads((folder / "segmenter" / "builtin.json").read_text(encoding="utf-8"))["rows"]


def _share(metric: dict[str, Any]) -> str:
    of = f" of {metric['of']}" if "of" in metric else ""
    return f"{100 * metric['value']:.0f} %{of}"


def _line(*cells: str) -> str:
    return "| " + " | ".join(cells) + " |"
