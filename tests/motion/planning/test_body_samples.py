"""A body as points: where the same body stands elsewhere, the points do, too."""

import numpy as np

from mmweaver.motion.animation.root_path import Move, RootPath
from mmweaver.motion.planning.body_samples import BodySamples
from tests.rooms import standing_person

HERE = RootPath(start_m=(0.0, 2.0), heading_rad=-np.pi / 2)


def test_a_body_moved_to_another_path_is_the_body_animated_there():
    body = BodySamples.of(standing_person((0.0, 2.0, -1.1), seconds=0.3))
    elsewhere = BodySamples.of(standing_person((0.7, 3.0, -1.1), seconds=0.3))
    moved = body.relative_to(HERE).along(RootPath(start_m=(0.7, 3.0), heading_rad=-np.pi / 2))
    assert np.allclose(moved.points_m, elsewhere.points_m)
    assert np.allclose(moved.lowest_m, elsewhere.lowest_m)


def test_a_body_turned_on_the_spot_faces_the_other_way():
    body = BodySamples.of(standing_person((0.0, 2.0, -1.1), seconds=0.3))
    turned = body.relative_to(HERE).along(RootPath(start_m=(0.0, 2.0), heading_rad=np.pi / 2))
    assert np.allclose(turned.points_m[:, :2] + body.points_m[:, :2], [0.0, 4.0])


def test_repeats_are_left_out_only_where_the_body_stays():
    body = BodySamples.of(standing_person((0.0, 2.0, -1.1), seconds=1.0))
    once = body.deduplicated()
    assert len(once.points_m) * 9 < len(body.points_m)
    walk = Move(start_s=0.0, end_s=1.0, length_m=1.0, direction_rad=0.0, ramp_in_s=0.0, ramp_out_s=0.0)
    walks = body.relative_to(HERE).along(RootPath(start_m=(0.0, 2.0), heading_rad=-np.pi / 2, moves=(walk,)))
    assert len(walks.deduplicated().points_m) == len(walks.points_m)
