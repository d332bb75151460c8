"""Doors and windows on the walls of a photo without a class mask, from their size and contrast with the wall."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float

from mmweaver.core.aligned_photo import AlignedPhoto
from mmweaver.core.records import Plane
from mmweaver.core.shapes import Array, Vec3
from mmweaver.scene.photo.depth_grid import depth_tolerance_m

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
