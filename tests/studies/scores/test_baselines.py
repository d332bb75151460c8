import numpy as np

from studies.scores.cube_scores import all_zeros, static_mean
from tests.cubes import point_cube


def test_baselines_know_nothing_that_moves():
    cube = point_cube()
    assert not all_zeros(cube).values.any()
    still = static_mean(cube).values
    assert still.shape == cube.values.shape
    assert (still[0] == still[-1]).all()
    assert np.allclose(still[0], cube.values.mean(axis=0), atol=1e-6)
