"""Random open rooms for the simulator."""

import numpy as np

from mmweaver.core.presets import IWR1443_RADHAR
from mmweaver.paths.ray_traced import Simulator
from mmweaver.recognition.open_room import Panel, open_room

PANEL = Panel(centre_m=(1.0, 2.0, 0.0), half_size_m=(0.4, 0.4), turn_rad=0.46, material="metal")


def test_a_panel_echoes_at_its_range():
    bare = Simulator(open_room(floor_z_m=-1.0, wall_y_m=None), IWR1443_RADHAR)
    room = Simulator(open_room(floor_z_m=-1.0, wall_y_m=None, panels=(PANEL,)), IWR1443_RADHAR)
    spectra = [np.abs(np.fft.fft(one.room_adc[0, 0] * np.hanning(240))) for one in (bare, room)]
    at = round(float(np.hypot(1.0, 2.0)) / IWR1443_RADHAR.range_resolution_m)
    near = slice(at - 4, at + 5)
    assert spectra[1][near].max() > 3 * spectra[0][near].max()


def test_nobody_walks_through_the_wall():
    free = open_room(floor_z_m=-1.0, wall_y_m=3.0).free_space
    assert free.is_free[free.y_m < 2.9].all()
    assert not free.is_free[free.y_m > 3.0].any()


def test_the_floor_is_at_its_height():
    assert open_room(floor_z_m=-0.8, wall_y_m=3.0).floor.centre_m[2] == -0.8
