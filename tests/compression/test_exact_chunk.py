import numpy as np
import pytest

from mmweaver.compression.exact_chunk import pack_exact, unpack_exact
from mmweaver.core.seeding import stream


@pytest.mark.parametrize("shape", [(1, 1, 1, 1), (2, 3, 4, 5)])
def test_every_bit_survives(shape: tuple[int, ...]):
    values = stream(0, "values").normal(size=(*shape, 2)).astype(np.float32).view(np.complex64)[..., 0]
    for array in (values, np.zeros_like(values)):
        assert np.array_equal(unpack_exact(pack_exact(array), shape), array)


@pytest.mark.parametrize("data", [b"", b"\0", b"\1junk", b"\0" + bytes(9)])
def test_other_sizes_are_refused(data: bytes):
    with pytest.raises(ValueError):
        unpack_exact(data, (1, 2, 1, 1))
