import numpy as np
import pytest

from mmweaver.compression.cell_choice import active_cells
from mmweaver.compression.chunk import decode_chunk
from mmweaver.compression.quality_search import within_error
from mmweaver.compression.rate_search import error_db
from mmweaver.core.errors import InputError
from tests.compression.test_rate_search import segment_of
from tests.fields.echoes import crowd


def test_a_quality_is_found_in_a_few_trials():
    cube, trials = crowd(), []
    chunks = within_error(segment_of(cube), 20.0, trials.append)
    values = np.concatenate([decode_chunk(chunk, cube.config).cube_values() for chunk in chunks])
    assert -20.3 <= error_db(cube.values, values, active_cells(cube.values)) <= -20
    assert len(trials) <= 12


def test_what_cannot_be_reached_is_refused():
    with pytest.raises(InputError, match="cannot be reached"):
        within_error(segment_of(crowd(num_frames=1)), 300.0, lambda _: None)
