from pathlib import Path

import numpy as np
import pytest

from mmweaver.core.errors import InputError
from tests.compression.test_mmw_codec import SHAPES, plain_cube
from tests.fields.echoes import error_db

numcodecs = pytest.importorskip("numcodecs")
zarr = pytest.importorskip("zarr")


def test_a_store_of_cubes_is_compressed(tmp_path: Path):
    from mmweaver.compression.zarr_codec import MmwCodec

    cube = plain_cube(*SHAPES["two loops, 120 frames"])
    codec = MmwCodec(cube.config, quality_db=20.0)
    store = zarr.create_array(
        tmp_path / "a.zarr", shape=cube.values.shape, chunks=(60, *cube.values.shape[1:]), dtype="complex64",
        zarr_format=2, compressors=codec, filters=None,
    )  # fmt: skip
    store[:] = cube.values
    again = zarr.open_array(tmp_path / "a.zarr", mode="r")[:]
    assert error_db(again, cube.values) < -15
    assert sum(file.stat().st_size for file in (tmp_path / "a.zarr").rglob("*")) < 0.3 * cube.values.nbytes
    assert numcodecs.get_codec(codec.get_config()).config == cube.config


def test_chunks_of_part_of_a_frame_are_refused():
    from mmweaver.compression.zarr_codec import MmwCodec

    cube = plain_cube(*SHAPES["three loops"])
    with pytest.raises(InputError, match=r"\(24, 3, 12\)"):
        MmwCodec(cube.config).encode(np.ascontiguousarray(cube.values[0, :5]))
