"""Tables of docs/weaver.md: photographed rooms, the activity network, recipe `paper`, the worth of generated data."""

import json
from pathlib import Path
from typing import Any

from mmweaver.core.errors import InputError

SPLITS = {
    "test_room": "kinds of rooms", "test_layout": "layouts of known kinds", "test_person": "a person",
}  # fmt: skip
PAPER = (
    ("cssim", "cSSIM", 3), ("psnr_db", "PSNR, dB", 1), ("nmse_db", "NMSE, all cells, dB", 2),
    ("nmse_active_db", "active, dB", 2), ("nmse_moving_db", "moving, dB", 2), ("rd_ssim", "RD SSIM", 2),
    ("ra_ssim", "RA SSIM", 2),
)  # fmt: skip


def activity_table(folder: Path) -> str:
    """Accuracy of the activity network on what it has not seen."""
    lines = ["| not seen before | sequences | rooms | accuracy | chance |", "|" + " --- |" * 5]
    for row in _rows(folder / "activity_accuracy" / "activity.json"):
        metric = row["metrics"]["accuracy"]
        lines.append(
            f"| {SPLITS[row['split']]} | {row['n']} | {row['num_rooms']} | {_percent(metric)} |"
            f" {100 * metric['floor']['chance']:.0f} % |"
        )
    return "\n".join(lines)


def paper_table(folder: Path) -> str:
    """The recipe `paper` in unseen kinds of rooms, beside the floors."""
    lines = [f"| method | {' | '.join(text for _, text, _ in PAPER)} |", "|" + " --- |" * (1 + len(PAPER))]
    for row in _rows(folder / "weaver_paper" / "test_room.json"):
        cells = (f"{row['metrics'][name]['value']:.{digits}f}" for name, _, digits in PAPER)
        lines.append(f"| {row['method']} | {' | '.join(cells)} |")
    return "\n".join(lines)


def gain_table(folder: Path) -> str:
    """Accuracy of the recogniser in an unseen room, with data of each method."""
    lines = ["| generated data of the room by | accuracy | gain, points | log loss less by |", "|" + " --- |" * 4]
    for row in _rows(folder / "activity_gain" / "test_room.json"):
        metrics, is_first = row["metrics"], row["method"] == "other_rooms"
        loss = metrics["log_loss_gain"]
        told = " | " if is_first else f"{_points(metrics['gain'])} | {_plain(loss)}"
        lines.append(f"| {row['method']} | {_percent(metrics['accuracy'])} | {told} |")
    return "\n".join(lines)


def told_apart_table(folder: Path) -> str:
    """How often generated cubes are told from true ones."""
    lines = ["| method | told apart | perfect |", "|" + " --- |" * 3]
    for row in _rows(folder / "real_or_generated" / "test_room.json"):
        lines.append(f"| {row['method']} | {_percent(row['metrics']['accuracy'])} | 50 % |")
    return "\n".join(lines)


def photographed_table(folder: Path) -> str:
    """Empty rooms as their photos show them."""
    lines = ["| the room's echoes | RA SSIM | RA difference, dB |", "|" + " --- |" * 3]
    for row in _rows(folder / "photographed_room" / "echoes.json"):
        ssim, gap = (row["metrics"][name] for name in ("ra_ssim", "ra_difference_db"))
        lines.append(
            f"| {row['method']} | {ssim['value']:.2f} ({ssim['low']:.2f} to {ssim['high']:.2f}) | {gap['value']:.2f} |"
        )
    return "\n".join(lines)


def _percent(metric: dict[str, Any]) -> str:
    return f"{100 * metric['value']:.1f} % ({100 * metric['low']:.1f} to {100 * metric['high']:.1f})"


def _plain(metric: dict[str, Any]) -> str:
    return f"{metric['value']:+.3f} ({metric['low']:+.3f} to {metric['high']:+.3f})"


def _points(metric: dict[str, Any]) -> str:
    return f"{100 * metric['value']:+.1f} ({100 * metric['low']:+.1f} to {100 * metric['high']:+.1f})"


def _rows(path: Path) -> list[dict[str, Any]]:
    if not path.exists():
        raise InputError(f"{path} is missing; run the experiment first")
    return json.loads(path.read_text(encoding="utf-8"))["rows"]
