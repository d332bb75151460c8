"""Which range bins a radar keeps."""

import pytest

from mmweaver.core.boards import AWR1843, BGT60
from mmweaver.core.errors import InputError
from mmweaver.core.range_window import chosen_range, with_range, with_range_bins


def test_metres_become_the_nearest_bins():
    config = with_range(AWR1843, 0.3, 8.0)
    assert config.range_m[0] == pytest.approx(0.3, abs=config.range_resolution_m / 2)
    assert config.range_m[-1] == pytest.approx(8.0, abs=config.range_resolution_m / 2)


def test_the_end_of_the_unambiguous_range_is_kept():
    assert with_range(BGT60, 0.0, BGT60.max_range_m).num_range_bins == 32


@pytest.mark.parametrize(("near_m", "far_m"), [(-1.0, 2.0), (3.0, 2.0), (2.0, 2.0), (0.0, 12.0), (0.0, float("nan"))])
def test_an_impossible_range_is_refused(near_m: float, far_m: float):
    with pytest.raises(InputError):
        with_range(AWR1843, near_m, far_m)


def test_bins_are_kept_as_named():
    config = with_range_bins(AWR1843, 10, 255)
    assert (config.first_range_bin, config.num_range_bins) == (10, 246)
    with pytest.raises(InputError, match="0 to 255"):
        with_range_bins(AWR1843, 0, 256)


def test_metres_or_bins_not_both():
    assert chosen_range(AWR1843) is AWR1843
    with pytest.raises(InputError, match="not both"):
        chosen_range(AWR1843, (0.0, 3.0), (0, 3))
