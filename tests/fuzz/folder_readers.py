"""Readers of what is brought for a room, a board or a recogniser: scans, bags, views, boards, tasks, models."""

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from PIL import Image

from mmweaver.core.board import read_board
from mmweaver.core.boards import PRESETS, typical_board
from mmweaver.recognition.point_recordings import read_task_recordings
from mmweaver.recognition.recogniser import load_recogniser, save_recogniser
from mmweaver.recognition.task_file import read_task
from mmweaver.scene.multiview.view_file import read_views
from mmweaver.scene.realsense_bag import read_bag_photo
from mmweaver.scene.scan_folders import read_scan_photo
from tests.fuzz import mutators as m
from tests.fuzz.harness import Reader, wrong_numbers
from tests.fuzz.set_readers import members_reader
from tests.recognition.small_recogniser import drawn_sequences, small_recogniser, write_recordings
from tests.scene.multiview.test_view_file import AHEAD, IDENTITY
from tests.scene.test_realsense_bag import DRIVER, write_bag
from tests.scene.test_scan_folders import polycam, record3d, scannet, stray, tum

TASK = """radar = "iwr1443_mars"
window_s = 1.0
[activities]
waving = ["a person waves with the left hand"]
walking = "a person walks around"
[recordings]
frame_rate_hz = 10.0
columns = ["x_right", "y_ahead", "z_up", "velocity"]
[mount]
height_m = 1.2
"""
SCANS: dict[str, Callable[[Path], None]] = {
    "Stray Scanner": stray, "Record3D": record3d, "Polycam": polycam, "ScanNet": scannet, "TUM RGB-D": tum,
}  # fmt: skip


def folder_readers(folder: Path) -> list[Reader]:
    """All of them, with sound files made in `folder`."""
    return [*_scans(folder), _views(folder), _bag(folder), _board(folder), *_recognition(folder)]


def _depth(found: Any) -> str | None:
    depth_m = found.photo.depth_m
    return wrong_numbers(depth_m[~np.isnan(depth_m)])


def _scans(folder: Path) -> list[Reader]:
    found = []
    for name, write in SCANS.items():
        place = folder / name.replace(" ", "_")
        write(place)
        found.append(members_reader(f"scan of {name}", place, read_scan_photo, _depth))
    return found


def _views(folder: Path) -> Reader:
    place, rng = folder / "views", np.random.default_rng(7)
    place.mkdir()
    Image.fromarray(rng.integers(0, 255, (48, 64, 3), dtype=np.uint8)).save(place / "a.png")
    np.save(place / "a.npy", rng.uniform(1, 3, (48, 64)))
    entries = [{"pose": AHEAD}, {"pose": IDENTITY}, {"place_m": [1, 2], "turned_deg": 90}]
    photos = [{"rgb": "a.png", "depth": "a.npy", **entry} for entry in entries]
    (place / "views.json").write_text(json.dumps({"photos": photos}))
    return members_reader("views", place, lambda data: read_views(data / "views.json"), _depth)


def _bag(folder: Path) -> Reader:
    write_bag(folder / "room.bag", DRIVER)
    sound = (folder / "room.bag").read_bytes()
    return Reader(
        name="ROS bag",
        suffix=".bag",
        read=lambda path: read_bag_photo(path, 1),
        wrong=_depth,
        damaged=lambda rng: m.mutated_bytes(sound, rng),
    )


def _board(folder: Path) -> Reader:
    typical_board(PRESETS["awr1843"], 3).save(folder / "board.json")
    sound = json.loads((folder / "board.json").read_text())
    return Reader(
        name="board.json",
        suffix=".json",
        read=read_board,
        wrong=lambda board: wrong_numbers(np.asarray(board.leakage_level_db)),
        damaged=lambda rng: m.json_bytes(m.mutated_json(sound, rng), rng),
    )


def _recognition(folder: Path) -> list[Reader]:
    task, model, recordings = folder / "task.toml", folder / "model", folder / "recordings"
    task.write_text(TASK)
    save_recogniser(model, small_recogniser(task))
    (model / "SHA256SUMS").unlink(missing_ok=True)
    settings = read_task(task).recordings
    write_recordings(recordings, drawn_sequences(settings, people=1))
    return [
        Reader(
            name="task file",
            suffix=".toml",
            read=read_task,
            damaged=lambda rng: m.mutated_text(TASK, rng).encode("utf-8", "surrogatepass"),
        ),
        members_reader("recogniser", model, load_recogniser, lambda _: None),
        members_reader("labelled recordings", recordings, lambda data: read_task_recordings(data, settings), _windows),
    ]


def _windows(recordings: Any) -> str | None:
    return next((problem for one in recordings if (problem := wrong_numbers(one.cloud.x_m))), None)
