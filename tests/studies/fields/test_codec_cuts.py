import numpy as np
import pytest

from mmweaver.core.boards import BGT60
from mmweaver.core.errors import InputError
from mmweaver.core.records import AdcCube
from mmweaver.signal.cube import radar_cube
from studies.fields.codec_cuts import CUTS, USUAL, cut
from studies.fields.codecs import CODECS


def recording() -> AdcCube:
    """8 frames of the radar; each sample is the number of its loop."""
    shape = (8, BGT60.num_loops, 1, 3, BGT60.num_samples)
    loops = np.arange(8 * BGT60.num_loops).reshape(shape[:2])[..., None, None, None]
    return AdcCube(samples=np.broadcast_to(loops, shape).astype(np.complex64), config=BGT60, scale=float("nan"))


def test_loops_of_all_frames_count_on():
    shorter = cut(recording(), frames=20, loops=2, antennas=1, ranges=16)
    assert shorter.samples.shape == (20, 2, 1, 1, BGT60.num_samples)
    assert np.array_equal(shorter.samples[:, :, 0, 0, 0].ravel(), np.arange(40))
    assert radar_cube(shorter).values.shape == (20, 16, 2, 1)


def test_cuts_are_of_recordings():
    with pytest.raises(InputError, match="--data"):
        CUTS[next(iter(CUTS))](None)
    assert set(USUAL) <= set(CODECS)
