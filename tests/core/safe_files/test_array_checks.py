"""Arrays out of files are of the type, shape and range that a reader asked for."""

from typing import Any

import numpy as np
import pytest

from mmweaver.core.errors import InputError
from mmweaver.core.safe_files.array_checks import ArrayChecks, real_numbers


def test_what_fits_comes_back_as_it_is():
    values = np.array([[1.0, np.nan], [3.0, 4.0]])
    assert ArrayChecks("a").numbers("x", values, ("row", 2), low=0, high=4, nan=True) is values
    assert ArrayChecks("a").numbers("x", np.zeros((0, 3)), ("row", 3)).size == 0
    assert real_numbers("a", "x", np.array([1, 2], np.int16)).dtype == np.float64


@pytest.mark.parametrize(
    ("values", "limits", "message"),
    [
        (np.array(["a"]), {}, "real"),
        (np.array([True]), {}, "real"),
        (np.array([1j]), {}, "real"),
        (np.array([1.5]), {"kinds": "iu"}, "whole"),
        (np.zeros((2, 3)), {"shape": ("row",)}, "it must be \\(row\\)"),
        (np.zeros((2, 3)), {"shape": ("row", 4)}, "it must be \\(row, 4\\)"),
        (np.array([np.nan, 1]), {}, "not finite"),
        (np.array([np.inf, np.nan]), {"nan": True}, "not finite"),
        (np.array([1 + 1j * np.inf]), {"kinds": "c"}, "not finite"),
        (np.array([0.0, 5.0]), {"high": 4}, "outside -inf to 4"),
        (np.array([3, -1]), {"low": 0}, "runs from -1 to 3"),
        (np.array([3 + 9j]), {"kinds": "c", "high": 4}, "outside"),
    ],
)
def test_what_does_not_is_refused_with_its_name(values: np.ndarray, limits: dict[str, Any], message: str):
    with pytest.raises(InputError, match=f"a.npz: place_m .*{message}"):
        ArrayChecks("a.npz").numbers("place_m", values, **limits)


def test_an_axis_has_one_length_in_a_file():
    checks = ArrayChecks("a.npz")
    checks.numbers("time_s", np.zeros(3), ("frame",))
    checks.shape("words", (3,), ("frame",))
    with pytest.raises(InputError, match=r"joints_m.*4.*time_s.*3"):
        checks.numbers("joints_m", np.zeros((4, 22, 3)), ("frame", 22, 3))
