"""The clutter's level is the one asked for, and it hides bodies at rest but not those that move."""

from dataclasses import replace

import numpy as np

from mmweaver.core.firmware_settings import FIRMWARE
from mmweaver.core.presets import IWR1443_RADHAR
from mmweaver.tasks.diffuse_clutter import AT_M, diffuse_clutter
from mmweaver.tasks.generation import Recipe, generate_window
from mmweaver.tasks.variation import Variation


def test_its_level_is_told_in_a_range_bin_over_the_noise_of_a_chirp():
    config = IWR1443_RADHAR
    rng = np.random.default_rng(0)
    samples = np.stack([diffuse_clutter(config, 10.0, rng) for _ in range(40)])
    power = np.mean(np.abs(np.fft.fft(samples, axis=-1) / config.num_samples) ** 2, axis=(0, 1, 2))
    noise = config.noise_power_mw / config.num_samples
    at = round(AT_M / config.range_resolution_m)
    assert abs(10 * np.log10(power[at - 3 : at + 4].mean() / noise) - 10.0) < 1.0
    assert abs(10 * np.log10(power[2 * at - 3 : 2 * at + 4].mean() / noise) - 4.0) < 1.0
    assert power[0] < 1e-6 * power[at]


def test_it_hides_what_rests_and_hardly_what_moves():
    quiet = Variation(
        turn_deg=0.0, roam_mps=(0.0, 0.0), noise_db=(0.0, 0.0), wall_share=0.0, most_panels=0, clutter_db=(-40.0, -40.0)
    )
    recipe = Recipe(
        activities={"walk": ("a person walks towards the radar",), "stand": ("a person stands",)},
        radar=IWR1443_RADHAR, firmware=FIRMWARE["iwr1443_radhar"], variation=quiet, window_s=0.4,
    )  # fmt: skip
    loud = replace(recipe, variation=replace(quiet, clutter_db=(14.0, 14.0)))
    counts = {}
    for label in recipe.activities:
        for name, one in (("quiet", recipe), ("loud", loud)):
            cloud = generate_window(one, label, 0, 3).cloud
            range_m = np.hypot(cloud.x_m, cloud.y_m)
            counts[label, name] = (np.abs(cloud.radial_velocity_mps) > 0.9)[range_m < 3].sum(), (range_m < 3).sum()
    resting = counts["stand", "loud"][1] / counts["stand", "quiet"][1]
    moving = counts["walk", "loud"][0] / counts["walk", "quiet"][0]
    assert resting < 0.8 * moving
    assert moving > 0.5
