"""A chunk without loss: float32 words, bytes of equal weight together, deflated or not."""

import zlib

import numpy as np

from mmweaver.core.shapes import CubeValues

PLAIN, DEFLATED = b"\0", b"\1"


def pack_exact(values: CubeValues) -> bytes:
    """Bytes of complex64 values."""
    words = np.ascontiguousarray(values, np.complex64).view("<f4").ravel()
    planes = words.view(np.uint8).reshape(-1, 4).T.tobytes()
    smaller = zlib.compress(planes, 9)
    return DEFLATED + smaller if len(smaller) < len(planes) else PLAIN + planes


def unpack_exact(data: bytes, shape: tuple[int, ...]) -> CubeValues:
    """The inverse of `pack_exact`. Raises ValueError where the bytes are not those of this shape."""
    size = 8 * int(np.prod(shape))
    planes = data[1:]
    if data[:1] == DEFLATED:
        unpacker = zlib.decompressobj()
        try:
            planes = unpacker.decompress(planes, size + 1)
        except zlib.error as error:
            raise ValueError(str(error)) from None
    if len(planes) != size:
        raise ValueError("wrong size")
    words = np.frombuffer(planes, np.uint8).reshape(4, -1).T.copy().view("<f4")
    return words.ravel().view(np.complex64).reshape(shape).astype(np.complex64)
