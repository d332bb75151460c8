import numpy as np

from mmweaver.core.seeding import stream
from studies.baselines.network_codecs import _rounded, _whole


def test_weights_come_back_in_whole_numbers():
    weights = stream(0, "weights").normal(size=1000).astype(np.float32)
    again = _whole(_rounded(weights, 127))
    assert again.shape == weights.shape
    assert np.abs(again - weights).max() < np.abs(weights).max() / 120
