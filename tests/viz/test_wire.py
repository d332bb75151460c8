"""The bytes between Python and the page."""

import numpy as np
import pytest

from mmweaver.core.errors import InputError
from mmweaver.viz.body_in_photo import pack, unpack


def test_header_and_arrays_come_back():
    arrays = {
        "bytes": np.arange(5, dtype=np.uint8), "floats": np.ones((2, 3), np.float32),
        "whole": np.array([-1, 2], np.int32), "short": np.zeros((0, 3), np.int16),
    }  # fmt: skip
    header, back = unpack(pack({"text": "grüß", "nan": float("nan")}, arrays))
    assert header == {"text": "grüß", "nan": None}
    assert list(back) == list(arrays)
    for name, array in arrays.items():
        assert back[name].dtype == array.dtype
        np.testing.assert_array_equal(back[name], array)


def test_arrays_begin_at_multiples_of_four():
    data = pack({}, {"odd": np.arange(3, dtype=np.uint8), "floats": np.ones(2, np.float32)})
    length = int.from_bytes(data[:4], "little")
    assert length % 4 == 0
    assert b'"floats":["f4",[2],4]' in data[:length].replace(b" ", b"")


def test_a_type_that_the_page_lacks_is_a_mistake():
    with pytest.raises(ValueError, match="complex64"):
        pack({}, {"cube": np.zeros(2, np.complex64)})


@pytest.mark.parametrize("data", [b"", b"\xff\xff\xff\xff", b"\x02\0\0\0{}", b"\x04\0\0\0[1] "])
def test_other_bytes_are_refused(data: bytes):
    with pytest.raises(InputError, match="hold no sequence"):
        unpack(data)


def test_a_type_that_the_page_does_not_read_is_refused():
    data = pack({}, {"a": np.zeros(3, np.float32)})
    for kind in (b"x)", b"O8", b"c8"):
        with pytest.raises(InputError, match="no type"):
            unpack(data.replace(b"f4", kind))
