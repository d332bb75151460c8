"""A labelled set from result folders: of `mmweaver generate --texts`, of an export, or recorded ones with joints.

A sequence is labelled by its sentence, or by the activity that includes its sentence. Missing information (place,
person) is derived from the joints, or unknown (-1).
"""

import json
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from mmweaver.core.atomic_files import staged_folder
from mmweaver.core.errors import InputError
from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.records import PoseSequence
from mmweaver.core.safe_files.safe_text import parse_json
from mmweaver.core.skeleton import joint
from mmweaver.datasets.activity_store import (
    ACTIVITIES_FILE,
    SCHEMA_VERSION,
    SET_FILE,
)
from mmweaver.datasets.build_set import Activities, split_columns, write_labelled, write_leaks
from mmweaver.datasets.confounders import circumstances
from mmweaver.datasets.data_card import write_set_card
from mmweaver.datasets.zarr_arrays import packed_iq
from mmweaver.io.stored_result import StoredResult, read_result
from mmweaver.signal.features import point_table

SAME_PLACE_M = 0.05
OWN = ("room", "place", "split")  # stored per sequence by an export of a set


def result_folders(folder: Path) -> list[Path]:
    """Lists the result folders in a folder, by name.

    Args:
        folder: Parent folder.

    Returns:
        The result folders.

    Raises:
        InputError: If there are none.
    """
    found = sorted(file.parent for file in folder.glob("*/radar.npz")) if folder.is_dir() else []
    if not found:
        raise InputError(f"{folder} holds no result folders; give what mmweaver generate --texts wrote")
    return found


def set_of_results(
    source: Path,
    out: Path,
    *,
    activities: Activities | None = None,
    split_by: str | None = None,
    seed: int = 0,
    command: str,
) -> dict[str, Any]:
    """Builds a labelled set from result folders.

    Args:
        source: Parent folder of the results.
        out: Folder of the set.
        activities: Sentences by label. Default: each sentence is a label.
        split_by: Property that is held out. Default: the splits of the set from which the folders were exported, else
            by subject.
        seed: Seed of the splits. Default: 0.
        command: Command line, stored in set.json.

    Returns:
        The leak report.

    Raises:
        InputError: If results differ in radar, length or number of people, lack joints, or have a sentence of no
            activity.
    """
    folders = result_folders(source)
    first = read_result(folders[0])
    label_of = _labels(folders, activities)
    names = tuple(activities or dict.fromkeys(label_of))
    rows: list[dict[str, Any]] = []
    for number, folder in enumerate(folders):
        result = read_result(folder)
        pose = _checked(result, folder, first)
        placed, own = _table(result.meta.get("placed")), _table(result.meta.get("sequence"))
        rows.append(
            {
                **{name: own.get(name) for name in OWN},
                "text": result.text,
                "height": pose.height_m,
                "subject": placed.get("subject", pose.subject),
                "draw": own.get("draw", result.meta.get("seed", number)),
                "heading": placed.get("heading_rad") or _heading(pose.joints_m),
                "iq_scale": packed_iq(result.cube)[1],
                "joints_m": pose.joints_m.astype(np.float32),
                "points": point_table(result.points),
                "point_frame": result.points.frame.astype(np.int32),
            }
        )
    columns = {name: [row[name] for row in rows] for name in rows[0]}
    arrays = {name: columns.pop(name) for name in ("joints_m", "points", "point_frame", "iq_scale")}
    for name in ("subject", "draw", "heading", "height"):
        columns[name] = _numbers(columns[name], name, source).tolist()
    columns["label"] = [names.index(label) for label in label_of]
    columns["room"] = _numbered(columns["room"])
    columns["place"] = _places(arrays["joints_m"]) if None in columns["place"] else _numbered(columns["place"])
    splits = split_columns(
        seed,
        subject=columns["subject"],
        room=columns["room"],
        sentence=columns["text"],
        place=list(zip(columns["room"], columns["place"], strict=True)),
    )
    is_split = split_by is None and all(isinstance(one, str) and one for one in columns["split"])
    columns |= splits if is_split else splits | {"split": splits[f"split_{split_by or 'subject'}"]}
    with staged_folder(out) as stage:
        signals = (packed_iq(read_result(folder).cube)[0] for folder in folders)  # keep one cube at a time in memory
        write_labelled(stage, first.cube.config, names, columns, arrays, signals, "float16")
        found = circumstances(
            arrays["joints_m"], np.asarray(columns["label"]), person=columns["subject"], height=columns["height"]
        )
        report = write_leaks(stage, found, columns, names)
        _describe(stage, names, columns, first.cube.config, command)
    write_set_card(out)
    return report


def _labels(folders: Sequence[Path], activities: Activities | None) -> list[str]:
    """Label of each folder."""
    texts = [_text(folder) for folder in folders]
    if activities is None:
        return texts
    of = {text: label for label, sentences in activities.items() for text in sentences}
    for folder, text in zip(folders, texts, strict=True):
        if text not in of:
            raise InputError(
                f"{folder}: {text!r} is a sentence of no activity; add it to one, or leave out --activities"
            )
    return [of[text] for text in texts]


def _text(folder: Path) -> str:
    text = read_result(folder).text
    if not text:
        raise InputError(f"{folder} says in no meta.json what was done; only results with a text can be labelled")
    return text


def _checked(result: StoredResult, folder: Path, first: StoredResult) -> PoseSequence:
    """Joints of the person. Raises InputError if the result does not match the first one."""
    if len(result.poses) != 1:
        raise InputError(f"{folder} has {len(result.poses)} people with joints; a labelled set is of one person each")
    if result.cube.values.shape != first.cube.values.shape or result.cube.config != first.cube.config:
        raise InputError(f"{folder} has another radar or length than the first result; a set has one of each")
    return result.poses[0]


def _table(found: Any) -> dict[str, Any]:
    return {key: value for key, value in found.items() if value is not None} if isinstance(found, dict) else {}


def _numbers(values: list[Any], name: str, source: Path) -> np.ndarray:
    try:
        return np.array(values, np.float64 if name in ("heading", "height") else np.int64)
    except (TypeError, ValueError, OverflowError):
        raise InputError(f"{source}: a meta.json has a {name} that is no number; generate the results again") from None


def _numbered(values: list[Any]) -> list[int]:
    """Keeps the values if all are valid numbers; otherwise numbers the distinct values."""
    if all(type(value) is int and 0 <= value < 2**31 for value in values):
        return values
    known = sorted({str(value) for value in values})
    return [known.index(str(value)) for value in values]


def _places(joints_m: Sequence[np.ndarray]) -> list[int]:
    """Numbers the start places; starts within 5 cm share a number."""
    found: list[np.ndarray] = []
    numbers = []
    for start_m in (one[0, joint("pelvis"), :2].astype(np.float64) for one in joints_m):
        near = [index for index, other in enumerate(found) if np.linalg.norm(start_m - other) < SAME_PLACE_M]
        if not near:
            found.append(start_m)
        numbers.append(near[0] if near else len(found) - 1)
    return numbers


def _heading(joints_m: np.ndarray) -> float:
    """Initial direction of the hips, from +x towards +y."""
    across = joints_m[0, joint("right_hip"), :2] - joints_m[0, joint("left_hip"), :2]
    return float(np.arctan2(across[0], -across[1]))


def _describe(stage: Path, names: tuple[str, ...], columns: dict[str, Any], config: RadarConfig, command: str) -> None:
    """Writes set.json and activities.toml."""
    import tomli_w

    sentences = {name: [] for name in names}
    for label, text in zip(columns["label"], columns["text"], strict=True):
        if text not in sentences[names[label]]:
            sentences[names[label]].append(text)
    description = {
        "schema_version": SCHEMA_VERSION,
        "command": command,
        "activities": sentences,
        "from_results": True,
        "radar": parse_json(config.to_json(), "the radar"),
    }
    (stage / SET_FILE).write_text(json.dumps(description, indent=1, ensure_ascii=False) + "\n", encoding="utf-8")
    (stage / ACTIVITIES_FILE).write_text(tomli_w.dumps({"activities": sentences}), encoding="utf-8")
