r"""What do several photos of a room, or a scan of it, add to one photo?

    mmweaver dataset rooms/ --rooms "office,living_room,classroom,workshop" --layouts 6 --sequences 2 \
        --board ideal --geometry-only
    python -m studies run whole_room --data rooms/

Rooms of kinds that the network never saw, one sequence each, exact joints; ground truth is the simulator in the true
room, as in `learned_scores`. *four photos*: the photo at the radar and three more by the same depth camera, whose poses
have the errors of a phone's tracking (POSE_ERROR). *scan*: a mesh of the true room, written to a GLB with a name for
each class of object, read back as any user's, with the radar's place and direction given. *rough poses*: of the further
photos only the place to 10 cm and the turn to 5 degrees are said.
Intervals: bootstrap over rooms.
"""

import argparse
import tempfile
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from mmweaver.core.radar_pose import RadarPose
from mmweaver.core.records import Scene
from mmweaver.core.seeding import stream
from mmweaver.datasets.dataset_store import read_plan, read_rooms
from mmweaver.models.neural_path_solver import LearnedRoom
from mmweaver.models.scatterer_network import WeaverNetwork
from mmweaver.models.weights import load_weights, shipped_weights
from mmweaver.scene.photo.posed_photo import PosedPhoto
from mmweaver.scene.procedural.procedural_room import ProceduralRoom, make_room
from mmweaver.scene.reconstruction import reconstruct
from mmweaver.scene.scanned_mesh.mesh_photo import read_mesh_photo
from studies.manifest import StudyRun
from studies.network.learned_scores import (
    BASELINES,
    ORACLES,
    OTHER,
    Case,
    Method,
    _row,
    cases_of,
    generic_scene_of,
    scored,
    simulated,
)
from studies.network.room_cache import RoomCache, digest
from studies.result_rows import complete_rows, dataset_of
from studies.study import Reads

POSE_ERROR = (0.01, 0.3)  # metres and degrees, standard deviations
ROUGH_ERROR = (0.10, 5.0)
EYE_ABOVE_FLOOR_M, PITCH_DEG = 1.5, -15.0
SPLIT = "test_room"


def stands(room: ProceduralRoom, number: int = 3) -> list[RadarPose]:
    """Where one would take further photos: free places far from the radar and each other, looking to the middle."""
    free = room.free_space
    y, x = np.nonzero(free.is_free)
    places = np.column_stack([free.x_m[x], free.y_m[y]])
    middle, chosen = places.mean(axis=0), [np.zeros(2)]
    for _ in range(number):
        away = np.min([np.linalg.norm(places - one, axis=1) for one in chosen], axis=0)
        chosen.append(places[int(np.argmax(away))])
    found = []
    for place in chosen[1:]:
        yaw = np.degrees(np.arctan2(*(middle - place)))
        found.append(
            RadarPose(
                x_m=float(place[0]), y_m=float(place[1]), z_m=room.floor_z_m + EYE_ABOVE_FLOOR_M, yaw_deg=float(yaw),
                pitch_deg=PITCH_DEG,
            )
        )  # fmt: skip
    return found


def further_photos(room: ProceduralRoom, lighting: str, *, is_rough: bool) -> list[PosedPhoto]:
    """Photos from `stands`, with poses as a phone's tracking or as a person would say them."""
    rng = stream(room.layout, room.kind, "poses")
    found = []
    for number, stand in enumerate(stands(room), 1):
        photo, pose = room.further_photo(stand, lighting, noise=True, number=number)
        if is_rough:
            shift, turn = ROUGH_ERROR[0] * rng.standard_normal(2), ROUGH_ERROR[1] * rng.standard_normal()
            rough = RadarPose(
                x_m=stand.x_m + float(shift[0]), y_m=stand.y_m + float(shift[1]), yaw_deg=stand.yaw_deg + float(turn)
            )
            found.append(PosedPhoto(photo=photo, pose=rough))
            continue
        wrong = pose.copy()
        angle = np.deg2rad(POSE_ERROR[1]) * rng.standard_normal(3)
        tilt = np.array([[0, -angle[2], angle[1]], [angle[2], 0, -angle[0]], [-angle[1], angle[0], 0]])
        wrong[:3, :3] = np.linalg.qr((np.eye(3) + tilt) @ pose[:3, :3])[0]
        wrong[:3, :3] *= np.sign((wrong[:3, :3] * pose[:3, :3]).sum(axis=0))
        wrong[:3, 3] += POSE_ERROR[0] * rng.standard_normal(3)
        found.append(PosedPhoto(photo=photo, pose=wrong))
    return found


def scanned(room: ProceduralRoom) -> Scene:
    """The room of a GLB of its mesh."""
    import trimesh

    mesh, whole = room.mesh, trimesh.Scene()
    to_y_up = np.array([[1.0, 0, 0, 0], [0, 0, 1, 0], [0, -1, 0, 0], [0, 0, 0, 1]])
    for name in sorted({one.coco for one in mesh.appearances}):
        of_name = np.isin(mesh.appearance, [at for at, one in enumerate(mesh.appearances) if one.coco == name])
        colours = np.array([one.colour for one in mesh.appearances])[mesh.appearance[of_name]]
        part: Any = trimesh.Trimesh(mesh.vertices_m, mesh.faces[of_name], process=False)
        part.visual.face_colors = np.clip(255 * np.column_stack([colours ** (1 / 2.2), np.ones(len(colours))]), 0, 255)
        part.apply_transform(to_y_up)
        whole.add_geometry(part, geom_name=name, node_name=name)
    x, y, z = room.shell.radar_m
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "room.glb"
        whole.export(str(path))
        look_deg = 90.0 + float(np.degrees(room.shell.radar_yaw_rad))
        found = read_mesh_photo(path, eye=(x, z, -y), look_deg=look_deg)
    return reconstruct(found.photo, found.others, assumptions=found.assumptions)


def _room_of(case: Case) -> ProceduralRoom:
    return make_room(case.room.kind, case.room.layout, case.seed_of_plan)


def four_photos(case: Case, *, is_rough: bool = False) -> Scene:
    """The room of the case's photo and three further ones."""
    return reconstruct(case.room.photo, further_photos(_room_of(case), case.lighting, is_rough=is_rough))


def scan(case: Case) -> Scene:
    """The room of a scan."""
    return scanned(_room_of(case))


def once_a_room(scene_of: Callable[[Case], Scene]) -> Callable[[Case], Scene]:
    """The same scene for all that ask about one room."""
    latest: dict[Path, Scene] = {}

    def found(case: Case) -> Scene:
        if case.room.folder not in latest:
            latest.clear()
            latest[case.room.folder] = scene_of(case)
        return latest[case.room.folder]

    return found


def learned(network: WeaverNetwork, scene_of: Callable[[Case], Scene]) -> Method:
    """The network in the room that `scene_of` gives."""

    def method(case: Case) -> Any:
        room = LearnedRoom(network, scene_of(case), case.room.config, room_seed=1)
        return room.cube([case.motion], seed=case.index)

    return method


def _figures(case: Case, methods: dict[str, Method]) -> dict[str, dict[str, float]]:
    """{method: {column: value}} of one room, baselines too."""
    table = scored([case], methods)
    return {name: {column: float(value[0]) for column, value in row.items()} for name, row in table.items()}


def add_options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--data", type=Path, action=Reads, required=True)
    parser.add_argument("--weights", type=Path, action=Reads, help="of recipe weaver (default: those included)")
    parser.add_argument("--most", type=int, help="rooms, sampled at random (default: all)")
    parser.add_argument("--only", nargs="*", help="rows (default: all)")
    parser.add_argument("--runs", type=Path, help="folder for what is done, to go on from")
    parser.add_argument("--backwards", action="store_true", help="the last room first, for a second process")


def run_study(options: argparse.Namespace, run: StudyRun) -> None:
    weights = options.weights or shipped_weights()
    network, card = load_weights(weights)
    rooms, plan = read_rooms(options.data), read_plan(options.data)
    cases = cases_of(rooms, SPLIT, 1, plan, 0, options.most)
    generic_scene = generic_scene_of(rooms, plan)
    methods = methods_of(network, generic_scene)
    methods = {name: methods[name] for name in options.only or methods}
    cache = RoomCache(options.runs, {"data_plan": plan, "weights": digest(weights), "rows": sorted(methods)})
    each = {}
    for case in reversed(cases) if options.backwards else cases:
        name = f"{case.room.kind}_{case.room.layout}"
        each[name] = cache.figures(name, partial(_figures, case, methods))
    names = [f"{case.room.kind}_{case.room.layout}" for case in cases]
    table = {
        method: {column: np.array([each[name][method][column] for name in names]) for column in columns}
        for method, columns in each[names[0]].items()
    }
    rows = [_row(name, values, names, SPLIT) for name, values in table.items()]
    rows = complete_rows(
        rows, dataset=dataset_of(options.data), seeds=[0], baselines=[name for name in BASELINES if name in table],
        oracles=[name for name in ORACLES if name in table],
        unknown={"seconds": "metric cpu_s has those of each method"},
    )  # fmt: skip
    run.write("whole_room", SPLIT, config={"weights": card.__dict__, "data_plan": plan}, rows=rows)
    for row in rows:
        shown = {name: row["metrics"][name]["value"] for name in ("ra_ssim", "rd_ssim", "chamfer_m", "cpu_s")}
        print(f"{row['method']:34}", *(f"{name} {value:.3f}" for name, value in shown.items() if value), flush=True)


def methods_of(network: WeaverNetwork, generic_scene: Scene) -> dict[str, Method]:
    """The rows: network and physics by what is known of the room, a baseline and the oracle."""
    scenes: dict[str, Callable[[Case], Scene]] = {
        "one photo": lambda case: reconstruct(case.room.photo),
        "four photos": four_photos,
        "four photos, rough poses": lambda case: four_photos(case, is_rough=True),
        "scan": scan,
    }
    methods: dict[str, Method] = {}
    for name, found in scenes.items():
        scene_of = once_a_room(found)
        methods[f"weaver, {name}"] = learned(network, scene_of)
        methods[f"physics, {name}"] = simulated(scene_of, skin=OTHER, micro_seed=1)
    methods[BASELINES[1]] = simulated(lambda case: generic_scene, skin=OTHER, micro_seed=1)
    methods[ORACLES[0]] = simulated(lambda case: case.true_scene, skin=OTHER, micro_seed=1)
    return methods
