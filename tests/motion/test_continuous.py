"""One sentence after the other: no jump and no step of velocity at any seam, postures kept, phases of their own."""

from collections.abc import Iterable
from itertools import pairwise

import numpy as np
import pytest
from scipy.interpolate import CubicSpline

from mmweaver.core.errors import InputError
from mmweaver.core.records import Scene
from mmweaver.core.skeleton import joint
from mmweaver.motion.continuous import ContinuousMotion, MotionPart
from mmweaver.motion.language.activities import BODY, HANDS
from mmweaver.motion.language.sentence import parse
from mmweaver.motion.planning.placement import Conditions
from rooms import WINDOW_M, room, sofa_room

PERIOD_S = 0.1
SEAM_S = 0.5  # in which one motion goes over into the next
SENTENCES = (
    "a person walks towards the radar", "waves with the left hand", "", "sits down", "drinks", "stands up", "claps",
    "walks to the left", "kneels down", "walks away from the radar",
)  # fmt: skip

EXAMPLES = [activity.example for activity in (*BODY, *HANDS)]


def continuous(scene: Scene | None = None, seed: int = 0, **given) -> ContinuousMotion:
    first = Conditions(seed=seed, **{name: given.pop(name) for name in ("start_m", "heading_rad") if name in given})
    return ContinuousMotion(scene or room(), first, frame_period_s=PERIOD_S, range_window_m=WINDOW_M, **given)


def carried_out(motion: ContinuousMotion, sentences=SENTENCES) -> list[MotionPart]:
    """The parts of all sentences; waiting ("") is ended after 1.3 s, in the middle of whatever goes on."""
    parts = []
    for sentence in sentences:
        part = motion.act(parse(sentence)) if sentence else motion.go_on()
        if not sentence:
            motion.cut(part.first_frame + 13)
        parts.append(part)
    return parts


def steps_of(part: MotionPart, until_s: float | None = None) -> tuple[float, float]:
    """Of a part with its seam: the largest change of a joint's velocity from one sample at 120 Hz to the next (m/s),
    and by how much a joint is farthest from where its own motion leads: the line between its neighbours (m)."""
    pose, first_s = part.pose, part.first_frame * PERIOD_S
    bounds = [first_s - 0.05] if until_s is None else [first_s - 0.05, first_s + until_s]
    own = slice(*map(int, np.searchsorted(pose.time_s, bounds)), None if until_s is None else 1)
    time_s, joints_m = pose.time_s[own], pose.joints_m[own]
    velocity = np.diff(joints_m, axis=0) / np.diff(time_s)[:, None, None]
    off_m = joints_m[1:-1] - (joints_m[:-2] + joints_m[2:]) / 2
    return float(np.linalg.norm(np.diff(velocity, axis=0), axis=-1).max()), float(np.linalg.norm(off_m, axis=-1).max())


def assert_smooth(seeds: Iterable[int]) -> None:
    """Any three activities in a row, half of them interrupted within a second of waiting: nothing jumps.

    A joint may move several centimetres a sample, as a fist at 4 m/s does; what may not be is a jump from where it
    moves. At a seam no joint changes its velocity by 1.25 m/s a sample (150 m/s2); throws and punches in themselves may
    by 2 m/s (240 m/s2), less than recorded clips at 120 Hz (CMU, 89 clips: 309 m/s2 and more in 95 of 100).
    """
    for seed in seeds:
        rng, motion = np.random.default_rng(seed), continuous(room() if seed % 2 else sofa_room(), seed=seed)
        before = 0
        for number in rng.integers(len(EXAMPLES), size=3):
            try:
                part = motion.act(parse(EXAMPLES[number]))
            except InputError:  # no room for it where the person is
                continue
            parts = [part]
            if rng.random() < 0.5:
                parts.append(motion.go_on())
                motion.cut(parts[-1].first_frame + int(rng.integers(1, 9)))
            for one in parts:
                for until_s, most_mps, most_m in ((SEAM_S, 1.25, 0.006), (None, 2.0, 0.009)):
                    step_mps, off_m = steps_of(one, until_s)
                    assert step_mps < most_mps, (seed, EXAMPLES[number], until_s)
                    assert off_m < most_m, (seed, EXAMPLES[number], until_s)
            before += len(parts)
        assert before


def test_no_joint_jumps_whatever_follows_whatever():
    assert_smooth(range(5))


def test_a_part_goes_on_from_where_the_last_one_ends():
    parts = carried_out(continuous())
    for before, after in pairwise(parts):
        seam_s = after.first_frame * PERIOD_S
        old, new = (CubicSpline(one.pose.time_s, one.pose.joints_m, axis=0) for one in (before, after))
        for order, unit in ((0, 1e-3), (1, 0.05)):
            np.testing.assert_allclose(new(seam_s, order), old(seam_s, order), atol=unit)
        gaps_s = np.diff(after.pose.time_s)
        assert 0.4 / 120 < gaps_s.min() < gaps_s.max() < 1.6 / 120


def test_who_sits_stands_up_before_walking_and_stays_seated_otherwise():
    parts = carried_out(continuous(sofa_room()), ("a person sits down", "waves", "walks to the left"))
    height_m = [part.pose.joints_m[part.pose.time_s > part.first_frame * PERIOD_S + 1][:, joint("pelvis"), 2]
                for part in parts]  # fmt: skip
    assert np.ptp(height_m[1]) < 0.1, "waves while seated"
    assert height_m[2].max() > height_m[1].max() + 0.2
    assert [step.lower for step in parts[2].motion.plan.steps[:2]] == ["sit", "stand_up"]


def test_the_same_seed_gives_the_same_motion_and_another_seed_another():
    one, same, other = (carried_out(continuous(seed=seed), SENTENCES[:2]) for seed in (1, 1, 2))
    for a, b in zip(one, same, strict=True):
        np.testing.assert_array_equal(a.pose.joints_m, b.pose.joints_m)
    assert one[0].pose.joints_m[5, 0, 0] != other[0].pose.joints_m[5, 0, 0]


def test_waiting_goes_on_with_an_activity_that_has_no_end_and_holds_the_posture_otherwise():
    motion = continuous()
    motion.act(parse("a person waves with the right hand"))
    assert [step.upper for step in motion.go_on().motion.plan.steps] == ["wave"]
    motion.act(parse("a person sits down"))
    assert [step.lower for step in motion.go_on().motion.plan.steps] == ["sit"]


def test_a_sentence_without_room_leaves_the_motion_as_it_was():
    motion = continuous(missing="refuse")
    first = motion.act(parse("a person waves"))
    with pytest.raises(InputError):
        motion.act(parse("goes to the door"))
    assert motion.go_on().first_frame == first.end_frame


@pytest.mark.parametrize("way", ["to the left", "forward", "backward"])
def test_who_has_fallen_where_there_was_just_room_for_it_gets_up_there(way: str):
    """Free floor 1.2 m wide: what the body lies on is free, whatever is around it."""
    narrow = room(boxes=((-3.0, -1.0, 0.0, 6.0), (1.2, 3.0, 0.0, 6.0)))
    falls, _, gets_up = carried_out(continuous(narrow, seed=3), (f"a person falls {way}", "waves", "gets up"))
    assert falls.pose.joints_m[-1, joint("pelvis"), 2] < gets_up.pose.joints_m[-1, joint("pelvis"), 2] - 0.5


@pytest.mark.parametrize("text", ["does jumping jacks", "hops in place"])
def test_who_is_interrupted_in_the_air_lands_on_the_floor(text: str):
    """Cut at any frame of a jump; the next movement takes over feet that are still in the air."""
    for cut in (1, 4, 7):
        motion = continuous(seed=cut)
        motion.act(parse(f"a person {text}"))
        motion.cut(motion.go_on().first_frame + cut)
        part = motion.act(parse("a person sweeps the floor"))
        pose, seam_s = part.pose, part.first_frame * PERIOD_S
        velocity = np.diff(pose.joints_m, axis=0) / np.diff(pose.time_s)[:, None, None]
        steps = np.linalg.norm(np.diff(velocity, axis=0), axis=-1)[pose.time_s[1:-1] > seam_s]
        assert steps.max() < 1.5  # 20 m/s where a share overshot, 1.9 where a sole went into the floor
        controls = part.motion.controls
        assert controls is not None
        assert controls.foot_m[..., 2].min() > -5e-3  # 22 mm before
        assert controls.contact.max() <= 1.0
        assert -1e-9 <= controls.knee_room.min() <= controls.knee_room.max() <= 1.0
