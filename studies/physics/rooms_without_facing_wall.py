"""Rows behind bodies and of static clutter in rooms where, as in the recorded ones, no wall nearby faces the radar.

    python -m studies run rooms_without_facing_wall --data <recordings>

Fixed before any figure was computed, by geometry alone: no flat surface of 0.5 m2 or more that the radar sees in its
beam faces it, within 10 degrees, nearer than 3.5 m or than 2 m behind the walkers. The generator's kinds have the wall
ahead at 2.9 to 3.45 m (a corridor's up to 5.2), so here all have it at 5.1 to 6.1 m (a recorded one is at 5.2 m), and
all else as it is. Of each kind the first draw that qualifies is taken, from layout and seed 700 on. Walkers, moments,
boards and features are those of `board_left_out`. Added after the rows were seen, to name what makes them: the same
rooms with some walls as rough surfaces alone, no mirrors (`walls_left_out`, not in the table of rows).
"""

import argparse
from collections.abc import Callable
from dataclasses import replace
from itertools import count
from pathlib import Path
from typing import Any

import numpy as np

from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.records import Plane, Scene
from mmweaver.core.seeding import stream
from mmweaver.geometry.ray_caster import RayCaster
from mmweaver.scene.procedural.procedural_room import make_room_of
from mmweaver.scene.procedural.room_kinds import KINDS, RoomKind
from studies.manifest import StudyRun
from studies.physics.board_left_out import room_rows, walked_through, walkers_m
from studies.physics.signal_statistics import recorded_people
from studies.result_rows import complete_rows
from studies.study import Reads

METHOD = "as generated, entire rooms without a facing wall"
WALL_DISTANCE_M, FIRST_DRAW = (5.1, 6.1), 700
NEAR_M, BEHIND_WALKERS_M = 3.5, 2.0
FLAT_M2, FACES_DEG = 0.5, 10.0
BEAM_DEG = (62, 50)  # azimuth and elevation at which the rays of static paths end
SAME_PLANE_DEG, SAME_PLANE_M = 1.0, 0.02
WALLS: dict[str, Callable[[Plane], bool]] = {  # the normal points into the room, and the radar looks along +y
    "side walls are no mirrors": lambda wall: abs(wall.normal[0]) > abs(wall.normal[1]),
    "the wall ahead is no mirror": lambda wall: -wall.normal[1] > abs(wall.normal[0]),
}


def is_free_of_facing_walls(scene: Scene) -> bool:
    """Whether nothing flat faces the radar nearby, nor nearly behind the walkers."""
    return nearest_facing_m(scene) >= max(NEAR_M, walkers_m(scene) + BEHIND_WALKERS_M)


def nearest_facing_m(scene: Scene) -> float:
    """Distance to the nearest flat surface that is seen in the beam and faces the radar, metres; inf without one."""
    rays = _beam()
    corner = np.asarray(scene.vertices_m, float)[scene.faces]
    normal = np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0])
    area_m2 = np.linalg.norm(normal, axis=1) / 2
    normal = normal / np.maximum(2 * area_m2, 1e-12)[:, None]
    distance_m, face = RayCaster(scene.vertices_m, scene.faces).first_hit(np.zeros_like(rays), rays)
    faces_radar = (face >= 0) & (np.abs((rays * normal[face]).sum(axis=1)) >= np.cos(np.radians(FACES_DEG)))
    flat = [
        one for one in np.unique(face[faces_radar]).tolist() if _plane_m2(one, corner[:, 0], normal, area_m2) >= FLAT_M2
    ]
    return float(distance_m[faces_radar & np.isin(face, flat)].min(initial=np.inf))


def _beam() -> np.ndarray:
    """Unit vectors (ray, 3), one a degree."""
    azimuth, elevation = (np.radians(np.arange(-limit, limit + 1)) for limit in BEAM_DEG)
    a, e = (part.ravel() for part in np.meshgrid(azimuth, elevation))
    return np.stack([np.cos(e) * np.sin(a), np.cos(e) * np.cos(a), np.sin(e)], axis=1)


def _plane_m2(face: int, corner_m: np.ndarray, normal: np.ndarray, area_m2: np.ndarray) -> float:
    """Area of all faces in the plane of one, m2."""
    is_parallel = np.abs(normal @ normal[face]) >= np.cos(np.radians(SAME_PLANE_DEG))
    is_near = np.abs((corner_m - corner_m[face]) @ normal[face]) <= SAME_PLANE_M
    return float(area_m2[is_parallel & is_near].sum())


def first_free(kind: RoomKind) -> tuple[int, Scene]:
    """The first draw of a deeper room of this kind that qualifies, and the room."""
    deeper = replace(kind, wall_distance_m=WALL_DISTANCE_M)
    drawn = ((draw, make_room_of(deeper, draw, draw).scene()) for draw in count(FIRST_DRAW))
    return next((draw, scene) for draw, scene in drawn if is_free_of_facing_walls(scene))


def rooms() -> dict[str, tuple[int, Scene]]:
    """Of each kind the draw and the room."""
    return {name: first_free(kind) for name, kind in KINDS.items()}


def without_mirrors(scene: Scene, is_left_out: Callable[[Plane], bool]) -> Scene:
    """The room with some walls by their mesh alone, which scatters and hides but does not reflect."""
    return replace(scene, planes=tuple(one for one in scene.planes if one.kind != "wall" or not is_left_out(one)))


def rows_of(scenes: list[Scene], config: RadarConfig) -> dict[str, Any]:
    """The rows of `board_left_out` in these rooms, each with the interval of its median over rooms."""
    rows = room_rows({str(seed): walked_through(scene, config, "after", seed) for seed, scene in enumerate(scenes)})
    return {name: {**row, "interval_95": median_interval(row["rooms"])} for name, row in rows.items()}


def median_interval(values: list[float | None]) -> list[float]:
    """95 % interval of the median, by bootstrap over rooms that show the row."""
    shown = np.array([one for one in values if one is not None])
    drawn = stream(0, "bootstrap").choice(shown, (2000, len(shown)))
    return np.percentile(np.median(drawn, axis=1), [2.5, 97.5]).round(2).tolist()


def add_options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--data", type=Path, action=Reads, required=True, help="folder with radar/ in it")


def run_study(options: argparse.Namespace, run: StudyRun) -> None:
    config = recorded_people(options.data).config
    chosen = rooms()
    draws = {kind: draw for kind, (draw, _) in chosen.items()}
    scenes = [scene for _, scene in chosen.values()]
    left_out = {name: [without_mirrors(scene, walls) for scene in scenes] for name, walls in WALLS.items()}
    unknown = {
        "seconds": "see the manifest",
        "dataset.sha256": "rooms are drawn; recordings are hashed in the manifest",
    }
    for name, each in (("physics_rooms", {METHOD: scenes}), ("walls_left_out", left_out)):
        rows = [{"method": method, "n": len(of), "metrics": rows_of(of, config)} for method, of in each.items()]
        rows = complete_rows(rows, dataset={"name": "one room a kind"}, seeds=list(range(len(scenes))), unknown=unknown)
        run.write("rooms_without_facing_wall", name, config={"draws": draws}, rows=rows)
