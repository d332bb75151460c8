"""Sequences of a labelled set or a data set of rooms as results, for every export format.

Also defines the format "results", a result folder per sequence.
"""

import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from mmweaver.core.records import PoseSequence
from mmweaver.core.version import __version__
from mmweaver.datasets.formats import export_format
from mmweaver.datasets.room_sequences import read_labelled
from mmweaver.io.npz_files import write_points_npz, write_pose_npz, write_radar_npz
from mmweaver.io.result_folder import FILES, META_VERSION, plain, radar_meta
from mmweaver.io.stored_result import StoredResult

OF_SEQUENCE = ("label_name", "split", "room", "place", "draw")


def results_of_set(folder: Path) -> Iterator[tuple[str, StoredResult]]:
    """Iterates over the sequences of a set.

    Args:
        folder: The set.

    Yields:
        Number of the sequence as folder name, and its result.

    Raises:
        InputError: If the folder is not a set, or damaged.
    """
    stored = read_labelled(folder)
    columns = stored.columns
    for index in range(len(stored)):
        cube = stored.cube(index)
        pose = PoseSequence(
            time_s=cube.grid.frame_time_s,
            joints_m=stored.joints_m[index],
            height_m=float(columns["height"][index]),
            subject=int(columns["subject"][index]),
        )
        meta: dict[str, Any] = {
            "schema_version": META_VERSION,
            "made_by": "mmweaver export",
            "version": __version__,
            "text": str(columns["text"][index]),
            "frames": len(cube.values),
            "fps": 1 / cube.config.frame_period_s,
            "placed": {
                "heading_rad": float(columns["heading"][index]) if "heading" in columns else None,
                "subject": int(columns["subject"][index]),
            },
            "sequence": {"index": index, **{name: columns[name][index] for name in OF_SEQUENCE if name in columns}},
            **radar_meta(cube.config),
        }
        name = f"{index:06d}"
        yield (
            name,
            StoredResult(folder=folder / name, cube=cube, points=stored.cloud(index), poses=(pose,), meta=plain(meta)),
        )


@export_format("results", "a result folder, of each sequence of a set")
def write_results(result: StoredResult, out: Path) -> str:
    """Writes a result folder: radar.npz, points.npz, pose.npz if there are people, radar.json, meta.json."""
    write_radar_npz(out / "radar.npz", result.cube)
    write_points_npz(out / "points.npz", result.points)
    if result.poses:
        write_pose_npz(out / "pose.npz", *result.poses)
    (out / "radar.json").write_text(result.cube.config.to_json(), encoding="utf-8")
    names = {file.name for file in out.iterdir()} | {"meta.json"}
    meta = {**result.meta, "files": {name: text for name, text in FILES.items() if name in names}}
    text = json.dumps(meta, indent=2, allow_nan=False, ensure_ascii=False)
    (out / "meta.json").write_text(text + "\n", encoding="utf-8")
    return "a result folder"
