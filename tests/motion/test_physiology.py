"""Breath, heart, sway and tremor: their sizes and rates, who keeps what, what is held, and what is reported of it."""

from dataclasses import replace

import numpy as np
import pytest

from mmweaver.core.errors import InputError
from mmweaver.core.records import Breathing
from mmweaver.core.skeleton import joint
from mmweaver.motion.physiology import STILL, Physiology, PhysiologySettings, Waves, breathing_rate_of, cover_of
from mmweaver.propagation.body_model import ScatteringBody, body_of
from tests.rooms import standing_person

STEP_S = 0.04
TIME_S = np.arange(0.0, 120.0, STEP_S)
HEIGHT_M = 1.75
JOINTS = np.repeat(standing_person((0.0, 2.0, -1.2)).joints_m[:1], len(TIME_S), axis=0)
LYING = JOINTS[..., [0, 2, 1]] * [1.0, 1.0, 0.1]
SUBJECTS = range(12)


def moved(subject: int, seed: int, settings: PhysiologySettings | None = None) -> np.ndarray:
    return Physiology(subject, seed, settings).moved(JOINTS, TIME_S, HEIGHT_M) - JOINTS


def seated() -> np.ndarray:
    joints = JOINTS.copy()
    joints[..., 2] -= np.where(joints[..., 2] > joints[:, [joint("left_knee")], 2], 0.45, 0.0)
    return joints


def rms(values: np.ndarray) -> float:
    return float(np.sqrt(np.mean((values - values.mean(axis=0)) ** 2)))


def band_db(values: np.ndarray, low: float, high: float) -> float:
    frequency_hz = np.fft.rfftfreq(len(values), STEP_S)
    power = np.abs(np.fft.rfft(values - values.mean())) ** 2
    return float(10 * np.log10(power[(frequency_hz > low) & (frequency_hz < high)].sum()))


@pytest.mark.parametrize(("posture", "largest_m", "below_db"), [("seated", 0.009, -8), ("standing", 0.014, -4)])
def test_still_people_move_as_recorded_ones_do(posture: str, largest_m: float, below_db: float):
    """Recorded within half a minute: 4 to 8 mm peak to peak, and 8 to 14 dB less below 0.12 Hz than at the breath."""
    joints, extent, below = seated() if posture == "seated" else JOINTS, [], []
    for subject in SUBJECTS:
        one = Physiology(subject, 1)
        along = -(one.moved(joints, TIME_S, HEIGHT_M) - joints)[:, joint("spine3"), 1]
        along = along + one.trunk_m(joints, TIME_S, HEIGHT_M)[:, 0]
        for first in range(0, len(TIME_S) - 750, 750):
            part, time_s = along[first : first + 750], TIME_S[:750]
            extent.append(np.ptp(part))
            part = part - np.polynomial.Polynomial.fit(time_s, part, 1)(time_s)
            below.append(band_db(part, 0.02, 0.12) - band_db(part, 0.15, 0.5))
    assert 0.004 < np.median(extent) < largest_m
    assert np.median(below) < below_db


def test_the_trunk_accelerates_over_the_hips_as_published():
    """Angular acceleration over the hips is 3.15 (deviation 1.24) times that over the ankles (Aramaki et al. 2001)."""
    hips, ankles = [], []
    for subject in range(8):
        place = moved(subject, 0, PhysiologySettings(tremor_m=0.0, breath_m=0.0, heart_m=0.0))[..., 1] + JOINTS[..., 1]
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
    alone = moved(0, 0, PhysiologySettings(sway_m=0.0, breath_m=0.0))
    assert rms(alone[:, joint("left_wrist")]) > rms(alone[:, joint("left_shoulder")])
    trembling = moved(0, 0, PhysiologySettings(sway_m=0.0, waver_m=0.0, breath_m=0.0, heart_m=0.0))[
        :, joint("left_wrist"), 0
    ]
    power = np.abs(np.fft.rfft(trembling)) ** 2
    frequency_hz = np.fft.rfftfreq(len(trembling), STEP_S)
    assert power[(frequency_hz > 7.9) & (frequency_hz < 12.1)].sum() > 0.95 * power.sum()


def test_who_sits_sways_less_and_who_lies_hardly():
    extents = [
        rms((Physiology(0, 0).moved(joints, TIME_S, HEIGHT_M) - joints)[:, joint("spine3"), 1])
        for joints in (JOINTS, seated(), LYING)
    ]
    assert extents[0] > 2 * extents[1] > 2 * extents[2]


def test_lying_people_breathe_with_the_belly_and_standing_ones_with_the_chest():
    one = Physiology(3, 0, PhysiologySettings(heart_m=0.0))
    chest, belly = np.ptp(one.trunk_m(JOINTS, TIME_S, HEIGHT_M), axis=0)
    assert chest > 1.4 * belly
    chest, belly = np.ptp(one.trunk_m(LYING, TIME_S, HEIGHT_M), axis=0)
    assert belly > 1.8 * chest


def test_rates_belong_to_the_person_and_the_moment_to_the_sequence():
    one, again, later, other = (Physiology(*who) for who in ((0, 0), (0, 0), (0, 1), (1, 0)))
    assert np.array_equal(one.breath_m(TIME_S), again.breath_m(TIME_S))
    assert one.breath_hz == later.breath_hz != other.breath_hz
    assert not np.array_equal(one.breath_m(TIME_S), later.breath_m(TIME_S))
    assert np.array_equal(moved(0, 0), moved(0, 0))


def test_how_time_is_cut_changes_no_bit():
    one = Physiology(0, 0, breathing=Breathing(held_s=((3.0, 9.0),)))
    whole, part = one.moved(JOINTS, TIME_S, HEIGHT_M), one.moved(JOINTS[40:60], TIME_S[40:60], HEIGHT_M)
    assert np.array_equal(whole[40:60], part)
    trunk = one.trunk_m(JOINTS, TIME_S, HEIGHT_M)
    assert np.array_equal(trunk[40:60], one.trunk_m(JOINTS[40:60], TIME_S[40:60], HEIGHT_M))


def test_breath_and_heart_have_published_sizes_and_the_rates_reported():
    frequency_hz = np.fft.rfftfreq(len(TIME_S), STEP_S)
    for subject in SUBJECTS:
        one = Physiology(subject, 0)
        breath, heart = one.breath_m(TIME_S), one.heart_m(TIME_S)
        assert 0.003 < np.ptp(breath) < 0.017
        assert 0.1e-3 < np.ptp(heart) < 0.6e-3
        truth = one.truth(JOINTS, TIME_S, HEIGHT_M, TIME_S[-1])
        peak_hz = frequency_hz[1 + np.abs(np.fft.rfft(breath - breath.mean()))[1:].argmax()]
        assert peak_hz == pytest.approx(truth.breathing_hz, abs=1.5 / 60)
        assert len(truth.beat_s) / TIME_S[-1] == pytest.approx(truth.heart_hz, rel=0.02)
        gaps = np.diff(truth.beat_s)
        assert 0.01 < gaps.std() / gaps.mean() < 0.08  # heart rate variability


def test_a_stated_rate_is_kept():
    one = Physiology(5, 2, breathing=Breathing(per_minute=24.0))
    assert one.truth(JOINTS, TIME_S, HEIGHT_M, TIME_S[-1]).breathing_hz == pytest.approx(0.4, abs=0.01)


def test_a_held_breath_stops_the_chest_and_not_the_heart():
    held = Breathing(held_s=((20.0, 30.0),))
    one = Physiology(4, 0, replace(PhysiologySettings(), depth_variation=0.0), held)
    still = (TIME_S > 20.7) & (TIME_S < 29.3)
    assert np.ptp(one.breath_m(TIME_S)[still]) < 1e-6 < np.ptp(one.breath_m(TIME_S)[~still])
    assert np.ptp(one.heart_m(TIME_S)[still]) > 0.1e-3
    steps = np.diff(one.breath_m(np.arange(18, 32, 1e-3)))
    assert np.abs(np.diff(steps)).max() < 1e-6  # nothing jumps


def test_rates_are_taken_out_of_sentences():
    assert breathing_rate_of("a person stands, breathing 12 times a minute") == ("a person stands", 12.0)
    assert breathing_rate_of("a person lies with 9.5 breaths per minute, then gets up") == (
        "a person lies, then gets up", 9.5,
    )  # fmt: skip
    assert breathing_rate_of("a person claps 20 times") == ("a person claps 20 times", None)
    with pytest.raises(InputError, match="4 to 60"):
        breathing_rate_of("a person sits and breathes 200 times per minute")


def test_the_trunk_breathes_forwards_and_the_limbs_do_not():
    body = ScatteringBody(0, HEIGHT_M)
    out = body.skin(JOINTS[:1], np.array([[0.01, 0.006]])).place_m - body.skin(JOINTS[:1]).place_m
    size = np.linalg.norm(out[0], axis=-1)
    assert size.max() == pytest.approx(0.01, rel=0.05)
    front = body.skin(JOINTS[:1]).normal[0] @ [0.0, -1.0, 0.0]  # the person faces the radar
    assert size[(size > 0) & (front > 0.7)].mean() > 3 * size[(size > 0) & (front < -0.7)].mean()
    assert (size > 0).mean() < 0.5


def test_still_is_still():
    assert np.array_equal(moved(0, 0, STILL), np.zeros_like(JOINTS))
    assert not Physiology(0, 0, STILL).trunk_m(JOINTS, TIME_S, HEIGHT_M).any()


def test_waves_have_the_rms_asked_for():
    rng = np.random.Generator(np.random.SFC64(0))
    waves = Waves(rng, (40,), 0.2, 2.0, 1.0).at(np.arange(0, 600, 0.05))
    assert np.sqrt((waves**2).mean()) == pytest.approx(1.0, rel=0.05)


def test_a_blanket_is_taken_out_of_the_sentence_and_weakens_the_body():
    assert cover_of("a person lies on the floor under a thick duvet") == ("a person lies on the floor", 5.0)
    assert cover_of("a person crawls under a table") == ("a person crawls under a table", 0.0)
    pose = replace(standing_person((0.0, 2.0, -1.2)), cover_db=3.0)
    bare, covered = (body_of(one).brightness for one in (replace(pose, cover_db=0.0), pose))
    assert covered == pytest.approx(bare / 10**0.3)
