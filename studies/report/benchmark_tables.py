"""Tables of docs/weaver.md: what a data set costs, and what the network costs beside physics."""

import json
from pathlib import Path

from mmweaver.core.errors import InputError

DATASET = (
    ("cpu_s_a_sequence", "a sequence of 20 frames, CPU", "{:.2f} s"),
    ("cpu_s_a_room", "a room with its photo, CPU", "{:.1f} s"),
    ("kb_a_sequence", "a sequence on disk", "{:.0f} kB"),
    ("kb_a_room", "a room on disk", "{:.0f} kB"),
    ("10_million_core_days", "10 million sequences, 120 a room", "{:.0f} core-days"),
    ("10_million_tb", "the same on disk", "{:.1f} TB"),
    ("sequences_a_s_1_workers", "sequences a second, 1 worker", "{:.1f}"),
    ("sequences_a_s_2_workers", "2 workers", "{:.1f}"),
    ("sequences_a_s_4_workers", "4 workers", "{:.1f}"),
)
SPEED = (
    ("weaver_motion_to_cube_cpu_s", "network, motion to cube of 20 frames, room encoded, CPU", "{:.3f} s"),
    ("physics_motion_to_cube_cpu_s", "physics, the same, room prepared, CPU", "{:.3f} s"),
    ("times_fewer_cpu_s_than_physics", "ratio of the two", "{:.1f}"),
    ("sentence_to_motion_cpu_s", "sentence to motion, for either, CPU", "{:.3f} s"),
    ("sentence_to_cube_wall_s", "network, sentence to cube, wall", "{:.2f} s"),
    ("weaver_encode_room_cpu_s", "encoding the reconstructed room, once, CPU", "{:.2f} s"),
    ("weaver_peak_memory_gb", "network, peak memory of the process", "{:.2f} GB"),
)


def dataset_cost_table(folder: Path) -> str:
    """With signals and with geometry only; what was not run is left empty."""
    values = _values(folder, "dataset")
    lines = ["| what | with signals | geometry only |", "| --- | --- | --- |"]
    for name, text, form in DATASET:
        cells = [values.get(f"{kind}_{name}") for kind in ("signals", "geometry_only")]
        lines.append(f"| {text} | " + " | ".join("" if cell is None else form.format(cell) for cell in cells) + " |")
    return "\n".join(lines)


def weaver_speed_table(folder: Path) -> str:
    """The network beside physics, one run."""
    values = _values(folder, "weaver")
    lines = [f"| {text} | {form.format(values[name])} |" for name, text, form in SPEED]
    return "\n".join(["| what | measured |", "| --- | --- |", *lines])


def _values(folder: Path, method: str) -> dict[str, float]:
    path = folder / "benchmark" / f"{method}.json"
    if not path.exists():
        raise InputError(f"{path} is missing; run the benchmark first: make bench")
    metrics = json.loads(path.read_text(encoding="utf-8"))["rows"][0]["metrics"]
    return {name: metric["value"] for name, metric in metrics.items()}
