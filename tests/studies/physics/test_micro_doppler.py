from pathlib import Path

import numpy as np
import pytest

from mmweaver.core.skeleton import joint
from studies.motion.motion_realism import cadence_hz
from studies.physics.micro_doppler import (
    NEAREST_M,
    RADAR,
    RATE_HZ,
    RecordedMotion,
    figures,
    frozen,
    library,
    placed,
    recorded,
    simulator,
    spectrogram,
    summary,
)
from studies.physics.micro_doppler_measures import STEP_S, gait_figures, spread_figures

SECONDS, SPEED_MPS = 1.8, 1.2


@pytest.fixture(scope="module")
def walk() -> RecordedMotion:
    """A library walk at 1.2 m/s along x."""
    joints = np.zeros((round(SECONDS * RATE_HZ), 22, 3))
    joints[..., 0] = (np.arange(len(joints)) / RATE_HZ * SPEED_MPS)[:, None]
    joints[:, [4, 5], 2], joints[:, [7, 8], 2] = -0.41, -0.82  # knees and ankles: legs have a length
    return library(RecordedMotion(joints_m=joints, height_m=1.75, subject=3, label="made up"), "walking", 1)


def test_the_radar_does_not_alias():
    assert RADAR.max_velocity_mps > 13
    assert RADAR.velocity_resolution_mps < 0.11
    assert RADAR.active_time_s < RADAR.frame_period_s


def test_towards_and_away_are_one_motion_turned(walk: RecordedMotion):
    there, back = (placed(walk.joints_m, is_away=is_away) for is_away in (False, True))
    np.testing.assert_allclose(np.linalg.norm(np.diff(there, axis=0)), np.linalg.norm(np.diff(back, axis=0)))
    assert there[0, 0, 1] > there[-1, 0, 1] > 0 < back[0, 0, 1] < back[-1, 0, 1]
    assert there[:, 0, 1].min() == pytest.approx(NEAREST_M)
    assert there[..., 2].min() == pytest.approx(-0.96, abs=0.02)
    # left stays left: turned, not mirrored
    for joints, facing in ((there, -1), (back, 1)):
        across = joints[:, joint("left_hip"), 0] - joints[:, joint("right_hip"), 0]
        assert np.sign(across.mean()) == -facing


def test_who_goes_nowhere_faces_the_radar_or_turns_the_back_on_it(walk: RecordedMotion):
    on_the_spot = walk.joints_m - walk.joints_m[:, :1] * [1, 1, 0]
    for is_away, facing in ((False, -1), (True, 1)):
        joints = placed(on_the_spot, is_away=is_away)
        toes = (
            joints[:, [joint("left_foot"), joint("right_foot")]]
            - joints[:, [joint("left_ankle"), joint("right_ankle")]]
        )
        assert np.sign(toes[..., 1].mean()) == facing


@pytest.mark.slow  # it simulates two walks
def test_a_walk_is_wider_than_the_same_body_frozen_and_its_cadence_is_found(walk: RecordedMotion):
    shown_by = simulator()
    seen, rigid = (spectrogram(motion, shown_by, 0, is_away=False) for motion in (walk, frozen(walk)))
    found, still = gait_figures(seen, STEP_S["walking"]), spread_figures(rigid)
    joints = {name: walk.joints_m[:, joint(name)] for name in ("pelvis", "left_ankle", "right_ankle")}
    assert found["cadence_hz"] == pytest.approx(cadence_hz(joints), rel=0.15)
    assert found["torso_ratio"] == pytest.approx(1, abs=0.12)
    np.testing.assert_allclose(seen.share.sum(axis=1), 1)
    assert still["limb_share"] < 0.02 < found["limb_share"]
    assert still["spread_mps"] < 0.5 < found["spread_mps"]


@pytest.mark.slow  # the walks of both directions
def test_figures_are_of_both_directions(walk: RecordedMotion):
    shown_by = simulator()
    found, _ = figures(walk, "walking", shown_by, 0)
    assert found["cadence_ratio"] == pytest.approx(1, abs=0.15)
    assert found["torso_ratio"] == pytest.approx(1, abs=0.12)
    rigid, _ = figures(frozen(walk), "jumping", shown_by, 0)
    assert rigid["limb_share"] < 0.02 < found["limb_share"]
    assert rigid["spread_mps"] < 0.5 < found["spread_mps"]


def test_summary_tells_inside_from_outside():
    theirs = [{"limb_share": value} for value in np.linspace(0.1, 0.2, 21)]
    for value, inside in ((0.15, True), (0.3, False)):
        row = summary([{"limb_share": value}] * 3, [{"limb_share": 0.0}], theirs)["limb_share"]
        assert row["inside"] is inside
        assert row["share_inside"] == float(inside)
        assert row["baseline"] == {"frozen": 0.0}


@pytest.mark.slow  # of all clips
def test_recorded_clips_are_steady_walks_and_windows_about_a_jump(real_data: Path):
    path = real_data / "motion" / "cmu" / "cmu_joints_m_120fps.npz"
    walks = recorded(path, "walking", most=3)
    assert len(walks) == 3
    assert all(len(clip.joints_m) <= 3 * RATE_HZ for clip in walks)
    jump = recorded(path, "jumping", most=1)[0]
    toes = jump.joints_m[:, [joint("left_foot"), joint("right_foot")], 2].min(axis=1)
    assert toes.max() - toes[:20].min() > 0.1
