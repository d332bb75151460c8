"""Poses of radars: directions by hand, there and back, and what is refused."""

import numpy as np
import pytest

from mmweaver.core.errors import InputError
from mmweaver.core.radar_pose import AT_CAMERA, RadarPose, check_poses


@pytest.mark.parametrize(
    ("words", "point", "seen"),
    [
        ("0,0,0,0,0", (1, 2, 3), (1, 2, 3)),
        ("1,2,3,0,0", (1, 4, 3), (0, 2, 0)),
        ("0,0,0,90,0", (2, 0, 0), (0, 2, 0)),  # turned to the right, it looks along x
        ("0,0,0,0,30", (0, np.cos(np.pi / 6), 0.5), (0, 1, 0)),  # lifted
        ("0,0,0,0,0,90", (0, 1, 1), (-1, 1, 0)),  # leant to its right, what was above is on its left
        ("2,2,0,-90,0", (0, 2, 0.5), (0, 2, 0.5)),
    ],
)
def test_places_are_seen_where_they_are(words: str, point: tuple[float, ...], seen: tuple[float, ...]):
    pose = RadarPose.of_words(words)
    np.testing.assert_allclose(pose.seen(np.array(point)), seen, atol=1e-12)
    np.testing.assert_allclose(pose.in_level_frame(np.array(seen)), point, atol=1e-12)
    assert RadarPose.of_words(pose.words) == pose


def test_a_pose_is_a_rotation():
    rotation = RadarPose.of_words("0.3,1,-0.2,25,-14.5,70").from_level
    np.testing.assert_allclose(rotation @ rotation.T, np.eye(3), atol=1e-12)
    assert np.linalg.det(rotation) == pytest.approx(1.0)


def test_radars_elsewhere_have_noise_of_their_own():
    here, there = AT_CAMERA, RadarPose(x_m=1.0)
    assert here.noise_seed(7) == 7
    assert len({here.noise_seed(7), there.noise_seed(7), there.noise_seed(8)}) == 3


@pytest.mark.parametrize(
    "words", ["", "1,2,3", "a,b,c,d,e", "0,0,0,0,0,0,0", "nan,0,0,0,0", "0,0,0,0,91", "1e9,0,0,0,0"]
)
def test_what_is_no_pose_is_refused(words: str):
    with pytest.raises(InputError):
        RadarPose.of_words(words)


def test_radars_at_the_same_place_are_refused():
    with pytest.raises(InputError, match="same place"):
        check_poses((AT_CAMERA, AT_CAMERA))
