import numpy as np
import pytest

from mmweaver.compression.cell_coder import CLOSED, COARSE, FINE
from mmweaver.compression.entropy import Decoder, Encoder
from mmweaver.compression.quantised_cells import code_cells, quantise
from mmweaver.compression.transforms import ChunkTransform, TransformChoice
from mmweaver.core.seeding import stream


def test_cells_open_where_coding_pays():
    """Signal at the fine step, strong noise at the coarse one, the rest not at all."""
    values = np.zeros((4, 1, 3, 2), complex)
    values[:, 0, 0] = np.array([5.0, 1.0]) * (1 + 1j)
    values[:, 0, 1] = 0.3 + 0.3j
    values[:, 0, 2] = 40 + 40j
    is_active = np.array([[[True, False], [True, False], [True, False]]])
    cells = quantise(values, 1.0, 4, is_active)
    assert cells.classes[0].tolist() == [[FINE, CLOSED], [CLOSED, CLOSED], [FINE, COARSE]]
    assert np.abs(cells.values(1.0, 4)[:, 0, 2] - values[:, 0, 2]).max() < 2.0


@pytest.mark.parametrize("shape", [(1, 1, 1, 1), (3, 5, 1, 1), (2, 1, 9, 7), (4, 40, 8, 2), (12, 3, 17, 16)])
@pytest.mark.parametrize("step", [3.0, 1e-4])
def test_any_shape_and_any_size_round_trips(shape: tuple[int, ...], step: float):
    noise = stream(0, "noise").normal(size=(2, *shape))
    decay = 10 ** (-np.arange(shape[1])[:, None, None] / 4) * np.ones(shape[1:])
    values = (noise[0] + 1j * noise[1]) * 20 * decay
    transform = ChunkTransform.of(TransformChoice(), np.moveaxis(values, 0, 3), np.eye(shape[0], dtype=complex))
    cells = quantise(values, step, 4, decay > 0.1)
    coder = Encoder()
    near = np.zeros(shape[1:], np.int64)
    code_cells(coder, cells.levels.copy(), cells.classes.copy(), near, transform.correlated, 4)
    classes = np.zeros_like(cells.classes)
    levels = code_cells(Decoder(coder.to_bytes()), None, classes, near, transform.correlated, 4, shape[0])
    assert np.array_equal(levels, cells.levels)
    assert np.array_equal(classes, cells.classes)
