"""Export of results and sets to other formats.

Sequences of a labelled set or a data set of rooms as results, for every export format.

Also defines the format "results", a result folder per sequence.
"""

import json
import shutil
from collections.abc import Iterator
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from mmweaver.core.atomic_files import atomic_file, staged_folder
from mmweaver.core.constants import __version__
from mmweaver.core.errors import InputError
from mmweaver.core.records import PoseSequence

# imported to register their formats
from mmweaver.datasets import cloud_layouts, containers, rerun_file, robotics, tensor_layouts, videos  # noqa: F401
from mmweaver.datasets.formats import FORMATS, export_format
from mmweaver.datasets.room_sequences import read_labelled
from mmweaver.io.npz_files import write_points_npz, write_pose_npz, write_radar_npz
from mmweaver.io.result_folder import FILES, META_VERSION, plain, radar_folder, radar_meta
from mmweaver.io.stored_result import StoredResult, read_result

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


def export_result(folder: Path | str, kind: str, out: Path | str, *, overwrite: bool = False) -> str:
    """Exports a result folder to another format, completely or not at all.

    Args:
        folder: The result; for some formats a folder of two radars of one scene.
        kind: Key of FORMATS.
        out: Output folder, or the file of a single-file format.
        overwrite: Whether files may be replaced. Default: False.

    Returns:
        Description of what was written.

    Raises:
        InputError: If the format is unknown, the folder is not a result, or the format cannot represent it.
    """
    if kind not in FORMATS:
        raise InputError(f"unknown format {kind!r}; known: {', '.join(FORMATS)}")
    if (write_pair := FORMATS[kind].write_pair) is not None and is_of_two_radars(Path(folder), kind):
        both = [read_result(Path(folder) / radar_folder(number)) for number in (1, 2)]
        with staged_folder(Path(out), overwrite=overwrite) as stage:
            return write_pair(both[0], both[1], stage)
    return export_stored(read_result(Path(folder)), kind, out, overwrite=overwrite)


def export_stored(result: StoredResult, kind: str, out: Path | str, *, overwrite: bool = False) -> str:
    """Exports a result in memory, as `export_result` does.

    Args:
        result: The result.
        kind: Key of FORMATS.
        out: Output folder; with the suffix of a single-file format, such as walk.mp4, the file.
        overwrite: Whether files may be replaced. Default: False.

    Returns:
        Description of what was written.

    Raises:
        InputError: If the file exists without `overwrite`, or the format cannot represent the result.
    """
    out, ending = Path(out), FORMATS[kind].ending
    if ending and out.suffix == ending and not out.is_dir():
        if out.exists() and not overwrite:
            raise InputError(f"{out} exists; choose another name, or add --overwrite")
        with atomic_file(out) as file, TemporaryDirectory() as folder:
            what = FORMATS[kind].write(result, Path(folder))
            shutil.copyfile(Path(folder) / f"result{ending}", file)
        return what
    with staged_folder(Path(out), overwrite=overwrite) as stage:
        return FORMATS[kind].write(result, stage)


def export_set(
    folder: Path | str, kind: str, out: Path | str, *, overwrite: bool = False
) -> Iterator[tuple[Path, str]]:
    """Exports every sequence of a set, labelled or of rooms, to its own folder below `out`.

    Args:
        folder: The set.
        kind: Key of FORMATS.
        out: Parent folder.
        overwrite: Whether files may be replaced. Default: False.

    Yields:
        Each folder with a description of its content.

    Raises:
        InputError: If the format needs raw samples, which sets do not contain, or the folder is not a set.
    """
    if FORMATS[kind].needs_samples:
        raise InputError(f"{kind} needs raw samples, which a set does not keep; generate results with --bin")
    for name, result in results_of_set(Path(folder)):
        yield Path(out) / name, export_stored(result, kind, Path(out) / name, overwrite=overwrite)


def is_of_two_radars(folder: Path, kind: str) -> bool:
    """Whether a folder contains results of several radars of one scene that the format combines."""
    two = [folder / radar_folder(number) / "radar.npz" for number in (1, 2)]
    return FORMATS[kind].write_pair is not None and all(file.is_file() for file in two)
