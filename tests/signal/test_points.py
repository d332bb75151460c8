"""The point cloud's rules: limits, order, arrays without elevation, bad input. Truths are in tests/physics."""

from dataclasses import replace

import numpy as np
import pytest

from mmweaver.core.boards import AWR1843, BGT60
from mmweaver.core.errors import InputError
from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.records import AdcCube, RadarCube
from mmweaver.core.seeding import stream
from mmweaver.signal.cube import radar_cube
from mmweaver.signal.points import point_cloud


def noise_cube(config: RadarConfig, num_frames: int = 4) -> RadarCube:
    draw = stream(0, "test points", config.name)
    shape = (num_frames, config.num_loops, config.num_tx, config.num_rx, config.num_samples, 2)
    samples = draw.standard_normal(shape, dtype=np.float32).view(np.complex64)[..., 0]
    if not config.complex_samples:
        samples = samples.real + np.complex64(0)
    return radar_cube(AdcCube(samples=samples, config=config, scale=1.0))


def test_a_frame_has_its_strongest_points_only():
    cube = noise_cube(AWR1843)
    everything = point_cloud(cube, false_alarm_rate=0.2, max_points_per_frame=100_000)
    few = point_cloud(cube, false_alarm_rate=0.2, max_points_per_frame=7)
    assert few.frame.tolist() == [frame for frame in range(4) for _ in range(7)]
    for frame in range(4):
        strongest = np.sort(everything.snr_db[everything.frame == frame])[::-1][:7]
        assert few.snr_db[few.frame == frame] == pytest.approx(strongest)


def test_points_lie_in_the_field_of_view():
    points = point_cloud(noise_cube(AWR1843), false_alarm_rate=0.2)
    range_m = np.sqrt(points.x_m**2 + points.y_m**2 + points.z_m**2)
    half_m = AWR1843.range_resolution_m / 2
    assert (points.y_m >= 0).all()
    assert range_m.min() >= AWR1843.range_m[0] - half_m
    assert range_m.max() <= AWR1843.range_m[-1] + half_m
    assert np.abs(points.radial_velocity_mps).max() <= AWR1843.max_velocity_mps


def test_leakage_does_not_come_back_at_the_end_of_the_range_axis():
    """Complex samples: the last bin follows on range 0. A strong tone there leaks into both."""
    config = replace(AWR1843, first_range_bin=0, num_range_bins=AWR1843.num_samples)
    shape = (2, config.num_loops, config.num_tx, config.num_rx, config.num_samples)
    tone = 1000 * np.exp(2j * np.pi * 0.2 * np.arange(config.num_samples) / config.num_samples)
    noise = stream(0, "test leakage").standard_normal((*shape, 2)).view(np.complex128)[..., 0]
    points = point_cloud(radar_cube(AdcCube(samples=(tone + noise).astype(np.complex64), config=config, scale=1.0)))
    range_m = np.sqrt(points.x_m**2 + points.y_m**2 + points.z_m**2)
    assert (range_m < 5 * config.range_resolution_m).any()
    assert range_m.max() < 0.9 * config.max_range_m


def test_moving_only_has_no_static_points():
    points = point_cloud(noise_cube(AWR1843), false_alarm_rate=0.2, moving_only=True)
    assert len(points.frame) > 100
    assert np.abs(points.radial_velocity_mps).min() > 1.49 * AWR1843.velocity_resolution_mps


def test_arrays_without_elevation_or_azimuth():
    flat = replace(AWR1843, tx_position_m=AWR1843.tx_position_m[:1], tx_order=(0,))
    points = point_cloud(noise_cube(flat), false_alarm_rate=0.05)
    assert len(points.frame)
    assert not points.z_m.any()
    single = replace(flat, rx_position_m=flat.rx_position_m[:1])
    points = point_cloud(noise_cube(single), false_alarm_rate=0.05)
    assert len(points.frame)
    assert not points.x_m.any()


def test_a_radar_with_few_loops_works():
    assert len(point_cloud(noise_cube(BGT60), false_alarm_rate=0.05).frame)


@pytest.mark.parametrize(
    ("change", "word"), [({"max_points_per_frame": 0}, "at least 1, not 0"), ({"false_alarm_rate": 2.0}, "between")]
)
def test_bad_input_is_refused(change: dict, word: str):
    with pytest.raises(InputError, match=word):
        point_cloud(noise_cube(BGT60), **change)
