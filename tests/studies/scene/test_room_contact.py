import numpy as np

from mmweaver.scene.procedural.procedural_room import make_room
from studies.scene.room_contact import contact
from tests.rooms import standing_person


def test_who_stands_in_the_open_is_clear_and_who_stands_in_the_sofa_is_not():
    from scipy import ndimage

    room = make_room("living_room", 0, 0)
    free = room.free_space
    clearance = np.asarray(ndimage.distance_transform_edt(free.is_free))
    row, column = np.unravel_index(int(np.argmax(clearance)), clearance.shape)
    place = (float(free.x_m[column]), float(free.y_m[row]), room.floor_z_m)
    assert contact(room, standing_person(place, seconds=0.3)).body_m == 0.0
    sofa = room.seats[0].position_m
    inside = contact(room, standing_person((float(sofa[0]), float(sofa[1]), room.floor_z_m), seconds=0.3))
    assert inside.body_m > 0.05
    assert "sofa" in inside.body_where or "armchair" in inside.body_where
