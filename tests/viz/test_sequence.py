"""What the page plays shows the person where the radar sees the person."""

import numpy as np
import pytest

from mmweaver import Weaver
from mmweaver.core.aligned_photo import AlignedPhoto
from mmweaver.core.skeleton import joint
from mmweaver.viz.sequence import Playback, make_playback, room_playback
from mmweaver.weaver.generation import Generation


@pytest.fixture(scope="module")
def walk() -> Generation:
    weaver = Weaver()
    return weaver.generate(weaver.sample_room(), "a person walks towards the radar", frames=20, seed=0)


@pytest.fixture(scope="module")
def played(walk: Generation) -> Playback:
    return make_playback(walk.cube, walk.points, walk.poses, walk.meta)


def test_maps_are_decibels_on_one_scale(walk: Generation, played: Playback):
    low, high = played.header["db"]["low"], played.header["db"]["high"]
    power = (np.abs(walk.cube.values[3]) ** 2).mean(axis=-1) * walk.cube.scale**2
    shown = low + played.arrays["range_doppler"][3] / 255 * (high - low)
    above = 10 * np.log10(power) > low
    assert above.mean() > 0.5
    np.testing.assert_allclose(shown[above], 10 * np.log10(power[above]), atol=(high - low) / 255)
    assert played.header["db"]["unit"] == "dBm"


def test_noise_is_in_sight(played: Playback):
    cells = played.arrays["range_doppler_moving"]
    assert 0 < np.median(cells) < 60
    assert played.header["db"]["low"] < played.header["db"]["noise"] < played.header["db"]["high"]


def test_the_strongest_moving_range_lies_within_the_body(walk: Generation, played: Playback):
    joints_m = played.arrays["joints"][0]
    near, far = played.header["range_m"]
    strongest = played.arrays["range_time"].argmax(axis=1)
    range_m = near + (strongest + 0.5) * (far - near) / played.arrays["range_time"].shape[1]
    distance_m = np.linalg.norm(joints_m, axis=-1)
    inside = (range_m > distance_m.min(axis=1) - 0.2) & (range_m < distance_m.max(axis=1) + 0.2)
    assert inside.mean() > 0.9
    pelvis_m = np.linalg.norm(joints_m[:, joint("pelvis")], axis=-1)
    assert pelvis_m[10] < pelvis_m[0] - 0.3


def test_parts_of_the_body_follow_the_joints(played: Playback):
    joints_m, capsules_m = played.arrays["joints"], played.arrays["capsules"]
    assert capsules_m.shape[:2] == joints_m.shape[:2]
    nearest_m = np.linalg.norm(capsules_m[..., None, :3] - joints_m[:, :, None], axis=-1).min(axis=-1)
    assert nearest_m.max() < 1e-5
    assert (played.arrays["radii"] > 0.01).all()


def test_points_are_those_of_their_frame(walk: Generation, played: Playback):
    np.testing.assert_array_equal(played.arrays["point_frame"], walk.points.frame)
    np.testing.assert_allclose(played.arrays["points"][:, 1], walk.points.y_m, rtol=1e-6)


def test_a_recording_has_neither_people_nor_a_unit(walk: Generation):
    from dataclasses import replace

    shown = make_playback(replace(walk.cube, scale=float("nan")), walk.points)
    assert shown.header["people"] == 0
    assert "joints" not in shown.arrays
    assert "uncalibrated" in shown.header["db"]["unit"]


def test_the_room_is_where_the_scene_is(walk: Generation):
    shown = room_playback(walk.scene, "demo", (0.7, 3.4), max_points=5000)
    points_m = shown.arrays["room_points"] / 1000
    assert 1000 < len(points_m) <= 5000
    assert abs(np.percentile(points_m[:, 2], 1) - walk.scene.floor_z_m) < 0.2
    sides_m = np.linalg.norm(np.diff(points_m[shown.arrays["room_faces"][:, [0, 1, 2, 0]]], axis=1), axis=-1)
    assert np.median(sides_m) < 0.15
    assert sides_m.max() < 2  # no triangle spans from an object to the wall behind it
    pixels, _ = AlignedPhoto.of(walk.scene).project(points_m)
    height, width = walk.scene.photo.depth_m.shape
    place = (pixels + 0.5) / (width, height)
    assert np.abs(shown.arrays["room_uv"] / 32767 - place).max() < 0.002
    free = shown.arrays["free_floor"]
    assert len(free) == walk.scene.free_space.is_free.sum()
    standing = free[shown.arrays["standable"].astype(bool)]
    assert 0 < len(standing) < len(free)
    assert np.linalg.norm(standing, axis=1).max() < 3.4
    assert {plane["kind"] for plane in shown.header["planes"]} == {plane.kind for plane in walk.scene.planes}
