"""A board that looks down has its beam on people below it, and reports them higher in its own axes."""

from dataclasses import replace

import numpy as np
import pytest

from mmweaver.core.firmware_settings import FirmwareSettings
from mmweaver.core.presets import PRESETS
from mmweaver.core.records import PointCloud
from mmweaver.recognition.observed_points import PointRadar, observed_cloud
from mmweaver.recognition.performance import Performance, PerformancePrior, perform, performer
from mmweaver.recognition.variation import Variation

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
    prior = PerformancePrior()
    who = performer(prior, VARIATION, 0, 0)
    return perform(who, prior, "a person waves", seconds=0.5, once=False, rng=np.random.default_rng(0))


def body_points(performance: Performance, tilt_deg: float) -> PointCloud:
    now = replace(performance.surroundings, tilt_deg=tilt_deg)
    cloud = observed_cloud(BOARD, now, performance.pose, FRAMES, seed=1)
    return cloud.select((cloud.range_m > 1.8) & (cloud.range_m < 3.6))


def test_a_beam_that_is_turned_down_finds_who_is_below(performance: Performance):
    level, down = body_points(performance, 0.0), body_points(performance, DOWN_DEG)
    assert len(down.frame) >= len(level.frame) + 2 * FRAMES
    # in the board's axes the chest, 1.2 to 1.5 m below it, lies about straight ahead
    assert abs(np.median(down.z_m)) < 0.5
