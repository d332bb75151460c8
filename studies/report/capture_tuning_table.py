"""The table of what fine-tuning on a few captures gains."""

import json
from pathlib import Path

COLUMNS = (
    ("ra_ssim", "RA SSIM"), ("rd_ssim", "RD SSIM"), ("ra_difference_db", "RA difference, dB"),
    ("rd_difference_db", "RD difference, dB"), ("chamfer_m", "Chamfer, m"),
)  # fmt: skip


def capture_tuning_table(folder: Path) -> str:
    """One row a method on other sequences of the room, mean and interval over rooms."""
    record = json.loads((folder / "capture_tuning" / "test_room.json").read_text(encoding="utf-8"))
    lines = ["| method | " + " | ".join(text for _, text in COLUMNS) + " |", "| --- |" + " --- |" * len(COLUMNS)]
    for row in record["rows"]:
        cells = []
        for name, _ in COLUMNS:
            metric = row["metrics"][name]
            cells.append(f"{metric['value']:.2f} ({metric['low']:.2f} to {metric['high']:.2f})")
        lines.append(f"| {row['method']} | " + " | ".join(cells) + " |")
    return "\n".join(lines)
