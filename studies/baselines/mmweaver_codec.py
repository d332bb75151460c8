"""Our own codec as one of them: whole .mmw files, header and checksums included."""

import tempfile
from pathlib import Path

from mmweaver.compression.mmw_codec import compress_cube, read_cube
from mmweaver.core.errors import InputError
from mmweaver.core.records import RadarCube
from mmweaver.core.shapes import CubeValues
from studies.baselines.codec_interface import Codec


class Mmw(Codec):
    """Scatterers, static layer and residual in a .mmw file; with `keep_noise`, noise cells have the same weight as
    others."""

    def __init__(self, *, keep_noise: bool = False, effort: str = "full"):
        self.keep_noise, self.effort = keep_noise, effort
        self.name = "mmw_keep_noise" if keep_noise else "mmw"

    def encoded(self, cube: RadarCube, num_bytes: int) -> bytes | None:
        try:
            return compress_cube(cube, num_bytes=num_bytes, keep_noise=self.keep_noise, effort=self.effort)
        except InputError:
            return None

    def decoded(self, data: bytes, like: RadarCube) -> CubeValues:
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "cube.mmw"
            path.write_bytes(data)
            return read_cube(path).values
