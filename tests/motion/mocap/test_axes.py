"""Units and axes: estimated from the body where they are not given; an error asks for what cannot be estimated."""

import numpy as np
import pytest
from mocap_files import walk

from mmweaver.core.errors import InputError
from mmweaver.motion.mocap.axes import UNITS_M, UPS, is_reflected, metres_of, rotate_z_up, unit_of, up_of


@pytest.mark.parametrize("unit", UNITS_M)
def test_units_are_read_off_the_body(unit: str):
    metres, note = unit_of(walk() / UNITS_M[unit], None, "walk")
    assert metres == UNITS_M[unit]
    assert ("CMU" if unit == "cmu" else f"taken as {unit}") in note
    assert "1.7" in note


def test_what_could_be_anything_is_asked_for():
    for scale in (10.0, 3.0, 1e5):
        with pytest.raises(InputError, match="--motion-set unit="):
            unit_of(walk() * scale, None, "walk")
    assert unit_of(walk(), "0.056444", "walk") == (0.056444, "")
    for said in ("furlong", "-1", "0", "nan"):
        with pytest.raises(InputError, match="no unit"):
            metres_of(said)


@pytest.mark.parametrize("up", UPS)
def test_up_is_where_the_head_is(up: str):
    """A body turned so that `up` is up is found and turned back, never mirrored."""
    to_up = rotate_z_up(np.repeat(np.eye(3)[:, None], 22, axis=1), up)[:, 0].T  # columns: where the file's axes go
    lying = walk() @ to_up  # the inverse rotation, for rows
    assert np.linalg.det(to_up) == pytest.approx(1.0)
    found, note = up_of(lying, None, "walk")
    assert found == up
    assert up in note
    np.testing.assert_allclose(rotate_z_up(lying, found), walk(), atol=1e-12)


def test_who_lies_is_asked_about():
    lying = walk() @ np.array([[1.0, 0, 0], [0, 0.7071, 0.7071], [0, -0.7071, 0.7071]])
    with pytest.raises(InputError, match="--motion-set up="):
        up_of(lying, None, "walk")
    assert up_of(lying, "y", "walk") == ("y", "")
    with pytest.raises(InputError, match="one of y, z"):
        up_of(lying, "w", "walk")


def test_mirrored_bodies_are_noticed():
    assert not is_reflected(walk())
    assert is_reflected(walk() * np.array([-1.0, 1.0, 1.0]))
