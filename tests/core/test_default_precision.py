"""A caller's default type of torch changes nothing."""

import numpy as np
import pytest
import torch

from mmweaver.core.seeding import single_precision
from mmweaver.weaver.front_door import Weaver


def test_the_default_type_is_restored():
    with pytest.raises(KeyError), single_precision():
        assert torch.get_default_dtype() == torch.float32
        raise KeyError
    assert torch.get_default_dtype() == torch.float32


@pytest.mark.parametrize("method", ["physics", "weaver"])
def test_a_signal_is_the_same_under_double_precision(method: str):
    weaver = Weaver(method=method)
    room = weaver.sample_room()
    expected = weaver.generate(room, "a person waves", frames=1, seed=3).cube.values
    torch.set_default_dtype(torch.float64)
    try:
        again = weaver.generate(room, "a person waves", frames=1, seed=3).cube.values
    finally:
        torch.set_default_dtype(torch.float32)
    assert np.array_equal(again, expected)
