"""A radar position in a scanned room: near a wall, with much of the room ahead."""

from dataclasses import dataclass

import numpy as np

from mmweaver.core.errors import InputError
from mmweaver.core.ray_caster import RayCaster
from mmweaver.core.shapes import Vec3

EYE_HEIGHT_M = 1.2
STEP_M, MIN_FREE = 0.4, 4  # between candidates; free neighbours of a place
HEAD_M, FOOT_M = 1.9, 0.12
FAR_M = 6.0  # larger distances do not count
_DIRECTIONS = 48
_HALF_VIEW = 6  # directions to either side: 45 degrees
_MAX_CANDIDATES = 400


@dataclass(frozen=True, kw_only=True)
class Viewpoint:
    """A position in metres (z up, floor at 0) and the boresight azimuth, from +x towards +y."""

    eye_m: Vec3
    azimuth_rad: float


def find_viewpoint(caster: RayCaster, vertices_m: np.ndarray, place_m: Vec3 | None = None) -> Viewpoint:
    """Finds the position above free floor, near a wall, with most of the room ahead.

    Args:
        caster: Ray caster of the upright mesh.
        vertices_m: Vertices of the mesh in metres, (vertex, 3).
        place_m: Fixed position in metres, (3,); only the azimuth is then chosen. None searches a grid.

    Returns:
        Position and azimuth.

    Raises:
        InputError: If no floor is free.
    """
    places = _free_places(caster, vertices_m) if place_m is None else np.asarray(place_m, float)[None]
    if not len(places):
        raise InputError("the mesh has no free floor below 1.9 m of air; give the place of the radar")
    azimuth = np.arange(_DIRECTIONS) * 2 * np.pi / _DIRECTIONS
    rays = np.stack([np.cos(azimuth), np.sin(azimuth), np.zeros(_DIRECTIONS)], axis=-1)
    origins = np.repeat(places, _DIRECTIONS, axis=0)
    reach = np.minimum(caster.distance_m(origins, np.tile(rays, (len(places), 1))), FAR_M).reshape(len(places), -1)
    ahead = np.mean([np.roll(reach, shift, axis=1) for shift in range(-_HALF_VIEW, _HALF_VIEW + 1)], axis=0)
    behind = np.roll(reach, _DIRECTIONS // 2, axis=1)
    best, look = np.unravel_index(np.argmax(ahead - 0.5 * behind), ahead.shape)
    return Viewpoint(eye_m=places[best], azimuth_rad=float(azimuth[look]))


def _free_places(caster: RayCaster, vertices_m: np.ndarray) -> np.ndarray:
    """Places at eye height over a grid of free floor, (place, 3)."""
    low, high = np.percentile(vertices_m[:, :2], [1, 99], axis=0)
    step_m = max(STEP_M, float(np.sqrt(np.prod(high - low) / _MAX_CANDIDATES)))
    x, y = np.meshgrid(*(np.arange(a + step_m / 2, b, step_m) for a, b in zip(low, high, strict=True)))
    above = np.stack([x, y, np.full(x.shape, HEAD_M)], axis=-1)
    flat = above.reshape(-1, 3)
    down = np.broadcast_to((0.0, 0.0, -1.0), flat.shape)
    is_free = (np.abs(caster.distance_m(flat, down) - HEAD_M) < FOOT_M).reshape(x.shape)
    padded = np.pad(is_free, 1)
    around = sum(padded[1 + r : 1 + r + len(x), 1 + c : 1 + c + x.shape[1]].astype(int) for r, c in _AROUND)
    chosen = is_free & (around >= min(MIN_FREE, 2)) if is_free.any() else is_free
    return np.stack([x[chosen], y[chosen], np.full(chosen.sum(), EYE_HEIGHT_M)], axis=-1)


_AROUND = ((0, 1), (1, 0), (0, -1), (-1, 0))
