"""Photos with little floor: is somebody placed in them, and clear of what the whole photo shows?

python -m studies run little_floor --rooms /path/to/rooms

Six crops (upper part, halves, middle, a corner, lower middle) of photographed rooms and of procedural ones. The crop is
all that is given; bodies are compared with what the whole photo measured, or with the procedural room's boxes. Crops in
which the method finds at most 1.5 m2 of free floor within the window are reported apart.
"""

import argparse
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np

from mmweaver.core.errors import InputError
from mmweaver.core.records import PoseSequence, RgbdPhoto, Scene
from mmweaver.core.shapes import Rotation
from mmweaver.motion.compose import Motion, compose
from mmweaver.motion.language.timing import plan_motion
from mmweaver.motion.planning.constraint_relaxation import ASSUMED_FLOOR
from mmweaver.scene.procedural.procedural_room import ProceduralRoom, make_room
from mmweaver.scene.read_photo import read_photo
from mmweaver.scene.reconstruction import reconstruct
from studies.manifest import StudyRun
from studies.result_rows import complete_rows
from studies.scene.affordances import RANGE_WINDOW_M, share_of
from studies.scene.real_placements import deepest_m, measured_m
from studies.scene.room_contact import contact
from studies.study import Reads

# top, bottom, left, right as shares of the picture
CROPS = {
    "upper part": (0.0, 0.6, 0.0, 1.0), "left half": (0.0, 1.0, 0.0, 0.5), "right half": (0.0, 1.0, 0.5, 1.0),
    "middle": (0.25, 0.75, 0.25, 0.75), "upper left": (0.0, 0.55, 0.0, 0.55), "lower middle": (0.45, 1.0, 0.2, 0.8),
}  # fmt: skip
KINDS, SEED = ("kitchen", "office", "bedroom"), 14000
SENTENCES, SECONDS = ("she claps", "a person walks to the left"), 2.0
LITTLE_M2 = 1.5
UNKNOWN = {
    "dataset.sha256": "rendered anew in every run; photos are hashed in the manifest",
    "seconds": "see the manifest: all rows together",
}


@dataclass
class CropTally:
    """What happened in a group of crops."""

    placed: list[bool] = field(default_factory=list)
    assumed: list[bool] = field(default_factory=list)
    clear: list[bool] = field(default_factory=list)


def cropped(photo: RgbdPhoto, box: tuple[float, float, float, float]) -> RgbdPhoto:
    """A part of a photo, as a camera with a smaller sensor would have taken it."""
    height, width = photo.depth_m.shape
    top, bottom, left, right = (
        round(share * size) for share, size in zip(box, (height,) * 2 + (width,) * 2, strict=True)
    )
    lens = replace(
        photo.intrinsics, cx=photo.intrinsics.cx - left, cy=photo.intrinsics.cy - top, width=right - left,
        height=bottom - top,
    )  # fmt: skip
    part = (slice(top, bottom), slice(left, right))
    return replace(
        photo, rgb=np.ascontiguousarray(photo.rgb[part]), depth_m=np.ascontiguousarray(photo.depth_m[part]),
        intrinsics=lens, classes=None,
    )  # fmt: skip


def turned(pose: PoseSequence, crop: Scene, radar_from_camera: Rotation) -> PoseSequence:
    """A pose of a crop's frame in that of another estimate of gravity; the camera is the same."""
    return replace(pose, joints_m=pose.joints_m @ crop.radar_from_camera @ radar_from_camera.T)


def measure(photo: RgbdPhoto, truth: Scene | ProceduralRoom, tallies: dict[bool, CropTally]) -> None:
    """Adds all crops of a photo to the tallies of crops with little floor (True) and with more (False)."""
    from scipy.spatial import KDTree

    tree = KDTree(measured_m(truth, photo)) if isinstance(truth, Scene) else None
    for box in CROPS.values():
        crop = reconstruct(cropped(photo, box))
        tally = tallies[_free_m2(crop) <= LITTLE_M2]
        for seed, text in enumerate(SENTENCES):
            try:
                motion = compose(plan_motion(text, SECONDS), crop, seed=seed, range_window_m=RANGE_WINDOW_M)
            except InputError:
                tally.placed.append(False)
                continue
            tally.placed.append(True)
            tally.assumed.append(ASSUMED_FLOOR in motion.assumptions)
            tally.clear.append(_is_clear(motion, crop, truth, tree))


def _is_clear(motion: Motion, crop: Scene, truth: Scene | ProceduralRoom, tree: Any) -> bool:
    pose = turned(motion.pose, crop, truth.radar_from_camera)
    if isinstance(truth, ProceduralRoom):
        return contact(truth, pose).body_m <= 0
    return deepest_m(tree, pose, None)[0] <= 0


def _free_m2(scene: Scene) -> float:
    free = scene.free_space
    distance_m = np.hypot(free.x_m[None, :], free.y_m[:, None])
    inside = (distance_m > RANGE_WINDOW_M[0]) & (distance_m < RANGE_WINDOW_M[1])
    return float((free.is_free & inside).sum()) * float(free.x_m[1] - free.x_m[0]) ** 2


def _row(name: str, little: bool, tally: CropTally) -> dict[str, Any]:
    where = f"at most {LITTLE_M2:g} m2 of free floor" if little else "more free floor"
    return {
        "dataset": {"name": name, "split": "rooms on which placements were developed", "crops": where},
        "n": len(tally.placed), "seeds": [0, 1], "refused": tally.placed.count(False),
        "metrics": {
            **_share("placed", tally.placed, "of the sentences, those with somebody placed"),
            **_share("on_assumed_floor", tally.assumed, "of those placed, on floor that was only assumed"),
            **_share("clear", tally.clear, "of those placed, trunk, legs and head nowhere 3 cm inside anything"),
        },
    }  # fmt: skip


def _share(name: str, values: list[bool], definition: str) -> dict[str, Any]:
    metric = share_of(name, values, definition)
    return {name: metric} if metric else {}


def add_options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--rooms", type=Path, action=Reads, required=True, help="folder of the photographed rooms")


def run_study(options: argparse.Namespace, run: StudyRun) -> None:
    real, procedural = ({True: CropTally(), False: CropTally()} for _ in range(2))
    for folder in sorted(options.rooms.iterdir()):
        if (folder / "camera.json").is_file():
            photo, _ = read_photo(folder / "rgb.png", folder / "depth.png", folder / "camera.json")
            measure(photo, reconstruct(photo), real)
    for kind in KINDS:
        room = make_room(kind, 0, SEED)
        measure(room.photo("day", noise=True), room, procedural)
    rows = [
        _row(name, little, tallies[little])
        for name, tallies in (("photographed", real), ("procedural", procedural)) for little in (True, False)
        if tallies[little].placed
    ]  # fmt: skip
    config = {
        "sentences": list(SENTENCES),
        "seconds": SECONDS,
        "crops": {name: list(box) for name, box in CROPS.items()},
    }
    run.write("little_floor", "crops", config=config, rows=complete_rows(rows, unknown=UNKNOWN))
