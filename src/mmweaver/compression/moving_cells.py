"""What is left in moving cells of a chunk, coded again with a finer step: few cells, whatever the transform."""

from dataclasses import replace

import numpy as np
from jaxtyping import Bool, Complex, Float

from mmweaver.compression.entropy import BitStream, Encoder
from mmweaver.compression.residual_stream import QuantizedCells, cell_energy, code_plain_cells, quantized
from mmweaver.compression.transforms import static_bins

Array = np.ndarray
FINER_STEPS = (1, 2, 4, 8)  # the step over that of moving cells
NO_OFFSET = (128, 128)  # centroids
# the byte of a chunk's prefix: which of COARSE_STEPS, which of FINER_STEPS times 8, 64 for version 5
COARSE_STEPS = (1, 2, 4, 8, 16, 32, 3)  # in fine steps
FINER, IS_VERSION_5 = 8, 64


def moving_cells(is_active: Bool[Array, "frame range doppler"]) -> Bool[Array, "frame range doppler"]:
    """Active cells outside the static Doppler bins."""
    mask = is_active.copy()
    mask[:, :, static_bins(mask.shape[2])] = False
    return mask


def code_moving(
    stream: Encoder,
    rest: Complex[Array, "frame range doppler antenna"],
    beams: Complex[Array, "beam antenna"],
    is_moving: Bool[Array, "frame range doppler"],
    step: float,
) -> Float[Array, "frame range doppler"]:
    """Codes moving cells of what is left at a step; returns the energy of each cell that is left then."""
    values = np.tensordot(beams.astype(rest.dtype), rest, axes=(1, 3))
    left = cell_energy(values)
    cells = replace(quantized(values, step, 0, is_moving, energy=left), centroids=NO_OFFSET)
    code_plain_cells(stream, cells.levels, cells.classes)
    is_open = cells.classes > 0
    left[is_open] = cell_energy(values[:, is_open] - cells.open_values(step, 1))
    return left


def decoded_moving(
    stream: BitStream, shape: tuple[int, ...], beams: Complex[Array, "beam antenna"], step: float
) -> Complex[Array, "frame range doppler antenna"]:
    """What `code_moving` coded of a chunk of this shape, complex64."""
    classes = np.zeros(shape[:3], np.int64)
    cells = QuantizedCells(
        levels=code_plain_cells(stream, None, classes, shape[3]), classes=classes, centroids=NO_OFFSET
    )
    rest = np.tensordot(beams.conj(), cells.values(step, 1), axes=(0, 0))
    return np.moveaxis(rest, 0, 3).astype(np.complex64)


def pack_steps(coarser: int, finer: int) -> int:
    """The byte that says coarse and finer steps, and the version."""
    return IS_VERSION_5 + FINER * FINER_STEPS.index(finer) + COARSE_STEPS.index(coarser)


def unpack_steps(byte: int, *, is_version_3: bool) -> tuple[int, int, int]:
    """Coarse step, finer step and version. Raises ValueError for what no encoder writes."""
    version, finer = 3 if is_version_3 else 4, 1
    if byte & IS_VERSION_5 and not is_version_3:
        version, finer, byte = 5, FINER_STEPS[byte // FINER % 4], byte & ~(IS_VERSION_5 + 3 * FINER)
    if byte >= len(COARSE_STEPS):
        raise ValueError("impossible prefix")
    return COARSE_STEPS[byte], finer, version
