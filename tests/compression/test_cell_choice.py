import numpy as np

from mmweaver.compression.cell_choice import active_cells, choose_cells, round_levels, share_static_frames
from mmweaver.compression.cell_coder import CLOSED, COARSE, FINE
from mmweaver.core.seeding import stream


def test_active_cells_are_those_of_the_metrics():
    from mmweaver.metrics.cells import cells_of
    from tests.fields.echoes import crowd

    cube = crowd()
    assert np.array_equal(active_cells(cube.values), cells_of(cube).is_active)
    assert active_cells(np.ones((1, 2, 2, 3), np.complex64)).all()


def test_missing_bins_do_not_count():
    """Where most cells are exactly zero, the noise floor is that of the others."""
    noise = stream(0, "noise").normal(size=(2, 8, 16, 4)).astype(np.complex64)
    noise[:, :, :12] = 0
    noise[1, 3, 14] = 100
    assert np.argwhere(active_cells(noise)).tolist() == [[1, 3, 14]]


def test_static_cells_are_active_in_all_frames():
    is_active = np.zeros((3, 4, 8), bool)
    is_active[1, 2, 4] = is_active[1, 2, 7] = True
    joined = share_static_frames(is_active)
    assert joined[:, 2, 4].all()
    assert joined[:, 2, 7].tolist() == [False, True, False]


def test_cells_open_where_coding_pays():
    """Signal at the fine step, strong noise at the coarse one, the rest not at all."""
    parts = np.zeros((2, 4, 1, 3, 2))
    parts[:, :, 0, 0] = np.array([5.0, 1.0])
    parts[:, :, 0, 1] = 0.3
    parts[:, :, 0, 2] = 40.0
    is_active = np.array([[[True, False], [True, False], [True, False]]])
    assert choose_cells(parts, is_active)[0].tolist() == [[FINE, CLOSED], [CLOSED, CLOSED], [FINE, COARSE]]


def test_rounding_keeps_signs_and_drops_the_small():
    assert round_levels(np.array([-2.9, -0.5, 0.5, 0.9, 1.1])).tolist() == [-3, 0, 0, 1, 1]
