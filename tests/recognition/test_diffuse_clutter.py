"""The clutter has the requested level and masks stationary bodies."""

from dataclasses import replace

import numpy as np

from mmweaver.core.firmware_settings import FIRMWARE
from mmweaver.core.presets import IWR1443_RADHAR
from mmweaver.recognition.diffuse_clutter import AT_M, diffuse_clutter
from mmweaver.recognition.generated_windows import GenerationRecipe, generate_window
from mmweaver.recognition.variation import Variation


def test_its_level_is_relative_to_the_noise_of_a_chirp_in_a_range_bin():
    config = IWR1443_RADHAR
    rng = np.random.default_rng(0)
    samples = np.stack([diffuse_clutter(config, 10.0, rng) for _ in range(40)])
    power = np.mean(np.abs(np.fft.fft(samples, axis=-1) / config.num_samples) ** 2, axis=(0, 1, 2))
    noise = config.noise_power_mw / config.num_samples
    at = round(AT_M / config.range_resolution_m)
    assert abs(10 * np.log10(power[at - 3 : at + 4].mean() / noise) - 10.0) < 1.0
    assert abs(10 * np.log10(power[2 * at - 3 : 2 * at + 4].mean() / noise) - 4.0) < 1.0
    assert power[0] < 1e-6 * power[at]


def test_it_masks_a_stationary_body():
    quiet = Variation(
        turn_deg=0.0, roam_mps=(0.0, 0.0), noise_db=(0.0, 0.0), wall_share=0.0, most_panels=0, clutter_db=(-40.0, -40.0)
    )
    recipe = GenerationRecipe(
        activities={"walk": ("a person walks towards the radar",), "stand": ("a person stands",)},
        radar=IWR1443_RADHAR, firmware=FIRMWARE["iwr1443_radhar"], variation=quiet, window_s=0.4,
    )  # fmt: skip
    loud = replace(recipe, variation=replace(quiet, clutter_db=(14.0, 14.0)))
    counts = []
    for one in (recipe, loud):
        cloud = generate_window(one, "stand", 0, 3).cloud
        counts.append(int((np.hypot(cloud.x_m, cloud.y_m) < 3).sum()))
    assert counts[0] > 20
    assert counts[1] < 0.7 * counts[0]
