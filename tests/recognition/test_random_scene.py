"""Sampled conditions stay within their ranges; open rooms echo where they should."""

import numpy as np

from mmweaver.core.boards import IWR1443_RADHAR
from mmweaver.core.seeding import stream
from mmweaver.propagation.ray_traced import Simulator
from mmweaver.recognition.random_scene import CHEST_M, Panel, Variation, hung_high, random_scene, sample_variation


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


def test_a_panel_echoes_at_its_range():
    panel = Panel(centre_m=(1.0, 2.0, 0.0), half_size_m=(0.4, 0.4), turn_rad=0.46, material="metal")
    bare = Simulator(random_scene(floor_z_m=-1.0, wall_y_m=None), IWR1443_RADHAR)
    room = Simulator(random_scene(floor_z_m=-1.0, wall_y_m=None, panels=(panel,)), IWR1443_RADHAR)
    spectra = [np.abs(np.fft.fft(one.room_adc[0, 0] * np.hanning(240))) for one in (bare, room)]
    at = round(float(np.hypot(1.0, 2.0)) / IWR1443_RADHAR.range_resolution_m)
    near = slice(at - 4, at + 5)
    assert spectra[1][near].max() > 3 * spectra[0][near].max()


def test_nobody_walks_through_the_wall_and_the_floor_is_at_its_height():
    scene = random_scene(floor_z_m=-0.8, wall_y_m=3.0)
    assert scene.free_space.is_free[scene.free_space.y_m < 2.9].all()
    assert not scene.free_space.is_free[scene.free_space.y_m > 3.0].any()
    assert scene.floor.centre_m[2] == -0.8
