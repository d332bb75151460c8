"""Gain and CFAR threshold come back from clouds of a simulated person who did something else, somewhere else."""

from dataclasses import replace

import numpy as np
import pytest

from mmweaver.calibration import cloud_levels
from mmweaver.calibration.calibrate import calibrate
from mmweaver.calibration.cloud_levels import CloudLevels, fit_levels, match_levels
from mmweaver.core.board import Board
from mmweaver.core.firmware_settings import FIRMWARE, FirmwareSettings
from mmweaver.core.presets import IWR1443_MARS
from mmweaver.dsp.firmware import FirmwareCloud, firmware_points
from mmweaver.motion.empty_floor import act_out, empty_floor
from mmweaver.paths.ray_traced import Simulator

SETTINGS = FIRMWARE["iwr1443_mars"]


def cloud(gain_db: float, threshold: int, seed: int = 40, text: str = cloud_levels.DOING) -> FirmwareCloud:
    """Thirty frames of somebody 1.9 m ahead."""
    pose = act_out(text, duration_s=3.0, seed=seed).pose
    shift = np.array([*(np.array([0.2, 1.9]) - pose.joints_m[:, 0, :2].mean(axis=0)), 0.0])
    simulator = Simulator(empty_floor(), IWR1443_MARS, board=Board(name="made", gain_db=gain_db))
    adc = simulator.run(replace(pose, joints_m=pose.joints_m + shift), num_frames=30, seed=seed).adc
    return firmware_points(adc, SETTINGS.with_threshold(threshold))


@pytest.mark.slow  # that levels are matched, and what is done with a threshold, is tested fast below
def test_gain_and_threshold_come_back():
    made = cloud(-7.0, 600)
    found = calibrate(made, radar="iwr1443_mars")
    assert found.board.gain_db == pytest.approx(-7.0, abs=2.5)
    assert found.board.cfar_threshold == pytest.approx(600, rel=0.25)
    assert "if people did as in" in found.text()
    range_cfar = SETTINGS.with_threshold(found.board.cfar_threshold).range_cfar
    assert range_cfar is not None
    assert range_cfar.threshold == found.board.cfar_threshold


def test_a_threshold_is_that_of_the_settings():
    found = SETTINGS.with_threshold(601.6).range_cfar
    assert found is not None
    assert found.threshold == 602
    assert SETTINGS.with_threshold(None) == SETTINGS


def test_levels_are_matched_in_turn():
    def detected(gain_db: float, threshold: int) -> CloudLevels:
        return CloudLevels(level_db=60 + gain_db + threshold / 400, points=40 * 2 ** (gain_db / 6) * 768 / threshold)

    gain_db, threshold = match_levels(detected(-5.0, 500), detected, rounds=8)
    assert gain_db == pytest.approx(-5.0, abs=0.3)
    assert threshold == pytest.approx(500, abs=20)


def few_points(intensity: float, frames: int = 30) -> FirmwareCloud:
    """Eight points a frame, made up, 2 m ahead."""
    count = 8 * frames
    place, zero = np.full(count, 2.0), np.zeros(count)
    return FirmwareCloud(
        frame=np.repeat(np.arange(frames), 8), x_m=zero, y_m=place, z_m=zero, radial_velocity_mps=zero, snr_db=zero,
        intensity=np.full(count, intensity), range_bin=zero.astype(int), doppler_bin=zero.astype(int),
    )  # fmt: skip


def test_frames_without_points_count_unless_the_recording_was_interrupted():
    made = few_points(100.0)
    spread = replace(made, frame=np.repeat(np.array([0, 1, 4, 5, 5000, 5001] * 5), 8))
    assert sorted(cloud_levels._frames_of(spread)) == [0, 1, 2, 3, 4, 5, 5000, 5001]


def test_clouds_that_do_not_show_it_say_why(monkeypatch: pytest.MonkeyPatch):
    made = few_points(100.0)
    plain = made.select(np.arange(len(made.frame)))
    assert "no intensities" in fit_levels([plain], IWR1443_MARS, FirmwareSettings())[0].text
    assert "it takes 20" in fit_levels([few_points(100.0, frames=3)], IWR1443_MARS, SETTINGS)[1].text
    monkeypatch.setattr(cloud_levels, "SECONDS", 0.3)
    assert "is it this radar" in fit_levels([few_points(1e12)], IWR1443_MARS, SETTINGS)[0].text
