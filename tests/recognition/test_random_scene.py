"""Sampled conditions stay within their ranges; open rooms echo where they should."""

import numpy as np

from mmweaver.core.seeding import stream
from mmweaver.recognition.random_scene import CHEST_M, Variation, closed_room, hung_high, sample_variation


def test_samples_fill_their_ranges():
    variation = Variation()
    samples = [sample_variation(variation, stream(seed, "draw")) for seed in range(300)]
    for name in ("tempo", "vigour", "distance_m", "height_m", "noise_db", "threshold_db", "gain_db"):
        low, high = getattr(variation, name)
        values = np.array([getattr(one, name) for one in samples])
        assert low <= values.min() < low + 0.1 * (high - low), name
        assert high >= values.max() > high - 0.1 * (high - low), name
    walls = [one.wall_m is not None for one in samples]
    assert abs(np.mean(walls) - variation.wall_share) < 0.1
    assert {one.skin_exponent for one in samples} == set(variation.skin_exponents)


def test_the_start_is_at_its_distance():
    one = sample_variation(Variation(), stream(0, "draw"))
    assert np.isclose(np.hypot(*one.start_m), one.distance_m)
    assert np.isclose(np.degrees(np.arctan2(*one.start_m)), one.azimuth_deg)


def test_a_share_of_the_radars_hangs_high_and_looks_down():
    variation = Variation(high_share=0.4, high_m=(1.8, 3.0), tilt_deg=(0.0, 0.0))
    before = [sample_variation(variation, stream(seed, "draw")) for seed in range(200)]
    after = [hung_high(one, variation, stream(seed, "mount")) for seed, one in enumerate(before)]
    high = [one for one in after if one.tilt_deg > 0.0]
    assert abs(len(high) / len(after) - 0.4) < 0.1
    for one in high:
        below_deg = np.degrees(np.arctan2(one.radar_height_m - CHEST_M, one.distance_m))
        assert 1.8 <= one.radar_height_m <= 3.0
        assert 0.1 * below_deg < one.tilt_deg < 1.2 * below_deg
    assert all(one in before for one in after if one not in high)
    assert all(hung_high(one, Variation(), stream(0, "mount")) is one for one in before[:3])


def test_a_closed_room_has_walls_all_round_radar_and_people():
    people = np.array([[-3.0, 2.0], [2.5, 8.0], [0.0, 1.0]])
    room = closed_room(floor_z_m=-1.2, people_m=people, panels=(), rng=stream(3, "room"))
    walls = [plane for plane in room.planes if plane.kind == "wall"]
    assert len(walls) == 4
    for plane in walls:  # normals point inwards
        away_m = (np.column_stack([people, np.zeros(3)]) - plane.centre_m) @ plane.normal
        assert away_m.min() > 0.39
        assert -plane.centre_m @ plane.normal > 0.29  # the radar is inside, too
    (ceiling,) = [plane for plane in room.planes if plane.kind == "ceiling"]
    assert 2.4 <= ceiling.centre_m[2] + 1.2 <= 3.0
    assert room.floor_z_m == -1.2
