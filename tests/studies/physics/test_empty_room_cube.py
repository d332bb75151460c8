import pytest

from mmweaver.core.boards import IWR1443_MARS
from mmweaver.propagation.paths import Interaction
from mmweaver.propagation.ray_traced import Simulator
from studies.physics.empty_room_cube import empty_room


@pytest.mark.parametrize(("wall_y_m", "reflectors"), [(None, 1), (3.0, 2)])
def test_a_floor_and_perhaps_a_wall(wall_y_m: float | None, reflectors: int):
    scene = empty_room(floor_z_m=-0.8, wall_y_m=wall_y_m)
    room = Simulator(scene, IWR1443_MARS).room
    assert len(room.reflectors) == reflectors
    assert room.counts[Interaction.DIFFUSE] > 0
    assert scene.floor.centre_m[2] == scene.floor_z_m
