"""Named lightings, and the irradiance from area lights and ambient light."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from mmweaver.core.ray_caster import RayCaster
from mmweaver.core.registry import Registry
from mmweaver.core.shapes import Array, Points
from mmweaver.scene.procedural.palette import TABLES
from mmweaver.scene.procedural.parts import Colour, PlacedPiece

Irradiance = Float[Array, "point 3"]  # red, green, blue
Picture = Float[Array, "row column 3"]
_SAMPLES, _OCCLUSION_M = 2, 0.9


@dataclass(frozen=True, kw_only=True)
class Lighting:
    """Radiance (red, green, blue) of windows, ceiling lamps, small lamps and the surroundings, and the exposure."""

    name: str
    window: Colour
    ceiling: Colour
    lamp: Colour
    ambient: Colour
    exposure: float = 1.0


LIGHTINGS: Registry[Lighting] = Registry(
    "lighting", [(name, Lighting(name=name, **row)) for name, row in TABLES["lightings"].items()]
)


@dataclass(frozen=True, kw_only=True)
class AreaLight:
    """A rectangle that emits to one side, in the room's frame.

    Attributes:
        corner_m: One corner in metres.
        edges_m: The two edges from this corner in metres, (2, 3).
        normal: Direction of emission; zero emits to both sides.
        radiance: Red, green, blue.
    """

    corner_m: Float[Array, "3"]
    edges_m: Float[Array, "2 3"]
    normal: Float[Array, "3"]
    radiance: Float[Array, "3"]


def area_lights(placed: tuple[PlacedPiece, ...], lighting: Lighting) -> list[AreaLight]:
    """The windows, ceiling lamps and lamp shades of a room as area lights.

    Args:
        placed: All pieces in the room.
        lighting: Radiance of each kind of light.

    Returns:
        Lights in the room's frame.
    """
    lamps = []
    for item in placed:
        (x0, y0, _), (x1, y1, top) = item.piece.low_m, item.piece.high_m
        match item.piece.name:
            case "window":
                (x0, _, z0), (x1, _, z1) = item.piece.parts[0].low_m, item.piece.parts[0].high_m
                low, high, normal, radiance = (x0, -0.06, z0), (x1, -0.06, z1), (0.0, -1.0, 0.0), lighting.window
            case "ceiling lamp":
                low, high, normal, radiance = (x0, y0, -0.05), (x1, y1, -0.05), (0.0, 0.0, -1.0), lighting.ceiling
            case "floor lamp" | "table lamp":
                above = top + 0.01
                low, high, normal, radiance = (-0.14, -0.14, above), (0.14, 0.14, above), (0.0,) * 3, lighting.lamp
            case _:
                continue
        corners = [low, (high[0], low[1], low[2]), (low[0], high[1], high[2]), normal, (0.0, 0.0, 0.0)]
        ends = item.points(np.array(corners, float))
        lamps.append(
            AreaLight(
                corner_m=ends[0],
                edges_m=ends[1:3] - ends[0],
                normal=ends[3] - ends[4],
                radiance=np.array(radiance, float),
            )
        )
    return lamps


def irradiance(
    caster: RayCaster,
    lamps: list[AreaLight],
    lighting: Lighting,
    points: Points,
    normals: Points,
    rng: np.random.Generator,
) -> Irradiance:
    """Irradiance of surface points: shadowed light of the lamps by stratified sampling, and occluded ambient light.

    Args:
        caster: Ray caster of the room's mesh.
        lamps: Area lights in the room's frame.
        lighting: Lighting with the ambient radiance.
        points: Points in metres, (point, 3).
        normals: Unit normals, (point, 3).
        rng: Random stream of the samples.

    Returns:
        Red, green, blue irradiance, (point, 3).
    """
    total = np.zeros_like(points)
    for lamp in lamps:
        area = float(np.linalg.norm(np.cross(*lamp.edges_m)))
        for stratum in range(_SAMPLES):
            u, v = (stratum + rng.random(len(points))) / _SAMPLES, rng.random(len(points))
            place = lamp.corner_m + u[:, None] * lamp.edges_m[0] + v[:, None] * lamp.edges_m[1]
            between = place - points
            distance = np.linalg.norm(between, axis=1)
            towards = between / distance[:, None]
            received = np.clip((towards * normals).sum(axis=1), 0, None)
            sent = np.clip(-(towards @ lamp.normal), 0, None) if lamp.normal.any() else np.full(len(points), 0.5)
            share = received * sent * area / (np.pi * np.maximum(distance, 0.3) ** 2)
            lit = np.flatnonzero(share > 2e-4)
            clear = caster.is_clear(points[lit] + 2e-3 * normals[lit], place[lit], 0.01)
            total[lit[clear]] += (share[lit[clear]] / _SAMPLES)[:, None] * lamp.radiance
    return total + _ambient_visibility(caster, points, normals, rng)[:, None] * np.array(lighting.ambient)


def _ambient_visibility(caster: RayCaster, points: Points, normals: Points, rng: np.random.Generator) -> np.ndarray:
    """Ambient occlusion from two rays over the hemisphere: 1 in the open, less in corners, (point,)."""
    total = np.zeros(len(points))
    for stratum in range(2):
        height = np.sqrt((stratum + rng.random(len(points))) / 2)
        angle = 2 * np.pi * rng.random(len(points))
        helper = np.where(np.abs(normals[:, :1]) > 0.8, np.array([[0.0, 1, 0]]), np.array([[1.0, 0, 0]]))
        tangent = np.cross(normals, helper)
        tangent /= np.linalg.norm(tangent, axis=1)[:, None]
        flat = np.cos(angle)[:, None] * tangent + np.sin(angle)[:, None] * np.cross(normals, tangent)
        directions = np.sqrt(1 - height**2)[:, None] * flat + height[:, None] * normals
        reach = caster.distance_m(points + 2e-3 * normals, directions)
        total += np.clip(reach / _OCCLUSION_M, 0.25, 1.0)
    return total / 2


def denoised(light: Picture, points: Picture, normals: Picture) -> Picture:
    """Removes sampling noise by an edge-avoiding a-trous filter, guided by points and normals.

    Reference: Dammertz et al., Edge-Avoiding A-Trous Wavelet Transform (2010).

    Args:
        light: Irradiance, (row, column, 3).
        points: Surface point of each pixel in metres, (row, column, 3).
        normals: Unit normals, (row, column, 3).

    Returns:
        Filtered irradiance, float32, (row, column, 3).
    """
    light, points, normals = (part.astype(np.float32) for part in (light, points, normals))
    for step in (1, 2, 4):
        total, weights = light.copy(), np.ones(light.shape[:2], np.float32)
        for row, column in ((-1, -1), (-1, 0), (-1, 1), (0, -1), (0, 1), (1, -1), (1, 0), (1, 1)):
            away = (row * step, column * step)
            place, facing = np.roll(points, away, (0, 1)), np.roll(normals, away, (0, 1))
            between = place - points
            same = np.abs((between * normals).sum(axis=-1)) < 0.02
            same &= (facing * normals).sum(axis=-1) > 0.9
            same &= (between * between).sum(axis=-1) < 0.2**2
            weight = same * np.float32(0.7 if row and column else 0.85)
            total += weight[..., None] * np.roll(light, away, (0, 1))
            weights += weight
        light = total / weights[..., None]
    return light
