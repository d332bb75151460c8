"""How accurate the built-in segmenter is: unseen kinds of rooms, real photographs, and its effect on affordances.

python -m studies run segmenter_study --rooms /path/to/rooms --picture docs/images/segmenter.png

In the real rooms places were annotated by hand before any prediction was looked at (real_rooms_classes.json).
Baselines: heights and slopes alone; depth without a mask. Oracle: the true mask.
"""

import argparse
import dataclasses
import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

from mmweaver.core.records import RgbdPhoto
from mmweaver.scene.coco_stuff import NAMES
from mmweaver.scene.photo.depth_grid import make_grid
from mmweaver.scene.procedural.lighting import LIGHTINGS
from mmweaver.scene.procedural.procedural_room import make_room
from mmweaver.scene.read_photo import read_photo
from mmweaver.scene.reconstruction import reconstruct
from mmweaver.scene.segmentation.builtin_segmenter import (
    GROUP_NAMES,
    STRIDE,
    grid_features,
    group_of_classes,
    groups_of_cells,
    load_network,
    segment_builtin,
)
from studies.manifest import StudyRun
from studies.result_rows import complete_rows
from studies.scene.affordances import Tally, measure_scene, share_of
from studies.scene.segmenter_data import SegmenterExample, make_examples
from studies.scene.segmenter_scores import by_geometry, confusion, scores
from studies.scene.segmenter_training import TEST_KINDS, TEST_SEED
from studies.study import Reads

REAL_TRUTH = Path(__file__).with_name("real_rooms_classes.json")
UNKNOWN = {
    "dataset.sha256": "rendered anew in every run; photos are hashed in the manifest",
    "seconds": "see the manifest: all rows together",
}
Guess = Callable[[np.ndarray], np.ndarray]


def unseen_row(name: str, guess: Guess, examples: list[SegmenterExample]) -> dict[str, Any]:
    """Scores on cells of rendered rooms of unseen kinds."""
    found = scores(confusion(examples, guess))
    metrics = {
        "miou": _metric(found["miou"], "mean intersection over union of the groups that occur"),
        "right": _metric(found["right"], "share of cells whose group is right"),
    }
    metrics |= {f"iou_{group}": _metric(value, "intersection over union") for group, value in found["iou"].items()}
    return _row("procedural, unseen kinds", name, len(examples), metrics)


def real_rows(name: str, guess: Guess, folders: list[Path]) -> list[dict[str, Any]]:
    """Scores on annotated places of real photos."""
    rows = []
    for folder in folders:
        photo, _ = read_photo(folder / "rgb.png", folder / "depth.png", folder / "camera.json")
        right = marked_right(photo, guess, json.loads(REAL_TRUTH.read_text(encoding="utf-8"))[folder.name])
        metrics = {
            "places_right": share_of("places_right", right, "of places marked by hand, those of the right group")
        }
        rows.append(_row(folder.name, name, 1, metrics))
    return rows


def marked_right(photo: RgbdPhoto, guess: Guess, marked: dict[str, list[tuple[float, float]]]) -> list[bool]:
    """For each annotated place (shares of width and height) whether its group is one of those named."""
    groups = guess(grid_features(make_grid(photo)))
    rows, columns = groups.shape
    right = []
    for names, places in marked.items():
        meant = [GROUP_NAMES.index(one) for one in names.split("|")]
        right += [bool(groups[int(v * rows), int(u * columns)] in meant) for u, v in places]
    return right


def affordance_row(name: str, number: int) -> dict[str, Any]:
    """Seats, tables, doors and windows in rooms of unseen kinds with a given kind of mask."""
    tally = Tally()
    for index in range(number):
        room = make_room(TEST_KINDS[index % len(TEST_KINDS)], index // len(TEST_KINDS) % 10, 20_000 + index)
        photo = room.photo(tuple(LIGHTINGS)[index % 4], noise=True)
        bare = dataclasses.replace(photo, classes=None)
        mask = {"none": None, "network": segment_builtin(bare) if name == "network" else None, "true": photo.classes}
        measure_scene(room, reconstruct(dataclasses.replace(photo, classes=mask[name])), tally)
    metrics = {
        "seats_found": share_of("seats_found", tally.seats, "of the seats in view, those found within 0.35 m and 8 cm"),
        "false_seats": share_of("false_seats", tally.false_seats, "of the seats found, those on no seat"),
    }
    for kind in ("table", "door", "window"):
        metrics[f"{kind}_found"] = share_of(
            f"{kind}_found", tally.marks.get(kind, []), f"of each {kind} in view, found"
        )
        metrics[f"{kind}_false"] = share_of(
            f"{kind}_false", tally.false_marks.get(kind, []), f"of each {kind} found, none"
        )
    return _row("procedural, unseen kinds: affordances", name, number, {k: v for k, v in metrics.items() if v})


def draw(path: Path, folders: list[Path]) -> None:
    """The real photos above the predictions of the network."""
    import matplotlib as mpl
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure
    from matplotlib.patches import Patch

    from studies.scene.room_pictures import save_small, small

    figure = Figure(figsize=(2.6 * len(folders), 4.4), layout="constrained")
    FigureCanvasAgg(figure)
    colours = mpl.colormaps["tab20"](np.arange(len(GROUP_NAMES)))
    colours[0] = (0.9, 0.9, 0.9, 1.0)
    axes, seen = figure.subplots(2, len(folders), squeeze=False), set()
    for (above, below), folder in zip(axes.T, folders, strict=True):
        photo, _ = read_photo(folder / "rgb.png", folder / "depth.png", folder / "camera.json")
        groups = group_of_classes(NAMES)[segment_builtin(photo).index[::4, ::4]]
        seen |= set(np.unique(groups).tolist())
        above.imshow(small(photo.rgb))
        below.imshow(colours[groups], interpolation="nearest")
        above.set_title(folder.name.replace("_", " "), fontsize=8)
        for one in (above, below):
            one.axis("off")
    patches = [Patch(color=_hex(colours[group]), label=GROUP_NAMES[group]) for group in sorted(seen)]
    figure.legend(handles=patches, loc="outside lower center", ncols=8, fontsize=7, frameon=False)
    save_small(figure, path)


def _hex(colour: np.ndarray) -> str:
    return "#" + "".join(f"{round(255 * float(part)):02x}" for part in colour[:3])


def _row(dataset: str, method: str, number: int, metrics: dict[str, Any]) -> dict[str, Any]:
    return {"dataset": {"name": dataset, "split": method}, "n": number, "seeds": [TEST_SEED], "metrics": metrics}


def _metric(value: float, definition: str) -> dict[str, Any]:
    return {"value": round(value, 4), "unit": "share", "definition": definition, "version": 1}


def measure(run: StudyRun, folders: list[Path], per_kind: int, number: int) -> Path:
    """Writes one file of all rows."""
    network = load_network()
    guesses: dict[str, Guess] = {
        "network": lambda features: groups_of_cells(features, network), "geometry": by_geometry,
    }  # fmt: skip
    examples = make_examples(TEST_KINDS, per_kind, TEST_SEED)
    rows = [unseen_row(name, guess, examples) for name, guess in guesses.items()]
    for name, guess in guesses.items():
        rows += real_rows(name, guess, folders)
    rows += [affordance_row(name, number) for name in ("none", "network", "true")]
    config = {"kinds": list(TEST_KINDS), "every": STRIDE}
    return run.write("segmenter", "builtin", config=config, rows=complete_rows(rows, seconds=None, unknown=UNKNOWN))


def add_options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--rooms", type=Path, action=Reads, required=True, help="folder of the real rooms")
    parser.add_argument("--per-kind", type=int, default=12)
    parser.add_argument("--number", type=int, default=60, help="rooms for the affordances")
    parser.add_argument("--picture", type=Path, default=None)


def run_study(options: argparse.Namespace, run: StudyRun) -> None:
    folders = sorted(one for one in options.rooms.iterdir() if (one / "camera.json").is_file())
    measure(run, folders, options.per_kind, options.number)
    if options.picture is not None:
        draw(options.picture, folders)
