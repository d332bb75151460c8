"""How many promises of sentences the joints keep: python tools/promises.py [--rooms demo,corridor,...] [--seeds 3]

Every sentence of promises.toml is acted out in every room with every seed, as `mmweaver generate` would, and measured
on its joints by joint_measures.py, which shares no code with the generator. A run is

    kept       every measure is within its tolerance
    reported   one is not, and the record of the sentence reports a deviation or the sentence is refused
    silent     one is not, and the record says that all is done
"""

import argparse
import json
import time
import tomllib
from collections import Counter
from pathlib import Path
from typing import Any

import joint_measures
import numpy as np

from mmweaver import InputError, Weaver
from mmweaver.weaver.composition import widened

HERE = Path(__file__).parent
TOLERANCES = {  # share, and at least; the closing step may count, and a fall has no exact direction
    "steps": (0.0, 1.0),
    "fall_deg": (0.0, 30.0),
    "_mps": (0.15, 0.0),
    "_spm": (0.15, 0.0),
    "_m": (0.10, 0.10),
    "_deg": (0.0, 10.0),
    "_s": (0.10, 0.10),
}
WIDTH_M, LENGTH_M, HEIGHT_M, CAMERA_M = 1.5, 3.0, 2.5, 1.1  # of the bare corridor, seen from its end
SEAT_WORDS = ("chair", "couch", "seat")


def within(measure: str, value: float, wanted: Any) -> bool:
    """Whether a measured value is what is promised: a bound, an angle either way, or a number with its tolerance."""
    if isinstance(wanted, str):
        if wanted[0] in "<>":
            return value < float(wanted[1:]) if wanted[0] == "<" else value > float(wanted[1:])
        value, wanted = abs(value), float(wanted)
    relative, absolute = next((pair for end, pair in TOLERANCES.items() if measure.endswith(end)), (0.0, 0.0))
    return abs(value - wanted) <= max(relative * abs(wanted), absolute) + 1e-6


def corridor_photo(folder: Path) -> Path:
    """A bare corridor, seen from its middle at the near end, as a photo with depth."""
    from PIL import Image

    width, height, focal = 640, 480, 390.0
    u, v = np.meshgrid(np.arange(width), np.arange(height))
    rays = np.stack([(u - 319.5) / focal, np.ones(u.shape), -(v - 239.5) / focal], axis=-1)
    with np.errstate(divide="ignore"):
        reach = np.stack([
            WIDTH_M / 2 / np.abs(rays[..., 0]), np.full(u.shape, LENGTH_M),
            np.where(rays[..., 2] < 0, CAMERA_M / -rays[..., 2], (HEIGHT_M - CAMERA_M) / rays[..., 2]),
        ])  # fmt: skip
    depth_m, surface = reach.min(axis=0), reach.argmin(axis=0)
    grey = np.array([200, 180, 120], np.uint8)[surface]
    folder.mkdir(parents=True, exist_ok=True)
    Image.fromarray(np.repeat(grey[..., None], 3, axis=-1)).save(folder / "rgb.png")
    Image.fromarray(np.round(1000 * depth_m).astype(np.uint16)).save(folder / "depth.png")
    camera = {"fx": focal, "fy": focal, "cx": 319.5, "cy": 239.5}
    (folder / "camera.json").write_text(json.dumps(camera), encoding="utf-8")
    return folder


def room_of(name: str, weaver: Weaver, scratch: Path, data: Path) -> Any:
    """The bundled room, the bare corridor, or a photographed room of the real data."""
    if name == "demo":
        return weaver.sample_room()
    return weaver.open_room(corridor_photo(scratch / "corridor") if name == "corridor" else data / "rooms" / name)


def things(scene: Any) -> dict[str, list[tuple[float, float]]]:
    """Where the things of a room are: (x, y) of each, by kind."""
    found: dict[str, list[tuple[float, float]]] = {}
    for mark in scene.landmarks:
        found.setdefault(mark.kind, []).append((float(mark.position_m[0]), float(mark.position_m[1])))
    for seat in scene.seats:
        for kind in SEAT_WORDS:
            found.setdefault(kind, []).append((float(seat.position_m[0]), float(seat.position_m[1])))
    return found


def measured(take: joint_measures.Take, checks: list[list[Any]]) -> list[tuple[str, float, Any]]:
    """Each measure with its value and what is promised; nan for a thing that the room does not have."""
    found = []
    for name, *rest in checks:
        try:
            value = float(getattr(joint_measures, name)(take, *rest[:-1]))
        except KeyError:
            value = float("nan")
        found.append((" ".join([name, *rest[:-1]]), value, rest[-1]))
    return found


def outcome(text: str, checks: list[list[Any]], room: Any, weaver: Weaver, seed: int) -> dict[str, Any]:
    """What came of one sentence in one room with one seed."""
    began = time.process_time()
    try:
        request, (motion,) = widened(weaver.request(text, seed=seed), room.scene)
    except InputError as error:
        return {"outcome": "reported", "why": f"refused: {error}", "cpu_s": time.process_time() - began}
    cpu_s = time.process_time() - began
    scene = getattr(motion, "scene", None) or room.scene
    inside = (motion.pose.time_s >= 0) & (motion.pose.time_s <= request.duration_s + 1e-9)
    take = joint_measures.Take(motion.pose.time_s[inside], motion.pose.joints_m[inside], scene.floor_z_m, things(scene))
    values = measured(take, checks)
    is_kept = all(within(name.split()[0], value, wanted) for name, value, wanted in values)
    statuses = [clause.status for clause in motion.clauses]
    is_said = any(status != "done" for status in statuses)
    return {
        "outcome": "kept" if is_kept else "reported" if is_said else "silent",
        "values": [(name, round(value, 3), wanted) for name, value, wanted in values],
        "records": [clause.sentence for clause in motion.clauses if clause.status != "done"],
        "done": not is_said,
        "sole_m": round(joint_measures.worst_sole_m(take), 4),
        "cpu_s": cpu_s,
    }


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--rooms", default="demo,corridor,kinect2_living_room")
    parser.add_argument("--seeds", type=int, default=3)
    parser.add_argument("--data", type=Path, default=HERE.parent.parent / "shared" / "data")
    parser.add_argument("--only", default="", help="part of the sentence, or its group")
    parser.add_argument("--out", type=Path, default=Path("build/promises.json"))
    parser.add_argument("--verbose", action="store_true", help="print every run that is not kept")
    asked = parser.parse_args()
    table = tomllib.loads((HERE / "promises.toml").read_text(encoding="utf-8"))
    weaver, runs = Weaver("physics"), []
    for name in asked.rooms.split(","):
        room = room_of(name, weaver, asked.out.parent, asked.data)
        for group, sentences in table.items():
            for text, checks in sentences.items():
                if asked.only and asked.only not in text and asked.only != group:
                    continue
                for seed in range(asked.seeds):
                    found = outcome(text, checks, room, weaver, seed)
                    runs.append({"room": name, "group": group, "text": text, "seed": seed, **found})
                    if asked.verbose and found["outcome"] != "kept":
                        print(f"{found['outcome']:9}{name:10} {seed} {text}: {found.get('values', '')}"
                              f" {found.get('records') or found.get('why', '')}")  # fmt: skip
    asked.out.parent.mkdir(parents=True, exist_ok=True)
    asked.out.write_text(json.dumps(runs, indent=1) + "\n", encoding="utf-8")
    for key in ("group", "room"):
        for value in dict.fromkeys(run[key] for run in runs):
            print(f"{value:22}", dict(Counter(run["outcome"] for run in runs if run[key] == value)))
    total, seconds = Counter(run["outcome"] for run in runs), [run["cpu_s"] for run in runs]
    cautious = sum(run["outcome"] == "kept" and not run["done"] for run in runs)
    print(f"{len(runs)} runs: {dict(total)}; {100 * total['kept'] / len(runs):.1f} % kept, {cautious} of them reported")
    soles = [run["sole_m"] for run in runs if "sole_m" in run]
    print(f"CPU seconds: median {np.median(seconds):.3f}, slowest {max(seconds):.3f}; sole at worst {min(soles):.3f} m")


if __name__ == "__main__":
    main()
