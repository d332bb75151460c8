"""Windows, mirrors, screens: a depth camera looks through, into or past them; a radar meets them where they hang."""

from dataclasses import replace

import numpy as np
from jaxtyping import Bool, Float

from mmweaver.core.records import RgbdPhoto
from mmweaver.core.shapes import Array, DepthPixels
from mmweaver.scene.coco_stuff import GLASS, MIRRORS, SCREENS, WALLS
from mmweaver.scene.layout.class_evidence import numbers_of, regions_of
from mmweaver.scene.layout.connected_patches import grown

SMALLEST = 0.002  # of the picture
RIM = 0.02  # width of the rim around a pane that tells its plane, in picture widths
FEWEST_RIM_PIXELS = 60
OFF_PLANE = 0.04  # the rim's inverse depths may miss the plane by this share, in the median
BEHIND_M = 0.08  # what lies so far behind the pane's plane was seen through it
FITS = 5


def with_transparent_surfaces(photo: RgbdPhoto) -> tuple[RgbdPhoto, tuple[str, ...]]:
    """The photo with the depth of each known window and mirror put where its rim says the pane is, and the holes of
    screens on the plane of what was measured of them.

    Only pixels without depth or with depth behind the pane change; a pane whose rim is no plane is left as it is.
    """
    if photo.classes is None:
        return photo, ()
    depth_m, filled = photo.depth_m.copy(), 0
    for pane in regions_of(photo.classes, GLASS | MIRRORS, SMALLEST):
        plane_m = _plane_depth(_rim(pane, photo), photo.depth_m)
        if plane_m is None:
            continue
        with np.errstate(invalid="ignore"):
            behind = pane & (plane_m > 0) & ~(photo.depth_m < plane_m + BEHIND_M)
        depth_m[behind] = plane_m[behind]
        filled += bool(behind.any())
    screens = 0
    for screen in regions_of(photo.classes, SCREENS, SMALLEST):
        lost = screen & ~np.isfinite(depth_m)
        plane_m = _plane_depth(screen & ~lost, photo.depth_m) if lost.any() else None
        if plane_m is not None:
            depth_m[lost] = plane_m[lost]
            screens += 1
    if not filled + screens:
        return photo, ()
    said = (
        (filled, "windows or mirrors were closed: what the depth picture showed behind them was put on their plane."),
        (screens, "screens without depth were put on the plane of what was measured of them."),
    )
    return replace(photo, depth_m=depth_m), tuple(f"{count} {what}" for count, what in said if count)


def _rim(pane: Bool[Array, "height width"], photo: RgbdPhoto) -> Bool[Array, "height width"]:
    """What was measured just around a pane: of the wall if that is seen, for curtains hang before it."""
    reach = max(2, round(RIM * pane.shape[1]))
    rim = grown(pane, reach) & ~pane & np.isfinite(photo.depth_m)
    assert photo.classes is not None
    of_wall = rim & np.isin(photo.classes.index, numbers_of(photo.classes, WALLS))
    return of_wall if of_wall.sum() >= FEWEST_RIM_PIXELS else rim


def _plane_depth(rim: Bool[Array, "height width"], depth_m: DepthPixels) -> Float[Array, "height width"] | None:
    """The depth that the plane through some pixels has at every pixel: 1/z is linear in the picture."""
    height, width = depth_m.shape
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
