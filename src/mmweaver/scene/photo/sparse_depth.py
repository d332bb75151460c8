"""Depth that is mostly scattered holes: each small hole takes its nearest measurement."""

from typing import Any

import numpy as np

from mmweaver.core.shapes import DepthPixels

SPARSE = 0.65  # share of the pixels with a measurement below which holes are filled
REACH = 1.6  # in mean distances between measurements: so far a hole may lie from its nearest one


def fill_scattered_holes(depth_m: DepthPixels) -> tuple[DepthPixels, tuple[str, ...]]:
    """The depth with its scattered holes filled where fewer than 65 % of the pixels have any, and a sentence on it.

    Nothing is interpolated, so edges stay edges; holes larger than the gaps between the measurements stay holes.
    """
    from scipy.ndimage import distance_transform_edt

    measured = np.isfinite(depth_m)
    share = float(measured.mean())
    if share >= SPARSE or not measured.any():
        return depth_m, ()
    reach = REACH / np.sqrt(share)
    found: Any = distance_transform_edt(~measured, return_indices=True)
    distance, (row, column) = found
    filled = np.where(distance <= reach, depth_m[row, column], np.nan)
    sentence = (
        f"Only {100 * share:.0f} % of the pixels have a depth: holes up to {reach:.0f} pixels from a measurement took"
        " the nearest one."
    )
    return filled, (sentence,)
