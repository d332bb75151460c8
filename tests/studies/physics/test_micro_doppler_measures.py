import numpy as np
import pytest

from mmweaver.core.skeleton import joint
from studies.physics.micro_doppler_measures import (
    Spectrogram,
    both_ways,
    gait_figures,
    kinematic_figures,
    spread_figures,
    step_difference,
    step_lag,
)

PERIOD_S = 0.02


def made_up(cadence_hz: float, *, left_over_right: float = 1.0) -> Spectrogram:
    """Nine tenths of the energy on a pelvis of 1.2 m/s, a tenth on a leg that swings at up to 3 m/s over it."""
    time_s = np.arange(150) * PERIOD_S
    velocity = np.arange(-128, 128) * 0.1055
    share = 0.9 * _line(velocity, np.full(150, 1.2))
    top = np.where((time_s * cadence_hz).astype(int) % 2 == 0, left_over_right, 1.0)
    share += 0.1 * _line(velocity, 1.2 + 3.0 * top * np.abs(np.sin(np.pi * cadence_hz * time_s)))
    return Spectrogram(time_s=time_s, velocity_mps=velocity, share=share, pelvis_mps=np.full(150, 1.2))


def _line(velocity: np.ndarray, at: np.ndarray) -> np.ndarray:
    shape = np.exp(-0.5 * ((velocity[None] - at[:, None]) / 0.1) ** 2)
    return shape / shape.sum(axis=1, keepdims=True)


@pytest.mark.parametrize("cadence_hz", [1.5, 1.8, 2.2])
def test_cadence_torso_and_limbs_are_those_put_in(cadence_hz: float):
    found = gait_figures(made_up(cadence_hz), (0.4, 0.85))
    assert found["cadence_hz"] == pytest.approx(cadence_hz, rel=0.03)
    assert found["torso_ratio"] == pytest.approx(1.0, abs=0.05)
    assert found["torso_surge_mps"] < 0.1
    assert found["limb_share"] == pytest.approx(0.09, abs=0.015)
    assert found["ahead_share"] > 0.98
    assert found["upper_mps"] == pytest.approx(3.0, abs=0.3)
    assert found["lower_mps"] > -0.4


def test_limbs_are_measured_about_the_pelvis():
    joints = np.zeros((240, 22, 3))
    joints[..., 0] = (np.arange(240) / 120 * 1.3)[:, None]
    joints[:, joint("left_knee"), 0] += 0.2 * np.sin(2 * np.pi * np.arange(240) / 120)
    joints[:, joint("right_knee"), 0] -= 0.2 * np.sin(2 * np.pi * np.arange(240) / 120)
    found = kinematic_figures(joints, 120.0)
    assert found["knee_ahead_mps"] == pytest.approx(0.2 * 2 * np.pi, rel=0.05)
    assert found["ankle_ahead_mps"] == pytest.approx(0.0, abs=1e-9)
    assert found["pelvis_surge_mps"] == pytest.approx(0.0, abs=1e-9)


def test_unequal_steps_show():
    alike, limping = (gait_figures(made_up(1.8, left_over_right=ratio), (0.4, 0.85)) for ratio in (1.0, 0.6))
    assert alike["step_difference"] < 0.05
    assert limping["step_difference"] == pytest.approx(0.5, abs=0.12)  # 0.4 over 0.8


def test_a_pair_of_one_spectrogram_is_symmetric_and_of_two_is_not():
    seen = made_up(1.8)
    same = both_ways(seen, seen, spread_figures)
    assert same["away_towards_overlap"] == pytest.approx(1.0)
    assert same["away_minus_towards"] == 0
    still = Spectrogram(
        time_s=seen.time_s, velocity_mps=seen.velocity_mps, share=_line(seen.velocity_mps, np.full(150, 1.2)),
        pelvis_mps=seen.pelvis_mps,
    )  # fmt: skip
    other = both_ways(seen, still, spread_figures)
    assert other["away_towards_overlap"] < 0.95
    assert other["away_minus_towards"] == pytest.approx(-0.09, abs=0.015)


def test_an_envelope_without_rhythm_has_none():
    time = np.arange(150)
    lag_s, rhythm = step_lag(np.cos(2 * np.pi * time / 30), PERIOD_S, (0.4, 0.85))
    assert lag_s == pytest.approx(0.6, abs=0.01)
    assert rhythm > 0.95
    assert step_lag(np.zeros(150), PERIOD_S, (0.4, 0.85))[1] == 0
    assert step_difference(np.zeros(150), 30.0) == 0
