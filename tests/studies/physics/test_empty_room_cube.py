import pytest

from mmweaver.core.boards import IWR1443_MARS
from mmweaver.propagation.paths import Interaction
from mmweaver.propagation.ray_traced import Simulator
from studies.physics.empty_room_cube import empty_room


@pytest.mark.parametrize(("has_floor", "wall_y_m", "reflectors"), [(True, None, 1), (True, 3.0, 2), (False, None, 1)])
def test_a_floor_and_perhaps_a_wall(has_floor: bool, wall_y_m: float | None, reflectors: int):
    scene = empty_room(floor_z_m=-0.8, has_floor=has_floor, wall_y_m=wall_y_m)
    room = Simulator(scene, IWR1443_MARS).room
    assert len(room.reflectors) == reflectors
    assert (room.counts[Interaction.DIFFUSE] > 0) == has_floor
    assert scene.floor.centre_m[2] == scene.floor_z_m
