"""Millimetres: their sizes and speeds, who keeps what, and what stays where it is."""

import numpy as np
import pytest

from mmweaver.core.skeleton import joint
from mmweaver.motion.micro_motion import MicroMotion, MicroMotionSettings
from mmweaver.propagation.body_model import ScatteringBody
from tests.rooms import standing_person

STEP_S = 0.04
TIME_S = np.arange(0.0, 120.0, STEP_S)
JOINTS = np.repeat(standing_person((0.0, 2.0, -1.2)).joints_m[:1], len(TIME_S), axis=0)


def moved(subject: int, seed: int, motions: MicroMotionSettings | None = None) -> np.ndarray:
    return MicroMotion(subject, seed, motions or MicroMotionSettings()).moved(JOINTS, TIME_S, 1.75) - JOINTS


def rms(values: np.ndarray) -> float:
    return float(np.sqrt(np.mean((values - values.mean(axis=0)) ** 2)))


def test_sway_is_twice_that_of_quiet_standing():
    """Averaged over people: 6 to 10 mm to and fro, less sideways, 6 to 14 mm/s; the head more than the hips."""
    motions = MicroMotionSettings(waver_m=0.0, tremor_m=0.0)
    all_of = np.stack([moved(subject, 0, motions) for subject in range(12)])
    pelvis, head = all_of[:, :, joint("pelvis")], all_of[:, :, joint("head")]
    fro, side = rms(pelvis[..., 1].T), rms(pelvis[..., 0].T)
    assert 0.006 < fro < 0.010
    assert 0.4 < side / fro < 0.8
    assert 0.006 < rms(np.diff(pelvis[..., 1].T, axis=0) / STEP_S) < 0.014
    assert 1.4 < rms(head[..., 1].T) / fro < 1.9


def test_the_trunk_accelerates_over_the_hips_as_published():
    """Angular acceleration over the hips is 3.15 (deviation 1.24) times that over the ankles (Aramaki et al. 2001)."""
    hips, ankles = [], []
    for subject in range(8):
        place = moved(subject, 0, MicroMotionSettings(tremor_m=0.0))[..., 1] + JOINTS[..., 1]
        pelvis, chest, foot = (place[:, joint(name)] for name in ("pelvis", "spine3", "left_foot"))
        height = {name: JOINTS[0, joint(name), 2] for name in ("pelvis", "spine3", "left_ankle")}
        leg_rad = (pelvis - foot) / (height["pelvis"] - height["left_ankle"])
        hip_rad = (chest - pelvis) / (height["spine3"] - height["pelvis"]) - leg_rad
        hips.append(np.diff(hip_rad, 2))
        ankles.append(np.diff(leg_rad, 2))
    assert 3.15 - 1.24 < rms(np.stack(hips).T) / rms(np.stack(ankles).T) < 3.15 + 1.24


def test_feet_stay_and_hands_tremble():
    wander = moved(0, 0)
    assert rms(wander[:, joint("left_foot")]) < 0.2e-3  # it lies a little over the lower one
    alone = moved(0, 0, MicroMotionSettings(sway_m=0.0))
    assert rms(alone[:, joint("left_wrist")]) > rms(alone[:, joint("left_shoulder")])
    trembling = moved(0, 0, MicroMotionSettings(sway_m=0.0, waver_m=0.0))[:, joint("left_wrist"), 0]
    power = np.abs(np.fft.rfft(trembling)) ** 2
    frequency_hz = np.fft.rfftfreq(len(trembling), STEP_S)
    assert power[(frequency_hz > 7.9) & (frequency_hz < 12.1)].sum() > 0.95 * power.sum()


def test_who_sits_does_not_sway_at_the_hips():
    seated = JOINTS.copy()
    above = seated[..., 2] > seated[:, [joint("left_knee")], 2]
    seated[..., 2] -= np.where(above, 0.35, 0.0)
    one = MicroMotion(0, 0, MicroMotionSettings(waver_m=0.0, tremor_m=0.0))
    wander = one.moved(seated, TIME_S, 1.75) - seated
    assert rms(wander[:, joint("pelvis")]) < 1e-6
    assert rms(wander[:, joint("head")]) > 1e-3


def test_who_sits_wavers_half_as_far_and_trembles_a_quarter():
    """As recorded: 7 to 10 Hz lie some 14 dB below 3 to 5 Hz in a seated person; standing, tremor fills both alike."""
    seated = JOINTS.copy()
    seated[..., 2] -= np.where(seated[..., 2] > seated[:, [joint("left_knee")], 2], 0.45, 0.0)
    for settings, share in (
        (MicroMotionSettings(sway_m=0.0, tremor_m=0.0), 0.5),
        (MicroMotionSettings(sway_m=0.0, waver_m=0.0), 0.25),
    ):
        one = MicroMotion(0, 0, settings)
        resting, standing = one.moved(seated, TIME_S, 1.75) - seated, one.moved(JOINTS, TIME_S, 1.75) - JOINTS
        for name in ("spine3", "left_wrist"):
            at = joint(name)
            assert rms(resting[:, at]) == pytest.approx(share * rms(standing[:, at]), rel=1e-3)


def test_rates_belong_to_the_person_and_the_moment_to_the_take():
    one, again, later, other = (MicroMotion(*who, MicroMotionSettings()) for who in ((0, 0), (0, 0), (0, 1), (1, 0)))
    assert np.array_equal(one.chest_m(TIME_S), again.chest_m(TIME_S))
    assert one.breath_hz == later.breath_hz != other.breath_hz
    assert not np.array_equal(one.chest_m(TIME_S), later.chest_m(TIME_S))
    assert np.array_equal(moved(0, 0), moved(0, 0))


def test_breath_is_millimetres_at_a_quarter_hertz():
    chest = np.stack(
        [MicroMotion(subject, 0, MicroMotionSettings(heart_m=0.0)).chest_m(TIME_S) for subject in range(20)]
    )
    assert 0.004 < np.median(np.ptp(chest, axis=1)) < 0.012
    peak_hz = np.fft.rfftfreq(len(TIME_S), STEP_S)[np.abs(np.fft.rfft(chest, axis=1)).argmax(axis=1)]
    assert np.all((peak_hz > 0.19) & (peak_hz < 0.34))


def test_the_chest_breathes_forwards_and_the_limbs_do_not():
    body = ScatteringBody(0, 1.75)
    out = body.skin(JOINTS[:1], np.array([0.01])).place_m - body.skin(JOINTS[:1]).place_m
    size = np.linalg.norm(out[0], axis=-1)
    assert size.max() == pytest.approx(0.01, rel=0.05)
    front = body.skin(JOINTS[:1]).normal[0] @ [0.0, -1.0, 0.0]  # the person faces the radar
    assert size[(size > 0) & (front > 0.7)].mean() > 3 * size[(size > 0) & (front < -0.7)].mean()
    assert (size > 0).mean() < 0.5
