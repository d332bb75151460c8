"""Tables that need more than a declaration: best of each in bold, paired differences, the registry of activities."""

import math
from collections.abc import Iterable
from pathlib import Path
from typing import Any

import numpy as np

from mmweaver.core.errors import InputError
from mmweaver.core.seeding import stream
from mmweaver.motion.language.activities import BODY, HANDS
from studies.network.ablation_variants import VARIANTS, WHOLE
from studies.report.cell_formats import markdown, number
from studies.report.table_layouts import contexts_of, records_of

OURS = ("mmw", "mmw_keep_noise")  # what the baseline codecs are compared with
USED_SHARE, SPARED = 0.97, " †"  # of the bytes allowed that a file has; the mark of one that has fewer
ERRORS = ("nmse_active_db", "nmse_moving_db", "nmse_db")
Scores = dict[tuple[str, int], dict[str, list[float | None]]]  # {(signal, bytes): {codec: value of each of ERRORS}}


def _codec_scores(results: Path, sources: str = "codecs/*") -> tuple[Scores, list[str]]:
    """Errors of every codec, and the codecs, ours first. What was measured on another cube than ours is left out."""
    found: Scores = {}
    cubes: dict[str, str] = {}
    records = sorted(records_of(results, sources), key=lambda record: record["method"] not in OURS)
    for record in records:
        for row in record["rows"]:
            cube = row["dataset"]
            if cubes.setdefault(cube["name"], cube["sha256"]) != cube["sha256"]:
                continue
            scores = [row["metrics"][name]["value"] for name in ERRORS]
            found.setdefault((row["dataset"]["name"], row["size"]["bytes_allowed"]), {})[record["method"]] = scores
    return found, [record["method"] for record in records]


def codecs_table(results: Path) -> str:
    """Error over active / moving cells in dB, one row a codec, one column a size; the best of each in bold."""
    found, codecs = _codec_scores(results)
    sizes = sorted({size for _, size in found})
    lines = []
    for signal in dict.fromkeys(signal for signal, _ in found):
        for codec in codecs:
            pairs = [_with_best(found[signal, size], codec) for size in sizes]
            lines.append([signal, codec, *pairs])
    return markdown(["signal", "codec", *(f"{size:,} B" for size in sizes)], lines)


def _with_best(scores: dict[str, list[float | None]], codec: str) -> str:
    """Active / moving error of a codec, each in bold where no codec has less."""
    words = []
    for index in (0, 1):
        value = scores.get(codec, [None] * 3)[index]
        least = _least(one[index] for one in scores.values())
        words.append(f"**{number(value)}**" if value is not None and value == least else number(value))
    return " / ".join(words)


def codec_margins_table(results: Path) -> str:
    """How many dB less error .mmw has than the best baseline, active / moving / all cells; losses in bold."""
    return _margins_table(results, "codecs/*")


def codec_cuts_table(results: Path) -> str:
    """The same of recordings cut in many ways."""
    return _margins_table(results, "codec_cuts/*")


def _margins_table(results: Path, sources: str) -> str:
    found, _ = _codec_scores(results, sources)
    sizes = sorted({size for _, size in found})
    signals = dict.fromkeys(signal for signal, _ in found)
    spared = _places_with_bytes_to_spare(results, sources)
    lines = [
        [signal, *(_margins(found.get((signal, size), {})) + SPARED * ((signal, size) in spared) for size in sizes)]
        for signal in signals
    ]
    return markdown(["signal", *(f"{size:,} B" for size in sizes)], lines)


def _places_with_bytes_to_spare(results: Path, sources: str) -> set[tuple[str, int]]:
    """Signals and sizes at which .mmw reaches the bound of its quality in fewer bytes than it promises to use."""
    rows = [row for record in records_of(results, sources) if record["method"] == OURS[0] for row in record["rows"]]
    return {
        (row["dataset"]["name"], row["size"]["bytes_allowed"])
        for row in rows
        if (row["size"]["bytes"] or math.inf) < USED_SHARE * row["size"]["bytes_allowed"]
    }


def _margins(scores: dict[str, list[float | None]]) -> str:
    words = []
    for index, ours in enumerate(scores.get(OURS[0], ())):
        best = _least(score[index] for codec, score in scores.items() if codec not in OURS)
        margin = None if best is None or ours is None else round(best - ours, 2)
        words.append(f"**{number(margin)}**" if margin is not None and margin < 0 else number(margin))
    return " / ".join(words)


def _least(values: Iterable[float | None]) -> float | None:
    return min((value for value in values if value is not None), default=None)


def statistics_table(results: Path) -> str:
    """Recorded compared with simulated, each with the spread over its quarters; bold where the spreads do not meet."""
    rows = contexts_of(results, ("signal_statistics/physics",))
    lines = []
    for name, metric in rows[0]["metrics"].items():
        cells: list[str] = []
        for real, made in zip(rows[::2], rows[1::2], strict=True):
            recorded, simulated = real["metrics"].get(name), made["metrics"].get(name)
            cells += ["", ""] if recorded is None else _spreads(recorded, simulated)
        lines.append([f"{metric['definition']} ({metric['unit']})", *cells])
    return markdown(["number", *(f"{row['dataset']['name']}, {row['dataset']['origin']}" for row in rows)], lines)


def _spreads(recorded: dict[str, Any], simulated: dict[str, Any]) -> list[str]:
    (low, high), (least, most) = recorded["quarters"], simulated["quarters"]
    texts = [
        f"{number(one['value'])}; {number(one['quarters'][0])} to {number(one['quarters'][1])}"
        for one in (recorded, simulated)
    ]
    return [f"**{text}**" for text in texts] if high < least or most < low else texts


ABLATION = (
    ("ra_ssim", "RA SSIM", 2), ("rd_ssim", "RD SSIM", 2), ("mean_ra_db", "expected RA map, dB", 1),
    ("mean_rd_db", "expected RD map, dB", 1), ("person_ra_db", "person alone RA, dB", 1),
    ("person_rd_db", "person alone RD, dB", 1),
)  # fmt: skip


def ablation_table(results: Path, folder: str = "ablation") -> str:
    """A row a variant: its score, and the paired difference from the whole network with a bootstrap interval."""
    rows = {row["method"]: row["metrics"] for row in contexts_of(results, (f"{folder}/*",))}
    if WHOLE not in rows:
        raise InputError(f"{results / folder} lacks the whole network; run the study first")
    order = [name for name in (*VARIANTS, *sorted(set(rows) - set(VARIANTS))) if name in rows]
    lines = [
        [name, *(_difference(rows[name], rows[WHOLE], column, digits) for column, _, digits in ABLATION)]
        for name in order
    ]
    return markdown(["variant", *(text for _, text, _ in ABLATION)], lines)


def _difference(own: dict[str, Any], whole: dict[str, Any], column: str, digits: int) -> str:
    if column not in own:
        return ""
    value = f"{own[column]['value']:.{digits}f}"
    differences = np.array(own[column]["each"]) - np.array(whole[column]["each"])
    if not differences.any():
        return value
    draws = stream(0, "bootstrap").integers(len(differences), size=(2000, len(differences)))
    low, high = np.percentile(differences[draws].mean(axis=1), (2.5, 97.5))
    more = digits + 1
    return f"{value} ({differences.mean():+.{more}f}; {low:+.{more}f} to {high:+.{more}f})"


def activities_table(results: Path) -> str:
    """One row an activity, from the registry alone; `results` is not read."""
    lines = [
        [activity.name, activity.example, f"{activity.natural_s:g}", "yes" if activity.counted_s else ""]
        for activity in (*BODY, *HANDS)
    ]
    return markdown(["activity", "example", "natural time, s", "can be counted"], lines)
