"""Propagation paths of one frame as rays in the room: corners, kind, level, and the radar cell of each."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Int

from mmweaver.core.records import Plane
from mmweaver.core.shapes import Array
from mmweaver.propagation.paths import Interaction, ScenePaths

MAX_RAYS = 750  # of the room, and of people
GHOST_M = 0.6  # an echo of the body farther from all joints is an image of it: the network knows no second vertex
MAX_VERTICES = 4  # from the radar to at most two reflections and back
RECIPROCAL_DB = 20 * np.log10(2.0)  # both directions of travel add coherently


@dataclass(frozen=True, kw_only=True)
class Rays:
    """Rays, the strongest first.

    Attributes:
        vertices_m: Corners (ray, 4, 3) in the radar's frame, from the radar back to it; nan where there are fewer. A
            path that returns as it came ends at its last scatterer.
        interaction: `Interaction` (ray,).
        level_dbm: Power (ray,) at the receiver's port.
        length_m: Length (ray,) there and back.
        velocity_mps: Radial velocity (ray,) at which it appears, away positive.
        azimuth_rad: Azimuth (ray,) at which it appears, right positive.
    """

    vertices_m: Float[Array, "ray 4 3"]
    interaction: Int[Array, " ray"]
    level_dbm: Float[Array, " ray"]
    length_m: Float[Array, " ray"]
    velocity_mps: Float[Array, " ray"]
    azimuth_rad: Float[Array, " ray"]

    @property
    def arrays(self) -> dict[str, np.ndarray]:
        """`ray_points` (ray, 4, 3) and `ray_facts` (ray, 6), the other attributes in order, for the playback page."""
        facts = np.zeros((len(self.level_dbm), 6), np.float32)
        columns = (self.interaction, self.level_dbm, self.length_m, self.velocity_mps, self.azimuth_rad)
        facts[:, : len(columns)] = np.stack(columns, axis=-1)
        return {"ray_points": self.vertices_m.astype(np.float32), "ray_facts": facts}

    @classmethod
    def of(cls, paths: ScenePaths, joints_m: Float[Array, "joint 3"], planes: Sequence[Plane]) -> "Rays":
        """The rays of the first frame.

        Args:
            paths: Paths of one frame.
            joints_m: Joints of all people in that frame in metres; may be empty.
            planes: Faces of the room, in which images of the body lie.
        """
        parts = []
        for part in (_static(paths), _moving(paths, joints_m, planes)):
            strongest = np.argsort(-part["level_dbm"], kind="stable")[:MAX_RAYS]
            parts.append({name: values[strongest] for name, values in part.items()})
        order = np.argsort(-np.concatenate([part["level_dbm"] for part in parts]), kind="stable")
        return cls(**{name: np.concatenate([part[name] for part in parts])[order] for name in parts[0]})


def _static(paths: ScenePaths) -> dict[str, np.ndarray]:
    static, clear = paths.static, (paths.occluded[0] == 0).numpy()
    amplitude = np.abs(static.amplitude.numpy())
    there = np.flatnonzero(clear & (amplitude > 0))
    first, last = (ends.numpy()[there] for ends in (static.departure_vertex_m, static.arrival_vertex_m))
    vertices = np.full((len(there), MAX_VERTICES, 3), np.nan)
    vertices[:, 0], vertices[:, 1] = 0.0, first
    is_second = np.linalg.norm(first - last, axis=-1) > 1e-6
    vertices[is_second, 2], vertices[is_second, 3] = last[is_second], 0.0
    return {
        "vertices_m": vertices,
        "interaction": static.interaction.numpy()[there].astype(int),
        "level_dbm": 20 * np.log10(amplitude[there]),
        "length_m": static.length_m.mean(dim=(1, 2)).numpy()[there],
        "velocity_mps": np.zeros(len(there)),
        "azimuth_rad": _azimuth(first, last),
    }


def _moving(paths: ScenePaths, joints_m: np.ndarray, planes: Sequence[Plane]) -> dict[str, np.ndarray]:
    moving = paths.moving[len(paths.moving) // 2]  # the middle of the frame's time segments
    amplitude = np.abs(moving.amplitude.numpy())
    there = np.flatnonzero(amplitude > 0)
    departure, arrival = (end.position_m.numpy()[there] for end in (moving.departure, moving.arrival))
    kind, reciprocal = moving.interaction.numpy()[there].astype(int), moving.is_reciprocal.numpy()[there]
    is_ghost = (kind == Interaction.BODY) & (_away(departure, joints_m) > GHOST_M)
    return {
        "vertices_m": moving_vertices(departure, arrival, kind, joints_m, planes),
        "interaction": np.where(is_ghost, Interaction.BODY_WALL, kind),
        "level_dbm": 20 * np.log10(amplitude[there]) + RECIPROCAL_DB * reciprocal,
        "length_m": moving.length_m.numpy()[there],
        "velocity_mps": moving.rate_mps.numpy()[there] / 2,
        "azimuth_rad": _azimuth(departure, arrival),
    }


def moving_vertices(
    departure_m: np.ndarray, arrival_m: np.ndarray, kind: np.ndarray, joints_m: np.ndarray, planes: Sequence[Plane]
) -> np.ndarray:
    """Corners (ray, 4, 3) of paths over people, from the apparent ends that renderers use.

    A path over the body at p that arrives from direction u after a length L turned at u t with t + |u t - p| = L.

    Args:
        departure_m: Apparent departure points (ray, 3).
        arrival_m: Apparent arrival points (ray, 3).
        kind: `Interaction` (ray,).
        joints_m: Joints (joint, 3) of all people.
        planes: Faces of the room.
    """
    vertices = np.full((len(kind), MAX_VERTICES, 3), np.nan)
    vertices[:, 0] = 0.0
    vertices[:, 1] = departure_m
    vertices[kind == Interaction.BODY_RADAR_BODY, 1] /= 2  # twice the way to the body
    if not len(joints_m):
        return vertices
    is_two = np.isin(kind, (Interaction.BODY_WALL, Interaction.BODY_ROOM, Interaction.BODY_BODY))
    swapped = is_two & (_away(arrival_m, joints_m) < _away(departure_m, joints_m))
    body_m = np.where(swapped[:, None], arrival_m, departure_m)[is_two]
    image_m = np.where(swapped[:, None], departure_m, arrival_m)[is_two]
    vertices[is_two, 1], vertices[is_two, 2], vertices[is_two, 3] = body_m, _turn(body_m, image_m), 0.0
    is_image = kind == Interaction.WALL_BODY_WALL
    if is_image.any() and len(planes):
        normal = np.array([plane.normal for plane in planes])
        offset_m = np.array([plane.normal @ plane.centre_m for plane in planes])
        height_m = departure_m[is_image] @ normal.T - offset_m  # (ray, plane)
        mirrored_m = departure_m[is_image, None] - 2 * height_m[..., None] * normal
        nearest = np.argmin([_away(mirrored_m[:, k], joints_m) for k in range(len(planes))], axis=0)
        body_m = mirrored_m[np.arange(len(nearest)), nearest]
        vertices[is_image, 1], vertices[is_image, 2] = _turn(body_m, departure_m[is_image]), body_m
    return vertices


def _turn(body_m: np.ndarray, image_m: np.ndarray) -> np.ndarray:
    """Where paths from bodies (ray, 3) turn that seem to come from images (ray, 3)."""
    length_m = np.linalg.norm(image_m, axis=-1)
    u = image_m / np.maximum(length_m, 1e-9)[:, None]
    t = (length_m**2 - (body_m**2).sum(-1)) / np.maximum(2 * (length_m - (u * body_m).sum(-1)), 1e-6)
    return u * np.clip(t, 0.0, length_m)[:, None]


def _away(points_m: np.ndarray, joints_m: np.ndarray) -> np.ndarray:
    """Distance (ray,) from each place (ray, 3) to the nearest joint."""
    return np.linalg.norm(points_m[:, None] - joints_m, axis=-1).min(axis=1, initial=np.inf)


def _azimuth(departure_m: np.ndarray, arrival_m: np.ndarray) -> np.ndarray:
    """Azimuth (ray,) at which a horizontal virtual array sees paths that leave and arrive along two directions."""
    sines = [ends[:, 0] / np.maximum(np.linalg.norm(ends, axis=-1), 1e-9) for ends in (departure_m, arrival_m)]
    return np.arcsin(np.clip(np.mean(sines, axis=0), -1, 1))
