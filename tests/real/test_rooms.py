"""The four real rooms become scenes."""

from pathlib import Path

import numpy as np
import pytest

from mmweaver.core.ray_caster import RayCaster
from mmweaver.core.records import Scene
from mmweaver.scene.read_photo import read_photo
from mmweaver.scene.reconstruction import reconstruct

ROOMS = ("kinect2_living_room", "kinect_dining_room", "redwood_chair_corner", "tum_office_desk")


def _scene(real_data: Path, name: str) -> Scene:
    folder = real_data / "rooms" / name
    photo, assumptions = read_photo(folder / "rgb.png", folder / "depth.png", folder / "camera.json")
    return reconstruct(photo, assumptions=assumptions)


@pytest.fixture(scope="module", params=ROOMS)
def scene(real_data: Path, request: pytest.FixtureRequest) -> Scene:
    return _scene(real_data, request.param)


def test_its_walls_are_upright(scene: Scene):
    """The points on each wall near enough to measure: their own best plane leans by less than 3 degrees."""
    walls = [plane for plane in scene.planes if plane.kind == "wall"]
    assert walls
    camera, depth = scene.photo.intrinsics, scene.photo.depth_m
    row, column = np.mgrid[0 : camera.height : 4, 0 : camera.width : 4]
    z = depth[row, column]
    points = np.stack([(column - camera.cx) / camera.fx * z, (row - camera.cy) / camera.fy * z, z], axis=-1)
    points = points[np.isfinite(z)] @ scene.radar_from_camera.T
    checked = 0
    for wall in walls:
        offset = points - wall.centre_m
        inside = (np.abs(offset @ wall.axis_u) < 0.9 * wall.half_size_m[0]) & (
            np.abs(offset @ wall.axis_v) < 0.9 * wall.half_size_m[1]
        )
        on_wall = points[inside & (np.abs(offset @ wall.normal) < 0.08)]
        if len(on_wall) < 2000 or np.linalg.norm(wall.centre_m) > 4.5:
            continue
        normal = np.linalg.svd(on_wall - on_wall.mean(axis=0), full_matrices=False)[2][2]
        assert np.rad2deg(np.arcsin(abs(normal[2]))) < 3
        checked += 1
    # The dining room's walls all lie farther off than its sensor measures well.
    assert checked >= 1 or min(np.linalg.norm(wall.centre_m) for wall in walls) > 4.5


def test_there_is_free_floor_in_the_window(scene: Scene):
    space = scene.free_space
    ground = np.hypot(space.x_m[None, :], space.y_m[:, None])
    in_window = space.is_free & (ground > 0.7) & (ground < 3.5)
    assert in_window.sum() * 0.05**2 > 1.0
    assert not (space.is_seen & ~space.is_free).any()


def test_its_mesh_is_small_and_says_the_depth(scene: Scene):
    assert len(scene.faces) < 60_000
    assert np.isfinite(scene.vertices_m).all()
    camera = scene.photo.intrinsics
    row, column = (grid.ravel() for grid in np.mgrid[5 : camera.height : 16, 5 : camera.width : 16])
    rays = np.stack([(column - camera.cx) / camera.fx, (row - camera.cy) / camera.fy, np.ones(len(row))], axis=1)
    length = np.linalg.norm(rays, axis=1)
    unit = rays / length[:, None] @ scene.radar_from_camera.T
    distance = RayCaster(scene.vertices_m, scene.faces).distance_m(np.zeros_like(unit), unit)
    measured = scene.photo.depth_m[row, column]
    error = np.abs(distance / length - measured)[np.isfinite(measured)]
    assert np.median(error) < 0.03
    assert (error < 0.15).mean() > 0.8


def test_the_sofa_is_sat_on_and_the_table_before_it_is_not(real_data: Path):
    scene = _scene(real_data, "kinect2_living_room")
    assert len(scene.seats) >= 3
    for seat in scene.seats:
        # The low table stands within half a metre of (-1.1, 2.3).
        assert np.hypot(seat.position_m[0] + 1.1, seat.position_m[1] - 2.3) > 0.5
        # Who sits there looks away from the walls in the corner.
        assert np.sin(seat.facing_rad) < -0.3
