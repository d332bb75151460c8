"""Procedural rooms: valid, different, and with a ground truth that agrees with their photo."""

import numpy as np
import pytest

from mmweaver.core.boards import AWR1843
from mmweaver.core.errors import InputError
from mmweaver.core.pinhole import unproject
from mmweaver.core.radar_pose import RadarPose
from mmweaver.propagation.paths import Interaction
from mmweaver.propagation.ray_traced import Simulator
from mmweaver.scene.procedural.arrangement import KINDS, MIN_FREE_M2, MIN_WALKABLE_M2
from mmweaver.scene.procedural.procedural_room import ProceduralRoom, make_room
from studies.scene.room_contact import signed_distance_m

TOUCH_M = 0.006


SEEDS_AND_LAYOUTS = (0, 1), (5, 7)


# slow: a second room of each kind
@pytest.fixture(
    scope="module",
    params=[
        pytest.param((kind, number), id=f"{kind}-{number}", marks=[pytest.mark.slow] if number else [])
        for kind in KINDS
        for number in range(2)
    ],
)
def room(request: pytest.FixtureRequest) -> ProceduralRoom:
    kind, number = request.param
    seed, layout = SEEDS_AND_LAYOUTS[number]
    return make_room(kind, layout, seed)


def test_nothing_overlaps(room: ProceduralRoom):
    piece = np.array(room.boxes.piece)
    cut = room.boxes.overlap(room.boxes, 0.001)
    assert room.boxes.half_m.min() > 1e-3, "a board without thickness would be a hole for rays"
    # Different pieces only: the cushions of a sofa press into it.
    cut &= piece[:, None] != piece[None, :]
    assert not cut.any(), [(room.boxes.names[a], room.boxes.names[b]) for a, b in np.argwhere(cut)[:4]]


def test_nothing_floats(room: ProceduralRoom):
    """Every box is connected to floor, walls or ceiling by boxes that touch."""
    boxes, (w, d, h) = room.boxes, room.shell.size_m
    low = boxes.centre_m[:, 2] - boxes.half_m[:, 2] - room.floor_z_m
    high = boxes.centre_m[:, 2] + boxes.half_m[:, 2] - room.floor_z_m
    corners = boxes.corners_m() @ _turn(room).T + np.array(room.shell.radar_m[:2])
    at_wall = (corners < TOUCH_M).any(axis=(1, 2)) | (corners > np.array([w, d]) - TOUCH_M).any(axis=(1, 2))
    held = (low < TOUCH_M) | at_wall | (high > h - TOUCH_M)
    touching = boxes.overlap(boxes, -TOUCH_M)
    for _ in range(12):
        held = held | touching[held].any(axis=0)
    assert held.all(), {boxes.names[i] for i in np.flatnonzero(~held)}


def _turn(room: ProceduralRoom) -> np.ndarray:
    cosine, sine = np.cos(room.shell.radar_yaw_rad), np.sin(room.shell.radar_yaw_rad)
    return np.array([[cosine, -sine], [sine, cosine]])


def test_meshes_lie_in_their_boxes_and_in_the_room(room: ProceduralRoom):
    used = room.mesh.faces[room.mesh.piece >= 0]
    points = room.vertices_m[np.unique(used)]
    nearest = np.concatenate([signed_distance_m(room.boxes, some).min(axis=1) for some in np.array_split(points, 20)])
    assert nearest.max() < 1e-6
    inside = room.mesh.vertices_m
    assert inside.min() > -1e-6
    assert (inside <= np.array(room.shell.size_m) + 1e-6).all()


def test_there_is_room_to_walk_and_the_window_holds_walls_and_furniture(room: ProceduralRoom):
    assert room.free_m2 >= MIN_FREE_M2
    assert room.walkable_m2 >= MIN_WALKABLE_M2
    ground = np.hypot(room.boxes.centre_m[:, 0], room.boxes.centre_m[:, 1])
    assert (ground < 3.4).any()
    offsets = [abs(float(p.normal @ p.centre_m)) for p in room.planes if p.kind == "wall"]
    assert min(offsets) < 3.4


SLOW_PHOTOS = [kind for kind in KINDS if kind not in ("living_room", "kitchen", "corridor")]


# slow: photos of more kinds, by the code that draws the three
@pytest.mark.parametrize(
    "kind", [pytest.param(kind, marks=[pytest.mark.slow] if kind in SLOW_PHOTOS else []) for kind in KINDS]
)
def test_the_photo_agrees_with_the_ground_truth(kind: str):
    """Every pixel's point lies on a box or on the shell; floor pixels lie at the floor's height."""
    room = make_room(kind, 0, 0)
    photo = room.photo()
    assert photo.classes is not None
    assert photo.rgb.shape == (480, 640, 3)
    assert np.isfinite(photo.depth_m).all()
    points = unproject(photo.depth_m, photo.intrinsics) @ room.radar_from_camera.T
    ground = [i for i, name in enumerate(photo.classes.names) if name.startswith(("floor", "carpet"))]
    on_floor = np.isin(photo.classes.index, ground)
    assert on_floor.mean() > 0.05
    assert np.abs(points[on_floor][:, 2] - room.floor_z_m).max() < 1e-3
    assert 20 < photo.rgb.mean() < 220
    assert photo.rgb.std() > 15


def test_noise_is_that_of_a_stereo_camera():
    room = make_room("living_room", 1, 4)
    true, noisy = room.photo(), room.photo(noise=True)
    holes = np.isnan(noisy.depth_m)
    assert 0.005 < holes.mean() < 0.35
    far = (true.depth_m > 2.5) & ~holes
    error = np.abs(noisy.depth_m - true.depth_m)[far] / true.depth_m[far]
    assert 0.0005 < np.median(error) < 0.02


def test_lightings_differ_and_unknown_ones_are_refused():
    room = make_room("office")
    assert np.abs(room.photo("day").rgb.astype(int) - room.photo("evening").rgb).mean() > 8
    with pytest.raises(InputError, match="known: day"):
        room.photo("moon")


def test_equal_seeds_give_equal_bits_and_different_seeds_different_rooms():
    one, again, layout, seed = (make_room("corridor", *key) for key in ((1, 2), (1, 2), (3, 2), (1, 4)))
    assert np.array_equal(one.vertices_m, again.vertices_m)
    photos = [room.photo("lamps", noise=True) for room in (one, again)]
    assert np.array_equal(photos[0].depth_m, photos[1].depth_m, equal_nan=True)
    assert np.array_equal(photos[0].rgb, photos[1].rgb)
    stand = RadarPose(x_m=0.3)
    first, same, other = (
        room.further_photo(stand, "lamps", noise=True, number=number)[0].depth_m
        for room, number in ((one, 1), (again, 1), (one, 2))
    )
    assert np.array_equal(first, same, equal_nan=True)
    assert not np.array_equal(first, other, equal_nan=True), "each further photo has noise of its own"
    assert one.shell.size_m == layout.shell.size_m  # rearranged, not rebuilt
    assert not np.array_equal(one.boxes.centre_m, layout.boxes.centre_m)
    assert one.shell.size_m != seed.shell.size_m
    for room in (layout, seed):  # both turn the camera
        assert not np.allclose(one.radar_from_camera, room.radar_from_camera, atol=1e-4)


@pytest.mark.parametrize(("kind", "layout", "seed"), [("castle", 0, 0), ("office", -1, 0), ("office", 0, -1)])
def test_invalid_requests_are_refused(kind: str, layout: int, seed: int):
    with pytest.raises(InputError):
        make_room(kind, layout, seed)


def test_every_kind_has_its_furniture(room: ProceduralRoom):
    needed = {
        "office": "desk", "living_room": "sofa", "lab": "lab bench", "kitchen": "oven", "library": "bookcase",
        "bedroom": "bed", "dining_room": "dining table", "meeting_room": "meeting table", "classroom": "school table",
        "corridor": "bench", "gym": "treadmill", "workshop": "workbench",
    }  # fmt: skip
    assert needed[room.kind] in room.boxes.names


def test_the_simulator_accepts_the_true_scene():
    room = make_room("living_room", 0, 1)
    simulator = Simulator(room.scene(), AWR1843)
    assert np.isfinite(simulator.room_adc).all()
    assert simulator.room.counts[Interaction.DIFFUSE] > 3000
    assert simulator.room.counts[Interaction.EDGE] > 5
