"""Doppler, phase and displacement over frames, of a radar with one or two loops a frame."""

from dataclasses import replace

import numpy as np
import pytest

from mmweaver.core.boards import AWR1843
from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.records import AdcCube, RadarCube
from mmweaver.propagation.reference_sum import exact_frame
from mmweaver.signal.cube import radar_cube, remove_static
from mmweaver.signal.points import point_cloud
from mmweaver.signal.slow_time import circle_centre, moving_cells, slow_time_doppler
from mmweaver.signal.spectra import range_doppler_power
from mmweaver.signal.vital_signs import breathing_rate, heart_rate

SLOW = replace(
    AWR1843, name="slow", num_loops=1, num_samples=64, sample_rate_hz=1.13e6, frame_period_s=0.05, first_range_bin=0,
    num_range_bins=64, tx_position_m=AWR1843.tx_position_m[:1], tx_order=(0,),
)  # fmt: skip
BREATH_HZ, HEART_HZ = 0.27, 1.23


def recorded(config: RadarConfig, place_m, num_frames: int, noise: float = 1e-3) -> RadarCube:
    """A point whose distance is a function of time, and a wall twice as strong in the same range bin."""
    rng = np.random.default_rng(0)
    frames = []
    for frame in range(num_frames):
        start_s = frame * config.frame_period_s

        def position_m(time_s: np.ndarray, start_s: float = start_s) -> np.ndarray:
            moving = np.zeros((2, len(time_s), 3))
            moving[0, :, 1] = place_m(start_s + time_s)
            moving[1, :, 1] = 1.21
            return moving

        frames.append(exact_frame(position_m, np.array([1.0, 2.0j]), config))
    samples = np.array(frames)
    samples = samples + noise * (rng.standard_normal(samples.shape) + 1j * rng.standard_normal(samples.shape))
    return radar_cube(AdcCube(samples=samples.astype(np.complex64), config=config, scale=1.0))


def breathing(time_s: np.ndarray) -> np.ndarray:
    breath = 4e-3 * np.sin(2 * np.pi * BREATH_HZ * time_s) + 0.8e-3 * np.sin(4 * np.pi * BREATH_HZ * time_s)
    return 1.2 + breath + 0.25e-3 * np.sin(2 * np.pi * HEART_HZ * time_s)


@pytest.fixture(scope="module")
def sitter() -> RadarCube:
    return recorded(SLOW, breathing, 500)


def test_displacement_and_rates_of_somebody_who_sits(sitter: RadarCube):
    cell = moving_cells(sitter)[0]
    assert cell.range_m == pytest.approx(1.2, abs=SLOW.range_resolution_m)
    assert cell.has_centre
    truth = breathing(sitter.grid.frame_time_s + SLOW.chirp_period_s / 2)
    assert np.abs(cell.displacement_m - (truth - truth.mean())).max() < 0.3e-3
    breath = breathing_rate(cell.displacement_m, SLOW.frame_period_s)
    heart = heart_rate(cell.displacement_m, SLOW.frame_period_s, breath)
    assert breath.is_clear
    assert breath.frequency_hz == pytest.approx(BREATH_HZ, abs=0.01)
    assert heart.is_clear
    assert heart.frequency_hz == pytest.approx(HEART_HZ, abs=0.02)


def test_noise_far_from_what_moves_is_no_cell_of_movement(sitter: RadarCube):
    cells = moving_cells(sitter, count=50)
    assert cells
    assert max(abs(cell.range_m - 1.2) for cell in cells) < 4 * SLOW.range_resolution_m
    assert [cell.moving_power for cell in cells] == sorted((cell.moving_power for cell in cells), reverse=True)


def test_slow_time_doppler_has_the_right_velocity_and_sign():
    cube = recorded(SLOW, lambda time_s: 1.4 + 6e-3 * time_s, 64)
    power, velocity_mps = slow_time_doppler(cube)
    row, column = np.unravel_index(power.argmax(), power.shape)
    assert cube.grid.range_m[row] == pytest.approx(1.4, abs=SLOW.range_resolution_m)
    assert velocity_mps[column] == pytest.approx(6e-3, abs=velocity_mps[1] - velocity_mps[0])


@pytest.mark.parametrize("num_loops", [1, 2, 3])
def test_each_thing_is_one_point_a_frame_and_clutter_removal_leaves_what_moves(num_loops: int):
    config = replace(SLOW, num_loops=num_loops)
    cube = recorded(config, lambda time_s: 2.3 + 6e-3 * time_s, 16)
    cloud = point_cloud(cube)
    for frame in range(16):
        at_m = np.hypot(cloud.x_m, cloud.y_m)[(cloud.frame == frame) & (np.abs(cloud.x_m) < 0.05)]
        assert sorted(at_m) == pytest.approx([1.21, 2.3], abs=0.03)
    power = range_doppler_power(remove_static(cube)).sum(axis=(0, 2))
    assert power[round(1.21 / config.range_resolution_m)] < 1e-3 * power.max()
    assert power.argmax() == round(2.3 / config.range_resolution_m)


def test_every_chirp_of_a_short_frame_counts():
    """A rectangular window: two loops have half the noise of one."""
    rng = np.random.default_rng(1)
    levels = []
    for num_loops in (1, 2):
        config = replace(SLOW, num_loops=num_loops)
        shape = (400, num_loops, 1, 4, 64)
        noise = (rng.standard_normal(shape) + 1j * rng.standard_normal(shape)).astype(np.complex64)
        cube = radar_cube(AdcCube(samples=noise, config=config, scale=1.0))
        levels.append(np.mean(np.abs(cube.values) ** 2))
    assert levels[0] / levels[1] == pytest.approx(2.0, rel=0.05)


def test_a_rate_in_noise_is_not_clear():
    """As large as breathing, but with power at all frequencies: most recordings of 30 s do not seem to breathe."""
    rng = np.random.default_rng(3)
    found = [breathing_rate(1e-3 * rng.standard_normal(600), 0.05) for _ in range(100)]
    hearts = [heart_rate(1e-3 * rng.standard_normal(600), 0.05) for _ in range(100)]
    assert sum(rate.is_clear for rate in found) < 50
    assert sum(rate.is_clear for rate in hearts) < 10


def test_nothing_is_invented():
    rng = np.random.default_rng(2)
    noise = np.cumsum(rng.standard_normal(400)) * 1e-6
    assert not breathing_rate(noise, 0.05).is_clear  # too small
    assert breathing_rate(noise[:10], 0.05) is None
    assert heart_rate(noise, 0.5) is None  # two frames a second
    assert circle_centre(np.linspace(0, 1, 50) + 0j) is None  # a line
    cube = recorded(SLOW, lambda time_s: 1.4 + 0 * time_s, 4)
    assert moving_cells(cube) == []
