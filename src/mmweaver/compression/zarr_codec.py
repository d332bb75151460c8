"""The .mmw codec for Zarr: radar cubes in a store are compressed chunk by chunk.

    import zarr
    from mmweaver.compression.zarr_codec import MmwCodec
    store = zarr.create_array("walk.zarr", shape=cube.values.shape, chunks=(20, 64, 32, 12), dtype="complex64",
                              zarr_format=2, compressors=MmwCodec(cube.config, quality_db=30.0), filters=None)

Registered with numcodecs as "mmweaver", so that stores open wherever mmWeaver is installed.
"""

import math
from typing import Any

import numpy as np

from mmweaver.compression.mmw_codec import compress_cube, values_of_bytes
from mmweaver.core.errors import InputError
from mmweaver.core.optional_packages import need
from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.records import CubeGrid, RadarCube

try:
    from numcodecs.abc import Codec
    from numcodecs.compat import ensure_contiguous_ndarray_like, ndarray_copy
    from numcodecs.registry import register_codec
except ImportError:
    need("dataset", "this codec of Zarr", "numcodecs")
    raise


class MmwCodec(Codec):
    """Compresses complex64 cubes (frame, range, doppler, antenna) of one radar to a quality in dB, with loss.

    A chunk of a store must hold whole frames: its last three axes are those of the radar's cube.
    """

    codec_id = "mmweaver"

    def __init__(self, radar: RadarConfig | dict[str, Any], quality_db: float = 30.0, keep_noise: bool = False):
        self.config = radar if isinstance(radar, RadarConfig) else RadarConfig.from_values(radar)
        self.quality_db, self.keep_noise = float(quality_db), bool(keep_noise)

    def encode(self, buf: Any) -> bytes:
        """A chunk as the bytes of a .mmw file. Raises InputError where it does not hold whole frames."""
        flat = np.asarray(buf).view(np.complex64).reshape(-1)
        shape = CubeGrid.of(self.config, 1).shape[1:]
        if not flat.size or flat.size % math.prod(shape):
            raise InputError(f"a chunk of the store must hold whole frames of {shape}; choose its chunks so")
        values = flat.reshape(-1, *shape)
        grid = CubeGrid.of(self.config, len(values))
        cube = RadarCube(values=values, grid=grid, config=self.config, scale=float("nan"))
        return compress_cube(cube, quality_db=self.quality_db, keep_noise=self.keep_noise)

    def decode(self, buf: Any, out: Any = None) -> Any:
        """The values of a chunk, complex64."""
        data = ensure_contiguous_ndarray_like(buf).tobytes()
        values = np.ascontiguousarray(values_of_bytes(data))
        return values if out is None else ndarray_copy(values, out)

    def get_config(self) -> dict[str, Any]:
        """What a store keeps about its codec."""
        return {
            "id": self.codec_id, "radar": self.config.to_values(), "quality_db": self.quality_db,
            "keep_noise": self.keep_noise,
        }  # fmt: skip


register_codec(MmwCodec)  # for programs that import this module without the package's entry point
