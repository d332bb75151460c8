"""Quantiles of clouds, and generated SNR against range held to that of a recorded board."""

from pathlib import Path

import numpy as np
import pytest

from mmweaver.recognition.generated_sequences import SequenceRecipe, generate_sequence
from mmweaver.recognition.task_file import read_task
from studies.recognition.cloud_quantiles import RECORDED, THRESHOLD_DB, quantiles, with_thresholds
from tests.recognition.clouds import recording_of

TASK = Path(__file__).resolve().parents[3] / "examples" / "tasks" / "iwr6843.toml"


def test_quantiles_of_known_points():
    frame = np.repeat(np.arange(20), 3)
    x, y, velocity = np.tile([0.0, 1.0, 0.0], 20), np.tile([2.5, 2.5, 7.0], 20), np.tile([0.5, 0.5, 0.0], 20)
    found = quantiles(
        [recording_of(frame, x_m=x, y_m=y, velocity_mps=velocity, snr_db=np.tile([10.0, 20.0, 50.0], 20))]
    )
    assert (found["moving points"], found["static points"], found["share beyond 6 m"]) == (2, 1, 0)
    assert found["SNR 2-3 m"] == 15
    assert np.isnan(found["SNR 6-9 m"])
    assert found["span across"] == 1.0
    assert found["span in range"] == pytest.approx(np.hypot(1, 2.5) - 2.5)


@pytest.mark.slow  # the reported share of SNR has a fast test in tests/signal/test_firmware_cfar.py
def test_snr_falls_with_range_as_recorded():
    """Median SNR of a walker within 3.5 dB of the recorded one at each range (3.1 dB off at 3 to 4 m)."""
    recipe = SequenceRecipe.of(with_thresholds(read_task(TASK), THRESHOLD_DB))
    found = quantiles([generate_sequence(recipe, "walk", index) for index in range(8)])
    for name in ("SNR 2-3 m", "SNR 3-4 m", "SNR 4-6 m", "SNR 6-9 m"):
        assert found[name] == pytest.approx(RECORDED["walk"][name], abs=3.5), name
    assert found["SNR 2-3 m"] > found["SNR 3-4 m"] > found["SNR 6-9 m"]
