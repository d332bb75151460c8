"""Connected patches of a mask."""

from typing import cast

import numpy as np
from jaxtyping import Bool, Int

from mmweaver.core.shapes import Array


def labelled(mask: Bool[Array, "row column"]) -> tuple[Int[Array, "row column"], int]:
    """Numbers the patches of cells that touch by their sides from 1; 0 elsewhere. Also gives how many there are."""
    from scipy import ndimage

    labels, count = cast(tuple[np.ndarray, int], ndimage.label(mask))
    return labels, int(count)


def places(labels: Int[Array, "row column"]) -> list[tuple[slice, slice]]:
    """The rows and columns that each numbered patch spans."""
    from scipy import ndimage

    return cast(list[tuple[slice, slice]], ndimage.find_objects(labels))


def grown(mask: Bool[Array, "row column"], steps: int = 1) -> Bool[Array, "row column"]:
    """The mask and the cells within so many steps of it."""
    from scipy import ndimage

    return np.asarray(ndimage.binary_dilation(mask, iterations=steps), bool)
