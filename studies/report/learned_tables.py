"""Tables of docs/weaver.md: photographed rooms, the activity network, recipe `paper`, the worth of generated data."""

import json
from pathlib import Path
from typing import Any

import numpy as np

from mmweaver.core.errors import InputError
from mmweaver.core.seeding import stream
from studies.network.ablation_variants import VARIANTS, WHOLE

SPLITS = {
    "test_room": "kinds of rooms", "test_layout": "layouts of known kinds", "test_person": "a person",
}  # fmt: skip
PAPER = (
    ("cssim", "cSSIM", 3), ("psnr_db", "PSNR, dB", 1), ("nmse_db", "NMSE, all cells, dB", 2),
    ("nmse_active_db", "active, dB", 2), ("nmse_moving_db", "moving, dB", 2), ("rd_ssim", "RD SSIM", 2),
    ("ra_ssim", "RA SSIM", 2),
)  # fmt: skip


SHORT = {
    "zeros": "all zeros", "generic_room_physics": "physics in some other room", "weaver": "the network, from the photo",
    "physics_in_photographed_room": "physics, from the photo",
    "twin": "the true room, phases drawn: the best that a photo can give",
    "weaver_with_empty_room": "the network, with a recording of the empty room",
    "twin_skin": "the true room, its phases known: the best that a recording can give",
}  # fmt: skip


def short_table(folder: Path) -> str:
    """The deciding table in few words, for the README."""
    rows = {row["method"]: row for row in _rows(folder / "weaver" / "test_room.json")}
    lines = ["| made by | range-azimuth, SSIM | range-Doppler, SSIM |", "| --- | --- | --- |"]
    for name, text in SHORT.items():
        cells = (
            f"{metric['value']:.2f} ({metric['low']:.2f} to {metric['high']:.2f})"
            for metric in (rows[name]["metrics"][view] for view in ("ra_ssim", "rd_ssim"))
        )
        lines.append(f"| {text} | {' | '.join(cells)} |")
    return "\n".join(lines)


ELSEWHERE = {
    "hupr": "preset `hupr`", "mmmesh": "`mmmesh`", "iwr6843": "`iwr6843`", "iwr1443_mars": "`iwr1443_mars`",
    "awr1843_100_frames": "`awr1843`, 100 frames",
}  # fmt: skip
BESIDE = ("zeros", "generic_room_physics", "weaver", "physics_in_photographed_room", "twin")


def elsewhere_table(folder: Path) -> str:
    """Radars and lengths that the network was not trained on, in unseen kinds of rooms."""
    lines = [f"| seen by | rooms | {' | '.join(f'{name}, RA / RD' for name in BESIDE)} |", "|" + " --- |" * 7]
    for name, text in ELSEWHERE.items():
        rows = {row["method"]: row for row in _rows(folder / "weaver_elsewhere" / f"{name}.json")}
        pairs = ([rows[one]["metrics"][metric] for metric in ("ra_ssim", "rd_ssim")] for one in BESIDE)
        cells = (" / ".join(f"{metric['value']:.2f}" for metric in pair) for pair in pairs)
        lines.append(f"| {text} | {rows['weaver']['num_rooms']} | {' | '.join(cells)} |")
    return "\n".join(lines)


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
    return _paper_rows(folder, {"": "test_room"})


def paper_few_table(folder: Path) -> str:
    """The same after the paper's 1,000 passes through few sequences: on these, and in unseen kinds of rooms."""
    return _paper_rows(folder, {", what it trained on": "few_train", ", unseen kinds": "few_test_room"})


def _paper_rows(folder: Path, names: dict[str, str]) -> str:
    lines = [f"| method | {' | '.join(text for _, text, _ in PAPER)} |", "|" + " --- |" * (1 + len(PAPER))]
    for text, name in names.items():
        for row in _rows(folder / "weaver_paper" / f"{name}.json"):
            cells = (f"{row['metrics'][column]['value']:.{digits}f}" for column, _, digits in PAPER)
            lines.append(f"| {row['method']}{text} | {' | '.join(cells)} |")
    return "\n".join(lines)


def gain_table(folder: Path, name: str = "test_room") -> str:
    """Accuracy of the recogniser in an unseen room, with data of each method."""
    lines = ["| generated data of the room by | accuracy | gain, points | log loss less by |", "|" + " --- |" * 4]
    for row in _rows(folder / "activity_gain" / f"{name}.json"):
        metrics, is_first = row["metrics"], row["method"] == "other_rooms"
        loss = metrics["log_loss_gain"]
        told = " | " if is_first else f"{_points(metrics['gain'])} | {_plain(loss)}"
        lines.append(f"| {row['method']} | {_percent(metrics['accuracy'])} | {told} |")
    return "\n".join(lines)


def small_gain_table(folder: Path) -> str:
    """The same with a head that begins anew and has 60 recordings of other rooms."""
    return gain_table(folder, "recordings_60")


def real_or_simulated_table(folder: Path) -> str:
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


ABLATION = (
    ("ra_ssim", "RA SSIM", 2), ("rd_ssim", "RD SSIM", 2), ("mean_ra_db", "mean map RA, dB", 1),
    ("mean_rd_db", "mean map RD, dB", 1), ("person_ra_db", "person alone RA, dB", 1),
    ("person_rd_db", "person alone RD, dB", 1),
)  # fmt: skip


def ablation_table(folder: Path) -> str:
    """A row a variant, in brackets by how much it differs from the whole network in the same rooms, with the interval
    of that difference."""
    rows = {row["method"]: row for file in (folder / "weaver_ablation").glob("*.json") for row in _rows(file)}
    if WHOLE not in rows:
        raise InputError(f"{folder / 'weaver_ablation'} lacks the whole network; run the experiment first")
    lines = [f"| variant | {' | '.join(text for _, text, _ in ABLATION)} |", "|" + " --- |" * (1 + len(ABLATION))]
    order = [*VARIANTS, *sorted(set(rows) - set(VARIANTS))]
    for name in (name for name in order if name in rows):
        cells = (
            _beside(rows[name]["metrics"], rows[WHOLE]["metrics"], column, digits) for column, _, digits in ABLATION
        )
        lines.append(f"| {name} | {' | '.join(cells)} |")
    return "\n".join(lines)


def _beside(own: dict[str, Any], whole: dict[str, Any], column: str, digits: int) -> str:
    """A value and its difference from the whole network's, over rooms drawn again and again."""
    if column not in own:
        return ""
    value = f"{own[column]['value']:.{digits}f}"
    differences = np.array(own[column]["each"]) - np.array(whole[column]["each"])
    if not differences.any():
        return value
    low, high = np.percentile(_means(differences), (2.5, 97.5))
    more = digits + 1
    return f"{value} ({differences.mean():+.{more}f}; {low:+.{more}f} to {high:+.{more}f})"


def _means(values: np.ndarray) -> np.ndarray:
    return values[stream(0, "bootstrap").integers(len(values), size=(2000, len(values)))].mean(axis=1)


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
