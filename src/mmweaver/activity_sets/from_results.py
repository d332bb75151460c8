"""A labelled set from result folders: those of `mmweaver generate --texts`, of an export, or recorded ones with joints.

A sequence is labelled by its sentence, or by the activity whose sentences hold it. What a folder does not say (a place,
a person) is taken from its joints, or is unknown (-1).
"""

import json
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from mmweaver.activity_sets.activity_list import ActivityList
from mmweaver.activity_sets.build_set import split_of
from mmweaver.activity_sets.leak_report import circumstances, leak_report
from mmweaver.core.atomic_files import staged_folder
from mmweaver.core.errors import InputError
from mmweaver.core.safe_files.safe_text import parse_json
from mmweaver.core.skeleton import joint
from mmweaver.datasets.activity_store import (
    ACTIVITIES_FILE,
    LEAKS_FILE,
    SCHEMA_VERSION,
    SET_FILE,
    SPLIT_KEYS,
    write_set,
)
from mmweaver.datasets.data_card import write_set_card
from mmweaver.datasets.zarr_arrays import packed_iq
from mmweaver.dsp.features import point_table
from mmweaver.formats.stored_result import StoredResult, read_result

SAME_PLACE_M = 0.05
OWN = ("room", "place", "split")  # what an export of a set says of each sequence


def result_folders(folder: Path) -> list[Path]:
    """The result folders in a folder, by name. Raises InputError where there is none."""
    found = sorted(file.parent for file in folder.glob("*/radar.npz")) if folder.is_dir() else []
    if not found:
        raise InputError(f"{folder} holds no result folders; give what mmweaver generate --texts wrote")
    return found


def set_of_results(
    source: Path, out: Path, *, activities: ActivityList | None = None, split_by: str | None = None, seed: int = 0,
    command: str,
) -> dict[str, Any]:  # fmt: skip
    """Writes the set into `out` and returns its leak report.

    `activities`: labels with their sentences (default: each sentence is a label). `split_by`: what is held out; by
    default the splits of the set that the folders were exported from are kept, else people are held out. Raises
    InputError for folders of several radars, lengths or people, without joints, or with a sentence that is no
    activity's.
    """
    folders = result_folders(source)
    first = read_result(folders[0])
    config, shape = first.cube.config, first.cube.values.shape
    label_of = _labels(folders, activities)
    names = tuple(activities.labels) if activities is not None else tuple(dict.fromkeys(label_of))
    columns: dict[str, list[Any]] = {name: [] for name in (*OWN, "text", "subject", "draw", "heading", "height")}
    joints, points, point_frame, counts, scales = [], [], [], [], []
    with staged_folder(out) as stage:
        for number, folder in enumerate(folders):
            result = read_result(folder)
            pose = _checked(result, folder, shape, config)
            placed, own = _table(result.meta.get("placed")), _table(result.meta.get("sequence"))
            columns["text"].append(result.text)
            columns["subject"].append(placed.get("subject", pose.subject))
            columns["draw"].append(own.get("draw", result.meta.get("seed", number)))
            columns["heading"].append(placed.get("heading_rad") or _heading(pose.joints_m))
            columns["height"].append(pose.height_m)
            for name in OWN:
                columns[name].append(own.get(name))
            joints.append(pose.joints_m.astype(np.float32))
            points.append(point_table(result.points))
            point_frame.append(result.points.frame.astype(np.int32))
            counts.append(len(result.points.frame))
            scales.append(packed_iq(result.cube)[1])
        numbers = {name: _numbers(columns[name], name, source) for name in ("subject", "draw", "heading", "height")}
        start_m = np.stack([one[0, joint("pelvis"), :2] for one in joints]).astype(np.float64)
        every = {
            **numbers, "text": columns["text"], "label": [names.index(label) for label in label_of],
            "label_name": label_of, "room": _numbered(columns["room"]),
            "place": _places(start_m) if None in columns["place"] else _numbered(columns["place"]),
        }  # fmt: skip
        groups = {
            "subject": numbers["subject"].tolist(), "room": every["room"],
            "place": list(zip(every["room"], every["place"], strict=True)),
            "sentence": every["text"],
        }  # fmt: skip
        splits = {f"split_{key}": split_of(groups[key], key, seed) for key in SPLIT_KEYS}
        is_split = split_by is None and all(isinstance(one, str) and one for one in columns["split"])
        every |= splits | {"split": columns["split"] if is_split else splits[f"split_{split_by or 'subject'}"]}
        signals = (packed_iq(read_result(folder).cube)[0] for folder in folders)  # one cube at a time in memory
        write_set(stage, config, names, every, {
            "joints_m": np.stack(joints), "points": np.concatenate(points).astype(np.float32),
            "point_frame": np.concatenate(point_frame), "iq_scale": np.array(scales),
            "point_sequence": np.repeat(np.arange(len(folders)), counts).astype(np.int32),
        }, signals, "float16")  # fmt: skip
        label = np.asarray(every["label"])
        more = {"person": numbers["subject"].tolist(), "height": numbers["height"].tolist()}
        report = leak_report(circumstances(joints, label, **more), label, numbers["draw"], names)
        (stage / LEAKS_FILE).write_text(json.dumps(report, indent=1) + "\n", encoding="utf-8")
        _describe(stage, names, every, config, command)
    write_set_card(out)
    return report


def _labels(folders: Sequence[Path], activities: ActivityList | None) -> list[str]:
    """The label of each folder."""
    texts = [_text(folder) for folder in folders]
    if activities is None:
        return texts
    of = {text: label for label, sentences in activities.sentences.items() for text in sentences}
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


def _checked(result: StoredResult, folder: Path, shape: tuple[int, ...], config: Any) -> Any:
    """The person's joints. Raises InputError where the result does not fit the others."""
    if len(result.poses) != 1:
        raise InputError(f"{folder} has {len(result.poses)} people with joints; a labelled set is of one person each")
    if result.cube.values.shape != shape or result.cube.config != config:
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
    """Numbers as they are where all are; else a number for each different value."""
    if all(type(value) is int and 0 <= value < 2**31 for value in values):
        return values
    known = sorted({str(value) for value in values})
    return [known.index(str(value)) for value in values]


def _places(start_m: np.ndarray) -> list[int]:
    """A number for each place, shared by starts within 5 cm."""
    found: list[np.ndarray] = []
    numbers = []
    for place in start_m:
        near = [index for index, other in enumerate(found) if np.linalg.norm(place - other) < SAME_PLACE_M]
        if not near:
            found.append(place)
        numbers.append(near[0] if near else len(found) - 1)
    return numbers


def _heading(joints_m: np.ndarray) -> float:
    """Where the hips face at first, from +x towards +y."""
    across = joints_m[0, joint("right_hip"), :2] - joints_m[0, joint("left_hip"), :2]
    return float(np.arctan2(across[0], -across[1]))


def _describe(stage: Path, names: tuple[str, ...], every: dict[str, Any], config: Any, command: str) -> None:
    """set.json and activities.toml."""
    import tomli_w

    sentences = {name: [] for name in names}
    for label, text in zip(every["label_name"], every["text"], strict=True):
        if text not in sentences[label]:
            sentences[label].append(text)
    description = {
        "schema_version": SCHEMA_VERSION, "command": command, "activities": sentences, "from_results": True,
        "radar": parse_json(config.to_json(), "the radar"),
    }  # fmt: skip
    (stage / SET_FILE).write_text(json.dumps(description, indent=1, ensure_ascii=False) + "\n", encoding="utf-8")
    (stage / ACTIVITIES_FILE).write_text(tomli_w.dumps({"activities": sentences}), encoding="utf-8")
