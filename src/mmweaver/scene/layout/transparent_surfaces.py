"""Windows, mirrors and screens: replaces their depth by that of their plane.

A depth camera measures what lies behind a pane, the reflected room, or nothing; a radar meets the pane itself.
"""

from dataclasses import replace

import numpy as np

from mmweaver.core.records import RgbdPhoto
from mmweaver.core.shapes import DepthPixels
from mmweaver.scene.coco_stuff import GLASS, MIRRORS, SCREENS, WALLS
from mmweaver.scene.layout.class_evidence import PixelMask, indices_of, regions_of
from mmweaver.scene.layout.connected_components import dilated

MIN_SHARE = 0.002  # of the picture
BORDER = 0.02  # width of the border around a pane to which its plane is fitted, in picture widths
MIN_BORDER_PIXELS = 60
MAX_RESIDUAL = 0.04  # median relative error of the border's inverse depths
BEHIND_M = 0.08  # points this far behind the pane's plane were seen through it
ITERATIONS = 5


def with_transparent_surfaces(photo: RgbdPhoto) -> tuple[RgbdPhoto, tuple[str, ...]]:
    """Replaces the depth of windows and mirrors by their planes, and fills holes of screens; returns assumptions too.

    A pane's plane is fitted to its border, a screen's to its measured pixels. Only pixels without depth or with depth
    behind the pane change; a pane whose border is not planar is left unchanged.
    """
    if photo.classes is None:
        return photo, ()
    depth_m, num_panes, num_screens = photo.depth_m.copy(), 0, 0
    for pane in regions_of(photo.classes, GLASS | MIRRORS, MIN_SHARE):
        plane_m = _plane_depth(_border(pane, photo), photo.depth_m)
        if plane_m is None:
            continue
        with np.errstate(invalid="ignore"):
            behind = pane & (plane_m > 0) & ~(photo.depth_m < plane_m + BEHIND_M)
        depth_m[behind] = plane_m[behind]
        num_panes += bool(behind.any())
    for screen in regions_of(photo.classes, SCREENS, MIN_SHARE):
        missing = screen & ~np.isfinite(depth_m)
        plane_m = _plane_depth(screen & ~missing, photo.depth_m) if missing.any() else None
        if plane_m is not None:
            depth_m[missing] = plane_m[missing]
            num_screens += 1
    if not num_panes + num_screens:
        return photo, ()
    notes = (
        (num_panes, "windows or mirrors: the depth measured behind them was replaced by that of their planes."),
        (num_screens, "screens: their missing depth was filled by the plane of their measured pixels."),
    )
    return replace(photo, depth_m=depth_m), tuple(f"{count} {note}" for count, note in notes if count)


def _border(pane: PixelMask, photo: RgbdPhoto) -> PixelMask:
    """Measured pixels just around a pane: those of the wall if there are enough, for curtains hang in front of it."""
    reach = max(2, round(BORDER * pane.shape[1]))
    border = dilated(pane, reach) & ~pane & np.isfinite(photo.depth_m)
    assert photo.classes is not None
    of_wall = border & np.isin(photo.classes.index, indices_of(photo.classes, WALLS))
    return of_wall if of_wall.sum() >= MIN_BORDER_PIXELS else border


def _plane_depth(border: PixelMask, depth_m: DepthPixels) -> DepthPixels | None:
    """The depth at every pixel, metres, of the plane through some pixels; None where they are not planar.

    The inverse depth of a plane is linear in the picture: a trimmed least-squares fit.
    """
    height, width = depth_m.shape
    rows, columns = np.nonzero(border)
    if len(rows) < MIN_BORDER_PIXELS:
        return None
    design = np.stack([columns / width, rows / width, np.ones(len(rows))], axis=1)
    inverse = 1 / depth_m[border]
    keep = np.abs(inverse - np.median(inverse)) < 0.5 * np.median(inverse)
    plane = np.zeros(3)
    for _ in range(ITERATIONS):  # refit to the better half of the pixels
        if keep.sum() < MIN_BORDER_PIXELS // 2:
            return None
        plane = np.linalg.lstsq(design[keep], inverse[keep], rcond=None)[0]
        error = np.abs(design @ plane - inverse) / np.maximum(inverse, 1e-6)
        keep = error <= max(float(np.median(error)), 0.01)
    if np.median(error[keep]) > MAX_RESIDUAL:
        return None
    x, y = np.arange(width) / width, np.arange(height)[:, None] / width
    fitted = plane[0] * x + plane[1] * y + plane[2]
    return np.where(fitted > 1e-3, 1 / np.maximum(fitted, 1e-3), np.nan)
