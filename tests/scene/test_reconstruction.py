"""A whole scene from a room whose geometry is known."""

from collections.abc import Callable

import numpy as np
import pytest

from mmweaver.core.ray_caster import RayCaster
from mmweaver.core.records import Plane, Scene
from mmweaver.scene.reconstruction import reconstruct

TABLE = ((-0.9, 0.3), (1.9, 2.6), (0.69, 0.73))


@pytest.fixture(scope="module")
def scene(box_room: Callable) -> Scene:
    room = box_room(boxes=[TABLE], pitch_deg=20.0, roll_deg=2.0)
    photo = room.photo(noise=0.002, holes=0.05, width=640, height=480)
    return reconstruct(photo, assumptions=("given",))


def _walls(scene: Scene) -> list[Plane]:
    return [plane for plane in scene.planes if plane.kind == "wall"]


def test_floor_and_frame(scene: Scene):
    assert scene.floor_z_m == pytest.approx(-1.4, abs=0.03)
    assert scene.floor.normal.tolist() == [0, 0, 1]
    assert scene.floor.centre_m[2] == scene.floor_z_m
    assert scene.assumptions[0] == "given"
    assert len(scene.assumptions) > 1


def test_the_floor_lies_under_all_that_is_seen_and_under_the_radar(scene: Scene, box_room: Callable):
    narrow = reconstruct(box_room(walls=(-0.5, 0.4, 2.0)).photo(width=320, height=240))
    for one in (scene, narrow):
        half = one.floor.half_size_m
        for x_m, y_m in [(0.0, 0.0), *(wall.centre_m[:2] for wall in _walls(one))]:
            across, along = (np.array([x_m, y_m, one.floor_z_m]) - one.floor.centre_m) @ np.stack(
                [one.floor.axis_u, one.floor.axis_v], axis=1
            )
            assert abs(across) < half[0] + 1e-6
            assert abs(along) < half[1] + 1e-6


@pytest.mark.parametrize(
    ("normal", "distance_m"), [((0, -1, 0), 3.8), ((1, 0, 0), 2.0), ((-1, 0, 0), 2.2)], ids=["back", "left", "right"]
)
def test_walls_are_found_where_they_are(scene: Scene, normal: tuple[int, ...], distance_m: float):
    found = [wall for wall in _walls(scene) if wall.normal @ np.array(normal) > np.cos(np.deg2rad(2))]
    assert len(found) == 1
    assert abs(found[0].normal @ found[0].centre_m) == pytest.approx(distance_m, abs=0.02)
    assert found[0].material == "plasterboard"


def test_the_table_is_a_top_and_no_seat(scene: Scene):
    tops = [plane for plane in scene.planes if plane.kind == "top"]
    assert len(tops) == 1
    assert tops[0].centre_m[2] == pytest.approx(0.73 - 1.4, abs=0.03)
    assert sorted(2 * np.array(tops[0].half_size_m)) == pytest.approx([0.7, 1.2], abs=0.12)
    assert scene.seats == ()


def test_the_mesh_says_the_measured_depth(scene: Scene):
    """Rays through pixels hit the mesh at the measured depth, and its faces are oriented towards the radar."""
    photo = scene.photo
    row, column = (grid.ravel() for grid in np.mgrid[6:474:13, 6:634:13])
    camera = photo.intrinsics
    rays = np.stack([(column - camera.cx) / camera.fx, (row - camera.cy) / camera.fy, np.ones(len(row))], axis=1)
    length = np.linalg.norm(rays, axis=1)
    unit = (rays / length[:, None]) @ scene.radar_from_camera.T
    distance, face = RayCaster(scene.vertices_m, scene.faces).first_hit(np.zeros_like(unit), unit)
    measured = photo.depth_m[row, column]
    error = np.abs(distance / length - measured)[np.isfinite(measured)]
    assert np.median(error) < 0.02
    assert (error < 0.1).mean() > 0.9
    corners = scene.vertices_m[scene.faces[face[face >= 0]]]
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    assert ((normal * unit[face >= 0]).sum(axis=1) < 0).all()
    assert len(scene.faces) < 60_000
    assert scene.face_material.shape == (len(scene.faces),)
    assert scene.face_material.max() < len(scene.material_names)


def test_a_mesh_has_no_faces_between_near_and_far(box_room: Callable):
    """No curtain from a post's edges to the wall behind it."""
    room = box_room(boxes=[((-0.3, 0.3), (1.5, 1.7), (0.0, 2.2))])
    scene = reconstruct(room.photo())
    corners = scene.vertices_m[scene.faces]
    is_floor = np.abs(corners[..., 2] - scene.floor_z_m).max(axis=1) < 0.01
    is_whole_wall = np.ptp(corners[..., 2], axis=1) > 2.0  # continued beyond the picture
    stretch = np.ptp(corners[~is_floor & ~is_whole_wall][..., 1], axis=1)
    assert stretch.max() < 0.8
