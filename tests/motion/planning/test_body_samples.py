"""A body as points: where the same body stands elsewhere, the points do, too."""

import numpy as np

from mmweaver.motion.animation.root_path import RootPath
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
