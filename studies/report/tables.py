"""Markdown tables of results/, for the documentation; a test keeps the two alike.

python -m studies tables
"""

import json
from pathlib import Path
from typing import Any

from mmweaver.core.errors import InputError
from studies.report.benchmark_tables import dataset_cost_table, weaver_speed_table
from studies.report.capture_tuning_table import capture_tuning_table
from studies.report.learned_tables import (
    ablation_table,
    activity_table,
    elsewhere_table,
    gain_table,
    paper_few_table,
    paper_table,
    photographed_table,
    real_or_simulated_table,
    short_table,
    small_gain_table,
)
from studies.report.mars_table import mars_table
from studies.report.micro_doppler_table import micro_doppler_table
from studies.report.motion_tables import activities_table, kitml_table, realism_table
from studies.report.segmenter_table import segmenter_affordances_table, segmenter_table
from studies.report.zero_shot_table import curve_table, limbs_table, zero_shot_table

SHOWN = ("nmse_db", "nmse_active_db", "nmse_moving_db", "psnr_db", "cssim", "rd_ssim", "ra_ssim", "chamfer_m")
FINER, RADII = (1.5, 2.0, 3.0, 4.0), (1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0)
QUESTIONS = (
    ("own_cells", (1.0,)), ("between_bins", FINER), ("sampled_places", RADII), ("more_bandwidth", FINER),
    ("more_loops", FINER), ("more_antennas", FINER),
)  # fmt: skip
PHYSICS = (
    ("command_wall_s", "`mmweaver generate --demo`, imports and pictures included, wall", "{:.1f} s"),
    ("command_peak_memory_gb", "its peak memory", "{:.2f} GB"),
    ("physics_command_wall_s", "the same with `--method physics`", "{:.1f} s"),
    ("physics_command_peak_memory_gb", "its peak memory", "{:.2f} GB"),
    (
        "sequence_cpu_s",
        "by physics, 20 frames of a person of 800 points in the furnished sample room, room loaded, CPU",
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
OURS = ("mmw", "mmw_keep_noise")  # what the rivals are measured against


def fidelity_table(folder: Path) -> str:
    """One row a method and signal, after the rows of the signal's floors and twin."""
    records = _records(folder / "field_fidelity")
    lines = [_line("signal", "method", "values", "fit CPU s", *SHOWN), _line(*["---"] * (4 + len(SHOWN)))]
    for at, row in enumerate(records[0]["rows"]):
        name, metrics = row["dataset"]["name"], row["metrics"]
        for floor in ("zeros", "static_mean"):
            scores = [metrics[metric]["floor"][floor] for metric in SHOWN]
            lines.append(_line(name, f"*{floor}*", "", "", *map(_number, scores)))
        for other in ("twin", "noise_free"):
            if other in metrics["nmse_db"]:
                lines.append(_line(name, f"*{other}*", "", "", *(_number(metrics[metric][other]) for metric in SHOWN)))
        for record in records:
            own = record["rows"][at]
            scores = [_number(own["metrics"][metric]["value"]) for metric in SHOWN]
            lines.append(
                _line(name, record["method"], f"{own['size']['values']:,}", f"{own['seconds']['fit']:.0f}", *scores)
            )
    return "\n".join(lines)


def codecs_table(folder: Path) -> str:
    """Error over active / moving cells in dB, one row a codec, one column a size; the best of each in bold."""
    records = sorted(_records(folder / "codecs"), key=lambda record: record["method"] not in OURS)
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


def codec_margins_table(folder: Path) -> str:
    """How many dB .mmw errs less than the best rival at that, active / moving / all cells; where it loses, in bold."""
    names = ("nmse_active_db", "nmse_moving_db", "nmse_db")
    found: dict[tuple[str, int], dict[str, list[float | None]]] = {}
    for record in _records(folder / "codecs"):
        for row in record["rows"]:
            scores = [row["metrics"][name]["value"] for name in names]
            found.setdefault((row["dataset"]["name"], row["size"]["bytes_allowed"]), {})[record["method"]] = scores
    sizes = sorted({size for _, size in found})
    lines = [_line("signal", *(f"{size:,} B" for size in sizes)), _line(*["---"] * (1 + len(sizes)))]
    for signal in dict.fromkeys(signal for signal, _ in found):
        lines.append(_line(signal, *(_margins(found[signal, size]) for size in sizes)))
    return "\n".join(lines)


def _margins(scores: dict[str, list[float | None]]) -> str:
    words = []
    for at, ours in enumerate(scores[OURS[0]]):
        rivals = [score[at] for method, score in scores.items() if method not in OURS]
        best = min((value for value in rivals if value is not None), default=None)
        margin = None if best is None or ours is None else round(best - ours, 2)
        words.append(f"**{_number(margin)}**" if margin is not None and margin < 0 else _number(margin))
    return " / ".join(words)


def codec_seconds_table(folder: Path) -> str:
    """Seconds of one processor that writing a .mmw of 20 frames took."""
    (record,) = [record for record in _records(folder / "codecs") if record["method"] == OURS[0]]
    rows = record["rows"]
    sizes = sorted({row["size"]["bytes_allowed"] for row in rows})
    lines = [_line("signal", *(f"{size:,} B" for size in sizes)), _line(*["---"] * (1 + len(sizes)))]
    seconds = {(row["dataset"]["name"], row["size"]["bytes_allowed"]): row["seconds"]["encode_cpu"] for row in rows}
    for signal in dict.fromkeys(signal for signal, _ in seconds):
        lines.append(_line(signal, *(f"{seconds[signal, size]:.1f}" for size in sizes)))
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
    """NMSE in dB, one row a question, one column a method; all zeros have 0 dB in each."""
    scores = {
        record["method"]: {
            (row["dataset"]["truth"], row["dataset"]["factor"]): row["metrics"]["nmse_db"]["value"]
            for row in record["rows"]
        }
        for record in _records(folder / "super_resolution")
    }
    lines = [_line("truth", "times finer, or radius", *scores), _line(*["---"] * (2 + len(scores)))]
    for truth, factors in QUESTIONS:
        for factor in factors:
            lines.append(_line(truth, f"{factor:g}", *(_number(own.get((truth, factor))) for own in scores.values())))
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


PEOPLE = (
    ("nmse_active_db", "error energy, active cells (dB)"), ("nmse_moving_db", "error energy, moving cells (dB)"),
    ("rd_ssim", "range-Doppler SSIM"), ("ra_ssim", "range-azimuth SSIM"), ("chamfer_m", "Chamfer of the points (m)"),
    ("hausdorff_m", "Hausdorff of the points (m)"),
)  # fmt: skip


def people_table(folder: Path) -> str:
    """Plain superposition against mutual shadowing, beside its floor and its ceilings; then what it is about."""
    (record,) = _records(folder / "several_people")
    lines = [
        _line("arrangement (pairs)", "score", "plain sum (95 %)", "without the second", "other noise", "twin"),
        _line(*["---"] * 6),
    ]
    for row in record["rows"]:
        name = f"{row['dataset']['name']} ({row['n']})"
        for metric, text in PEOPLE:
            own = row["metrics"][metric]
            beside = [_number(own["beside"][who]) for who in ("without_second", "other_noise", "twin")]
            lines.append(_line(name, text, _with_interval(own), *beside))
        dimmed, points = row["metrics"]["second_dimmed_db"], row["metrics"]["points_of_second"]
        lines.append(_line(name, "*the second is dimmed by (dB)*", _with_interval(dimmed), "", "", ""))
        with_shadows, without = (_number(points["beside"][who]) for who in ("mutual", "without_second"))
        told = f"{_with_interval(points)}; with mutual shadows {with_shadows}"
        lines.append(_line(name, "*points a frame at the second*", told, without, "", ""))
    return "\n".join(lines)


def statistics_table(folder: Path) -> str:
    """Recorded beside simulated, one row a number, each with the range over its quarters; bold where those part."""
    (record,) = _records(folder / "signal_statistics")
    rows = record["rows"]
    lines = [_line("number", *(f"{row['dataset']['name']}, {row['dataset']['origin']}" for row in rows))]
    lines.append(_line(*["---"] * (1 + len(rows))))
    for name, metric in rows[0]["metrics"].items():
        cells = []
        for real, made in zip(rows[::2], rows[1::2], strict=True):
            both = [row["metrics"].get(name) for row in (real, made)]
            cells += ["", ""] if both[0] is None else _beside(*both)
        lines.append(_line(f"{metric['definition']} ({metric['unit']})", *cells))
    return "\n".join(lines)


def _beside(real: dict[str, Any], made: dict[str, Any]) -> list[str]:
    (low, high), (least, most) = real["quarters"], made["quarters"]
    part = high < least or most < low
    texts = [f"{_number(one['value'])}; {_number(a)} to {_number(b)}" for one, a, b in (
        (real, low, high), (made, least, most))]  # fmt: skip
    return [f"**{text}**" for text in texts] if part else texts


AFFORDANCES = (
    ("floor_error_median_m", "floor height, median error", "{:.3f} m"),
    ("floor_error_p95_m", "95th percentile", "{:.3f} m"),
    ("floor_within_3_cm", "within 3 cm", "share"), ("seats_found", "seats found", "share"),
    ("false_seats", "found seats that are none", "share"),
    ("facing_error_median_deg", "facing, median error", "{:.0f} deg"),
    ("table_found", "tables and counters found", "share"), ("table_false", "found ones that are none", "share"),
    ("door_found", "doors found", "share"), ("door_false", "found ones that are none", "share"),
    ("window_found", "windows found", "share"), ("window_false", "found ones that are none", "share"),
    ("bed_found", "beds found", "share"), ("bed_false", "found ones that are none", "share"),
    ("placements_clear", "placements clear of furniture", "share"), ("arms_clear", "arms too", "share"),
)  # fmt: skip


def affordances_table(folder: Path) -> str:
    """What is found in rooms whose truth is known, one column a set of rooms and an input."""
    rows = [(record["method"], row) for record in _records(folder / "affordances") for row in record["rows"]]
    heads = [f"{row['dataset']['name']}, {method} ({row['n']})" for method, row in rows]
    lines = [_line("what", *heads), _line(*["---"] * (1 + len(rows)))]
    for name, text, form in AFFORDANCES:
        cells = [_share_cell(row["metrics"].get(name), form, edges=name == "placements_clear") for _, row in rows]
        lines.append(_line(text, *cells))
    return "\n".join(lines)


def _share_cell(metric: dict[str, Any] | None, form: str, *, edges: bool) -> str:
    if metric is None:
        return "-"
    if form != "share":
        return form.format(metric["value"])
    of = f" of {metric['of']}" if "of" in metric else ""
    low, high = (100 * edge for edge in metric["interval"]) if edges else (0.0, 0.0)
    return f"{100 * metric['value']:.1f} %{of}" + (f" ({low:.1f} to {high:.1f})" if edges else "")


def real_placements_table(folder: Path) -> str:
    """One row a real room: its floor, and people against its measured points."""
    (record,) = _records(folder / "real_placements")
    lines = [
        _line("room", "floor against marked places", "placements clear", "arms too", "refused"),
        _line(*["---"] * 5),
    ]
    for row in record["rows"]:
        floor, clear, arms = (row["metrics"][name] for name in ("floor_error_m", "placements_clear", "arms_clear"))
        cells = [_share_cell(metric, "share", edges=False) for metric in (clear, arms)]
        lines.append(_line(row["dataset"]["name"], f"{100 * floor['value']:.1f} cm", *cells, str(row["refused"])))
    return "\n".join(lines)


def motiongpt_table(folder: Path) -> str:
    """One row a set of motions: how often the classifier's first, and one of its first three, is what was asked."""
    (record,) = _records(folder / "motiongpt")
    lines = [_line("motions", "first of 12", "among first 3", "bones stretch"), _line("---", "---", "---", "---")]
    for row in record["rows"]:
        first, three, bones = (row["metrics"][name] for name in ("r_precision_1", "r_precision_3", "bone_spread"))
        cells = [f"{100 * m['value']:.0f} % ({100 * m['interval_95'][0]:.0f} to {100 * m['interval_95'][1]:.0f})"
                 for m in (first, three)]  # fmt: skip
        lines.append(_line(row["dataset"]["name"], *cells, f"{100 * bones['value']:.1f} %"))
    lines.append(_line("chance", f"{100 / 12:.0f} %", "25 %", ""))
    return "\n".join(lines)


def tracks_table(folder: Path) -> str:
    """One row a shape of track, beside free points in as many numbers."""
    (record,) = _records(folder / "scatterer_tracks")
    lines = [
        _line("frames", "numbers a track", "nmse_db, tracks", "nmse_db, free points", "CPU s of all"),
        _line(*["---"] * 5),
    ]
    for row in record["rows"]:
        metric = row["metrics"]["nmse_db"]
        cells = (_number(metric["value"]), _number(metric["free_points"]), f"{row['seconds']['all']:.0f}")
        lines.append(_line(str(row["frames"]), str(row["values_of_track"]), *cells))
    return "\n".join(lines)


def noise_table(folder: Path) -> str:
    """One row a signal: rendered without noise / with noise (the capture's own where it is not zero or the same)."""
    (record,) = _records(folder / "rendered_noise")
    names = list(record["rows"][0]["metrics"])
    lines = [_line("signal", *names), _line(*["---"] * (1 + len(names)))]
    for row in record["rows"]:
        cells = []
        for name in names:
            metric = row["metrics"][name]
            both = f"{_number(metric['floor']['without_noise'])} / {_number(metric['value'])}"
            cells.append(f"{both} ({_number(metric['capture'])})" if metric["capture"] else both)
        lines.append(_line(row["dataset"]["name"], *cells))
    return "\n".join(lines)


def _with_interval(metric: dict[str, Any]) -> str:
    edges = metric.get("interval")
    value = _number(metric["value"])
    return f"{value} ({_number(edges[0])} to {_number(edges[1])})" if edges else value


WEAVER = (
    ("ra_ssim", "RA SSIM"), ("rd_ssim", "RD SSIM"), ("ra_ssim_all_cells", "RA, all cells"),
    ("rd_ssim_all_cells", "RD, all cells"), ("rd_difference_db", "RD difference, dB"),
    ("magnitude_nmse_db", "NMSE of magnitude, dB"), ("antenna_phase_error_rad", "antenna phase error, rad"),
    ("chamfer_m", "Chamfer, m"), ("hausdorff_m", "Hausdorff, m"), ("cpu_s", "CPU, s"),
)  # fmt: skip


def weaver_table(folder: Path) -> str:
    """One row a method in unseen kinds of rooms, mean and interval over rooms."""
    record = _split(folder, "test_room")
    lines = [_line("method", *(text for _, text in WEAVER)), _line(*["---"] * (1 + len(WEAVER)))]
    for row in record["rows"]:
        cells = [_bounded(row["metrics"][name], name in ("ra_ssim", "rd_ssim")) for name, _ in WEAVER]
        lines.append(_line(_loudness(row), *cells))
    return "\n".join(lines)


COLLAPSED_DB = -10.0  # energy over the truth's


def _loudness(row: dict[str, Any]) -> str:
    """The method's name, and that it has collapsed where it has."""
    energy_db: float | None = row["metrics"].get("energy_db", {}).get("value")
    if energy_db is None or energy_db > COLLAPSED_DB:
        return row["method"]
    return f"{row['method']}, collapsed: {-energy_db:.0f} dB too little energy"


UNSEEN = {
    "test_room": "kind of room", "test_layout": "layout of a seen kind", "test_person": "person",
    "test_activity": "activity",
}  # fmt: skip
BESIDE = ("nearest_training_pose", "weaver", "weaver_with_empty_room", "physics_in_photographed_room", "twin")


def weaver_unseen_table(folder: Path) -> str:
    """What else was withheld from training: one row each."""
    lines = [_line("unseen", "sequences", *(f"{name}, {view}" for name in BESIDE for view in ("RA", "RD")))]
    lines.append(_line(*["---"] * (2 + 2 * len(BESIDE))))
    for split, text in UNSEEN.items():
        rows = {row["method"]: row for row in _split(folder, split)["rows"]}
        cells = [
            _bounded(rows[name]["metrics"][metric], name == "weaver")
            for name in BESIDE
            for metric in ("ra_ssim", "rd_ssim")
        ]
        lines.append(_line(text, str(rows["weaver"]["n"]), *cells))
    return "\n".join(lines)


def weaver_few_shot_table(folder: Path) -> str:
    """Jumps after tuning on a few of them."""
    (record,) = _records(folder / "weaver_few_shot")
    lines = [_line("tuned on", "RA SSIM", "RD SSIM", "RA difference, dB", "RD difference, dB"), _line(*["---"] * 5)]
    for row in record["rows"]:
        names = ("ra_ssim", "rd_ssim", "ra_difference_db", "rd_difference_db")
        lines.append(_line(row["method"], *(_bounded(row["metrics"][name], name.endswith("ssim")) for name in names)))
    return "\n".join(lines)


def _split(folder: Path, split: str) -> dict[str, Any]:
    return next(record for record in _records(folder / "weaver") if record["method"] == split)


def _bounded(metric: dict[str, Any], with_edges: bool) -> str:
    if metric["value"] is None:
        return "-"
    return f"{metric['value']:.2f}" + (f" ({metric['low']:.2f} to {metric['high']:.2f})" if with_edges else "")


TABLES = {
    "field_fidelity": fidelity_table, "super_resolution": super_resolution_table, "physics": physics_table,
    "real_rooms": rooms_table, "signal_statistics": statistics_table, "codecs": codecs_table,
    "mars": mars_table, "several_people": people_table, "micro_doppler": micro_doppler_table,
    "affordances": affordances_table, "real_placements": real_placements_table,
    "segmenter": segmenter_table, "segmenter_affordances": segmenter_affordances_table,
    "activities": activities_table, "kitml": kitml_table, "motion_realism": realism_table,
    "motiongpt": motiongpt_table,
    "codec_margins": codec_margins_table, "codec_seconds": codec_seconds_table,
    "rendered_noise": noise_table,
    "scatterer_tracks": tracks_table,
    "photographed_room": photographed_table,
    "weaver": weaver_table, "weaver_unseen": weaver_unseen_table,
    "weaver_few_shot": weaver_few_shot_table,
    "dataset_cost": dataset_cost_table, "weaver_speed": weaver_speed_table,
    "capture_tuning": capture_tuning_table,
    "weaver_elsewhere": elsewhere_table, "weaver_short": short_table,
    "weaver_paper": paper_table, "weaver_paper_few": paper_few_table, "weaver_ablation": ablation_table,
    "activity_accuracy": activity_table, "activity_gain": gain_table, "activity_gain_60": small_gain_table,
    "real_or_generated": real_or_simulated_table,
    "zero_shot": zero_shot_table, "zero_shot_curve": curve_table, "zero_shot_limbs": limbs_table,
}  # fmt: skip


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
