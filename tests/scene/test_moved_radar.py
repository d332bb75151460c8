"""Radars that do not stand at the camera: where they see person and walls, what hides them, and what they share."""

from unittest.mock import patch

import numpy as np
import pytest

from mmweaver.core.boards import AWR1843
from mmweaver.core.errors import InputError
from mmweaver.core.radar_pose import AT_CAMERA, RadarPose
from mmweaver.core.records import PoseSequence, RadarCube, Scene
from mmweaver.core.skeleton import joint
from mmweaver.propagation import ray_traced
from mmweaver.propagation.ray_traced import Simulator
from mmweaver.propagation.receiver import IDEAL
from mmweaver.scene.moved_radar import people_seen_from, scene_seen_from, unseen_notes
from mmweaver.signal.cube import radar_cube, remove_static
from mmweaver.signal.spectra import (
    azimuth_axis_rad,
    elevation_axis_rad,
    range_azimuth_power,
    range_doppler_power,
    range_elevation_power,
)
from tests.rooms import STANDING_M, back_wall, floor, plane, scene_of, side_wall, standing_person

RIGHT_ANGLE = RadarPose.of_words("1.8,2.2,0,-90,0")  # 2.2 m ahead of the camera, looks to its left
OPEN = scene_of((floor(material="concrete"),))


def recorded(pose: RadarPose, person: PoseSequence, scene: Scene = OPEN) -> RadarCube:
    """The moving part of what a radar at `pose` records."""
    people = people_seen_from((person,), pose)
    simulator = Simulator(scene_seen_from(scene, pose), AWR1843, IDEAL)
    return remove_static(radar_cube(simulator.run(people, num_frames=1, seed=0).adc))


def strongest_place_m(cube: RadarCube, pose: RadarPose) -> np.ndarray:
    """Where the range-azimuth map is strongest, (x, y) in the camera's level frame."""
    azimuth_rad = azimuth_axis_rad()
    power = range_azimuth_power(cube, azimuth_rad).sum(axis=0)
    near, aside = np.unravel_index(power.argmax(), power.shape)
    range_m, azimuth = cube.grid.range_m[near], azimuth_rad[aside]
    return pose.in_level_frame(np.array([range_m * np.sin(azimuth), range_m * np.cos(azimuth), 0.0]))[:2]


@pytest.mark.parametrize("aside_m", [-0.3, 0.2])
def test_two_radars_see_the_person_at_the_same_place(aside_m: float):
    """Each sees the skin that faces it: 0.1 to 0.2 m before the middle; across, a cell of the array is 0.5 m wide."""
    person = standing_person((aside_m, 2.2, -1.2), (0.5, -0.6, 0.0))
    places = [strongest_place_m(recorded(pose, person), pose) for pose in (AT_CAMERA, RIGHT_ANGLE)]
    middle_m = np.array([aside_m, 2.2]) + 0.0035 * np.array([0.5, -0.6])
    for place in places:
        assert np.linalg.norm(place - middle_m) < 0.3
    assert abs(places[0][1] - (middle_m[1] - 0.13)) < 0.1  # the camera's radar ranges along y
    assert abs(places[1][0] - (middle_m[0] + 0.17)) < 0.1  # the other along x, at the person's wider side
    assert np.linalg.norm(places[0] - places[1]) < 0.5


def test_a_tilted_radar_sees_the_person_lower():
    person = standing_person((0.0, 3.0, -1.2), (0.0, -0.8, 0.0))
    elevation_rad = elevation_axis_rad()

    def seen_deg(pose: RadarPose) -> float:
        power = range_elevation_power(recorded(pose, person), elevation_rad).sum(axis=(0, 1))
        return float(np.degrees(elevation_rad[power.argmax()]))

    level_deg = seen_deg(AT_CAMERA)
    assert seen_deg(RadarPose(pitch_deg=10.0)) == pytest.approx(level_deg - 10, abs=4)
    assert seen_deg(RadarPose(pitch_deg=-10.0)) == pytest.approx(level_deg + 10, abs=4)


def test_walls_are_where_they_are():
    """A wall returns a specular path of twice its distance from the radar's own place."""
    room = scene_of((floor(), back_wall(3.2), side_wall(0.95)))
    for words, distances_m in {"0,1,0,0,0": (2.2,), "0,2,0,90,0": (0.95,), "-0.5,1.5,0,45,0": (1.45, 1.7)}.items():
        simulator = Simulator(scene_seen_from(room, RadarPose.of_words(words)), AWR1843, IDEAL)
        paths = simulator.room.paths[simulator.room.paths.interaction == 1]
        found_m = paths.length_m.mean(dim=(1, 2)).numpy() / 2
        for distance_m in distances_m:
            assert np.abs(found_m - distance_m).min() < 0.01, (words, found_m)


def test_what_hides_a_person_from_one_radar_does_not_from_another():
    panel = plane("wall", (0.0, 1.4, 0.0), (0, -1, 0), (1, 0, 0), (0.7, 1.3), "metal")
    room = scene_of((floor(), panel))
    person = standing_person((0.0, 2.2, -1.2), (0.4, -0.4, 0.0))
    power = {pose: range_doppler_power(recorded(pose, person, room)).sum() for pose in (AT_CAMERA, RIGHT_ANGLE)}
    assert power[RIGHT_ANGLE] > 100 * power[AT_CAMERA]


def test_people_sway_alike_before_all_radars():
    """Micro-motion is the person's: a radar on its side traces the same skin at the same places, to a micrometre."""
    person = standing_person((0.0, 2.2, -1.2))
    still = STANDING_M["head"] + np.array([0.0, 2.2, -1.2])
    heads = []
    for pose in (AT_CAMERA, RadarPose.of_words("0.4,0.2,0.3,-20,15,90")):
        people = people_seen_from((person,), pose)
        simulator = Simulator(scene_seen_from(OPEN, pose), AWR1843, IDEAL)
        with patch.object(ray_traced, "PeoplePaths", wraps=ray_traced.PeoplePaths) as traced:
            simulator.run(people, num_frames=4, seed=5, num_points=20)
        (joints_m,) = traced.call_args.args[3]
        heads.append(pose.in_level_frame(joints_m[:, :, joint("head")]))
    np.testing.assert_allclose(heads[0], heads[1], atol=1e-6)
    assert 1e-4 < np.abs(heads[0] - still).max() < 0.05


def test_where_the_person_is_not_seen_is_said():
    person = standing_person((0.0, 2.2, -1.2))
    window_m = (0.7, 3.5)
    assert unseen_notes((person,), window_m) == ()
    away = people_seen_from((person,), RadarPose(yaw_deg=90.0))
    assert "in 0 of" in unseen_notes(away, window_m)[0]


def test_no_radar_stands_under_the_floor():
    with pytest.raises(InputError, match="under the floor"):
        scene_seen_from(OPEN, RadarPose(z_m=-1.3))
    assert scene_seen_from(OPEN, AT_CAMERA) is OPEN
