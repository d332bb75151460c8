"""The image method: specular reflection of the radar's waves by flat faces.

Reference: docs/radar_primer.md, section 5; reflection coefficients from `materials`.
"""

import math
from dataclasses import dataclass, replace
from typing import TypeVar

import numpy as np
from scipy.special import erf
from torch import Tensor

from mmweaver.core.records import Plane
from mmweaver.core.rotations import unit
from mmweaver.core.shapes import Values
from mmweaver.propagation.materials import MATERIALS, Material, SlabEchoes, reflection, slab_echoes

MAX_REFLECTORS = 10  # the largest faces; smaller ones count as diffuse surface only
BEFORE_M = 0.12  # mesh and fitted plane of a wall differ by so much, so rays at the mesh do not tell these faces apart
SAME_FACE_M, PARALLEL_COS = 0.02, 0.98
SLAB_ECHOES = 3  # of a face: front, back, and all that goes to and fro within


Vectors = TypeVar("Vectors", np.ndarray, Tensor)


def mirrored(vectors: Vectors, along: Vectors, normal: Vectors) -> Vectors:
    """Mirror images (..., 3) in a face with a unit normal (..., 3), of arrays or tensors.

    `along` (...) is the height above the face of places, and the component along its normal of velocities.
    """
    return vectors - 2 * along[..., None] * normal  # ty: ignore[invalid-explicit-return]


@dataclass(frozen=True, kw_only=True)
class SpecularReflector:
    """A plane as the simulator uses it."""

    plane: Plane
    offset_m: float  # normal . x on the face
    is_rough: bool = False  # whether its fine roughness scatters
    before: tuple["SpecularReflector", ...] = ()  # faces right before it: where they are, it is hidden

    def side(self, points_m: np.ndarray) -> Values:
        """Signed distance (...,), positive on the free side."""
        return points_m @ self.plane.normal - self.offset_m

    def image(self, points_m: np.ndarray) -> np.ndarray:
        """Mirrored points (..., 3)."""
        return mirrored(points_m, np.asarray(self.side(points_m)), self.plane.normal)

    def image_of_motion(self, motion: np.ndarray) -> np.ndarray:
        """Mirrored position, velocity and acceleration (..., 3, 3), the last but one axis naming which."""
        along = motion @ self.plane.normal
        along[..., 0] -= self.offset_m
        return mirrored(motion, along, self.plane.normal)

    def crossing(self, start_m: np.ndarray, image_m: np.ndarray) -> np.ndarray:
        """Where the segments from `start_m` to `image_m`, one on each side, meet the face (..., 3)."""
        near, far = self.side(start_m), -self.side(image_m)
        share = near / np.maximum(near + far, 1e-9)
        return start_m + np.asarray(share)[..., None] * (image_m - start_m)

    def inside(self, points_m: np.ndarray, fresnel_m: Values) -> Values:
        """How much of the first Fresnel zone about each point of the face lies within it and is not hidden, 0 to 1."""
        weight = self._within(points_m, fresnel_m)
        for face in self.before:
            weight = weight * (1 - face._within(points_m, fresnel_m))
        return weight

    def _within(self, points_m: np.ndarray, fresnel_m: Values) -> Values:
        weight = np.ones(points_m.shape[:-1])
        local = points_m - self.plane.centre_m
        for axis, half_m in zip((self.plane.axis_u, self.plane.axis_v), self.plane.half_size_m, strict=True):
            along = local @ axis
            reach = np.maximum(fresnel_m, 1e-3)
            weight = weight * 0.5 * (erf((half_m - along) / reach) + erf((half_m + along) / reach))
        return np.clip(weight, 0.0, 1.0)

    def coefficient(self, cos_incidence: Values, frequency_hz: float) -> Values:
        """Specular reflection coefficient: the slab's minus what roughness scatters."""
        smooth = self._smooth(cos_incidence, frequency_hz)
        return smooth * reflection(self.material, cos_incidence, frequency_hz, polarisation=self.polarisation)

    def echoes(self, cos_incidence: Values, frequency_hz: float, most: int = SLAB_ECHOES) -> SlabEchoes:
        """The same over a radar's band, in the phases of its beat: the echoes of the slab's two surfaces."""
        smooth = self._smooth(cos_incidence, frequency_hz)
        slab = slab_echoes(self.material, cos_incidence, frequency_hz, polarisation=self.polarisation, most=most)
        return SlabEchoes(smooth * slab.coefficient, slab.longer_m)

    def _smooth(self, cos_incidence: Values, frequency_hz: float) -> Values:
        """Share of the reflected amplitude that is not scattered."""
        smooth = np.sqrt(1 - self.material.scattering**2)
        return smooth * np.sqrt(1 - self.material.fine_loss(cos_incidence, frequency_hz)) if self.is_rough else smooth

    def is_before(self, other: "SpecularReflector") -> bool:
        """Whether it lies right before another face, or, as a window, in it."""
        ahead_m = float(other.side(self.plane.centre_m))
        if self is other or self.plane.normal @ other.plane.normal < PARALLEL_COS or ahead_m > BEFORE_M:
            return False
        return ahead_m > SAME_FACE_M or (ahead_m >= -SAME_FACE_M and self.area_m2 < other.area_m2)

    @property
    def area_m2(self) -> float:
        return 4 * self.plane.half_size_m[0] * self.plane.half_size_m[1]

    @property
    def material(self) -> Material:
        return MATERIALS[self.plane.material]

    @property
    def polarisation(self) -> str:
        """Of a vertically polarised radar's wave on this face."""
        return "tm" if abs(self.plane.normal[2]) > 0.7 else "te"


def specular_reflectors(
    planes: tuple[Plane, ...], *, rough: bool = False, hidden: bool = False
) -> list[SpecularReflector]:
    """The largest planes that face the radar.

    Args:
        planes: flat faces of the room.
        rough: whether their fine roughness scatters.
        hidden: whether those right behind others are hidden by them.
    """
    facing = []
    for plane in planes:
        face = SpecularReflector(plane=plane, offset_m=float(plane.normal @ plane.centre_m), is_rough=rough)
        if face.side(np.zeros(3)) > 0.02:
            facing.append(face)
    facing.sort(key=lambda face: -face.area_m2)
    faces = facing[:MAX_REFLECTORS]
    return layered_faces(faces) if hidden else faces


def layered_faces(faces: list[SpecularReflector]) -> list[SpecularReflector]:
    """Faces, each hidden where another one lies right before it."""
    return [replace(face, before=tuple(one for one in faces if one.is_before(face))) for face in faces]


def fresnel_radius_m(first_m: Values, second_m: Values, wavelength_m: float) -> Values:
    """Radius of the first Fresnel zone.

    Args:
        first_m: length from the one end to the point.
        second_m: length from the point to the other end.
        wavelength_m: of the wave.

    Returns:
        Radius in m, 0 at either end.
    """
    return np.sqrt(wavelength_m * np.maximum(first_m * second_m, 0) / np.maximum(first_m + second_m, 1e-9))


@dataclass(frozen=True, kw_only=True)
class SpecularPath:
    """A path from the radar over some faces back to it."""

    corners_m: np.ndarray  # (bounce, 3)
    rotation: np.ndarray  # (3, 3) and
    shift_m: np.ndarray  # (3,): image of a transmitter at x is rotation @ x + shift
    echoes: SlabEchoes  # products of the slabs' echoes and the tapers, (echo,)

    @property
    def length_m(self) -> float:
        """Over the fronts of the slabs."""
        return float(np.linalg.norm(self.shift_m))


def specular_paths(
    reflectors: list[SpecularReflector], wavelength_m: float, frequency_hz: float, most_echoes: int = SLAB_ECHOES
) -> list[SpecularPath]:
    """All paths of one, two and three bounces from the radar to itself, each image once.

    Args:
        reflectors: flat faces.
        wavelength_m: at the centre of the band.
        frequency_hz: the centre of the band.
        most_echoes: of each slab; with one its reflection is that at the centre.
    """
    paths: list[SpecularPath] = []
    seen: list[np.ndarray] = []
    chains: list[tuple[list[SpecularReflector], list[np.ndarray]]] = [([], [np.zeros(3)])]  # faces, and images in them
    for _ in range(3):
        chains = [
            ([*faces, face], [*images, face.image(images[-1])])
            for faces, images in chains
            for face in reflectors
            if not (faces and face is faces[-1]) and face.side(images[-1]) > 0
        ]
        for faces, images in chains:
            path = _path(faces, images, wavelength_m, frequency_hz, most_echoes)
            if path and not any(np.linalg.norm(path.shift_m - other) < 1e-3 for other in seen):
                seen.append(path.shift_m)
                paths.append(path)
    return paths


def _path(
    faces: list[SpecularReflector], images: list[np.ndarray], wavelength_m: float, frequency_hz: float, most: int
) -> SpecularPath | None:
    """The path over some faces with the radar's images in them (bounce + 1); None where it meets no face or is weak."""
    corners = _corners(faces, images)
    if corners is None:
        return None
    length = float(np.linalg.norm(images[-1]))
    tapers, end, gone = [], np.zeros(3), 0.0
    echoes = SlabEchoes(np.ones(1, complex), np.zeros(1))
    for face, image, corner in zip(reversed(faces), reversed(images[1:]), corners, strict=True):
        gone += float(np.linalg.norm(corner - end))
        fresnel_m = fresnel_radius_m(np.array(gone), np.array(length - gone), wavelength_m)
        tapers.append(float(face.inside(corner, fresnel_m)))
        cos = np.abs(unit(image - end) @ face.plane.normal)
        echoes = echoes.combined(face.echoes(cos, frequency_hz, most), frequency_hz)
        end = corner
    share = _share_of_wave(np.array(corners), min(tapers), length)
    echoes = SlabEchoes(share * echoes.coefficient, echoes.longer_m)
    if abs(echoes.coefficient).max() < 1e-5:
        return None
    rotation = np.eye(3)
    for face in faces:
        rotation = (np.eye(3) - 2 * np.outer(face.plane.normal, face.plane.normal)) @ rotation
    return SpecularPath(corners_m=np.array(corners[::-1]), rotation=rotation, shift_m=images[-1], echoes=echoes)


def _corners(faces: list[SpecularReflector], images: list[np.ndarray]) -> list[np.ndarray] | None:
    """Where a path back to the radar meets the faces, the last one first; None where it passes behind one."""
    corners, end = [], np.zeros(3)
    for face, image in zip(reversed(faces), reversed(images[1:]), strict=True):
        if face.side(end) < -1e-6 or face.side(image) >= 0:
            return None
        end = face.crossing(end, image)
        corners.append(end)
    return corners


def _share_of_wave(corners_m: np.ndarray, taper: float, length_m: float) -> float:
    """The share of the wave that takes this path.

    Where right-angled faces meet, the image lies straight through their common edge, and half of the wave meets one
    face first, half the other: all orders of such a corner make one image, counted once.
    """
    steps = np.linalg.norm(np.diff(corners_m, axis=0), axis=1)
    orders = math.factorial(1 + int((steps < 1e-3 * length_m).sum()))
    return min(1.0, orders * taper)
