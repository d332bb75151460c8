import numpy as np

from mmweaver.compression.quantised_cells import active_mask
from mmweaver.core.seeding import stream


def test_active_mask_are_those_of_the_metrics():
    from studies.scores.cube_scores import cells_of
    from tests.compression.echoes import crowd

    cube = crowd()
    assert np.array_equal(active_mask(cube.values), cells_of(cube).is_active)
    assert active_mask(np.ones((1, 2, 2, 3), np.complex64)).all()


def test_missing_bins_do_not_count():
    """Where most cells are exactly zero, the noise floor is that of the others."""
    noise = stream(0, "noise").normal(size=(2, 8, 16, 4)).astype(np.complex64)
    noise[:, :, :12] = 0
    noise[1, 3, 14] = 100
    assert np.argwhere(active_mask(noise)).tolist() == [[1, 3, 14]]
