"""Does the radar see the person where the skeleton is? Sentences in photographed rooms, frame by frame.

python -m studies run real_rooms --rooms <folder of rooms>

A frame has motion where some joint moves faster than one Doppler bin towards or from the radar. It is correct if the
strongest moving range bin lies within the extent of the body. Baseline: a random bin of the range window.
"""

import argparse
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from mmweaver.core.errors import InputError
from mmweaver.signal.cube import remove_static
from mmweaver.signal.spectra import moving_doppler, range_doppler_power
from mmweaver.weaver.front_door import Weaver
from mmweaver.weaver.generation import Generation, Room
from studies.manifest import StudyRun
from studies.result_rows import complete_rows
from studies.study import Reads

SKIN_M = 0.2  # joints lie inside the body
SENTENCES = (
    "a person walks towards the radar, then waves with the left hand",
    "someone does jumping jacks",
    "user seated on couch drinking water",
    "a man boxes quickly",
    "the woman squats",
    "she raises her left hand",
    "he claps",
)
SEEDS = (0, 1, 2)
UNKNOWN = {
    "dataset.sha256": "photos are hashed in the manifest",
    "seconds": "see the manifest: all rows together",
}


@dataclass(frozen=True, kw_only=True)
class Agreement:
    """Frames with motion, how many of them are correct, and how many a random bin would get."""

    moving: int
    right: int
    by_chance: float


def agreement(result: Generation) -> Agreement:
    """Compares the range-Doppler track of a generation with its joints."""
    cube = remove_static(result.cube)
    power = range_doppler_power(cube)[:, :, moving_doppler(cube)].sum(axis=2)
    strongest_m = cube.grid.range_m[np.argmax(power, axis=1)]
    distance_m = np.linalg.norm(result.motion.joints_m, axis=-1)
    speed = np.abs(np.gradient(distance_m, result.motion.time_s, axis=0)).max(axis=1)
    at_frames = np.interp(cube.grid.frame_time_s, result.motion.time_s, speed)
    moving = at_frames > cube.config.velocity_resolution_mps
    joints_m = np.linalg.norm(result.pose.joints_m, axis=-1)
    low, high = joints_m.min(axis=1) - SKIN_M, joints_m.max(axis=1) + SKIN_M
    inside = (strongest_m > low) & (strongest_m < high)
    in_body = (cube.grid.range_m > low[:, None]) & (cube.grid.range_m < high[:, None])
    return Agreement(
        moving=int(moving.sum()), right=int(inside[moving].sum()), by_chance=float(in_body.mean(axis=1)[moving].sum())
    )


def room_row(name: str, weaver: Weaver, room: Room) -> dict[str, Any]:
    """All sentences and seeds in one room."""
    total, refused = [], 0
    for text in SENTENCES:
        for seed in SEEDS:
            try:
                total.append(agreement(weaver.generate(room, text, seed=seed, keep_adc=False, board="ideal")))
            except InputError:
                refused += 1
    frames = sum(one.moving for one in total)
    share = sum(one.right for one in total) / max(frames, 1)
    chance = sum(one.by_chance for one in total) / max(frames, 1)
    return {
        "dataset": {"name": name, "split": "no part of any fit", "sentences": list(SENTENCES)},
        "n": frames,
        "seeds": list(SEEDS),
        "sequences": len(total),
        "refused_for_lack_of_room": refused,
        "metrics": {
            "frames_with_person_in_place": {
                "value": round(share, 4),
                "unit": "share of frames with motion",
                "definition": "strongest moving range bin within the joints' extent and 0.2 m of skin",
                "version": 1,
                "baseline": {"random_bin": round(chance, 4)},
            }
        },
    }


def measure(run: StudyRun, folders: list[Path]) -> Path:
    """One row a room, the bundled sample first."""
    weaver = Weaver("physics")
    rows = [room_row("bundled sample", weaver, weaver.sample_room())]
    for folder in folders:
        room = weaver.read_room(folder / "rgb.png", folder / "depth.png", folder / "camera.json")
        rows.append(room_row(folder.name, weaver, room))
    rows = complete_rows(rows, unknown=UNKNOWN)
    return run.write("real_rooms", "physics", config={"radar": weaver.radar.name}, rows=rows)


def add_options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "--rooms",
        type=Path,
        action=Reads,
        default=None,
        help="folder of folders with rgb.png, depth.png, camera.json",
    )


def run_study(options: argparse.Namespace, run: StudyRun) -> None:
    folders = [] if options.rooms is None else sorted(options.rooms.iterdir())
    measure(run, [folder for folder in folders if (folder / "camera.json").is_file()])
