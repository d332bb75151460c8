"""Windows and mirrors: a depth camera looks through the one and into the other; a radar meets both where they hang."""

from dataclasses import replace
from typing import Any

import numpy as np
from jaxtyping import Bool, Float

from mmweaver.core.records import RgbdPhoto
from mmweaver.core.shapes import Array, DepthPixels
from mmweaver.scene.coco_stuff import GLASS, MIRRORS

SMALLEST = 0.002  # of the picture
RIM = 0.02  # width of the rim around a pane that tells its plane, in picture widths
FEWEST_RIM_PIXELS = 60
OFF_PLANE = 0.04  # the rim's inverse depths may miss the plane by this share, in the median
BEHIND_M = 0.08  # what lies so far behind the pane's plane was seen through it
FITS = 5


def with_panes(photo: RgbdPhoto) -> tuple[RgbdPhoto, tuple[str, ...]]:
    """The photo with the depth of each known window and mirror put where its rim says the pane is.

    Only pixels without depth or with depth behind the pane change; a pane whose rim is no plane is left as it is.
    """
    if photo.classes is None:
        return photo, ()
    from scipy.ndimage import label

    wanted = [index for index, name in enumerate(photo.classes.names) if name in GLASS | MIRRORS]
    found: Any = label(np.isin(photo.classes.index, wanted))
    regions, count = found
    depth_m, filled = photo.depth_m.copy(), 0
    for region in range(1, count + 1):
        pane = regions == region
        if pane.mean() < SMALLEST:
            continue
        plane_m = _plane_depth(pane, photo.depth_m)
        if plane_m is None:
            continue
        with np.errstate(invalid="ignore"):
            behind = pane & (plane_m > 0) & ~(photo.depth_m < plane_m + BEHIND_M)
        depth_m[behind] = plane_m[behind]
        filled += bool(behind.any())
    if not filled:
        return photo, ()
    sentence = (
        f"{filled} windows or mirrors were closed: what the depth picture showed behind them was put on their plane."
    )
    return replace(photo, depth_m=depth_m), (sentence,)


def _plane_depth(pane: Bool[Array, "height width"], depth_m: DepthPixels) -> Float[Array, "height width"] | None:
    """The depth that the plane through a pane's rim has at every pixel: 1/z is linear in the picture."""
    from scipy.ndimage import binary_dilation

    height, width = depth_m.shape
    reach = max(2, round(RIM * width))
    rim = binary_dilation(pane, iterations=reach) & ~pane & np.isfinite(depth_m)
    rows, columns = np.nonzero(rim)
    if len(rows) < FEWEST_RIM_PIXELS:
        return None
    factors = np.stack([columns / width, rows / width, np.ones(len(rows))], axis=1)
    inverse = 1 / depth_m[rim]
    keep = np.abs(inverse - np.median(inverse)) < 0.5 * np.median(inverse)
    plane = np.zeros(3)
    for _ in range(FITS):  # least squares of the better half of what is kept, again and again
        if keep.sum() < FEWEST_RIM_PIXELS // 2:
            return None
        plane = np.linalg.lstsq(factors[keep], inverse[keep], rcond=None)[0]
        error = np.abs(factors @ plane - inverse) / np.maximum(inverse, 1e-6)
        keep = error <= max(float(np.median(error)), 0.01)
    if np.median(error[keep]) > OFF_PLANE:
        return None
    across, down = np.arange(width) / width, np.arange(height)[:, None] / width
    fitted = plane[0] * across + plane[1] * down + plane[2]
    return np.where(fitted > 1e-3, 1 / np.maximum(fitted, 1e-3), np.nan)
