"""Are seats, tables, doors, windows and the floor found, and does nobody walk or sit inside furniture?

python -m studies run affordances --rooms /path/to/rooms

200 procedural rooms with noisy depth and known ground truth, of kinds on which no threshold was chosen (develop: the
other kinds, fewer rooms), from depth alone and with the true class mask; and the real rooms, whose ground truth was
annotated in their photos (real_rooms_truth.json).
"""

import argparse
import dataclasses
import functools
import json
import multiprocessing
import time
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from mmweaver.core.errors import InputError
from mmweaver.core.pinhole import project
from mmweaver.core.records import Landmark, Scene, Seat
from mmweaver.core.seeding import stream
from mmweaver.motion.compose import compose
from mmweaver.motion.language.timing import plan_motion
from mmweaver.scene.procedural.ground_truth import RadarFrame
from mmweaver.scene.procedural.lighting import LIGHTINGS
from mmweaver.scene.procedural.procedural_room import ProceduralRoom, make_room
from mmweaver.scene.read_photo import read_photo
from mmweaver.scene.reconstruction import reconstruct
from studies.manifest import StudyRun
from studies.result_rows import complete_rows
from studies.scene.room_contact import contact, signed_distance_m
from studies.study import Reads

DEVELOP = ("office", "living_room", "bedroom", "dining_room", "corridor", "workshop")
REPORT = ("kitchen", "lab", "library", "meeting_room", "classroom", "gym")
SENTENCES = (
    "a person walks to the left, then waves",
    "user seated on couch drinking water",
    "she walks, then sits down",
    "he does jumping jacks",
    "someone walks towards the radar, turns around and walks away",
    "a man boxes quickly",
)
RANGE_WINDOW_M, SECONDS = (0.70, 3.48), 3.0
METHODS = ("depth", "mask")
FIRST_SEED = 30000  # rooms used while placements were developed lie between 5000 and 25000
SEAT_M, SEAT_HEIGHT_M, MARK_M, FLOOR_M = 0.35, 0.08, 0.6, 0.03
_SEEN_SHARE = 0.3  # of a seat, for it to be findable
_ALIKE = {"counter": "table"}
REAL_TRUTH = Path(__file__).with_name("real_rooms_truth.json")


@dataclass
class Tally:
    """Counts of one group of rooms."""

    floor_error_m: list[float] = field(default_factory=list)
    seats: list[bool] = field(default_factory=list)  # of the findable: found?
    false_seats: list[bool] = field(default_factory=list)  # of the found: on nothing that one sits on?
    facing_error_rad: list[float] = field(default_factory=list)
    marks: dict[str, list[bool]] = field(default_factory=dict)  # by kind: of those in view, found?
    false_marks: dict[str, list[bool]] = field(default_factory=dict)
    clear: list[bool] = field(default_factory=list)  # placements without trunk, legs or head in anything
    arms_clear: list[bool] = field(default_factory=list)
    refused: int = 0
    sitters: int = 0
    stools: int = 0  # that were invented
    pulled: int = 0  # chairs taken as pulled out
    seconds: float = 0.0


# Procedural rooms ---------------------------------------------------------------------------------------------------
def measure_room(room: ProceduralRoom, tally: Tally, *, lighting: str, with_mask: bool, place: bool) -> None:
    """Adds the counts of one room."""
    photo = room.photo(lighting, noise=True)
    begin = time.process_time()
    scene = reconstruct(photo if with_mask else dataclasses.replace(photo, classes=None))
    tally.seconds += time.process_time() - begin
    measure_scene(room, scene, tally)
    if place:
        _measure_placements(room, scene, tally)


def measure_scene(room: ProceduralRoom, scene: Scene, tally: Tally) -> None:
    """What was found in a room compared with its ground truth."""
    tally.floor_error_m.append(abs(scene.floor_z_m - room.floor_z_m))
    for seat in room.seats:
        if not _is_findable(room, seat):
            continue
        near = [found for found in scene.seats if _is_same_seat(found, seat)]
        tally.seats.append(bool(near))
        if near:
            tally.facing_error_rad.append(abs(float(np.angle(np.exp(1j * (near[0].facing_rad - seat.facing_rad))))))
    for found in scene.seats:
        tally.false_seats.append(not _is_on_seat(room, found))
    _measure_marks(tally, scene.landmarks, room.landmarks, lambda mark: _is_in_view(room, mark))


def _is_same_seat(found: Seat, seat: Seat) -> bool:
    away = found.position_m - seat.position_m
    return bool(np.hypot(*away[:2]) < SEAT_M and abs(away[2]) < SEAT_HEIGHT_M)


def _is_on_seat(room: ProceduralRoom, found: Seat) -> bool:
    """Whether a place is on a seat, at the height of its surface."""
    piece = np.array(room.boxes.piece)
    distance = signed_distance_m(room.boxes, found.position_m[None])[0]
    frame = RadarFrame(room.shell)
    for number, item in enumerate(room.pieces):
        if not item.piece.seats or distance[piece == number].min() > 0.1:
            continue
        heights = [frame.points(np.array([0.0, 0.0, seat.height_m]))[2] for seat in item.piece.seats]
        if min(abs(height - found.position_m[2]) for height in heights) < SEAT_HEIGHT_M:
            return True
    return False


def _is_findable(room: ProceduralRoom, seat: Seat) -> bool:
    """In the picture and the range window, with enough of its surface visible."""
    if np.hypot(*seat.position_m[:2]) > RANGE_WINDOW_M[1]:
        return False
    offset = np.array([(a, b) for a in (-0.3, 0.0, 0.3) for b in (-0.3, 0.0, 0.3)])
    ahead = np.array([np.cos(seat.facing_rad), np.sin(seat.facing_rad)])
    sideways = np.array([-ahead[1], ahead[0]])
    places = seat.position_m[:2] + seat.size_m[1] * offset[:, :1] * ahead + seat.size_m[0] * offset[:, 1:] * sideways
    points = np.column_stack([places, np.full(9, seat.position_m[2] + 0.03)])
    return float(_is_seen(room, points).mean()) >= _SEEN_SHARE


def _is_seen(room: ProceduralRoom, points: np.ndarray) -> np.ndarray:
    pixels, depth_m = project(points @ room.radar_from_camera, room.intrinsics)
    column, row = pixels.T
    width, height = room.intrinsics.width, room.intrinsics.height
    inside = (depth_m > 0.3) & (column > 0) & (column < width - 1) & (row > 0) & (row < height - 1)
    surface_m = room.true_depth_m[np.where(inside, row, 0).astype(int), np.where(inside, column, 0).astype(int)]
    return inside & (surface_m > depth_m - 0.06)


def _is_in_view(room: ProceduralRoom, mark: Landmark) -> bool:
    """Its middle within the width of the picture, and near enough to walk to."""
    pixel, depth_m = project(mark.position_m @ room.radar_from_camera, room.intrinsics)
    in_width = 20 < pixel[0] < room.intrinsics.width - 20
    return bool(depth_m > 0.3 and in_width and np.hypot(*mark.position_m[:2]) < 4.0)


def _measure_marks(
    tally: Tally,
    found: tuple[Landmark, ...],
    truth: tuple[Landmark, ...],
    counts: Callable[[Landmark], bool],
) -> None:
    for mark in truth:
        if counts(mark):
            kind = _ALIKE.get(mark.kind, mark.kind)
            tally.marks.setdefault(kind, []).append(any(_is_same_mark(other, mark, MARK_M) for other in found))
    for other in found:
        kind = _ALIKE.get(other.kind, other.kind)
        right = any(_is_same_mark(other, mark, MARK_M + 0.4) for mark in truth)
        tally.false_marks.setdefault(kind, []).append(not right)


def _is_same_mark(found: Landmark, truth: Landmark, within_m: float) -> bool:
    same_kind = _ALIKE.get(found.kind, found.kind) == _ALIKE.get(truth.kind, truth.kind)
    return same_kind and bool(np.hypot(*(found.position_m - truth.position_m)[:2]) < within_m)


def _measure_placements(room: ProceduralRoom, scene: Scene, tally: Tally) -> None:
    for seed, text in enumerate(SENTENCES):
        try:
            motion = compose(plan_motion(text, SECONDS), scene, seed=seed, range_window_m=RANGE_WINDOW_M)
        except InputError:
            tally.refused += 1
            continue
        seated = any(step.lower in ("sit", "sit_down", "stand_up") for step in motion.plan.steps)
        pelvis = motion.pose.joints_m[:, 0]
        lowest = pelvis[np.argmin(pelvis[:, 2])] - np.array([0.0, 0.0, 0.1])
        if motion.chair is not None:  # taken as pulled out: what stood where it was is gone
            lowest = np.array([*motion.chair.place_m, lowest[2]])
            tally.pulled += 1
        met = contact(room, motion.pose, lowest if seated else None, is_moved=motion.chair is not None)
        tally.stools += any(" stool " in note for note in motion.assumptions)
        tally.sitters += seated
        tally.clear.append(met.body_m <= 0)
        tally.arms_clear.append(met.arms_m <= 0)


def procedural_row(
    kinds: tuple[str, ...], number: int, split: str, *, with_mask: bool, place: bool, workers: int = 1
) -> dict[str, Any]:
    """The row of `number` rooms, each kind in turn, with another layout and seed; independent of the number of
    processes."""
    tally = Tally()
    by_kind: dict[str, Tally] = {}
    one_room = functools.partial(_one_room, kinds=kinds, with_mask=with_mask, place=place)
    if workers > 1:
        with ProcessPoolExecutor(workers, mp_context=multiprocessing.get_context("spawn")) as pool:
            parts = list(pool.map(one_room, range(number)))
    else:
        parts = [one_room(index) for index in range(number)]
    for index, one in enumerate(parts):
        for total in (tally, by_kind.setdefault(kinds[index % len(kinds)], Tally())):
            _add(total, one)
    row = _row(f"procedural, {split}", f"kinds {', '.join(kinds)}", number, tally)
    row["dataset"]["input"] = "depth with noise and true class mask" if with_mask else "colour and depth with noise"
    row["by_kind"] = {kind: _shares(part) for kind, part in by_kind.items()}
    return row


def _one_room(index: int, *, kinds: tuple[str, ...], with_mask: bool, place: bool) -> Tally:
    kind, tally = kinds[index % len(kinds)], Tally()
    room = make_room(kind, layout=index // len(kinds) % 10, seed=FIRST_SEED + index)
    measure_room(room, tally, lighting=tuple(LIGHTINGS)[index % 4], with_mask=with_mask, place=place)
    return tally


def _add(total: Tally, one: Tally) -> None:
    for name in ("floor_error_m", "seats", "false_seats", "facing_error_rad", "clear", "arms_clear"):
        getattr(total, name).extend(getattr(one, name))
    for name in ("marks", "false_marks"):
        for kind, values in getattr(one, name).items():
            getattr(total, name).setdefault(kind, []).extend(values)
    for name in ("refused", "sitters", "stools", "pulled"):
        setattr(total, name, getattr(total, name) + getattr(one, name))
    total.seconds += one.seconds


def _shares(tally: Tally) -> dict[str, Any]:
    return {
        "seats_found": [sum(tally.seats), len(tally.seats)],
        "false_seats": [sum(tally.false_seats), len(tally.false_seats)],
        "placements_clear": [sum(tally.clear), len(tally.clear)],
    }


# Real rooms -----------------------------------------------------------------------------------------------------------
def real_row(folder: Path) -> dict[str, Any]:
    """One photographed room compared with the annotation of its photo."""
    truth = json.loads(REAL_TRUTH.read_text(encoding="utf-8"))[folder.name]
    photo, assumptions = read_photo(folder / "rgb.png", folder / "depth.png", folder / "camera.json")
    tally = Tally()
    begin = time.process_time()
    scene = reconstruct(photo, assumptions=assumptions)
    tally.seconds = time.process_time() - begin
    places = [np.array(seat) for seat in truth["seats"]]
    for place in places:
        tally.seats.append(any(np.hypot(*(found.position_m[:2] - place)) < SEAT_M + 0.1 for found in scene.seats))
    areas = [np.array(place) for place in (*truth["seats"], *truth["also_seats"])]
    for found in scene.seats:
        tally.false_seats.append(min(np.hypot(*(found.position_m[:2] - place)) for place in areas) > SEAT_M + 0.25)
    marks = tuple(
        Landmark(kind=kind, position_m=np.array([x, y, 0.0]), approach_m=(float(x), float(y)), facing_rad=0.0)
        for kind, x, y in truth["landmarks"]
    )
    _measure_marks(tally, scene.landmarks, marks, lambda mark: True)
    return _row(folder.name, "annotated by eye in the photo", 1, tally)


UNKNOWN = {"dataset.sha256": "rendered anew in every run; photos are hashed in the manifest"}


# Rows -----------------------------------------------------------------------------------------------------------------
def _row(name: str, split: str, number: int, tally: Tally) -> dict[str, Any]:
    floor = np.array(tally.floor_error_m)
    metrics: dict[str, Any] = {}
    if len(floor):
        metrics["floor_error_median_m"] = _metric(float(np.median(floor)), "m", "error of the floor's height, median")
        metrics["floor_error_p95_m"] = _metric(float(np.percentile(floor, 95)), "m", "the same, 95th percentile")
        metrics["floor_within_3_cm"] = _metric(float((floor <= FLOOR_M).mean()), "share of rooms", "at most 3 cm")
    _add_share(metrics, "seats_found", tally.seats, "of the seats in view, those found within 0.35 m and 8 cm")
    _add_share(metrics, "false_seats", tally.false_seats, "of the seats found, those on no seat")
    if tally.facing_error_rad:
        degrees = float(np.rad2deg(np.median(tally.facing_error_rad)))
        metrics["facing_error_median_deg"] = _metric(degrees, "degrees", "of the seats found, median")
    for kind in sorted({*tally.marks, *tally.false_marks}):
        _add_share(metrics, f"{kind}_found", tally.marks.get(kind, []), f"of each {kind} in view, found within 0.6 m")
        _add_share(metrics, f"{kind}_false", tally.false_marks.get(kind, []), f"of each {kind} found, none is there")
    _add_share(metrics, "placements_clear", tally.clear, "trunk, legs and head nowhere 3 cm inside furniture or walls")
    _add_share(metrics, "arms_clear", tally.arms_clear, "the same of the arms")
    return {
        "dataset": {"name": name, "split": split}, "n": number, "seeds": [FIRST_SEED], "refused": tally.refused,
        "sitters": tally.sitters, "stools": tally.stools, "pulled_out": tally.pulled,
        "seconds": {"reconstruct_cpu": round(tally.seconds / number, 3)}, "metrics": metrics,
    }  # fmt: skip


def _metric(value: float, unit: str, definition: str) -> dict[str, Any]:
    return {"value": round(value, 4), "unit": unit, "definition": definition, "version": 1}


def _add_share(metrics: dict[str, Any], name: str, values: list[bool], definition: str) -> None:
    metric = share_of(name, values, definition)
    if metric:
        metrics[name] = metric


def share_of(name: str, values: list[bool], definition: str) -> dict[str, Any]:
    """A share with its bootstrap interval over the counted items; empty where there are none."""
    if not values:
        return {}
    counted = np.array(values, float)
    draws = stream(0, "affordances", name).integers(len(counted), size=(1000, len(counted)))
    low, high = np.percentile(counted[draws].mean(axis=1), [2.5, 97.5])
    metric = _metric(float(counted.mean()), "share", definition)
    return {**metric, "of": len(values), "interval_95": [round(float(low), 4), round(float(high), 4)]}


def measure(
    run: StudyRun, folders: list[Path], number: int, methods: tuple[str, ...] = METHODS, workers: int = 1
) -> list[Path]:
    """Writes a result each: depth alone (with the real rooms and placements), and with the true mask."""
    written = []
    for method in methods:
        with_mask = method == "mask"
        rows = [
            procedural_row(REPORT, number, "report", with_mask=with_mask, place=not with_mask, workers=workers),
            procedural_row(
                DEVELOP, max(number // 4, 1), "develop", with_mask=with_mask, place=not with_mask, workers=workers
            ),
        ]
        rows += [] if with_mask else [real_row(folder) for folder in folders]
        config = {"sentences": list(SENTENCES), "seconds": SECONDS, "range_window_m": list(RANGE_WINDOW_M)}
        written.append(run.write("affordances", method, config=config, rows=complete_rows(rows, unknown=UNKNOWN)))
    return written


def add_options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--rooms", type=Path, action=Reads, default=None, help="folder of the real rooms")
    parser.add_argument("--number", type=int, default=200, help="how many rooms to report on")
    parser.add_argument("--workers", type=int, default=1, help="processes")
    parser.add_argument("--methods", nargs="*", choices=METHODS, default=METHODS)


def run_study(options: argparse.Namespace, run: StudyRun) -> None:
    folders = [] if options.rooms is None else sorted(options.rooms.iterdir())
    measure(
        run,
        [folder for folder in folders if (folder / "camera.json").is_file()],
        options.number,
        tuple(options.methods),
        options.workers,
    )
