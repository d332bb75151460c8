"""Markdown tables of results/, for the documentation; a test keeps the two alike.

python -m mmweaver.experiments.tables results README.md docs/fields.md docs/limits.md docs/zero_shot.md
"""

import json
import sys
from pathlib import Path
from typing import Any

from mmweaver.core.atomic_files import atomic_file
from mmweaver.core.errors import InputError
from mmweaver.experiments.zero_shot_table import curve_table, zero_shot_table

SHOWN = ("nmse_db", "nmse_active_db", "nmse_moving_db", "psnr_db", "cssim", "rd_ssim", "ra_ssim", "chamfer_m")
QUESTIONS = (
    ("own_cells", 1.0), ("between_bins", 2.0), ("between_bins", 4.0), ("drawn_places", 2.0),
    ("more_bandwidth", 2.0), ("more_bandwidth", 4.0), ("more_loops", 2.0), ("more_loops", 4.0), ("more_antennas", 2.0),
)  # fmt: skip
PHYSICS = (
    ("command_wall_s", "`mmweaver generate --demo`, imports and pictures included, wall", "{:.1f} s"),
    ("command_peak_memory_gb", "its peak memory", "{:.2f} GB"),
    (
        "sequence_cpu_s",
        "20 frames of a person of 800 points in the furnished sample room, room loaded, CPU",
        "{:.2f} s",
    ),
    ("room_cpu_s", "loading the room, CPU", "{:.2f} s"),
    (
        "times_cheaper_than_exact",
        "the exact sum of the same echoes costs (extrapolated from one frame)",
        "{:.0f} times that",
    ),
    ("synthesis_error_at_rest_db", "error of the range-Doppler cube against the exact sum, at rest", "{:.1f} dB"),
    ("synthesis_error_at_0.5_mps_db", "up to 0.5 m/s and 5 m/s2 on each axis", "{:.1f} dB"),
    ("synthesis_error_at_3_mps_db", "up to 3 m/s and 30 m/s2 on each axis", "{:.1f} dB"),
)
BEGIN, END = "<!-- table: {} -->", "<!-- end -->"


def fidelity_table(folder: Path) -> str:
    """One row a method and signal, after the rows of the signal's floors and twin."""
    records = _records(folder / "field_fidelity")
    lines = [_line("signal", "method", "values", "fit s", *SHOWN), _line(*["---"] * (4 + len(SHOWN)))]
    for at, row in enumerate(records[0]["rows"]):
        name, metrics = row["dataset"]["name"], row["metrics"]
        for floor in ("zeros", "static_mean"):
            scores = [metrics[metric]["floor"][floor] for metric in SHOWN]
            lines.append(_line(name, f"*{floor}*", "", "", *map(_number, scores)))
        if "twin" in metrics["nmse_db"]:
            lines.append(_line(name, "*twin*", "", "", *(_number(metrics[metric]["twin"]) for metric in SHOWN)))
        for record in records:
            own = record["rows"][at]
            scores = [_number(own["metrics"][metric]["value"]) for metric in SHOWN]
            lines.append(
                _line(name, record["method"], f"{own['size']['values']:,}", f"{own['seconds']['fit']:.0f}", *scores)
            )
    return "\n".join(lines)


def codecs_table(folder: Path) -> str:
    """Error over active / moving cells in dB, one row a codec, one column a size; the best of each in bold."""
    records = sorted(_records(folder / "codecs"), key=lambda record: record["method"] != "mmw")
    found: dict[tuple[str, int, str], tuple[float | None, float | None]] = {}
    for record in records:
        for row in record["rows"]:
            key = (row["dataset"]["name"], row["size"]["bytes_allowed"], record["method"])
            found[key] = (row["metrics"]["nmse_active_db"]["value"], row["metrics"]["nmse_moving_db"]["value"])
    signals = list(dict.fromkeys(signal for signal, _, _ in found))
    sizes = sorted({size for _, size, _ in found})
    methods = list(dict.fromkeys(method for _, _, method in found))
    lines = [_line("signal", "codec", *(f"{size:,} B" for size in sizes)), _line(*["---"] * (2 + len(sizes)))]
    for signal in signals:
        best = [_best(found, signal, size) for size in sizes]
        for method in methods:
            scores = [found.get((signal, size, method), (None, None)) for size in sizes]
            cells = [_pair(score, least) for score, least in zip(scores, best, strict=True)]
            lines.append(_line(signal, method, *cells))
    return "\n".join(lines)


def _best(found: dict, signal: str, size: int) -> tuple[float | None, float | None]:
    scores = [score for key, score in found.items() if key[:2] == (signal, size)]
    active, moving = ([score[at] for score in scores if score[at] is not None] for at in (0, 1))
    return min(active, default=None), min(moving, default=None)


def _pair(score: tuple[float | None, float | None], best: tuple[float | None, float | None]) -> str:
    words = [_number(value) for value in score]
    return " / ".join(
        f"**{word}**" if value is not None and value == least else word
        for word, value, least in zip(words, score, best, strict=True)
    )


def super_resolution_table(folder: Path) -> str:
    """NMSE in dB, one row a method, one column a question; all zeros have 0 dB in each."""
    lines = [
        _line("method", *(f"{truth} {factor:g}" for truth, factor in QUESTIONS)),
        _line(*["---"] * (1 + len(QUESTIONS))),
    ]
    for record in _records(folder / "super_resolution"):
        scores = {
            (row["dataset"]["truth"], row["dataset"]["factor"]): row["metrics"]["nmse_db"]["value"]
            for row in record["rows"]
        }
        lines.append(_line(record["method"], *(_number(scores[question]) for question in QUESTIONS)))
    return "\n".join(lines)


def physics_table(folder: Path) -> str:
    """What the physics costs and how far it is from the exact sum; one benchmark run."""
    record = json.loads((folder / "benchmark" / "physics.json").read_text(encoding="utf-8"))
    values = {name: metric["value"] for name, metric in record["rows"][0]["metrics"].items()}
    lines = [_line("what", "measured"), _line("---", "---")]
    lines += [_line(text, form.format(values[name])) for name, text, form in PHYSICS]
    return "\n".join(lines)


def rooms_table(folder: Path) -> str:
    """Frames with motion whose strongest moving range bin lies within the person, beside chance."""
    (record,) = _records(folder / "real_rooms")
    lines = [_line("room", "frames", "person in place", "a random bin"), _line(*["---"] * 4)]
    for row in record["rows"]:
        metric = row["metrics"]["frames_with_person_in_place"]
        shares = (metric["value"], metric["floor"]["random_bin"])
        lines.append(_line(row["dataset"]["name"], str(row["n"]), *(f"{100 * share:.0f} %" for share in shares)))
    return "\n".join(lines)


def statistics_table(folder: Path) -> str:
    """Recorded beside simulated: one row a number, the simulated ones with their range over seeds."""
    (record,) = _records(folder / "signal_statistics")
    rows = record["rows"]
    lines = [_line("number", *(f"{row['dataset']['name']}, {row['dataset']['origin']}" for row in rows))]
    lines.append(_line(*["---"] * (1 + len(rows))))
    for name, metric in rows[0]["metrics"].items():
        cells = [_with_interval(row["metrics"][name]) for row in rows]
        lines.append(_line(f"{metric['definition']} ({metric['unit']})", *cells))
    return "\n".join(lines)


def _with_interval(metric: dict[str, Any]) -> str:
    edges = metric.get("interval")
    value = _number(metric["value"])
    return f"{value} ({_number(edges[0])} to {_number(edges[1])})" if edges else value


TABLES = {
    "field_fidelity": fidelity_table, "super_resolution": super_resolution_table, "physics": physics_table,
    "real_rooms": rooms_table, "signal_statistics": statistics_table, "codecs": codecs_table,
    "zero_shot": zero_shot_table, "zero_shot_curve": curve_table,
}  # fmt: skip


def with_tables(text: str, folder: Path) -> str:
    """The document with each of its marked tables made anew. Raises InputError where a mark has no end."""
    for name, make in TABLES.items():
        begin = BEGIN.format(name)
        if begin not in text:
            continue
        before, _, rest = text.partition(begin)
        _, end, after = rest.partition(END)
        if not end:
            raise InputError(f"the mark {begin} has no {END} after it")
        text = f"{before}{begin}\n{make(folder)}\n{END}{after}"
    return text


def _records(folder: Path) -> list[dict[str, Any]]:
    records = [json.loads(path.read_text(encoding="utf-8")) for path in sorted(folder.glob("*.json"))]
    if not records:
        raise InputError(f"{folder} holds no results; run the experiment first")
    return records


def _line(*cells: str) -> str:
    return "| " + " | ".join(cells) + " |"


def _number(value: float | None) -> str:
    if value is None:
        return "-"
    text = f"{value:.2f}" if abs(value) < 10 else f"{value:.1f}"
    return text.removeprefix("-") if float(text) == 0 else text


def main() -> None:
    folder = Path(sys.argv[1])
    for document in map(Path, sys.argv[2:]):
        text = with_tables(document.read_text(encoding="utf-8"), folder)
        with atomic_file(document) as temporary:
            temporary.write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main()
