"""The free floor of places relative to walls, corners and two things at once, and the places where nobody can be."""

from dataclasses import replace

import numpy as np
import pytest

from mmweaver.core.errors import InputError
from mmweaver.core.records import Landmark, Plane
from mmweaver.motion.compose import compose
from mmweaver.motion.language.places import Place
from mmweaver.motion.language.timing import plan_motion
from mmweaver.motion.planning.floor_map import FloorMap
from mmweaver.motion.planning.named_places import cells_of
from tests.motion.rooms import FLOOR_Z_M, WINDOW_M, room, seat

UP = np.array([0.0, 0.0, 1.0])
TABLE = Landmark(kind="table", position_m=np.array([-0.6, 2.0, -0.5]), approach_m=(0.0, 1.4), facing_rad=np.pi / 2)
DOOR = Landmark(kind="door", position_m=np.array([0.8, 2.6, -0.1]), approach_m=(0.7, 2.3), facing_rad=1.2)


def _wall(x_m: float, y_m: float, normal: tuple[float, float], half_m: float) -> Plane:
    facing = np.array([*normal, 0.0])
    return Plane(
        kind="wall", centre_m=np.array([x_m, y_m, FLOOR_Z_M + 1.2]), normal=facing, axis_u=np.cross(UP, facing),
        axis_v=UP, half_size_m=(half_m, 1.2), material="plasterboard",
    )  # fmt: skip


BACK, RIGHT = _wall(0.0, 3.0, (0.0, -1.0), 1.4), _wall(1.5, 1.5, (-1.0, 0.0), 1.4)


def _floor(*walls: Plane, landmarks: tuple[Landmark, ...] = (TABLE, DOOR)) -> FloorMap:
    empty = room(boxes=((-2.5, 2.5, 3.0, 5.0), (1.5, 2.5, 0.0, 5.0)), seats=(seat(0.2, 2.0),))
    return FloorMap(replace(empty, planes=(*empty.planes, *walls), landmarks=landmarks), WINDOW_M, 1.75)


def test_a_corner_is_where_two_walls_meet_though_the_photo_ends_before():
    cells = cells_of(Place("in", "corner"), _floor(BACK, RIGHT))
    assert np.hypot(*(cells - [1.5, 3.0]).T).max() < 1.25
    for walls in ((), (BACK,), (BACK, _wall(4.5, 1.5, (-1.0, 0.0), 1.4))):
        with pytest.raises(InputError, match=r"no corner .*a door, a seat, a table"):
            cells_of(Place("in", "corner"), _floor(*walls))


def test_who_stands_against_a_wall_is_nearer_than_who_is_near_it():
    floor = _floor(BACK)
    against, near = (cells_of(Place(relation, "wall"), floor) for relation in ("against", "near"))
    assert against[:, 1].min() > 2.35
    assert 2.05 < near[:, 1].min() < against[:, 1].min()
    with pytest.raises(InputError, match="no wall"):
        cells_of(Place("near", "wall"), _floor())


def test_between_two_things_is_on_the_way_from_one_to_the_other():
    floor = _floor(BACK)
    cells = cells_of(Place("between", "table", other="door"), floor)
    assert -0.6 < cells[:, 0].min() < cells[:, 0].max() < 0.8
    assert 1.4 < cells[:, 1].min() < cells[:, 1].max() < 3.0
    to_wall = cells_of(Place("between", "wall", other="table"), floor)
    assert np.abs(to_wall[:, 0] + 0.6).max() <= 0.5
    assert to_wall[:, 1].min() > 2.1
    for place, missing in ((Place("between", "bed", other="door"), "no bed was found"),
                           (Place("between", "table", other="table"), "only one of them"),
                           (Place("between", "wall", other="wall"), "say one thing")):  # fmt: skip
        with pytest.raises(InputError, match=missing):
            cells_of(place, floor)


@pytest.mark.parametrize("text", ["waves under the table", "crawls under the table", "walks outside", "waves outside"])
def test_nobody_is_shown_under_a_table_or_outside(text: str):
    floor = _floor(BACK)
    with pytest.raises(InputError, match="nobody is shown") as refused:
        compose(plan_motion(f"a person {text}"), floor.scene, seed=0, range_window_m=WINDOW_M)
    assert "under" not in text or "say 'near the table'" in str(refused.value)


@pytest.mark.parametrize(
    ("text", "goal_m", "within_m"),
    [("walks to the middle of the room", (0.0, 1.9), 0.7), ("walks to the corner", (1.5, 3.0), 1.4)],
)
def test_walks_end_at_the_middle_and_in_the_corner(text: str, goal_m: tuple[float, float], within_m: float):
    scene = _floor(BACK, RIGHT).scene
    made = compose(plan_motion(f"a person {text}"), scene, seed=1, range_window_m=WINDOW_M)
    start, *_, end = made.pose.joints_m[:, 0, :2]
    assert np.hypot(*(end - goal_m)) < within_m
    assert np.hypot(*(end - start)) > 0.3
