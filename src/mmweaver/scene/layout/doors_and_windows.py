"""Doors and windows on the walls of a photo without a mask: by their size, and by how they differ from the wall."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float

from mmweaver.core.records import Plane, RgbdPhoto
from mmweaver.core.shapes import Array, Rotation
from mmweaver.geometry.pinhole import project
from mmweaver.scene.photo.depth_grid import depth_tolerance_m

CELL_M = 0.05
_DOOR_WIDTH_M, _WINDOW_WIDTH_M = (0.65, 1.30), (0.7, 2.4)
_DOOR_BAND_M, _WINDOW_BAND_M, _SILL_BAND_M = (0.15, 1.85), (1.05, 1.95), (0.25, 0.70)
# A door is the whole wall's other colour from the floor to over head height, and the wall goes on above: windows over
# something, boards and cupboards differ only in parts.
_DOOR_FOOT_M, _LINTEL_M = (0.0, 0.15), (2.15, 2.4)
_WHOLE, _WHOLE_FOOT, _FEW_ABOVE = 0.95, 0.8, 0.4
_FOOT_KNOWN, _ALL_KNOWN = 0.4, 0.85
_FARTHEST_M = 5.0
_MIN_KNOWN, _MIN_SHARE = 0.45, 0.72
_LEAF_M = 0.09  # how far a leaf or a frame may stand before its wall

Wall2 = Float[Array, "height along"]
WallMask = Bool[Array, "height along"]


@dataclass(frozen=True, kw_only=True)
class Opening:
    """A door or a window in a wall: its middle, and places along its foot on the floor."""

    kind: str
    position_m: Float[Array, "3"]
    foot_m: Float[Array, "square 2"]


@dataclass(frozen=True, kw_only=True)
class _WallPicture:
    """A wall in squares of 5 cm from the floor up: what is known of each, and what differs from the wall."""

    known: WallMask  # seen, and not hidden by something before it
    differs: WallMask  # of another colour, open to what lies behind, or without depth as glass is
    along_m: Float[Array, " along"]
    height_m: Float[Array, " height"]


def find_openings(
    photo: RgbdPhoto, radar_from_camera: Rotation, floor_z_m: float, planes: tuple[Plane, ...]
) -> list[Opening]:
    """Runs of columns, as wide as a door or a window, that differ from the wall at its heights and not beside it.

    Doors are told only where next to nothing speaks against them: few are found, and those are doors.
    """
    found: list[Opening] = []
    for wall in planes:
        if wall.kind != "wall" or np.linalg.norm(wall.centre_m) > 2 * _FARTHEST_M:
            continue
        picture = _picture(photo, radar_from_camera, floor_z_m, wall)
        if picture is None:
            continue
        doors = [run for run in _runs(picture, _DOOR_BAND_M, _DOOR_WIDTH_M) if _is_door(picture, run)]
        windows = [
            run for run in _runs(picture, _WINDOW_BAND_M, _WINDOW_WIDTH_M)
            if _share(picture, run, _SILL_BAND_M) < 0.35 and not any(run[0] < b and a < run[1] for a, b in doors)
        ]  # fmt: skip
        found += [_opening("door", run, picture, wall, floor_z_m) for run in doors]
        found += [_opening("window", run, picture, wall, floor_z_m) for run in windows]
    return found


def _picture(photo: RgbdPhoto, radar_from_camera: Rotation, floor_z_m: float, wall: Plane) -> _WallPicture | None:
    """Looks up the wall's squares in the photo."""
    along = np.arange(-wall.half_size_m[0] - 0.6, wall.half_size_m[0] + 0.6, CELL_M)
    height = np.arange(CELL_M / 2, 2.4, CELL_M)
    a, h = np.meshgrid(along, height)
    points = wall.centre_m + a[..., None] * wall.axis_u
    points[..., 2] = floor_z_m + h
    camera = photo.intrinsics
    pixels, depth = project(points.reshape(-1, 3) @ radar_from_camera, camera)
    pixels = np.nan_to_num(np.round(pixels), nan=-1.0)
    column, row = np.clip(pixels, -1, 1e6).astype(int).T
    inside = (column >= 0) & (column < camera.width) & (row >= 0) & (row < camera.height) & (depth < _FARTHEST_M)
    column, row = np.where(inside, column, 0), np.where(inside, row, 0)
    measured, colour = photo.depth_m[row, column], photo.rgb[row, column].astype(float) / 255
    tolerance = depth_tolerance_m(np.nan_to_num(depth, nan=9.0)) + 0.02
    before = measured < depth - tolerance - _LEAF_M
    behind = measured > depth + 0.25 + tolerance
    on_wall = inside & ~before & ~behind & np.isfinite(measured)
    if on_wall.sum() < 60:
        return None
    usual = np.median(colour[on_wall], axis=0)
    away = _unlike(colour, usual)
    limit = max(0.055, 2.5 * float(np.median(away[on_wall])))
    differs = inside & ~before & ((away > limit) | behind | np.isnan(measured))
    shape = a.shape
    known = inside & ~before
    return _WallPicture(
        known=known.reshape(shape), differs=differs.reshape(shape), along_m=along, height_m=height
    )  # fmt: skip


def _unlike(colour: Float[Array, "n 3"], usual: Float[Array, "3"]) -> Float[Array, " n"]:
    """Difference of hue (colour over brightness), and of brightness beyond what shadow and light make."""
    bright, normal = colour.mean(axis=1), max(float(usual.mean()), 0.02)
    hue = np.abs(colour / np.maximum(bright, 0.04)[:, None] - usual / normal).max(axis=1)
    return 0.5 * hue + 0.35 * np.clip(np.abs(np.log(np.maximum(bright, 0.01) / normal)) - 0.12, 0, None)


def _runs(picture: _WallPicture, band_m: tuple[float, float], width_m: tuple[float, float]) -> list[tuple[int, int]]:
    """Spans of columns in which most of what is known within the band differs; others beside them do not."""
    rows = (picture.height_m > band_m[0]) & (picture.height_m < band_m[1])
    known = picture.known[rows]
    share = (picture.differs[rows] & known).sum(axis=0) / np.maximum(known.sum(axis=0), 1)
    differs = (share > _MIN_SHARE) & (known.mean(axis=0) > _MIN_KNOWN)
    # Handles, panels and glazing bars leave gaps of a column or two.
    differs |= np.pad(differs[2:], (0, 2)) & np.pad(differs[:-2], (2, 0))[: len(differs)]
    edges = np.flatnonzero(np.diff(np.concatenate([[0], differs.astype(int), [0]])))
    runs = [(int(start), int(end)) for start, end in zip(edges[::2], edges[1::2], strict=True)]
    return [run for run in runs if width_m[0] <= (run[1] - run[0]) * CELL_M <= width_m[1]]


def _is_door(picture: _WallPicture, run: tuple[int, int]) -> bool:
    """Differs all over and down to the floor, where that is seen, and ends under the wall above it."""
    if _share(picture, run, _DOOR_BAND_M) < _WHOLE or _share(picture, run, _LINTEL_M) > _FEW_ABOVE:
        return False
    if _known(picture, run, _DOOR_FOOT_M) >= _FOOT_KNOWN:
        return _share(picture, run, _DOOR_FOOT_M) >= _WHOLE_FOOT
    return _known(picture, run, _DOOR_BAND_M) >= _ALL_KNOWN


def _known(picture: _WallPicture, run: tuple[int, int], band_m: tuple[float, float]) -> float:
    rows = (picture.height_m > band_m[0]) & (picture.height_m < band_m[1])
    return float(picture.known[rows][:, slice(*run)].mean())


def _share(picture: _WallPicture, run: tuple[int, int], band_m: tuple[float, float]) -> float:
    rows = (picture.height_m > band_m[0]) & (picture.height_m < band_m[1])
    part = (slice(None), slice(*run))
    known = picture.known[rows][part]
    return float((picture.differs[rows][part] & known).sum() / max(int(known.sum()), 1))


def _opening(kind: str, run: tuple[int, int], picture: _WallPicture, wall: Plane, floor_z_m: float) -> Opening:
    along = picture.along_m[run[0] : run[1]]
    places = wall.centre_m + along[:, None] * wall.axis_u + 0.05 * wall.normal
    middle = places.mean(axis=0)
    middle[2] = floor_z_m + (1.0 if kind == "door" else 1.5)
    return Opening(kind=kind, position_m=middle, foot_m=places[:, :2].copy())
