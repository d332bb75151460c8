"""How a seat of the scene is sat on."""

import dataclasses
from dataclasses import replace

import numpy as np
import pytest

from mmweaver.motion.animation.skeleton_proportions import SkeletonProportions
from mmweaver.motion.compose import compose
from mmweaver.motion.language.timing import plan_motion
from mmweaver.motion.planning.collision import PulledChair
from mmweaver.motion.planning.floor_map import FloorMap
from mmweaver.motion.planning.seating import (
    Sitting,
    centred_to_lie,
    pulled_out,
    random_subset,
    turned,
    usable_seats,
    usual_variation,
)
from mmweaver.scene.procedural.lighting import LIGHTINGS
from mmweaver.scene.procedural.procedural_room import make_room
from mmweaver.scene.reconstruction import reconstruct
from tests.motion.rooms import WINDOW_M, room, seat


def _ways_of_sitting(sitting: Sitting) -> list[Sitting]:
    rng = np.random.default_rng(0)
    return [usual_variation(sitting, rng) for _ in range(200)]


def test_a_seat_is_mostly_sat_on_as_it_is_made_for():
    (sitting,) = usable_seats(FloorMap(room(seats=(seat(),)), WINDOW_M, 1.75), SkeletonProportions(1.75))
    ways = _ways_of_sitting(sitting)
    assert 0.4 < np.mean([way is sitting for way in ways]) < 0.6
    assert all(way.cost > 0 for way in ways if way is not sitting)


def test_turned_or_further_back_the_feet_stay_before_the_seat():
    (sitting,) = usable_seats(FloorMap(room(seats=(seat(),)), WINDOW_M, 1.75), SkeletonProportions(1.75))
    reach = float(np.hypot(*(sitting.feet_m - sitting.seat_m)))
    ways = _ways_of_sitting(sitting)
    assert {round(way.facing_rad - sitting.facing_rad, 1) for way in ways} >= {-0.4, 0.0, 0.4}
    for way in ways:
        ahead = np.array([np.cos(way.facing_rad), np.sin(way.facing_rad)])
        assert (way.feet_m - way.seat_m) @ ahead == pytest.approx(reach)
        assert np.hypot(*(way.seat_m - sitting.seat_m)) <= 0.051


def test_nobody_sits_back_on_a_shallow_seat():
    shallow = Sitting(feet_m=np.array([0.0, 2.0]), facing_rad=-1.57, height_m=0.45, seat_m=np.zeros(2), depth_m=0.3)
    assert all((way.seat_m == shallow.seat_m).all() for way in _ways_of_sitting(shallow))


def test_some_seats_are_left_out_but_never_all():
    seats = usable_seats(FloorMap(room(seats=(seat(-0.6), seat(0.6))), WINDOW_M, 1.75), SkeletonProportions(1.75))
    kept = [random_subset(seats, np.random.default_rng(k)) for k in range(50)]
    assert {len(some) for some in kept} == {1, 2}


def test_who_lies_down_is_in_the_middle_of_the_couch():
    couch = [
        Sitting(feet_m=np.array([x, 2.0]), facing_rad=-np.pi / 2, height_m=0.45, seat_m=np.array([x, 2.4]), width_m=1.6)
        for x in (-0.4, 0.4)
    ]
    for place in centred_to_lie(couch, 1.75):
        # The own left is the picture's right: the head is there, 0.6 m from the seat, the toes at 0.87.
        head, toes = place.seat_m[0] + 0.6, place.seat_m[0] - 0.87
        assert head + toes == pytest.approx(0.0, abs=0.02)
        assert place.feet_m[0] == pytest.approx(place.seat_m[0])


def test_knees_clear_the_edge_of_a_deep_seat_and_a_chair_is_sat_on_in_the_middle():
    body = SkeletonProportions(1.6)

    def on(depth_m: float) -> Sitting:
        scene = room(seats=(replace(seat(), size_m=(0.6, depth_m)),))
        (sitting,) = usable_seats(FloorMap(scene, WINDOW_M, 1.6), body)
        return sitting

    middle_m = seat().position_m[:2]
    chair, bed = on(0.45), on(0.9)
    assert chair.seat_m == pytest.approx(middle_m)
    ahead_m = float(np.hypot(*(bed.seat_m - middle_m)))
    assert 0.1 < ahead_m < 0.45 - 0.12 + 1e-9
    assert bed.knees_m >= bed.edge_m + 0.05 - 1e-9
    assert bed.feet_m - bed.seat_m == pytest.approx(chair.feet_m - chair.seat_m)


def test_who_turns_on_a_seat_moves_ahead_past_its_corner():
    square = Sitting(
        feet_m=np.array([0.0, 1.6]), facing_rad=-np.pi / 2, height_m=0.45, seat_m=np.array([0.0, 2.0]),
        width_m=0.6, depth_m=0.6, edge_m=0.3, knees_m=0.36,
    )  # fmt: skip
    aslant = turned(square, 0.6)
    assert square.clear_knees() is square
    assert aslant.knees_m >= aslant.edge_m + 0.05 - 1e-9
    assert np.hypot(*(aslant.seat_m - square.seat_m)) > 0.05


def test_a_chair_is_pulled_back_from_what_is_ahead_of_it_where_there_is_floor_behind():
    floor = FloorMap(room(seats=(seat(),), boxes=((-0.3, 0.3, 2.3, 2.9),)), WINDOW_M, 1.75)
    (sitting,) = usable_seats(floor, SkeletonProportions(1.75))
    pulled = pulled_out(sitting, floor, 0.3)
    assert pulled is not None
    assert pulled.chair is not None
    np.testing.assert_allclose(pulled.seat_m - sitting.seat_m, [0.0, 0.3], atol=1e-9)  # it faces the radar
    np.testing.assert_allclose(pulled.feet_m - pulled.seat_m, sitting.feet_m - sitting.seat_m, atol=1e-9)
    assert pulled.cost > sitting.cost
    assert pulled.chair.covers(sitting.seat_m)
    assert replace(pulled.chair, by_m=0.5) == pulled.chair  # what is there without it is kept once
    assert not pulled.chair.covers(pulled.seat_m + np.array([0.0, 0.3]))
    against_a_wall = FloorMap(room(seats=(seat(),), boxes=((-2.0, 2.0, 2.3, 5.0),)), WINDOW_M, 1.75)
    assert pulled_out(sitting, against_a_wall, 0.3) is None
    assert pulled_out(replace(sitting, width_m=1.6), floor, 0.3) is None  # nobody pulls a couch


def test_a_chair_at_a_desk_is_pulled_out_rather_than_a_stool_invented():
    """A procedural office whose chair stands under the desk: the same seat is used, further from the desk, and said."""
    office = make_room("office", layout=0, seed=40000)
    scene = reconstruct(dataclasses.replace(office.photo(next(iter(LIGHTINGS)), noise=True), classes=None))
    motion = compose(plan_motion("she walks, then sits down", 3.0), scene, seed=2, range_window_m=(0.70, 3.48))
    assert motion.chair is not None
    assert any("pulled out" in note for note in motion.assumptions)
    assert not any("stool" in note for note in motion.assumptions)
    pelvis = motion.pose.joints_m[np.argmin(motion.pose.joints_m[:, 0, 2]), 0, :2]
    assert np.hypot(*(pelvis - np.array(motion.chair.place_m))) < motion.chair.by_m + 0.1


@pytest.mark.parametrize(
    ("text", "word"),
    [
        *(("a person sits on the {}", word) for word in ("couch", "sofa", "bench", "chair", "stool")),
        *(("a person walks to the {} and sits down on it", word) for word in ("couch", "chair")),
    ],
)
def test_who_sits_on_the_couch_is_on_the_couch_and_on_the_chair_on_the_chair(text: str, word: str):
    couch = replace(seat(x_m=-0.9, y_m=2.4), size_m=(1.7, 0.6))
    chair = replace(seat(x_m=0.9, y_m=2.4), size_m=(0.45, 0.45))
    meant = chair if word in ("chair", "stool") else couch
    motion = compose(plan_motion(text.format(word), 4.0), room(seats=(couch, chair)), seed=0, range_window_m=WINDOW_M)
    pelvis_m = motion.pose.joints_m[-1, 0, :2]
    assert (np.abs(pelvis_m - meant.position_m[:2]) < np.array(meant.size_m) / 2 + 0.1).all()


def test_the_edge_of_a_bed_is_sat_on_with_the_feet_on_floor_that_is_seen():
    """A procedural bedroom, and of its seats the one found among the pillows, where nobody's shins have room."""
    bedroom = make_room("bedroom", layout=1, seed=700008)
    scene = reconstruct(dataclasses.replace(bedroom.photo(next(iter(LIGHTINGS)), noise=True), classes=None))
    scene = dataclasses.replace(scene, seats=scene.seats[:1])
    floor = FloorMap.of(scene, (0.70, 3.48), 1.7)
    (edge,) = usable_seats(floor, SkeletonProportions(1.7))
    found_m = scene.seats[0].position_m[:2]
    assert 0.2 < np.hypot(*(edge.seat_m - found_m)) < 1.5
    assert bool(floor.is_seen_floor(edge.feet_m))
    assert not bool(floor.is_seen_floor(found_m))
    motion = compose(plan_motion("a person walks, then sits down"), scene, seed=0, range_window_m=(0.70, 3.48))
    assert not any("stool" in note for note in motion.assumptions)


def test_a_table_ahead_of_a_chair_is_no_part_of_it():
    chair = PulledChair((0.0, 2.0), -np.pi / 2, 0.3)  # it faces the radar
    points = np.array([[0.0, 2.2, 0.9], [0.0, 1.8, 0.6], [0.0, 1.8, 0.72], [0.0, 2.0, 0.5], [0.0, 1.5, 0.5]])
    assert chair.holds(points, 0.0).tolist() == [True, True, False, True, False]  # back, armrest, table, seat, beyond
