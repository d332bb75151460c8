"""`.mmw` compared with the codecs of others that are installed, on the user's own cube."""

import time
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np

from mmweaver.compression.cell_choice import active_cells
from mmweaver.compression.mmw_codec import compress_cube, error_db, values_of_bytes
from mmweaver.compression.rivals.codec_interface import Codec
from mmweaver.compression.rivals.coefficient_codecs import KltContext, TopCells, TopCoefficients, Wavelets
from mmweaver.compression.rivals.float_compressors import Blosc2, Sperr, Sz3, Zfp
from mmweaver.compression.rivals.picture_codecs import Jpeg2000, JpegXl
from mmweaver.compression.rivals.tensor_codecs import TensorTrain, TruncatedSvd, Tucker
from mmweaver.core.errors import InputError
from mmweaver.core.records import RadarCube
from mmweaver.core.shapes import CubeValues

RIVALS: tuple[type[Codec], ...] = (
    KltContext, TopCoefficients, TopCells, TruncatedSvd, Tucker, TensorTrain, Wavelets, Sz3, Sperr, Zfp, Blosc2,
    Jpeg2000, JpegXl,
)  # fmt: skip

Row = dict[str, Any]


class OwnCodec(Codec):
    """Whole .mmw files, header and checksums included."""

    name = "mmw"

    def encoded(self, cube: RadarCube, num_bytes: int) -> bytes | None:
        try:
            return compress_cube(cube, num_bytes=num_bytes)
        except InputError:
            return None

    def decoded(self, data: bytes, like: RadarCube) -> CubeValues:
        return values_of_bytes(data)


def compared(cube: RadarCube, num_bytes: int, progress: Callable[[str], None] = lambda _: None) -> list[Row]:
    """A row for .mmw and for each codec that is installed: bytes, errors in dB, CPU seconds; None where impossible.

    Codecs whose package is missing have a row with its name under `missing`.
    """
    rows = []
    for make in (OwnCodec, *RIVALS):
        progress(make.name)
        rows.append(_row(make(), cube, num_bytes))
    return rows


def _row(codec: Codec, cube: RadarCube, num_bytes: int) -> Row:
    row: Row = dict.fromkeys(("bytes", "signal_error_db", "all_error_db", "encode_cpu_s", "decode_cpu_s"))
    row = {"codec": codec.name, **row}
    start = time.process_time()
    try:
        data = codec.encoded(cube, num_bytes)
    except InputError as error:
        return row | {"missing": str(error)}
    row["encode_cpu_s"] = round(time.process_time() - start, 2)
    if data is None:
        return row
    start = time.process_time()
    values = codec.decoded(data, replace(cube, values=np.zeros_like(cube.values)))
    row["decode_cpu_s"] = round(time.process_time() - start, 2)
    active = active_cells(cube.values)
    return row | {
        "bytes": len(data),
        "signal_error_db": round(error_db(cube.values, values, active), 2),
        "all_error_db": round(error_db(cube.values, values, np.ones_like(active)), 2),
    }
