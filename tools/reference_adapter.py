"""The one file of the references that names modules of mmweaver and of the studies: a rename changes it alone.

What is frozen is described in its terms: `steps_of` turns the parser's plan into plain records, so that the steps of
string-typed and of typed records compare.
"""

import json
import os
import re
import subprocess
import sys
from collections.abc import Iterator
from dataclasses import asdict, fields
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np

from mmweaver import PRESETS as PRESETS
from mmweaver import InputError as InputError
from mmweaver import RadarCube, RadarPose, Weaver
from mmweaver import read_radar_npz as read_radar_npz
from mmweaver.compression.lossless_file import LosslessFile, compress_bin
from mmweaver.compression.mmw_codec import compress_cube, errors_db, values_of_bytes
from mmweaver.compression.mmw_codec import read_cube as read_mmw
from mmweaver.models.methods import Learned, Physics
from mmweaver.motion.language.plan import MotionPlan, Step
from mmweaver.motion.language.sentence import parse
from mmweaver.motion.language.timing import natural_s
from mmweaver.propagation.static_paths import Propagation

# name of a projected field -> name of today's; what only schedules, quotes or personalizes a step is left out
PROJECTION = {
    "body": "lower", "hands": "upper", "hand": "hand", "foot": "foot", "way": "direction", "bend_deg": "arc_deg",
    "turn_deg": "turn_deg", "style": "style", "speed": "speed", "count": "count", "seat": "seat", "target": "target",
    "place": "place", "distance_m": "distance_m", "route_m": "route_m", "facing": "facing", "seconds": "seconds",
}  # fmt: skip


def projected(step: Step) -> dict[str, Any]:
    """A step by what it shows; empty fields are left out, numbers are rounded to 3 digits.

    body, hands: what the body and the hands do at the same time (two hands that differ: other_hand); hand, foot: the
    side of the limb; way: left, right, towards, away, ... of the body; bend_deg, turn_deg: of the path and of a turn;
    style: back, front, bent, ahead, knee; speed: -1, 1; count: repetitions; seat, target, place, facing: what is gone
    to, sat on, looked at; distance_m, route_m, seconds: as the sentence gives them.
    """
    found = {name: _plain(getattr(step, today)) for name, today in PROJECTION.items()}
    found["style"] = step.style or "either" * step.either_side or "several" * step.several
    found["other_hand"] = None if step.other_hand is None else projected(step.other_hand)
    return {name: value for name, value in found.items() if value}


def _plain(value: Any) -> Any:
    if isinstance(value, float):
        return round(value, 3)
    if isinstance(value, list | tuple):
        return [_plain(one) for one in value]
    return value if value is None or isinstance(value, str | int) else json.loads(json.dumps(asdict(value)))


def steps_of(text: str) -> dict[str, Any]:
    """How a sentence is read: the projected steps, all their fields, records of clauses, notes, the person, seconds.

    `read` is "whole", "in part" (only where clauses may be left out), or "refused" with the message.
    """
    try:
        plan = parse(text, in_part=True)
    except InputError as error:
        return {"read": "refused", "steps": [], "message": str(error)}
    return {
        "read": "whole" if _is_read_whole(text) else "in part",
        "steps": [projected(step) for step in plan.steps],
        "fields": [_told(step) for step in plan.steps],
        "clauses": [asdict(one) for one in plan.clauses],
        "notes": list(plan.notes),
        "person": {name: value for name, value in asdict(plan.person).items() if value},
        "seconds": _natural_s(plan),
    }


def _is_read_whole(text: str) -> bool:
    try:
        parse(text)
    except InputError:
        return False
    return True


def _natural_s(plan: MotionPlan) -> float | None:
    try:
        return round(natural_s(plan), 3)
    except InputError:
        return None


def _told(step: Step) -> dict[str, Any]:
    """All fields of a step that differ from their defaults."""
    usual = Step()
    of = {
        one.name: getattr(step, one.name) for one in fields(Step) if getattr(step, one.name) != getattr(usual, one.name)
    }
    return {name: _told(value) if isinstance(value, Step) else _plain(value) for name, value in of.items()}


def kitml_sentences(data: Path) -> list[str]:
    from studies.motion.kitml import sentences_of

    return [one.text for one in sentences_of(data / "motion" / "kitml_text" / "kitml_annotations.json")]


# signals ------------------------------------------------------------------------------------------------------------
@cache
def weaver(method: str, radar: str = "awr1843", **options: Any) -> Weaver:
    if options.pop("bounces", 2) == 1 and options.pop("clutter", "") == "resolved":
        propagation = Propagation(bounces=1, clutter=False)
        return Weaver(Physics(propagation) if method == "physics" else Learned(None, propagation), radar, **options)
    return Weaver(method, radar, **options)


def command(*words: object) -> str:
    """What a command prints. Raises RuntimeError with its message where it fails."""
    done = subprocess.run(
        [sys.executable, "-m", "mmweaver", *map(str, words)], capture_output=True, text=True, env=dict(os.environ),
        check=False,
    )  # fmt: skip
    if done.returncode:
        raise RuntimeError(f"mmweaver {' '.join(map(str, words))}: {done.stderr.strip()}")
    return done.stdout


def another_place() -> RadarPose:
    return RadarPose(x_m=0.4, y_m=0.2, z_m=0.3, yaw_deg=-20.0, pitch_deg=-5.0)


def motion_clip(data: Path) -> Any:
    return Weaver.read_motion(data / "motion" / "humanml3d_sample" / "HumanML3D_new_joints_012314.npy", fps=20)


# compression --------------------------------------------------------------------------------------------------------
def encoded(cube: RadarCube, **how: Any) -> bytes:
    return compress_cube(cube, **how)


def decoding_errors(data: bytes, cube: RadarCube) -> dict[str, float]:
    return errors_db(values_of_bytes(data), cube)


def decoded(path: Path) -> np.ndarray:
    """The values of a .mmw file."""
    return read_mmw(path).values


def encoded_samples(path: Path, out: Path, preset: str, max_error: int) -> None:
    compress_bin(path, out, PRESETS[preset], max_error=max_error)


def decoded_samples(path: Path, out: Path) -> None:
    LosslessFile(path).decompress(out)


# placements ---------------------------------------------------------------------------------------------------------
def placements(index: int) -> dict[str, Any]:
    """Counts of one procedural room of the kinds that placements were developed on: [of them so, counted]."""
    from studies.scene.affordances import DEVELOP, FIRST_SEED, LIGHTINGS, Tally, make_room, measure_room

    tally = Tally()
    room = make_room(DEVELOP[index % len(DEVELOP)], layout=index // len(DEVELOP) % 10, seed=FIRST_SEED + index)
    measure_room(room, tally, lighting=tuple(LIGHTINGS)[index % 4], with_mask=False, place=True)
    counts = {name: getattr(tally, name) for name in ("clear", "arms_clear", "seats", "false_seats")}
    return {name: [sum(values), len(values)] for name, values in counts.items()} | {
        "refused": tally.refused, "stools": tally.stools, "sitters": tally.sitters,
        "floor_error_m": round(float(tally.floor_error_m[0]), 6),
    }  # fmt: skip


# RadHAR -------------------------------------------------------------------------------------------------------------
def score_of_shipped(data: Path) -> dict[str, Any]:
    """The shipped recogniser on the half of RadHAR's recordings that its method was developed on."""
    from mmweaver.recognition.point_recordings import read_task_recordings
    from mmweaver.recognition.recogniser import load_recogniser
    from mmweaver.recognition.scoring import score_recordings

    model = load_recogniser(Path(__file__).resolve().parents[1] / "weights" / "recogniser_radhar")
    recordings = read_task_recordings(data / "pointclouds" / "radhar", model.settings)
    developed = [one for one in recordings if re.search(r"[a-z]_20_\d+$", one.name)]
    window = score_recordings(model, developed)["window"]
    return {name: window[name] for name in ("balanced_accuracy", "interval_95", "n")}


# files of before ----------------------------------------------------------------------------------------------------
def arrays_in(folder: Path) -> Iterator[tuple[str, np.ndarray]]:
    """The arrays of all Zarr groups in a folder, by path."""
    import zarr

    for marker in sorted({*folder.rglob(".zarray"), *folder.rglob("zarr.json")}):
        node = zarr.open(str(marker.parent), mode="r")
        if isinstance(node, zarr.Array):
            yield str(marker.parent.relative_to(folder)), np.asarray(node[...])


def recognised(model: Path, points: Path) -> str:
    """The labels that a stored recogniser gives to a recording."""
    return command("recognise", "run", model, "--points", points, "--json")


def weights_digestible(path: Path) -> list[tuple[str, np.ndarray]]:
    """The tensors of a weight file, and that its card is read."""
    from safetensors.numpy import load_file

    from mmweaver.models.weights import read_card

    read_card(path)
    return sorted(load_file(path).items())
