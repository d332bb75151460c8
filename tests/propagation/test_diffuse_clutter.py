"""Static clutter that photo and mesh do not resolve: level, distribution and where it is."""

from dataclasses import replace

import numpy as np
import pytest

from mmweaver.core.boards import AWR1843, PRESETS
from mmweaver.core.radar_pose import RadarPose
from mmweaver.core.stages import Stages
from mmweaver.models.methods import Physics
from mmweaver.propagation.cube_rendering import CubeRenderer
from mmweaver.propagation.diffuse_clutter import diffuse_clutter, room_level, seed_of_room
from mmweaver.propagation.paths import Interaction
from mmweaver.propagation.ray_traced import Simulator
from mmweaver.propagation.receiver import IDEAL
from mmweaver.propagation.static_paths import Propagation
from mmweaver.scene.moved_radar import scene_seen_from
from tests.rooms import back_wall, floor, scene_of, side_wall

BOARD = PRESETS["xwr1443boost"]

NEAREST_M, AZIMUTH_DEG, LEVELS_DB, ASIDE_M = 1.0, 75.0, 12.0, 5.0
ROOM = scene_of((floor(), back_wall(), side_wall(2.5)))


def test_as_much_comes_back_from_every_metre_as_was_recorded():
    """The mean power a metre of range is that of the stated cross section at 2 m, up to 12 dB more by the room."""
    # the radar equation (docs/radar_primer.md, 10): 12 dBm, 10.5 dBi each way, 79 GHz, 1.5e-4 m2 at 2 m, in mW
    wavelength_m = 299_792_458 / 79.06e9
    stated = 10 ** ((12 + 2 * 10.5) / 10) * wavelength_m**2 * 1.5e-4 / ((4 * np.pi) ** 3 * 2.0**4)
    profiles = []
    for seed in range(20):
        paths = diffuse_clutter(AWR1843, seed, ROOM)
        range_m = paths.length_m.mean(dim=(1, 2)).numpy() / 2
        profiles.append(np.histogram(range_m, np.arange(1.0, 7.1), weights=np.abs(paths.amplitude.numpy()) ** 2)[0])
        profiles[-1] = profiles[-1] / room_level(seed)
        assert range_m.min() > NEAREST_M - 1e-3
    assert np.mean(profiles, axis=0)[1:] == pytest.approx(stated, rel=0.25)
    levels_db = 10 * np.log10([room_level(seed) for seed in range(100)])
    assert 0 <= levels_db.min() < 1 < 11 < levels_db.max() <= LEVELS_DB


def test_it_comes_from_the_sides_too_but_not_from_beyond_five_metres():
    power, across = np.zeros(4), np.linspace(0, np.sin(np.radians(AZIMUTH_DEG)), 5)
    for seed in range(8):
        paths = diffuse_clutter(AWR1843, seed, ROOM)
        place_m, each = paths.departure_vertex_m.numpy(), np.abs(paths.amplitude.numpy()) ** 2 / room_level(seed)
        assert np.abs(place_m[:, 0]).max() < ASIDE_M
        near = np.linalg.norm(place_m, axis=1) < ASIDE_M
        sine = np.abs(np.sin(np.arctan2(place_m[near, 0], place_m[near, 1])))
        power += np.histogram(sine, across, weights=each[near])[0]
    assert 10 * np.log10(power.max() / power.min()) < 6


def test_amplitudes_are_spikier_than_a_gaussian_sum():
    """A gamma distribution with shape 0.5 has a variance of two means squared."""
    paths = diffuse_clutter(AWR1843, 0, ROOM)
    range_m = paths.length_m.mean(dim=(1, 2)).numpy() / 2
    near = (range_m > 2) & (range_m < 8)
    ahead = near & (np.abs(paths.departure_vertex_m.numpy()[:, 0]) < 0.2 * range_m)
    power = np.abs(paths.amplitude.numpy()[ahead]) ** 2
    assert power.var() / power.mean() ** 2 > 1.5


def test_two_radars_see_the_same_patches_with_phases_of_their_own():
    """Places and textures are the room's; a radar elsewhere is as coherent with the first as with other range bins."""
    cubes = []
    pose = RadarPose(x_m=1.0, y_m=0.8, yaw_deg=-45.0)
    for one in (RadarPose(), pose):
        scene = scene_seen_from(ROOM, one)
        paths = diffuse_clutter(BOARD, 3, scene)
        cubes.append(CubeRenderer(BOARD).static(paths).layer().numpy())
    level_m = [
        one.in_level_frame(diffuse_clutter(BOARD, 3, scene_seen_from(ROOM, one)).departure_vertex_m.numpy())
        for one in (RadarPose(), pose)
    ]
    rounded = [set(map(tuple, np.round(places, 3))) for places in level_m]
    assert len(rounded[0] & rounded[1]) > 0.3 * min(map(len, rounded))
    first, second = (cube / np.linalg.norm(cube, axis=1, keepdims=True) for cube in cubes)
    bins = np.flatnonzero((BOARD.range_m > 6) & (BOARD.range_m < 11))
    coherence = np.abs(first[bins].conj() @ second[bins].T)
    assert np.median(np.diag(coherence)) == pytest.approx(np.median(coherence), abs=0.08)  # 0.98 against 0.36 before


def test_a_step_of_the_radar_turns_the_phases_by_its_part_along_each_line_of_sight():
    step_m = 1e-3
    for pose in (RadarPose(x_m=step_m), RadarPose(y_m=step_m)):
        before = diffuse_clutter(BOARD, 3, ROOM)
        after = diffuse_clutter(BOARD, 3, scene_seen_from(ROOM, pose))
        place_m = before.departure_vertex_m.numpy()
        moved_m = after.departure_vertex_m.numpy() + pose.position_m
        common = np.argmin(np.linalg.norm(place_m[:200, None] - moved_m[None], axis=-1), axis=1)
        changed_m = (after.length_m[common] - before.length_m[:200]).mean(dim=(1, 2)).numpy()
        along = place_m[:200] @ pose.position_m / np.linalg.norm(place_m[:200], axis=1)
        assert changed_m == pytest.approx(-2 * along, abs=5e-6)
        turn = np.angle(after.amplitude[common].numpy() / before.amplitude[:200].numpy())
        assert np.abs(turn).max() < 1e-6  # the rest of the phase is the patch's own


def test_the_front_door_has_it_and_the_ray_tracer_only_where_asked():
    scene = scene_of((floor(), back_wall()))
    counts = {}
    for clutter in (False, True):
        room = Simulator(scene, AWR1843, IDEAL, propagation=Propagation(clutter=clutter)).room
        counts[clutter] = int((room.paths.interaction == int(Interaction.CLUTTER)).sum())
    assert counts[False] == 0
    assert counts[True] > 1000
    assert Physics().propagation.clutter


def test_rooms_have_clutter_of_their_own_and_keep_it():
    """Whatever the sequence's seed is: clutter belongs to the room, and another room's is not this one's."""
    rooms = [scene_of((floor(), back_wall())), scene_of((floor(),))]
    seeds = [seed_of_room(room) for room in rooms]
    assert seeds[0] != seeds[1]
    moved = replace(rooms[0], vertices_m=rooms[0].vertices_m * (1 + 1e-7))  # as another processor rounds
    assert seed_of_room(moved) == seeds[0]
    physics = Physics()
    clutter = []
    for seed, room in ((0, rooms[0]), (1, rooms[0]), (0, rooms[1])):
        physics(room, (), AWR1843, num_frames=1, seed=seed, keep_adc=False, stages=Stages())
        paths = physics._prepared.get(room, AWR1843, None, None).room.paths
        clutter.append(paths.amplitude[paths.interaction == int(Interaction.CLUTTER)].numpy())
    assert np.array_equal(clutter[0], clutter[1])
    assert not np.array_equal(clutter[0], clutter[2])
