"""The lamps, and what light they send to the eye."""

from dataclasses import dataclass

import numpy as np

from mmweaver.core.ray_caster import RayCaster
from mmweaver.core.seeding import stream
from sample_room.living_room import CEILING_M, LEFT_WALL_M
from sample_room.patterns import albedo
from sample_room.solids import Room


@dataclass(frozen=True)
class Lamp:
    """A rectangle that shines: corner, two edges, and its colour of light (radiant exitance)."""

    corner: tuple[float, float, float]
    edges: tuple[tuple[float, float, float], tuple[float, float, float]]
    light: tuple[float, float, float]


LAMPS = (
    Lamp((LEFT_WALL_M + 0.03, 1.55, 0.9), ((0, 1.4, 0), (0, 0, 1.25)), (3.6, 4.2, 5.0)),
    Lamp((-0.5, 0.6, CEILING_M - 0.01), ((1.0, 0, 0), (0, 1.0, 0)), (2.0, 1.85, 1.55)),
    Lamp((0.52, 3.60, 1.70), ((0.2, 0, 0), (0, 0.2, 0)), (7.0, 5.2, 3.0)),
)


class Renderer:
    """Direct light from the lamps, one diffuse bounce, and a floor of ambient light for the bounces after it."""

    def __init__(self, room: Room, seed: int, lamp_samples: int, bounce_samples: int):
        self.vertices, self.faces, self.face_surface = room.mesh()
        self.surfaces, self.seed = room.surfaces, seed
        self.lamp_samples, self.bounce_samples = lamp_samples, bounce_samples
        self.generator = stream(seed, "light")
        self.caster = RayCaster(self.vertices, self.faces)
        corners = self.vertices[self.faces]
        normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        self.normals = normals / np.maximum(np.linalg.norm(normals, axis=1), 1e-15)[:, None]

    def picture(self, origin: np.ndarray, rays: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Colour, light received and light of its own (n, 3) of what unit rays from one point meet."""
        _, face, points, normals = self.hit(np.tile(origin, (len(rays), 1)), rays)
        generator = self.generator
        irradiance = self._direct(points, normals, self.lamp_samples, generator)
        bounced = np.zeros_like(irradiance)
        for turn in range(self.bounce_samples):
            directions = _cosine_directions(normals, generator, turn, self.bounce_samples)
            _, far_face, far_points, far_normals = self.hit(points + 1e-3 * normals, directions)
            light = self._direct(far_points, far_normals, 1, generator) + 0.16
            sent = self._colour(far_face, far_points, far_normals) * light + self._glow(far_face)[:, None] * 0.1
            bounced += np.minimum(sent, 1.2)  # the corner by the lamp would leave sparks
        colour = self._colour(face, points, normals)
        return colour, irradiance + bounced / self.bounce_samples + 0.05, colour * self._glow(face)[:, None]

    def hit(self, origins: np.ndarray, rays: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        distance, face = self.caster.first_hit(origins, rays)
        distance = np.where(face >= 0, distance, 50.0)
        normals = self.normals[face]
        normals = np.where((normals * rays).sum(axis=1)[:, None] > 0, -normals, normals)
        return distance, face, origins + distance[:, None] * rays, normals

    def _direct(
        self, points: np.ndarray, normals: np.ndarray, samples: int, generator: np.random.Generator
    ) -> np.ndarray:
        total = np.zeros_like(points)
        for lamp in LAMPS:
            edge_a, edge_b = np.array(lamp.edges[0]), np.array(lamp.edges[1])
            area_normal = np.cross(edge_a, edge_b)
            for turn in range(samples):
                u = (turn + generator.random(len(points))) / samples
                v = (generator.random(len(points)) + turn * 0.618) % 1
                place = np.array(lamp.corner) + u[:, None] * edge_a + v[:, None] * edge_b
                between = place - points
                distance = np.linalg.norm(between, axis=1)
                towards = between / distance[:, None]
                received = np.clip((towards * normals).sum(axis=1), 0, None)
                sent = np.abs(towards @ area_normal)  # cosine times area
                clear = self.caster.is_clear(points + 2e-3 * normals, place, margin_m=0.012)
                share = received * sent / (np.pi * np.maximum(distance, 0.2) ** 2) * clear / samples
                total += share[:, None] * np.array(lamp.light)
        return total

    def _colour(self, face: np.ndarray, points: np.ndarray, normals: np.ndarray) -> np.ndarray:
        colour = np.zeros_like(points)
        surface_of = self.face_surface[face]
        for index in np.unique(surface_of):
            chosen = surface_of == index
            colour[chosen] = albedo(self.seed, self.surfaces[index], points[chosen], normals[chosen])
        return colour

    def _glow(self, face: np.ndarray) -> np.ndarray:
        return np.array([surface.glow for surface in self.surfaces])[self.face_surface[face]]


def _cosine_directions(normals: np.ndarray, generator: np.random.Generator, turn: int, turns: int) -> np.ndarray:
    """Directions over the hemisphere, as many as a matt surface sends them."""
    u = (turn + generator.random(len(normals))) / turns
    angle = 2 * np.pi * generator.random(len(normals))
    helper = np.where(np.abs(normals[:, :1]) > 0.8, np.array([[0.0, 1, 0]]), np.array([[1.0, 0, 0]]))
    tangent = np.cross(normals, helper)
    tangent /= np.linalg.norm(tangent, axis=1)[:, None]
    other = np.cross(normals, tangent)
    radius = np.sqrt(u)
    flat = radius[:, None] * (np.cos(angle)[:, None] * tangent + np.sin(angle)[:, None] * other)
    return flat + np.sqrt(1 - u)[:, None] * normals


def smoothed(light: np.ndarray, points: np.ndarray, normals: np.ndarray) -> np.ndarray:
    """Light averaged along surfaces: an a-trous filter that stops at edges of place, direction and strong shadows.

    Reference: Dammertz et al., Edge-Avoiding A-Trous Wavelet Transform (2010).
    """
    kernel = np.array([1, 4, 6, 4, 1]) / 16
    for step in (1, 2, 4):
        total, weight_sum = np.zeros_like(light), np.zeros(light.shape[:2])
        for v, u in np.ndindex(5, 5):
            away = ((v - 2) * step, (u - 2) * step)
            other, place, facing = (np.roll(part, away, (0, 1)) for part in (light, points, normals))
            off_plane = ((place - points) * normals).sum(axis=-1)
            shade = np.log((other.sum(axis=-1) + 0.1) / (light.sum(axis=-1) + 0.1))
            weight = kernel[v] * kernel[u] * np.exp(-np.square(off_plane / 0.02) - np.square(shade * step / 0.9))
            weight *= np.clip((facing * normals).sum(axis=-1), 0, 1) ** 16
            weight *= ((place - points) ** 2).sum(axis=-1) < 0.3**2
            total += weight[..., None] * other
            weight_sum += weight
        light = total / weight_sum[..., None]
    return light
