"""A sentence that a room's range window has no floor for gets a wider window; things that are missing are put there."""

from dataclasses import replace

import numpy as np
import pytest

from mmweaver.core.errors import InputError
from mmweaver.core.placed_thing import FURNISHABLE
from mmweaver.motion.language.plan import DONE
from mmweaver.scene.furnished import RECORD_OF
from mmweaver.weaver.composition import compose_request, furnished_room, lost_of, widened
from mmweaver.weaver.front_door import Weaver
from mmweaver.weaver.generation import Room
from tests.motion.rooms import room

WEAVER = Weaver("physics")
LONG = "a person walks 4 m away from the radar"


def deep_room() -> Room:
    """Free floor of 7 x 8 m, twice as deep as the usual window."""
    return Room(scene=room(width_m=7, depth_m=8), inputs={}, seconds={})


def test_a_longer_way_widens_the_window_and_says_so():
    request = WEAVER.request(LONG, seed=1)
    assert lost_of(compose_request(request, deep_room().scene)) > 0
    wider, (motion,) = widened(request, deep_room().scene)
    (near, far), (old_near, old_far) = wider.range_window_m, request.range_window_m
    assert far > old_far + 0.5
    assert near <= old_near
    pelvis_m = motion.pose.joints_m[:, 0]
    assert np.linalg.norm(pelvis_m[-1, :2]) - np.linalg.norm(pelvis_m[0, :2]) == pytest.approx(4.0, abs=0.4)
    assert np.linalg.norm(motion.pose.joints_m, axis=-1).max() < far
    assert sum("range window is widened" in note for note in motion.assumptions) == 1
    assert motion.clauses[0].status == DONE


def test_a_way_that_fits_keeps_the_window():
    request = WEAVER.request("a person walks 1 m away from the radar", seed=1)
    same, (motion,) = widened(request, deep_room().scene)
    assert same.config == request.config
    assert not any("widened" in note for note in motion.assumptions)


def test_strict_refuses_what_the_joints_do_not_show():
    request = WEAVER.request(LONG, seed=1, strict=True)
    with pytest.raises(InputError, match=r"4 m away from the radar asked, [0-3]\.\d+ shown"):
        compose_request(request, deep_room().scene)
    assert widened(request, deep_room().scene)[1][0].clauses[0].status == DONE


def test_furniture_that_can_be_put_somewhere_is_that_which_advice_names():
    assert set(RECORD_OF) == FURNISHABLE


def test_a_bed_that_is_missing_is_put_there_and_sat_on():
    own = WEAVER.sample_room()
    request = WEAVER.request("a person sits on the bed", seed=2, missing="furnish")
    furnished = furnished_room(request, own)
    ((kind, x, y, _),) = furnished.inputs["furniture"]
    assert kind == "bed"
    assert len(furnished.scene.faces) > len(own.scene.faces)
    assert (furnished.scene.photo.depth_m < own.scene.photo.depth_m - 0.05).any()
    assert furnished.scene.free_space.is_free.sum() < own.scene.free_space.is_free.sum()
    (motion,) = compose_request(request, furnished.scene)
    assert motion.clauses[0].status == DONE
    assert np.hypot(*(motion.pose.joints_m[-1, 0, :2] - (x, y))) < 1.3
    (other,) = compose_request(replace(request, missing="stand-in"), own.scene)
    assert other.clauses[0].status != DONE


def test_furniture_echoes_and_stands_where_it_was_put():
    own = WEAVER.sample_room().with_furniture(("wardrobe", (0.0, 2.0)))
    (mark,) = (mark for mark in own.scene.landmarks if mark.kind == "wardrobe")
    assert mark.position_m[:2] == pytest.approx((0.0, 2.0), abs=0.3)
    alone = WEAVER.generate(WEAVER.sample_room(), "nobody", frames=1, seed=0, board="ideal")
    behind = WEAVER.generate(own, "nobody", frames=1, seed=0, board="ideal")
    near = np.abs(behind.cube.grid.range_m - 1.75) < 0.15
    power = [float((np.abs(one.cube.values[:, near]) ** 2).sum()) for one in (alone, behind)]
    assert power[1] > 2 * power[0]
