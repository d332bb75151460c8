"""The image method: specular reflection of the radar's waves by flat faces.

Reference: docs/radar_primer.md, section 5; reflection coefficients from `materials`.
"""

import math
from dataclasses import dataclass

import numpy as np
from scipy.special import erf

from mmweaver.core.records import Plane
from mmweaver.core.shapes import Values
from mmweaver.paths.materials import MATERIALS, reflection

MAX_REFLECTORS = 10  # the largest faces; smaller ones count as diffuse surface only


@dataclass(frozen=True, kw_only=True)
class SpecularReflector:
    """A plane as the simulator uses it."""

    plane: Plane
    offset_m: float  # normal . x on the face

    def side(self, points_m: np.ndarray) -> Values:
        """Signed distance (...,), positive on the free side."""
        return points_m @ self.plane.normal - self.offset_m

    def image(self, points_m: np.ndarray) -> np.ndarray:
        """Mirrored points (..., 3)."""
        return points_m - 2 * np.asarray(self.side(points_m))[..., None] * self.plane.normal

    def image_of_motion(self, motion: np.ndarray) -> np.ndarray:
        """Mirrored position, velocity and acceleration (..., 3, 3), the last but one axis naming which."""
        along = motion @ self.plane.normal
        along[..., 0] -= self.offset_m
        return motion - 2 * along[..., None] * self.plane.normal

    def crossing(self, start_m: np.ndarray, image_m: np.ndarray) -> np.ndarray:
        """Where the segments from `start_m` to `image_m`, one on each side, meet the face (..., 3)."""
        near, far = self.side(start_m), -self.side(image_m)
        share = near / np.maximum(near + far, 1e-9)
        return start_m + np.asarray(share)[..., None] * (image_m - start_m)

    def inside(self, points_m: np.ndarray, fresnel_m: Values) -> Values:
        """How much of the first Fresnel zone about each point of the face lies within it, 0 to 1."""
        weight = np.ones(points_m.shape[:-1])
        local = points_m - self.plane.centre_m
        for axis, half_m in zip((self.plane.axis_u, self.plane.axis_v), self.plane.half_size_m, strict=True):
            along = local @ axis
            reach = np.maximum(fresnel_m, 1e-3)
            weight = weight * 0.5 * (erf((half_m - along) / reach) + erf((half_m + along) / reach))
        return np.clip(weight, 0.0, 1.0)

    def coefficient(self, cos_incidence: Values, frequency_hz: float) -> Values:
        """Specular reflection coefficient: the slab's, less what roughness scatters."""
        material = MATERIALS[self.plane.material]
        polarisation = "tm" if abs(self.plane.normal[2]) > 0.7 else "te"
        smooth = np.sqrt(1 - material.scattering**2)
        return smooth * reflection(material, cos_incidence, frequency_hz, polarisation=polarisation)


def specular_reflectors(planes: tuple[Plane, ...]) -> list[SpecularReflector]:
    """The largest planes that face the radar."""
    facing = []
    for plane in planes:
        face = SpecularReflector(plane=plane, offset_m=float(plane.normal @ plane.centre_m))
        if face.side(np.zeros(3)) > 0.02:
            facing.append(face)
    facing.sort(key=lambda face: -face.plane.half_size_m[0] * face.plane.half_size_m[1])
    return facing[:MAX_REFLECTORS]


def fresnel_radius_m(first_m: Values, second_m: Values, wavelength_m: float) -> Values:
    """Radius of the first Fresnel zone at a point between two path lengths, in m."""
    return np.sqrt(wavelength_m * np.maximum(first_m * second_m, 0) / np.maximum(first_m + second_m, 1e-9))


@dataclass(frozen=True, kw_only=True)
class SpecularPath:
    """A path from the radar over some faces back to it."""

    corners_m: np.ndarray  # (bounce, 3)
    rotation: np.ndarray  # (3, 3) and
    shift_m: np.ndarray  # (3,): image of a transmitter at x is rotation @ x + shift
    coefficient: complex  # product of the reflections and tapers

    @property
    def length_m(self) -> float:
        return float(np.linalg.norm(self.shift_m))


def specular_paths(reflectors: list[SpecularReflector], wavelength_m: float, frequency_hz: float) -> list[SpecularPath]:
    """All paths of one, two and three bounces from the radar to itself, each image once."""
    paths: list[SpecularPath] = []
    seen: list[np.ndarray] = []
    sequences = [[first] for first in reflectors]
    for _ in range(3):
        for sequence in sequences:
            path = _path(sequence, wavelength_m, frequency_hz)
            if path and not any(np.linalg.norm(path.shift_m - other) < 1e-3 for other in seen):
                seen.append(path.shift_m)
                paths.append(path)
        sequences = [[*sequence, more] for sequence in sequences for more in reflectors if more is not sequence[-1]]
    return paths


def _path(sequence: list[SpecularReflector], wavelength_m: float, frequency_hz: float) -> SpecularPath | None:
    images = [np.zeros(3)]
    rotation = np.eye(3)
    for face in sequence:
        if face.side(images[-1]) <= 0:
            return None
        images.append(face.image(images[-1]))
        normal = face.plane.normal
        rotation = (np.eye(3) - 2 * np.outer(normal, normal)) @ rotation
    length = float(np.linalg.norm(images[-1]))
    corners, tapers, coefficient, end, gone = [], [], 1.0 + 0j, np.zeros(3), 0.0
    for face, image in zip(reversed(sequence), reversed(images[1:]), strict=True):
        if face.side(end) < -1e-6 or face.side(image) >= 0:
            return None
        corner = face.crossing(end, image)
        gone += float(np.linalg.norm(corner - end))
        fresnel_m = fresnel_radius_m(np.array(gone), np.array(length - gone), wavelength_m)
        tapers.append(float(face.inside(corner, fresnel_m)))
        direction = (image - end) / np.linalg.norm(image - end)
        coefficient *= complex(face.coefficient(np.abs(direction @ face.plane.normal), frequency_hz))
        corners.append(corner)
        end = corner
    coefficient *= _share_of_wave(np.array(corners), min(tapers), length)
    if abs(coefficient) < 1e-5:
        return None
    return SpecularPath(
        corners_m=np.array(corners[::-1]), rotation=rotation, shift_m=images[-1], coefficient=coefficient
    )


def _share_of_wave(corners_m: np.ndarray, taper: float, length_m: float) -> float:
    """The share of the wave that takes this path.

    Where right-angled faces meet, the image lies straight through their common edge, and half of the wave meets one
    face first, half the other: all orders of such a corner make one image, counted once.
    """
    steps = np.linalg.norm(np.diff(corners_m, axis=0), axis=1)
    orders = math.factorial(1 + int((steps < 1e-3 * length_m).sum()))
    return min(1.0, orders * taper)
