"""The table of docs/reality.md, from results/mars/*.json.

python -m studies tables
"""

import json
from pathlib import Path
from typing import Any

COLUMNS = {
    "chamfer_m": ("Chamfer, m", 3),
    "hausdorff_m": ("Hausdorff, m", 2),
    "centroid_m": ("centroid, m", 2),
    "extent_m": ("extent, m", 3),
    "points": ("points", 1),
    "points_error": ("points off by", 1),
    "points_correlation": ("points corr.", 2),
    "empty": ("empty", 2),
    "doppler": ("Doppler TV", 3),
    "speed_correlation": ("speed corr.", 2),
    "intensity_db": ("intensity, dB", 1),
}
FIRST = (
    "floor_centroid", "floor_random_on_body", "floor_random_real_frame", "ceiling_neighbouring_frame", "simulator",
)  # fmt: skip


def mars_table(folder: Path) -> str:
    """The table from a folder of results."""
    return table(folder / "mars")


def table(folder: Path) -> str:
    """Markdown: one row a method, floors and ceiling first; the Chamfer distance with its 95 % interval."""
    names = sorted(path.stem for path in folder.glob("*.json"))
    ordered = [name for name in FIRST if name in names] + [name for name in names if name not in FIRST]
    lines = ["| | " + " | ".join(title for title, _ in COLUMNS.values()) + " |", "|---" * (len(COLUMNS) + 1) + "|"]
    for name in ordered:
        metrics = json.loads((folder / f"{name}.json").read_text(encoding="utf-8"))["rows"][0]["metrics"]
        lines.append(f"| {name.replace('_', ' ')} | " + " | ".join(_cell(metrics, key) for key in COLUMNS) + " |")
    return "\n".join(lines)


def _cell(metrics: dict[str, Any], key: str) -> str:
    if key not in metrics:
        return "-"
    digits = COLUMNS[key][1]
    text = f"{metrics[key]['value']:.{digits}f}"
    if key == "chamfer_m":
        low, high = metrics[key]["interval_95"]
        text += f" ({low:.{digits}f} to {high:.{digits}f})"
    return text
