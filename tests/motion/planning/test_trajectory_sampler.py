"""One candidate trajectory: its start, an entry for each step, and what the floor does not allow."""

import numpy as np
import pytest

from mmweaver.motion.animation.skeleton_proportions import SkeletonProportions
from mmweaver.motion.language.timing import plan_motion
from mmweaver.motion.planning.approaches import approaches
from mmweaver.motion.planning.floor_map import FloorMap
from mmweaver.motion.planning.trajectory import NoTrajectory, Trajectory
from mmweaver.motion.planning.trajectory_sampler import CandidateSampler
from rooms import WINDOW_M, sofa_room


def sampler(text: str, scene, *, start_m=None, attempt: int = 0, seed: int = 0, **more) -> CandidateSampler:
    return CandidateSampler(
        plan=plan_motion(text, 4.0), floor=FloorMap(scene, WINDOW_M, 1.75), body=SkeletonProportions(1.75),
        rng=np.random.default_rng(seed), start_m=start_m, attempt=attempt, **more,
    )  # fmt: skip


def found_by(sampler: CandidateSampler) -> Trajectory:
    """The first candidate that works out."""
    for _ in range(50):
        try:
            return sampler.sample()
        except NoTrajectory:
            continue
    raise AssertionError("no candidate")


def test_attempt_2_leaves_the_seats_unless_the_sentence_names_one():
    usual, without = (found_by(sampler("sits", sofa_room(), attempt=attempt)) for attempt in (0, 2))
    assert not any("stool" in note for note in usual.notes)
    assert any("stool" in note for note in without.notes)
    named = found_by(sampler("sits on the chair", sofa_room(), attempt=2))
    assert not any("stool" in note for note in named.notes)


@pytest.mark.parametrize(
    ("text", "heading_rad"),
    [
        ("sits", 0.0),
        ("sits down", 2.0),
        ("walks to the left", -2.5),
        ("walks towards the radar", 0.0),
        ("walks to the chair", 2.0),
        ("waves facing the radar", -2.5),
        ("turns to face the radar", 2.0),
    ],
)
def test_a_given_start_and_heading_are_kept_whatever_is_done(text: str, heading_rad: float):
    found = found_by(sampler(text, sofa_room(), start_m=(0.0, 1.7), heading_rad=heading_rad))
    path = found.path()
    assert path.heading_rad == pytest.approx(heading_rad)
    hips_m = found.seats_m[0] if text == "sits" else path.start_m
    assert hips_m == pytest.approx((0.0, 1.7), abs=1e-6)


def test_who_sits_where_the_usual_ways_collide_takes_a_way_that_is_known_to_fit():
    scene = sofa_room()
    known = [way.sitting for way in approaches(FloorMap(scene, WINDOW_M, 1.75), SkeletonProportions(1.75))]
    taken = [found_by(sampler("sits", scene, attempt=1, seed=seed)).seats_m[0] for seed in range(8)]
    near = [min(np.hypot(*(one.seat_m - np.array(place))) for one in known) < 0.01 for place in taken]
    assert 1 <= sum(near) < len(near)
