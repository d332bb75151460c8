"""Cutting, scaling, and the height of a body."""

import numpy as np
import pytest
from mocap_files import walk

from mmweaver.core.errors import InputError
from mmweaver.motion.mocap.clip import MotionClip


def clip() -> MotionClip:
    return MotionClip(joints_m=walk(), fps=60.0, label="walk")


def test_the_height_of_our_own_body_comes_back():
    assert clip().height_m == pytest.approx(1.75, abs=0.02)


def test_scaling():
    small = clip().scaled_to(1.5)
    assert small.height_m == pytest.approx(1.5)
    ratio = small.joints_m / np.where(walk() == 0, 1, walk())
    np.testing.assert_allclose(ratio, 1.5 / clip().height_m)
    assert "scaled" in small.notes[-1]
    with pytest.raises(InputError, match="outside"):
        clip().scaled_to(3.0)


def test_cutting():
    later = clip().after(0.5)
    np.testing.assert_array_equal(later.joints_m, walk()[30:])
    assert later.first_frame == 30
    assert later.after(0.5).first_frame == 60
    for start in (-1.0, 2.0, 50.0):
        with pytest.raises(InputError, match="cannot start"):
            clip().after(start)
