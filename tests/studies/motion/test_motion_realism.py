from pathlib import Path

import numpy as np
import pytest

from studies.motion.motion_realism import compare, gait_figures, jump_figures, ours, recorded, speed_of


def test_figures_find_what_was_put_in():
    clip = ours("walk", 1, seconds=4.0, speed_mps=1.2)
    assert speed_of(clip) == pytest.approx(1.2, abs=0.08)
    figures = gait_figures(clip)
    assert figures["step_length_m"] * figures["cadence_hz"] == pytest.approx(speed_of(clip))
    assert 0.8 < figures["left_right_ratio"] < 1.25
    jump = jump_figures(ours("jump", 1, seconds=2.4, count=1))
    assert jump["rise_m"] > 0.1
    assert 0.15 < jump["flight_s"] < 0.6


def test_inside_is_between_the_percentiles():
    theirs = [{"cadence_hz": float(value)} for value in np.linspace(1, 2, 21)]
    for value, inside in ((1.5, True), (2.5, False)):
        assert compare(theirs, [{"cadence_hz": value}])["cadence_hz"]["inside"] is inside


def test_recorded_clips_are_read(real_data: Path):
    clips = recorded(real_data / "motion" / "cmu" / "cmu_joints_m_120fps.npz", "walking")
    assert len(clips) > 20
    assert all(0.8 < speed_of(clip) < 1.6 for clip in clips)
