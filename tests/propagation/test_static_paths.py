"""What lies behind a plasterboard wall returns faintly, behind concrete it does not; rough walls scatter."""

from dataclasses import replace

import numpy as np
import pytest

from mmweaver.core.boards import AWR1843
from mmweaver.propagation.materials import MATERIALS, transmission
from mmweaver.propagation.paths import Interaction, StaticPaths
from mmweaver.propagation.static_paths import Propagation, RayTracedRoom
from tests.rooms import back_wall, plane, scene_of

ONCE = Propagation(bounces=1, fine_roughness=False)


def diffuse(planes: tuple, propagation: Propagation = ONCE) -> StaticPaths:
    return RayTracedRoom(scene_of(planes), AWR1843, 0, propagation).paths.select(Interaction.DIFFUSE)


def power_beyond(paths: StaticPaths, range_m: float) -> float:
    far = paths.length_m.mean(dim=(1, 2)).numpy() / 2 > range_m
    return float((paths.amplitude.abs().numpy()[far] ** 2).sum())


def test_a_metal_wall_returns_through_plasterboard_as_the_slab_lets_it():
    hidden, front = back_wall(3.2, "metal"), back_wall(2.0, "plasterboard")
    alone = diffuse((hidden,))
    # rays of the same directions: those that meet the front wall within 3 m on either side meet both
    behind = diffuse((front, hidden))
    got = power_beyond(behind, 3.1) / power_beyond(alone, 3.1)
    reach_hz = 0.4 * AWR1843.bandwidth_hz
    frequencies_hz = AWR1843.centre_frequency_hz + np.linspace(-reach_hz, reach_hz, 9)
    once = np.mean([np.abs(transmission(MATERIALS["plasterboard"], np.ones(1), hz)) ** 2 for hz in frequencies_hz])
    # oblique rays lose more; straight ahead it is there and back through the slab
    assert 0.3 * once**2 < got < 1.1 * once**2
    assert -22 < 10 * np.log10(got) < -8


def through(planes: tuple) -> int:
    """Number of paths through walls."""
    return len(diffuse(planes)) - len(diffuse(planes, replace(ONCE, through_walls=False)))


@pytest.mark.parametrize("material", ["concrete", "metal", "wood"])
def test_nothing_returns_through_what_is_no_thin_wall(material: str):
    hidden = back_wall(3.2, "metal")
    assert through((back_wall(2.0, material), hidden)) == 0
    assert through((back_wall(2.0, "glass"), hidden)) > 1000


def test_the_same_wall_twice_is_one_wall():
    straight_ahead = 0.05  # oblique rays are longer between two faces
    two = through((back_wall(2.0), back_wall(2.0 + straight_ahead)))
    assert two < 0.01 * through((back_wall(2.0), back_wall(2.5)))


@pytest.mark.parametrize(("material", "loss_db"), [("plasterboard", 1.07), ("concrete", 1.07), ("glass", 0.0)])
def test_fine_roughness_takes_from_the_mirror_what_it_scatters(material: str, loss_db: float):
    """0.15 mm of plaster at 79 GHz, straight ahead: exp(-(4 pi 0.15 mm / 3.79 mm)^2), by Ament."""
    rooms = [
        RayTracedRoom(scene_of((back_wall(2.0, material),)), AWR1843, 0, replace(ONCE, fine_roughness=fine))
        for fine in (False, True)
    ]
    flat, rough = (np.abs(room.paths.select(Interaction.SPECULAR).amplitude.numpy()) ** 2 for room in rooms)
    assert 10 * np.log10(flat[0] / rough[0]) == pytest.approx(loss_db, abs=0.03)
    flat_m2, rough_m2 = (room.patches.cross_section_m2.sum() for room in rooms)
    share = MATERIALS[material].scattering ** 2
    most = (share + (1 - share) * (1 - 10 ** (-loss_db / 10))) / share
    assert 1 + 0.5 * (most - 1) <= rough_m2 / flat_m2 <= most + 1e-9  # oblique rays meet a smoother wall


def test_a_window_and_a_door_take_the_place_of_what_is_right_behind_them():
    """A pane in the wall's own plane, and a metal door 5 cm before it: straight ahead one face reflects, not two."""
    wall = back_wall(3.0, "brick")
    pane = plane("panel", (0, 3.0, 0), (0, -1, 0), (1, 0, 0), (0.5, 0.5), "glass")
    door = plane("panel", (0, 2.95, 0), (0, -1, 0), (1, 0, 0), (0.5, 0.5), "metal")

    def mirrored(planes: tuple, hidden: bool = True) -> float:
        faces = RayTracedRoom(scene_of(planes), AWR1843, 0, replace(ONCE, slab_echoes=1, hidden_faces=hidden))
        return float((np.abs(faces.paths.select(Interaction.SPECULAR).amplitude.numpy()) ** 2).sum())

    for front in (pane, door):
        assert mirrored((wall, front)) == pytest.approx(mirrored((front,)), rel=0.01)
    assert mirrored((wall, door), hidden=False) > 1.05 * mirrored((door,))
    aside = replace(pane, centre_m=pane.centre_m + np.array([2.0, 0, 0]))
    assert mirrored((wall, aside)) == pytest.approx(mirrored((wall,)), rel=0.01)
    apart = plane("panel", (0, 2.5, 0), (0, -1, 0), (1, 0, 0), (0.5, 0.5), "metal")  # rays at the mesh decide
    assert mirrored((wall, apart)) == pytest.approx(mirrored((apart,)), rel=0.01)
