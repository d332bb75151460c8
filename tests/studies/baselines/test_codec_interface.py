"""Every codec of the table: keeps to its bytes, comes back from them alone, and errs less with more of them."""

from dataclasses import replace

import numpy as np
import pytest

from mmweaver.core import optional_packages
from mmweaver.core.errors import InputError
from studies.baselines.codec_interface import library, merged, split
from studies.fields.codecs import CODECS
from tests.compression.echoes import crowd, error_db

NEEDS = {
    "sperr": "imagecodecs", "jpeg2000": "imagecodecs", "jpegxl": "imagecodecs", "blosc2": "blosc2", "cp": "tensorly",
}  # fmt: skip
SLOW = {"inr_smooth_short", "inr_paper"}
# .mmw with its noise: "mmw" here and test_noise_is_kept_on_request in tests/compression/test_mmw_codec.py
AT_NIGHT = {"mmw_keep_noise"}


@pytest.mark.parametrize(
    "name",
    [pytest.param(name, marks=[pytest.mark.slow] * (name in AT_NIGHT)) for name in CODECS if name not in SLOW],
)
def test_bytes_are_kept_to_and_more_of_them_help(name: str):
    if name in NEEDS:
        pytest.importorskip(NEEDS[name])
    cube = crowd(num_frames=2)
    codec = CODECS[name]()
    assert codec.name == name
    blank = replace(cube, values=np.zeros_like(cube.values))
    errors = []
    for num_bytes in (2_000, 6_000 if name.startswith(("mmw", "klt")) else 24_000):
        data = codec.encoded(cube, num_bytes)
        if data is None:
            errors.append(0.0)
            continue
        assert len(data) <= num_bytes
        values = codec.decoded(data, blank)
        assert values.shape == cube.values.shape
        assert values.dtype == np.complex64
        errors.append(error_db(values, cube.values))
    assert errors[1] < min(errors[0], -3.0)


def test_what_cannot_be_so_small_says_so():
    assert CODECS["svd"]().encoded(crowd(), 100) is None
    assert CODECS["mmw"]().encoded(crowd(), 20) is None


def test_planes_come_back():
    assert np.array_equal(merged(split(crowd().values)), crowd().values)


def test_a_missing_library_is_named(monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(optional_packages, "is_installed", lambda _: False)
    with pytest.raises(InputError, match=r"tensorly.*mmweaver\[codecs\]"):
        library("tensorly.decomposition")
