"""What guards removed from each recording, as figures and as pictures."""

import re
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from mmweaver.recognition.guards import GUARDS, WindowFilter
from mmweaver.recognition.point_recordings import PointRecording, is_moving
from mmweaver.viz.theme import PEOPLE_ON_WHITE, STYLE

if TYPE_CHECKING:
    from matplotlib.axes import Axes

MAX_PICTURES = 200
KEPT_COLOUR = "#b6bcc4"
COLOURS = dict(zip(GUARDS, PEOPLE_ON_WHITE, strict=False))


def removed_points(
    points: WindowFilter, recordings: Sequence[PointRecording], windows: Sequence[int] | None = None
) -> list[dict[str, Any]]:
    """What guards remove from each recording, and how many of its frames are missing.

    Args:
        points: The guards.
        recordings: The recordings.
        windows: Number of windows of each that are used. Default: not reported.

    Returns:
        One mapping per recording: `name`, `label`, `frames`, `missing_frames`, `points`, `moving`, `removed` (points by
        guard), `moving_removed`, and `windows`.
    """
    found: list[dict[str, Any]] = []
    for number, one in enumerate(recordings):
        masks, moving = points.removed(one), is_moving(one.cloud)
        gone = np.any([np.zeros(len(moving), bool), *masks.values()], axis=0)
        row = {
            "name": one.name,
            "label": one.label,
            "frames": one.num_frames,
            "missing_frames": len(one.missing),
            "points": len(moving),
            "moving": int(moving.sum()),
            "removed": {name: int(mask.sum()) for name, mask in masks.items()},
            "moving_removed": int((gone & moving).sum()),
        }
        found.append(row if windows is None else row | {"windows": windows[number]})
    return found


def removed_lines(rows: Sequence[dict[str, Any]]) -> list[str]:
    """A line per guard on what it removed of all recordings, and one on recordings that lost most of their motion."""
    text: list[str] = []
    total = sum(row["points"] for row in rows)
    for name in GUARDS:
        counts = [row["removed"].get(name, 0) for row in rows]
        if any(counts):
            text.append(
                f"guard {name}: removed {sum(counts) / total:.1%} of the points, of"
                f" {np.count_nonzero(counts)} of {len(rows)} recordings (--without {name} keeps them)"
            )
    emptied = [row["name"] for row in rows if row["moving"] and row["moving_removed"] > row["moving"] / 2]
    if emptied:
        named = ", ".join(emptied[:3]) + (", ..." if len(emptied) > 3 else "")
        text.append(f"more than half of the moving points were removed of {len(emptied)} recordings: {named}")
    if lost := sum(row["missing_frames"] for row in rows):
        files = sum(row["missing_frames"] > 0 for row in rows)
        text.append(f"{lost} frames of {files} recordings are missing; windows there are left out")
    return text


def write_pictures(folder: Path, points: WindowFilter, recordings: Sequence[PointRecording]) -> list[Path]:
    """Draws the points of each recording from which a guard removed any: from above, and range over time.

    Args:
        folder: Existing folder for the pictures.
        points: The guards.
        recordings: The recordings.

    Returns:
        The files, at most MAX_PICTURES.
    """
    files: list[Path] = []
    for number, one in enumerate(recordings):
        masks = points.removed(one)
        if (masks or len(one.missing)) and len(files) < MAX_PICTURES:
            name = re.sub(r"[^\w.-]+", "_", f"{one.label}_{one.name}".strip("_")) or "recording"
            files.append(folder / f"{number:04d}_{name[:80]}.png")
            _draw(files[-1], one, masks)
    return files


def _draw(file: Path, recording: PointRecording, masks: dict[str, np.ndarray]) -> None:
    import matplotlib as mpl
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    cloud, time_s = recording.cloud, recording.cloud.frame / recording.frame_rate_hz
    with mpl.rc_context(STYLE):
        figure = Figure(figsize=(11.0, 4.2), layout="constrained")
        FigureCanvasAgg(figure)
        above, over = figure.subplots(1, 2, width_ratios=(1, 2))
        _scatter(above, cloud.x_m, cloud.y_m, masks)
        _scatter(over, time_s, cloud.range_m, masks)
        for run in np.split(recording.missing, np.flatnonzero(np.diff(recording.missing) > 1) + 1):
            if len(run):
                start_s, end_s = run[0] / recording.frame_rate_hz, (run[-1] + 1) / recording.frame_rate_hz
                over.axvspan(start_s, end_s, color="#f3d9d4", lw=0)
        above.set(xlabel="x, right (m)", ylabel="y, away (m)", title=f"{recording.name} {recording.label}", aspect=1)
        over.set(xlabel="time (s)", ylabel="range (m)", title="kept, and removed by each guard; missing frames shaded")
        over.legend(loc="upper right")
        figure.savefig(file)


def _scatter(axes: "Axes", x: np.ndarray, y: np.ndarray, masks: dict[str, np.ndarray]) -> None:
    kept = ~np.any([np.zeros(len(x), bool), *masks.values()], axis=0)
    axes.scatter(x[kept], y[kept], s=5, c=KEPT_COLOUR, lw=0, label=f"kept, {kept.sum()}")
    for name, mask in masks.items():
        axes.scatter(x[mask], y[mask], s=5, c=COLOURS[name], lw=0, label=f"{name}, {mask.sum()}")
