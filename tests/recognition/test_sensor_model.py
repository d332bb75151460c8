"""What a board reports: people below its beam, and less of a stationary body the more diffuse clutter there is."""

from dataclasses import replace

import numpy as np
import pytest

from mmweaver.core.boards import IWR1443_RADHAR, PRESETS
from mmweaver.core.firmware_settings import FirmwareSettings
from mmweaver.core.records import PointCloud
from mmweaver.recognition.generated_sequences import AT_M, PointRadar, diffuse_clutter, observed_cloud
from mmweaver.recognition.random_scene import Variation
from mmweaver.recognition.subject_simulation import Performance, PerformancePrior, perform, performer

FRAMES, HIGH_M, DOWN_DEG = 3, 2.6, 30.0
BOARD = PointRadar(
    radar=replace(PRESETS["iwr1443_radhar"], num_loops=8), firmware=FirmwareSettings(group_range=False), skin_points=300
)
VARIATION = Variation(
    radar_height_m=(HIGH_M, HIGH_M), tilt_deg=(0.0, 0.0), most_panels=0, wall_share=0.0, clutter_db=(-30.0, -30.0),
    noise_db=(0.0, 0.0), gain_db=(0.0, 0.0), threshold_db=(0.0, 0.0), elevation_beamwidth_deg=(25.0, 25.0),
    distance_m=(2.4, 2.4), azimuth_deg=(0.0, 0.0), albedo_db=(0.0, 0.0),
)  # fmt: skip


@pytest.fixture(scope="module")
def performance() -> Performance:
    who = performer(PerformancePrior(), VARIATION, 0, 0)
    return perform(who, PerformancePrior(), "a person waves", seconds=0.5, once=False, rng=np.random.default_rng(0))


def body_cloud(performance: Performance, **conditions: float) -> PointCloud:
    """Points near the person under other conditions than sampled."""
    cloud = observed_cloud(BOARD, replace(performance.surroundings, **conditions), performance.pose, FRAMES, seed=1)
    return cloud.select((cloud.range_m > 1.8) & (cloud.range_m < 3.6))


def test_a_beam_that_is_turned_down_finds_who_is_below(performance: Performance):
    level, down = body_cloud(performance), body_cloud(performance, tilt_deg=DOWN_DEG)
    assert len(down.frame) >= len(level.frame) + 2 * FRAMES
    # in the board's axes the chest, 1.2 to 1.5 m below it, lies about straight ahead
    assert abs(np.median(down.z_m)) < 0.5


def test_diffuse_clutter_masks_points_at_rest(performance: Performance):
    quiet, loud = (body_cloud(performance, tilt_deg=DOWN_DEG, clutter_db=level_db) for level_db in (-40.0, 20.0))
    still = [int((cloud.radial_velocity_mps == 0).sum()) for cloud in (quiet, loud)]
    assert still[0] > 5
    assert still[1] < 0.7 * still[0]


def test_the_level_of_diffuse_clutter_is_relative_to_the_noise_of_a_chirp_in_a_range_bin():
    config = IWR1443_RADHAR
    rng = np.random.default_rng(0)
    samples = np.stack([diffuse_clutter(config, 10.0, rng) for _ in range(40)])
    power = np.mean(np.abs(np.fft.fft(samples, axis=-1) / config.num_samples) ** 2, axis=(0, 1, 2))
    noise = config.noise_power_mw / config.num_samples
    at = round(AT_M / config.range_resolution_m)
    assert abs(10 * np.log10(power[at - 3 : at + 4].mean() / noise) - 10.0) < 1.0
    assert abs(10 * np.log10(power[2 * at - 3 : 2 * at + 4].mean() / noise) - 4.0) < 1.0
    assert power[0] < 1e-6 * power[at]
