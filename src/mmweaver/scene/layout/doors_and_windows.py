"""Doors and windows on the walls of a photo without a class mask, from their size and contrast with the wall.

Windows, mirrors, screens and doors: the depth of their planes, and panels on the walls.

A depth camera measures what lies behind a pane, the reflected room, or nothing; the radar wave meets the pane itself,
which reflects more than the wall around it. Reference: docs/decisions/class-mask.md.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Bool, Float

from mmweaver.core.aligned_photo import AlignedPhoto
from mmweaver.core.records import Plane, RgbdPhoto
from mmweaver.core.shapes import Array, DepthPixels, Points, Vec3
from mmweaver.scene.coco_stuff import DOORS, GLASS, MATERIAL, MIRRORS, SCREENS, WALLS
from mmweaver.scene.layout.class_evidence import PixelMask, indices_of, regions_of
from mmweaver.scene.layout.height_map import dilated
from mmweaver.scene.photo.depth_grid import depth_tolerance_m

MIN_PANE_SHARE = 0.002  # of the picture
BORDER = 0.02  # width of the border around a pane to which its plane is fitted, in picture widths
MIN_BORDER_PIXELS = 60
MAX_RESIDUAL = 0.04  # median relative error of the border's inverse depths
BEHIND_M = 0.08  # points this far behind the pane's plane were measured through it
ITERATIONS = 5


def fill_panes(photo: RgbdPhoto) -> tuple[RgbdPhoto, tuple[str, ...]]:
    """Replaces the depth of windows and mirrors by their planes, and fills the holes of screens.

    A pane's plane is fitted to its border, a screen's to its measured pixels. Only pixels without depth or with depth
    behind the pane change; a pane whose border is not planar is left unchanged.

    Args:
        photo: Photo with depth; returned unchanged without a class mask.

    Returns:
        The photo with corrected depth, and a sentence for each kind of correction.
    """
    if photo.classes is None:
        return photo, ()
    depth_m, num_panes, num_screens = photo.depth_m.copy(), 0, 0
    for pane in regions_of(photo.classes, GLASS | MIRRORS, MIN_PANE_SHARE):
        plane_m = _plane_depth(_border(pane, photo), photo.depth_m)
        if plane_m is None:
            continue
        with np.errstate(invalid="ignore"):
            behind = pane & (plane_m > 0) & ~(photo.depth_m < plane_m + BEHIND_M)
        depth_m[behind] = plane_m[behind]
        num_panes += bool(behind.any())
    for screen in regions_of(photo.classes, SCREENS, MIN_PANE_SHARE):
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


MIN_PANEL_SHARE = 0.004  # of the picture
MIN_AREA_M2, MIN_SIDE_M = 0.15, 0.3
_MAX_OFFSET_M = 0.06  # how far a frame or a leaf may stand before its wall
_MIN_ON_WALL = 0.6  # share of a region's measured pixels that must lie on the wall
_EXTENT_PERCENTILES = (2, 98)
_SAME_NORMAL, _SAME_PLANE_M = 0.95, 0.1


def find_wall_panels(view: AlignedPhoto, walls: Sequence[Plane]) -> tuple[Plane, ...]:
    """Panels for the windows, mirrors, doors and screens that the photo's class mask shows on walls.

    Args:
        view: The photo in the radar's frame.
        walls: Walls in the same frame.

    Returns:
        Rectangles with the material of their class; empty without a class mask.
    """
    classes = view.photo.classes
    if classes is None or not walls:
        return ()
    found = []
    for name in classes.names:
        if name not in GLASS | MIRRORS | DOORS | SCREENS:
            continue
        for region in regions_of(classes, frozenset({name}), MIN_PANEL_SHARE):
            panel = _panel(region, view, walls, MATERIAL[name])
            if panel is not None:
                found.append(panel)
    return tuple(found)


def add_wall_panels(planes: Sequence[Plane], panels: Sequence[Plane], walls: Sequence[Plane]) -> tuple[Plane, ...]:
    """Adds panels to planes and removes the planes that they cover.

    Args:
        planes: All planes of the room.
        panels: Panels on its walls.
        walls: Those of `planes` that are kept in any case.

    Returns:
        The panels, then the remaining planes.
    """

    def is_kept(plane: Plane) -> bool:
        return any(plane is wall for wall in walls) or not any(_covers(panel, plane) for panel in panels)

    return (*panels, *filter(is_kept, planes))


def _covers(panel: Plane, plane: Plane) -> bool:
    offset = plane.centre_m - panel.centre_m
    return bool(
        panel.normal @ plane.normal > _SAME_NORMAL
        and abs(offset @ panel.normal) < _SAME_PLANE_M
        and abs(offset @ panel.axis_u) < panel.half_size_m[0]
        and abs(offset @ panel.axis_v) < panel.half_size_m[1]
    )


def _panel(region: PixelMask, view: AlignedPhoto, walls: Sequence[Plane], material: str) -> Plane | None:
    """The region as a rectangle on the wall that its measured pixels lie on; None where they lie on no wall."""
    depth_m, rays = view.photo.depth_m[region], view.rays[region]
    measured = np.isfinite(depth_m)
    if not measured.any():
        return None
    for wall in walls:
        with np.errstate(divide="ignore"):
            wall_depth_m = float(wall.normal @ wall.centre_m) / (rays @ wall.normal)
        tolerance_m = _MAX_OFFSET_M + depth_tolerance_m(np.maximum(depth_m, 0))
        on_wall = measured & (np.abs(wall_depth_m - depth_m) < tolerance_m)
        if on_wall.sum() < _MIN_ON_WALL * measured.sum():
            continue
        projected_m = (rays * wall_depth_m[:, None])[on_wall | ~measured & (wall_depth_m > 0)]
        offset_m = float(np.median((rays * depth_m[:, None])[on_wall] @ wall.normal - wall.centre_m @ wall.normal))
        return _rectangle(projected_m, wall, max(offset_m, 0.01), material)
    return None


def _rectangle(points_m: Points, wall: Plane, offset_m: float, material: str) -> Plane | None:
    """The bounding rectangle of points on a wall, moved off it by `offset_m`; None if it is too small."""
    local = points_m - wall.centre_m
    left, right = np.percentile(local @ wall.axis_u, _EXTENT_PERCENTILES)
    low, high = np.percentile(local @ wall.axis_v, _EXTENT_PERCENTILES)
    half = (float(right - left) / 2, float(high - low) / 2)
    if 2 * min(half) < MIN_SIDE_M or 4 * half[0] * half[1] < MIN_AREA_M2:
        return None
    middle = wall.centre_m + (left + right) / 2 * wall.axis_u + (low + high) / 2 * wall.axis_v
    return Plane(
        kind="panel",
        centre_m=middle + offset_m * wall.normal,
        normal=wall.normal,
        axis_u=wall.axis_u,
        axis_v=wall.axis_v,
        half_size_m=half,
        material=material,
    )


CELL_M = 0.05
_DOOR_WIDTH_M, _WINDOW_WIDTH_M = (0.65, 1.30), (0.7, 2.4)
_DOOR_BAND_M, _WINDOW_BAND_M, _SILL_BAND_M = (0.15, 1.85), (1.05, 1.95), (0.25, 0.70)
# A door differs from the wall over its whole height, and the wall continues above it: windows above furniture,
# boards and cupboards differ only in parts.
_DOOR_FOOT_M, _LINTEL_M = (0.0, 0.15), (2.15, 2.4)
_MIN_DOOR_SHARE, _MIN_FOOT_SHARE, _MAX_LINTEL_SHARE = 0.95, 0.8, 0.4
_MIN_FOOT_VISIBLE, _MIN_DOOR_VISIBLE = 0.4, 0.85
_MAX_DISTANCE_M = 5.0
_MIN_VISIBLE, _MIN_SHARE = 0.45, 0.72
_MIN_WALL_SQUARES = 60
_LEAF_M = 0.09  # how far a leaf or a frame may protrude from the wall

WallFloat = Float[Array, "height along"]
WallMask = Bool[Array, "height along"]
Span = tuple[int, int]  # first column, and the one after the last
BandM = tuple[float, float]


@dataclass(frozen=True, kw_only=True)
class LandmarkCandidate:
    """A landmark whose approach is not known yet."""

    kind: str
    position_m: Vec3  # its middle
    squares_m: Float[Array, "square 2"]  # (x, y) of the floor that it covers


@dataclass(frozen=True, kw_only=True)
class _WallImage:
    """A rectified view of a wall in squares of 5 cm, from the floor up."""

    is_visible: WallMask  # in the picture, and not occluded
    differs: WallMask  # in colour, or open to what lies behind, or without depth as glass is
    along_m: Float[Array, " along"]
    height_m: Float[Array, " height"]


def find_openings(view: AlignedPhoto, planes: tuple[Plane, ...]) -> list[LandmarkCandidate]:
    """Finds spans of a wall, as wide as a door or window, that differ from the wall at the corresponding heights.

    The criterion for doors is strict: it misses most doors but has few false positives.

    Args:
        view: The photo in the radar's frame.
        planes: Planes of the room; walls farther than 10 m are skipped.

    Returns:
        Candidates of kinds "door" and "window", in metres in the radar's frame.
    """
    found: list[LandmarkCandidate] = []
    for wall in planes:
        if wall.kind != "wall" or np.linalg.norm(wall.centre_m) > 2 * _MAX_DISTANCE_M:
            continue
        image = _rectified(view, wall)
        if image is None:
            continue
        doors = [span for span in _spans(image, _DOOR_BAND_M, _DOOR_WIDTH_M) if _is_door(image, span)]
        windows = [
            span
            for span in _spans(image, _WINDOW_BAND_M, _WINDOW_WIDTH_M)
            if _shares(image, span, _SILL_BAND_M)[1] < 0.35 and not any(span[0] < b and a < span[1] for a, b in doors)
        ]
        found += [_opening("door", span, image, wall, view.floor_z_m) for span in doors]
        found += [_opening("window", span, image, wall, view.floor_z_m) for span in windows]
    return found


def _rectified(view: AlignedPhoto, wall: Plane) -> _WallImage | None:
    """Samples the photo at the squares of a wall; None where too little of the wall is visible."""
    along = np.arange(-wall.half_size_m[0] - 0.6, wall.half_size_m[0] + 0.6, CELL_M)
    height = np.arange(CELL_M / 2, 2.4, CELL_M)
    a, h = np.meshgrid(along, height)
    points_m = wall.centre_m + a[..., None] * wall.axis_u
    points_m[..., 2] = view.floor_z_m + h
    seen = view.look_up(points_m)
    in_view = seen.in_picture & (seen.depth_m < _MAX_DISTANCE_M)
    measured_m = view.photo.depth_m[seen.row, seen.column]
    colour = view.photo.rgb[seen.row, seen.column].astype(float) / 255
    tolerance_m = depth_tolerance_m(seen.depth_m) + 0.02
    is_occluded = measured_m < seen.depth_m - tolerance_m - _LEAF_M
    is_open = measured_m > seen.depth_m + 0.25 + tolerance_m
    on_wall = in_view & ~is_occluded & ~is_open & np.isfinite(measured_m)
    if on_wall.sum() < _MIN_WALL_SQUARES:
        return None
    difference = _colour_difference(colour, np.median(colour[on_wall], axis=0))
    limit = max(0.055, 2.5 * float(np.median(difference[on_wall])))
    is_visible = in_view & ~is_occluded
    differs = is_visible & ((difference > limit) | is_open | np.isnan(measured_m))
    return _WallImage(is_visible=is_visible, differs=differs, along_m=along, height_m=height)


def _colour_difference(colour: Float[Array, "height along 3"], wall: Float[Array, "3"]) -> WallFloat:
    """Difference from the wall's colour in chromaticity, and in brightness beyond that of shading; colours 0 to 1."""
    brightness, wall_brightness = colour.mean(axis=-1), max(float(wall.mean()), 0.02)
    chromaticity = np.abs(colour / np.maximum(brightness, 0.04)[..., None] - wall / wall_brightness).max(axis=-1)
    log_ratio = np.abs(np.log(np.maximum(brightness, 0.01) / wall_brightness))
    return 0.5 * chromaticity + 0.35 * np.clip(log_ratio - 0.12, 0, None)


def _spans(image: _WallImage, band_m: BandM, width_m: tuple[float, float]) -> list[Span]:
    """Spans of columns of a given width that differ over most of their visible part within a band of heights."""
    rows = _rows(image, band_m)
    visible = image.is_visible[rows]
    share = (image.differs[rows] & visible).sum(axis=0) / np.maximum(visible.sum(axis=0), 1)
    differs = (share > _MIN_SHARE) & (visible.mean(axis=0) > _MIN_VISIBLE)
    # Handles, panels and glazing bars leave gaps of a column or two.
    differs |= np.pad(differs[2:], (0, 2)) & np.pad(differs[:-2], (2, 0))[: len(differs)]
    edges = np.flatnonzero(np.diff(np.concatenate([[0], differs.astype(int), [0]])))
    spans = [(int(start), int(end)) for start, end in zip(edges[::2], edges[1::2], strict=True)]
    return [span for span in spans if width_m[0] <= (span[1] - span[0]) * CELL_M <= width_m[1]]


def _is_door(image: _WallImage, span: Span) -> bool:
    """Differs over its whole height, down to the floor where that is visible, and ends below the lintel."""
    (band_seen, band), (foot_seen, foot), (_, lintel) = (
        _shares(image, span, part) for part in (_DOOR_BAND_M, _DOOR_FOOT_M, _LINTEL_M)
    )
    if band < _MIN_DOOR_SHARE or lintel > _MAX_LINTEL_SHARE:
        return False
    return foot >= _MIN_FOOT_SHARE if foot_seen >= _MIN_FOOT_VISIBLE else band_seen >= _MIN_DOOR_VISIBLE


def _rows(image: _WallImage, band_m: BandM) -> Bool[Array, " height"]:
    """The image's rows within a band of heights."""
    return (image.height_m > band_m[0]) & (image.height_m < band_m[1])


def _shares(image: _WallImage, span: Span, band_m: BandM) -> tuple[float, float]:
    """Of the squares of a span and band, the share that is visible, and of these the share that differs."""
    part = _rows(image, band_m), slice(*span)
    visible = image.is_visible[part]
    return float(visible.mean()), float((image.differs[part] & visible).sum() / max(int(visible.sum()), 1))


def _opening(kind: str, span: Span, image: _WallImage, wall: Plane, floor_z_m: float) -> LandmarkCandidate:
    along = image.along_m[span[0] : span[1]]
    places_m = wall.centre_m + along[:, None] * wall.axis_u + 0.05 * wall.normal
    middle = places_m.mean(axis=0)
    middle[2] = floor_z_m + (1.0 if kind == "door" else 1.5)
    return LandmarkCandidate(kind=kind, position_m=middle, squares_m=places_m[:, :2].copy())
