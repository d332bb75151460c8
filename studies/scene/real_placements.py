"""The four real rooms: is the floor at its height, and does nobody intersect what the depth camera measured?

python -m studies run real_placements --rooms /path/to/rooms

The floor is compared with places in the photo that were annotated as floor (real_rooms_classes.json), bodies with the
measured points, the only ground truth for what stands in a real room: no limb may be within its own thickness of a
point, less 3 cm. A body wholly behind a surface would not be found; the procedural rooms of `affordances`, whose boxes
are known, cover that.
"""

import argparse
import json
from pathlib import Path
from typing import Any

import numpy as np
from jaxtyping import Float

from mmweaver.core.errors import InputError
from mmweaver.core.pinhole import unproject
from mmweaver.core.records import PoseSequence, RgbdPhoto, Scene
from mmweaver.core.shapes import Points
from mmweaver.core.skeleton import joint
from mmweaver.motion.compose import Motion, compose
from mmweaver.motion.language.timing import plan_motion
from mmweaver.scene.read_photo import read_photo
from mmweaver.scene.reconstruction import reconstruct
from studies.manifest import StudyRun
from studies.result_rows import complete_rows
from studies.scene.affordances import RANGE_WINDOW_M, SECONDS, share_of
from studies.scene.room_contact import ALLOWED_M, ON_SEAT_M, sampled
from studies.study import Reads

SENTENCES = {
    "kinect2_living_room": (
        "user seated on couch drinking water", "a person walks towards the radar, then waves with the left hand",
        "she sits down on the couch", "someone does jumping jacks", "a man boxes quickly",
        "he stands up",
    ),
    "kinect_dining_room": (
        "a person walks away from the radar", "someone waves with both hands", "she claps",
        "a man walks towards the radar and stops", "he squats", "she raises her right hand",
    ),
    "redwood_chair_corner": (
        "a person waves with the right hand", "someone claps", "she squats", "he jumps",
        "a woman raises her left hand", "a man boxes",
    ),
    "tum_office_desk": (
        "a person sits and drinks", "someone walks to the right, then claps", "a man does jumping jacks",
        "she walks towards the radar", "he stands up and waves", "someone turns around",
    ),
}  # fmt: skip
SEEDS = range(10)
MARKS = Path(__file__).with_name("real_rooms_classes.json")
FLOOR_MARKS = "floor-other"
_WINDOW = 4  # pixels about a mark
_LOWEST_M, _NEAREST_M = 0.09, 0.3  # above the floor, where its noise ends; from the camera
_ON_SEAT_REACH_M, _FARTHEST_M = 0.65, 0.3
_SINKS = {"pelvis", "spine1", "spine2", "spine3", "left_hip", "right_hip", "left_collar", "right_collar"}
_ARMS = {"shoulder", "elbow", "wrist"}
_ALONG = np.linspace(0.0, 1.0, 7)

Array = np.ndarray


def floor_error_m(scene: Scene, photo: RgbdPhoto, marks: list[list[float]]) -> tuple[float, int]:
    """Distance of the found floor from the median height of annotated places, and how many of them have a depth.

    Places are x, y as shares of the photo.
    """
    rows, columns = photo.depth_m.shape
    points = unproject(photo.depth_m, photo.intrinsics) @ scene.radar_from_camera.T
    heights = []
    for x, y in marks:
        row, column = int(y * rows), int(x * columns)
        near = points[max(row - _WINDOW, 0) : row + _WINDOW + 1, max(column - _WINDOW, 0) : column + _WINDOW + 1, 2]
        if np.isfinite(near).any():
            heights.append(float(np.nanmedian(near)))
    return abs(float(np.median(heights)) - scene.floor_z_m), len(heights)


def measured_m(scene: Scene, photo: RgbdPhoto) -> Points:
    """The measured points above the floor."""
    depth_m = photo.depth_m
    points = unproject(depth_m, photo.intrinsics)[np.isfinite(depth_m) & (depth_m > _NEAREST_M)]
    points = points @ scene.radar_from_camera.T
    return points[points[:, 2] > scene.floor_z_m + _LOWEST_M]


def deepest_m(tree: Any, pose: PoseSequence, seat_m: Float[Array, "2"] | None) -> tuple[float, float]:
    """Depth of measured points inside the body beyond the tolerance: in trunk, legs and head, and in the arms.

    Near a seat, trunk and thighs may sink in.
    """
    worst = {"body": 0.0, "arms": 0.0}
    for capsule, points, radius in sampled(pose, _ALONG):
        allowed = np.full(len(points), ALLOWED_M)
        if seat_m is not None and capsule.start in _SINKS:
            allowed[np.hypot(*(points[:, :2] - seat_m).T) < _ON_SEAT_REACH_M] = ON_SEAT_M
        distance, _ = tree.query(points, distance_upper_bound=_FARTHEST_M)
        part = "arms" if any(word in capsule.start for word in _ARMS) else "body"
        worst[part] = max(worst[part], float((radius - distance - allowed).max()))
    return worst["body"], worst["arms"]


def _seat_of(motion: Motion) -> Float[Array, "2"] | None:
    """Where the pelvis is lowest, if the person sits."""
    if not any(step.lower in ("sit", "sit_down", "stand_up") for step in motion.plan.steps):
        return None
    pelvis = motion.pose.joints_m[:, joint("pelvis")]
    return np.asarray(pelvis[np.argmin(pelvis[:, 2]), :2], float)


def room_row(folder: Path) -> dict[str, Any]:
    """One room: its six sentences of the docs, ten seeds each."""
    from scipy.spatial import KDTree

    photo, assumptions = read_photo(folder / "rgb.png", folder / "depth.png", folder / "camera.json")
    scene = reconstruct(photo, assumptions=assumptions)
    marks = json.loads(MARKS.read_text(encoding="utf-8"))[folder.name][FLOOR_MARKS]
    error_m, num_marks = floor_error_m(scene, photo, marks)
    measured = measured_m(scene, photo)
    trees = {None: KDTree(measured)}  # and without each chair that is taken as pulled out
    clear, arms_clear, refused = [], [], 0
    for text in SENTENCES[folder.name]:
        for seed in SEEDS:
            try:
                motion = compose(plan_motion(text, SECONDS), scene, seed=seed, range_window_m=RANGE_WINDOW_M)
            except InputError:
                refused += 1
                continue
            chair = motion.chair
            if chair is not None and chair not in trees:
                trees[chair] = KDTree(measured[~chair.holds(measured, scene.floor_z_m)])
            body_m, arms_m = deepest_m(trees[chair], motion.pose, _seat_of(motion))
            clear.append(body_m <= 0)
            arms_clear.append(arms_m <= 0)
    floor_error = {"value": round(error_m, 4), "unit": "m", "version": 1, "of": num_marks,
             "definition": "found floor against the median height of places marked as floor by hand"}  # fmt: skip
    clearness = "no measured point 3 cm inside trunk, legs or head"
    return {
        "dataset": {"name": folder.name, "split": "all four rooms were used while placements were developed"},
        "n": len(clear), "seeds": list(SEEDS), "refused": refused,
        "metrics": {
            "floor_error_m": floor_error,
            "placements_clear": share_of("placements_clear", clear, clearness),
            "arms_clear": share_of("arms_clear", arms_clear, "the same of the arms"),
        },
    }  # fmt: skip


UNKNOWN = {
    "dataset.sha256": "photos are hashed in the manifest",
    "seconds": "see the manifest: all rows together",
}


def add_options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--rooms", type=Path, action=Reads, required=True, help="folder of the real rooms")


def run_study(options: argparse.Namespace, run: StudyRun) -> None:
    rows = [room_row(options.rooms / name) for name in SENTENCES]
    config = {"sentences": SENTENCES, "seconds": SECONDS, "range_window_m": list(RANGE_WINDOW_M)}
    run.write("real_placements", "depth", config=config, rows=complete_rows(rows, unknown=UNKNOWN))
