"""Rehabilitation, seated exercises, floor sitting, falls and walking aids, measured on joints."""

import numpy as np
import pytest
from acted import acted, away, axes, bend_deg
from scipy.signal import find_peaks

from mmweaver.core.skeleton import joint

RATE_HZ = 120.0
HEEL, BALL = (0.026, 0.046), 0.012  # heel behind and below the ankle, sole below the ball, of a foot of 8.2 cm


def peaks(signal: np.ndarray) -> int:
    """How often a signal rises and falls by half of its span."""
    padded = np.pad(signal, 1, constant_values=signal.min())
    return len(find_peaks(padded, prominence=0.5 * np.ptp(signal))[0])


def lowest_m(joints: np.ndarray, side: str) -> np.ndarray:
    """Height of the lower of heel and ball over the floor."""
    ankle, ball = joints[:, joint(f"{side}_ankle")], joints[:, joint(f"{side}_foot")]
    along = ball - ankle
    unit = np.median(np.linalg.norm(along, axis=1)) / np.hypot(0.075, 0.034)
    pitch = -np.arctan2(along[:, 2], np.hypot(along[:, 0], along[:, 1])) - np.arctan2(0.034, 0.075)
    heel = ankle[:, 2] - unit * (HEEL[1] * np.cos(pitch) - HEEL[0] * np.sin(pitch))
    return np.minimum(heel, ball[:, 2] - unit * BALL * np.cos(pitch))


def up(name: str):
    return lambda joints: joints[:, joint(name), 2]


def aside(name: str, sign: float):
    return lambda joints: sign * away(joints, name)[:, 1]


def ahead(name: str, origin: str = "pelvis"):
    return lambda joints: away(joints, name, origin)[:, 0]


COUNTED = [
    ("does ten heel raises", up("left_ankle"), 10, (0.05, 0.12)),
    ("does five toe raises", up("right_foot"), 5, (0.02, 0.09)),
    ("taps the right foot five times", up("right_foot"), 5, (0.02, 0.09)),
    ("lifts the left leg to the side three times", aside("left_ankle", 1.0), 3, (0.3, 0.65)),
    ("raises both arms to the side five times", up("left_wrist"), 5, (0.4, 0.65)),
    ("raises the right arm sideways five times", aside("right_wrist", -1.0), 5, (0.3, 0.65)),
    ("raises the right arm forward three times", ahead("right_wrist"), 3, (0.35, 0.65)),
    ("sits on the chair and extends the right knee five times", ahead("right_ankle"), 5, (0.2, 0.5)),
    ("sits on the chair and marches six times", lambda j: up("left_knee")(j) + up("right_knee")(j), 6, (0.04, 0.3)),
    ("sits on the chair and leans forward three times", ahead("neck"), 3, (0.15, 0.5)),
    ("sits on the chair and leans back twice", lambda j: -ahead("neck")(j), 2, (0.05, 0.4)),
    ("sits on the chair and leans to the left three times", aside("neck", 1.0), 3, (0.1, 0.45)),
    ("does three burpees", lambda j: -up("head")(j), 3, (0.8, 1.6)),
    ("does four pull-ups", up("pelvis"), 4, (0.35, 0.7)),
    ("lies on the side and raises the leg three times", up("left_ankle"), 3, (0.3, 0.8)),
    ("lies on the back and raises the right leg twice", up("right_ankle"), 2, (0.4, 0.8)),
    ("stands up from the chair and sits down five times", up("pelvis"), 5, (0.3, 0.6)),
]


@pytest.mark.parametrize(("text", "signal", "count", "span_m"), COUNTED, ids=[row[0] for row in COUNTED])
def test_repetitions_are_as_many_and_as_large_as_stated(text, signal, count, span_m):
    values = signal(acted(text))
    assert peaks(values) == count
    assert span_m[0] < np.ptp(values) < span_m[1]


FEET = [
    "does two heel raises",
    "does two toe raises",
    "taps the right foot twice",
    "lifts the left leg to the side twice",
    "stretches the left calf",
    "stands in tandem",
    "reaches forward as far as possible",
    "sits on the chair and leans forward",
    "walks heel to toe",
    "walks with a cane",
    "walks with a rollator",
    "walks on crutches",
    "pushes a chair",
]


@pytest.mark.parametrize("text", FEET)
def test_feet_stay_within_1_cm_of_the_floor_while_they_carry_weight(text: str):
    joints = acted(text, 1)
    soles = np.stack([lowest_m(joints, side) for side in ("left", "right")])
    assert soles.min() > -0.01
    assert soles.min(axis=0).max() < 0.01, "one foot carries the body"


@pytest.mark.parametrize(
    ("text", "speed_mps"),
    [
        ("walks heel to toe for 6 seconds", (0.2, 0.42)),
        ("walks with a cane for 4 seconds", (0.45, 0.95)),
        ("walks with a rollator for 4 seconds", (0.45, 0.95)),
        ("walks on crutches for 4 seconds", (0.45, 0.95)),
    ],
)
def test_walks_with_an_aid_are_slow(text: str, speed_mps: tuple[float, float]):
    pelvis = acted(text, 2)[:, 0, :2]
    middle = pelvis[len(pelvis) // 4 : -len(pelvis) // 4]
    speed = np.hypot(*(middle[-1] - middle[0])) / (len(middle) / RATE_HZ)
    assert speed_mps[0] < speed < speed_mps[1]


def test_knees_get_to_the_hips_on_the_spot_and_to_the_chest_in_mountain_climbers():
    joints = acted("runs on the spot with high knees for 4 seconds")
    for side in ("left", "right"):
        assert (joints[:, 0, 2] - up(f"{side}_knee")(joints)).min() < 0.2
        assert 4 <= peaks(up(f"{side}_knee")(joints)) <= 7
    joints = acted("does mountain climbers")
    assert joints[:, joint("neck"), 2].max() < 0.9
    near = np.linalg.norm(joints[:, joint("left_knee")] - joints[:, joint("spine3")], axis=1)
    assert near.min() < near.max() - 0.15


def test_feet_in_tandem_are_in_line_heel_at_toes():
    joints = acted("stands in tandem for 4 seconds")[240:]
    apart = away(joints, "left_ankle", "right_ankle")
    assert np.abs(apart[:, 1]).max() < 0.03
    assert 0.22 < np.abs(apart[:, 0]).min() < 0.32


def test_hands_on_a_rollator_keep_their_place_before_the_body():
    joints = acted("walks with a rollator for 4 seconds")
    for side in ("left", "right"):
        hand = away(joints, f"{side}_wrist")
        assert hand[:, 0].min() > 0.2
        assert 0.75 < up(f"{side}_wrist")(joints).mean() < 1.05


@pytest.mark.parametrize(
    ("text", "knees_deg"),
    [("sits on the floor cross-legged", (60, 150)), ("sits on the floor with the legs out", (0, 30))],
)
def test_who_sits_on_the_floor_has_an_upright_trunk_over_a_low_pelvis(text: str, knees_deg: tuple[float, float]):
    last = acted(text)[-1:]
    assert last[0, 0, 2] < 0.22
    assert last[0, joint("neck"), 2] - last[0, 0, 2] > 0.38
    assert knees_deg[0] < bend_deg(last, "left_hip", "left_knee", "left_ankle")[0] < knees_deg[1]


def test_who_has_sat_on_the_floor_stands_up_again():
    pelvis_m = acted("sits down on the floor and gets up again")[:, 0, 2]
    assert pelvis_m.min() < 0.22
    assert pelvis_m[-1] > 0.9


@pytest.mark.parametrize(
    "text",
    [
        "faints",
        "slowly collapses",
        "slips and falls backwards",
        "trips and falls forward",
        "falls out of bed",
        "falls and tries to get up but stays lying",
        "faints and lies still for ten seconds",
    ],
)
def test_who_has_fallen_stays_down(text: str):
    joints = acted(text)
    trunk = joints[-1, [joint(name) for name in ("pelvis", "spine3", "neck", "head")], 2]
    assert trunk.max() < 0.42
    low = np.flatnonzero(joints[:, 0, 2] < 0.35)
    assert joints[low[0] :, 0, 2].max() < 0.5, "no standing up in between"


def test_a_faint_is_slower_than_a_fall_and_a_slip_takes_the_feet_ahead():
    falls = {text: acted(text)[:, 0, 2] for text in ("faints", "falls")}
    took = {text: np.flatnonzero(z < 0.3)[0] - np.flatnonzero(z < 0.9)[0] for text, z in falls.items()}
    assert took["faints"] > 1.3 * took["falls"]
    joints = acted("slips and falls backwards")
    way = (joints[:, joint("left_foot")] - joints[0, joint("left_foot")]) @ axes(joints)[0]
    assert way.max() > 0.2


def test_ten_seconds_of_lying_are_ten_seconds_without_motion():
    joints = acted("faints and lies still for ten seconds")
    assert np.ptp(joints[-int(9 * RATE_HZ) :], axis=0).max() < 0.02


def test_timed_up_and_go_stands_up_walks_three_metres_turns_and_sits_again():
    joints = acted("does the timed up and go test")
    pelvis = joints[:, 0]
    assert pelvis[0, 2] < 0.65
    assert pelvis[-1, 2] < 0.65
    assert pelvis[:, 2].max() > 0.9
    assert 2.8 < np.hypot(*(pelvis[:, :2] - pelvis[0, :2]).T).max() < 3.6
    assert np.hypot(*(pelvis[-1, :2] - pelvis[0, :2])) < 0.5
