"""No joint changes its velocity at once: within the library, between movements, and across a stream's parts.

A velocity step keeps its size where the motion is sampled more finely, an acceleration does not: so joints are
composed at four times their usual rate. At that rate the hardest landings change a knee by 0.2 m/s from one sample to
the next.
"""

import numpy as np
import pytest

from mmweaver.core.records import PoseSequence
from mmweaver.motion import continuous
from mmweaver.motion.animation import assemble
from mmweaver.motion.continuous import ContinuousMotion
from mmweaver.motion.empty_floor import WINDOW_M, act_out, empty_floor
from mmweaver.motion.language.activities import BODY, HANDS
from mmweaver.motion.language.sentence import parse

FINER = 4
LARGEST_MPS = 0.35


@pytest.fixture(autouse=True)
def finer_times(monkeypatch: pytest.MonkeyPatch) -> None:
    for module in (assemble, continuous):
        monkeypatch.setattr(module, "RATE_HZ", FINER * assemble.RATE_HZ)


def largest_step_mps(pose: PoseSequence) -> float:
    velocity = np.diff(pose.joints_m, axis=0) / np.diff(pose.time_s)[:, None, None]
    return float(np.linalg.norm(np.diff(velocity, axis=0), axis=-1).max())


@pytest.mark.parametrize("activity", [*BODY, *HANDS], ids=lambda activity: activity.key)
def test_no_activity_has_a_velocity_step(activity):
    assert largest_step_mps(act_out(activity.example, seed=1).pose) < LARGEST_MPS


@pytest.mark.parametrize(
    "text",
    [
        "a person does push-ups, takes two steps sideways to the right, then runs to the left",
        "a person combs the hair, then holds a plank, then sits down",
        "a person circles the arms twice, then puts the hands on the hips",
        "a person is boxing, then does a lunge, then crawls to the left",
        "a person does squats with the hands up, then lies down on the bed",
    ],
)
def test_no_transition_has_a_velocity_step(text: str):
    assert largest_step_mps(act_out(text, seed=2).pose) < LARGEST_MPS


def test_a_stream_has_no_velocity_step_across_its_parts():
    stream = ContinuousMotion(empty_floor(), frame_period_s=0.1, range_window_m=WINDOW_M, seed=3)
    for text in ("runs to the left", "circles the arms", "does push-ups", "sits down", "walks to the right"):
        part = stream.act(parse(f"a person {text}"))
        assert largest_step_mps(part.pose) < LARGEST_MPS, text
