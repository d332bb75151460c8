import numpy as np
import pytest

from mmweaver.compression.cell_choice import active_cells
from mmweaver.compression.chunk import decode_chunk
from mmweaver.compression.quality_search import within_error
from mmweaver.compression.rate_search import error_db
from mmweaver.core.errors import InputError
from tests.compression.test_mmw_codec import plain_cube
from tests.compression.test_rate_search import segment_of
from tests.fields.echoes import SMALL, crowd


def test_a_quality_is_found_in_a_few_trials():
    cube, trials = crowd(), []
    chunks = within_error(segment_of(cube), 20.0, trials.append)
    values = np.concatenate([decode_chunk(chunk, cube.config).cube_values() for chunk in chunks])
    assert -20.3 <= error_db(cube.values, values, active_cells(cube.values)) <= -20
    assert len(trials) <= 12


def test_what_cannot_be_reached_is_refused():
    with pytest.raises(InputError, match="300 dB"):
        within_error(segment_of(crowd(num_frames=1)), 300.0, lambda _: None)


def test_a_cube_of_one_number_is_kept_without_loss():
    """Its transforms would take a thousand bytes for matrices alone."""
    cube = plain_cube(SMALL, 5, "constant")
    chunks = within_error(segment_of(cube), 20.0, lambda _: None)
    assert sum(map(len, chunks)) < 500
    assert np.array_equal(np.concatenate([decode_chunk(one, cube.config).cube_values() for one in chunks]), cube.values)
