"""Image method: specular reflection by flat faces.

Reference: docs/radar_primer.md, section 5; reflection coefficients from `materials`.

Paths as points in a radar's cells: apparent position and strength.
"""

import math
from dataclasses import dataclass, replace
from typing import TypeVar

import numpy as np
import torch
from scipy.special import erf
from torch import Tensor

from mmweaver.core.records import Plane
from mmweaver.core.rotations import unit
from mmweaver.core.shapes import Values
from mmweaver.propagation.materials import MATERIALS, Material, SlabEchoes, reflection, slab_echoes
from mmweaver.propagation.paths import Paths, StaticPaths
from mmweaver.signal.point_response import PointResponse, Points


def apparent_direction(departure: Tensor, arrival: Tensor) -> Tensor:
    """Apparent direction of paths whose departure and arrival differ.

    An array of transmitter-receiver pairs sees such a path half way between its two ends.

    Args:
        departure: Vectors (..., 3) towards the departure point.
        arrival: Vectors (..., 3) towards the arrival point.

    Returns:
        Unit vectors (..., 3).
    """
    towards = (_unit(departure) + _unit(arrival)) / 2
    ahead = (1 - towards[..., 0].square() - towards[..., 2].square()).clamp(0, 1).sqrt()
    return torch.stack([towards[..., 0], ahead, towards[..., 2]], dim=-1)


def static_points(paths: StaticPaths, response: PointResponse) -> Points:
    """Static paths as points.

    Args:
        paths: Static paths, (path,).
        response: Point response of the radar, which defines the bins.

    Returns:
        Points (path,) of real amplitude in sqrt(mW).
    """
    towards = apparent_direction(paths.departure_vertex_m, paths.arrival_vertex_m)
    range_m = paths.length_m.mean(dim=(-2, -1)) / 2
    return _points(range_m, torch.zeros_like(range_m), towards, paths.amplitude.abs(), response)


def moving_points(paths: Paths, response: PointResponse) -> Points:
    """Moving paths as points at the middle of their segment.

    Both directions of a reciprocal path add coherently as far as the array cannot resolve its two ends.

    Args:
        paths: Moving paths, (..., path).
        response: Point response of the radar, which defines the bins.

    Returns:
        Points (..., path) of real amplitude in sqrt(mW).
    """
    towards = apparent_direction(paths.departure.position_m, paths.arrival.position_m)
    both = 2 + 2 * _agreement(paths, response)
    power = paths.amplitude.abs().square() * torch.where(paths.is_reciprocal, both, torch.ones_like(both))
    return _points(paths.length_m / 2, paths.rate_mps / 2, towards, power.sqrt(), response)


def _agreement(paths: Paths, response: PointResponse) -> Tensor:
    """Mean cosine (..., path) of the phase between both directions of a path over the antenna pairs."""
    tx_m, rx_m = (
        torch.from_numpy(np.asarray(place)) for place in (response.config.tx_position_m, response.config.rx_position_m)
    )
    apart_m = (tx_m[:, None] - rx_m).reshape(-1, 3)
    cycles = (paths.departure.direction - paths.arrival.direction) @ apart_m.T / response.config.wavelength_m
    return torch.cos(2 * torch.pi * cycles).mean(dim=-1)


def _points(
    range_m: Tensor, velocity_mps: Tensor, towards: Tensor, amplitude: Tensor, response: PointResponse
) -> Points:
    doppler_bin = (velocity_mps / response.velocity_a_bin_mps).float()
    return Points(
        range_bin=(range_m / response.range_a_bin_m).float() + response.coupling * doppler_bin,
        doppler_bin=doppler_bin,
        direction=towards[..., [0, 2]].float(),
        amplitude=amplitude.float(),
    )


def _unit(vectors: Tensor) -> Tensor:
    return vectors / vectors.norm(dim=-1, keepdim=True).clamp(min=1e-9)


MAX_REFLECTORS = 10  # the largest faces; smaller ones scatter diffusely only
BEFORE_M = 0.12  # distance between mesh and fitted plane of a wall, below which rays cannot separate two faces
SAME_FACE_M, PARALLEL_COS = 0.02, 0.98
SLAB_ECHOES = 3  # per face: front, back, and all internal reflections


Vectors = TypeVar("Vectors", np.ndarray, Tensor)


def mirrored(vectors: Vectors, along: Vectors, normal: Vectors) -> Vectors:
    """Mirror images in a face.

    Args:
        vectors: Places or velocities (..., 3), arrays or tensors.
        along: Height (...) of places above the face, or normal component of velocities.
        normal: Unit normal (..., 3) of the face.

    Returns:
        Images (..., 3).
    """
    return vectors - 2 * along[..., None] * normal  # ty: ignore[invalid-explicit-return]


@dataclass(frozen=True, kw_only=True)
class SpecularReflector:
    """A flat face that reflects specularly."""

    plane: Plane
    offset_m: float  # normal . x on the face
    is_rough: bool = False  # whether its fine roughness scatters
    before: tuple["SpecularReflector", ...] = ()  # faces directly in front, which hide it where they extend

    def side(self, points_m: np.ndarray) -> Values:
        """Signed distance (...) of places (..., 3) in metres, positive on the free side."""
        return points_m @ self.plane.normal - self.offset_m

    def image(self, points_m: np.ndarray) -> np.ndarray:
        """Mirror images (..., 3) of places (..., 3)."""
        return mirrored(points_m, np.asarray(self.side(points_m)), self.plane.normal)

    def image_of_motion(self, motion: np.ndarray) -> np.ndarray:
        """Mirror image (..., 3, 3) of position, velocity and acceleration, which lie along the last but one axis."""
        along = motion @ self.plane.normal
        along[..., 0] -= self.offset_m
        return mirrored(motion, along, self.plane.normal)

    def crossing(self, start_m: np.ndarray, image_m: np.ndarray) -> np.ndarray:
        """Reflection points: where the segments from places to images on the other side meet the face.

        Args:
            start_m: Places (..., 3) on the free side.
            image_m: Images (..., 3) behind the face.

        Returns:
            Points (..., 3) on the face.
        """
        near, far = self.side(start_m), -self.side(image_m)
        share = near / np.maximum(near + far, 1e-9)
        return start_m + np.asarray(share)[..., None] * (image_m - start_m)

    def inside(self, points_m: np.ndarray, fresnel_m: Values) -> Values:
        """Share of the first Fresnel zone around points of the face that lies within it and is not hidden.

        Args:
            points_m: Points (..., 3) on the face.
            fresnel_m: Radius (...) of the Fresnel zone in metres.

        Returns:
            Weights (...) from 0 to 1.
        """
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
        """Specular reflection coefficient: that of the slab, reduced by diffuse scattering, for a
        wave along the horizon.

        Args:
            cos_incidence: Cosine (...) of the angle of incidence.
            frequency_hz: Frequency in Hz.

        Returns:
            Complex amplitude coefficient (...).
        """
        polarisation = "tm" if abs(self.plane.normal[2]) > 0.7 else "te"
        smooth = self._smooth(cos_incidence, frequency_hz)
        return smooth * reflection(self.material, cos_incidence, frequency_hz, polarisation=polarisation)

    def both_echoes(
        self, cos_incidence: Values, frequency_hz: float, most: int = SLAB_ECHOES
    ) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """The reflection over the radar's band, as echoes of the slab's two surfaces in the phases of a beat signal.

        Args:
            cos_incidence: Cosine (...) of the angle of incidence.
            frequency_hz: Frequency in Hz at which the sum of the echoes is exact.
            most: Maximum number of echoes.

        Returns:
            Coefficients (echo, ...) of the field across (TE) and in (TM) the plane of incidence, reduced by diffuse
            scattering, and excess lengths (echo, ...) in metres.
        """
        smooth = self._smooth(cos_incidence, frequency_hz)
        te, tm = (
            slab_echoes(self.material, cos_incidence, frequency_hz, polarisation=one, most=most) for one in ("te", "tm")
        )
        longest = max(te, tm, key=lambda one: len(one.coefficient))
        fields = []
        for slab in (te, tm):
            field = np.zeros(longest.coefficient.shape, complex)
            field[: len(slab.coefficient)] = smooth * slab.coefficient
            fields.append(field)
        return *fields, longest.longer_m

    def echoes(self, direction: np.ndarray, frequency_hz: float, most: int = SLAB_ECHOES) -> SlabEchoes:
        """Echoes of a vertically polarised wave, as an antenna of the same polarisation receives them.

        Args:
            direction: Unit vectors (..., 3) of the incident wave.
            frequency_hz: Frequency in Hz at which the sum of the echoes is exact.
            most: Maximum number of echoes.

        Returns:
            The echoes (echo, ...).
        """
        te, tm, longer_m = self.both_echoes(np.abs(direction @ self.plane.normal), frequency_hz, most)
        across, along = polarised(direction, self.plane.normal)
        return SlabEchoes(across * te + along * tm, longer_m)

    def _smooth(self, cos_incidence: Values, frequency_hz: float) -> Values:
        """Share of the reflected amplitude that is specular."""
        smooth = np.sqrt(1 - self.material.scattering**2)
        return smooth * np.sqrt(1 - self.material.fine_loss(cos_incidence, frequency_hz)) if self.is_rough else smooth

    def is_before(self, other: "SpecularReflector") -> bool:
        """Whether the face lies directly in front of another one, or within it as a window does."""
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


def vertical_field(direction: np.ndarray) -> np.ndarray:
    """Unit field vectors (..., 3) of a vertically polarised antenna, for unit directions (..., 3) of travel."""
    return unit(np.array([0.0, 0.0, 1.0]) - direction[..., 2:] * direction)


def incidence_axes(direction: np.ndarray, normal: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Axes of the field at a reflection.

    Args:
        direction: Unit vectors (..., 3) of the incident wave.
        normal: Unit normals (..., 3) of the face.

    Returns:
        Unit vectors (..., 3) across the plane of incidence, and in it before and after the reflection. Straight on,
        where any plane of incidence does, the one across the vertical field.
    """
    across = np.cross(direction, normal)
    straight = np.linalg.norm(across, axis=-1, keepdims=True) < 1e-6
    across = unit(np.where(straight, np.cross(vertical_field(direction), direction), across))
    after = direction - 2 * (direction * normal).sum(-1, keepdims=True) * normal
    return across, np.cross(across, direction), np.cross(across, after)


def polarised(direction: np.ndarray, normal: np.ndarray) -> tuple[Values, Values]:
    """Weights of the TE and the TM reflection of a vertically polarised wave that is received as such.

    Args:
        direction: Unit vectors (..., 3) of the incident wave.
        normal: Unit normals (..., 3), of either sign.

    Returns:
        Weights (...) of the amplitude coefficients; at a wall along the horizon 1 and 0, at the floor 0 and 1.
    """
    across, before, after = incidence_axes(direction, normal)
    gone = direction - 2 * (direction * normal).sum(-1, keepdims=True) * normal
    sent, received = vertical_field(direction), vertical_field(gone)
    return (sent * across).sum(-1) * (across * received).sum(-1), (sent * before).sum(-1) * (after * received).sum(-1)


def specular_reflectors(
    planes: tuple[Plane, ...], *, rough: bool = False, hidden: bool = False
) -> list[SpecularReflector]:
    """The largest planes that face the radar.

    Args:
        planes: Flat faces of the room.
        rough: Whether their fine roughness scatters.
        hidden: Whether faces are hidden by others directly in front of them.

    Returns:
        At most MAX_REFLECTORS faces, the largest first.
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
    """Faces, each hidden where another one lies directly in front of it."""
    return [replace(face, before=tuple(one for one in faces if one.is_before(face))) for face in faces]


def fresnel_radius_m(first_m: Values, second_m: Values, wavelength_m: float) -> Values:
    """Radius of the first Fresnel zone.

    Args:
        first_m: Length (...) from one end of the path to the point, in metres.
        second_m: Length (...) from the point to the other end, in metres.
        wavelength_m: Wavelength in metres.

    Returns:
        Radius (...) in metres, 0 at either end.
    """
    return np.sqrt(wavelength_m * np.maximum(first_m * second_m, 0) / np.maximum(first_m + second_m, 1e-9))


@dataclass(frozen=True, kw_only=True)
class SpecularPath:
    """A path from the radar over one or more faces back to it."""

    corners_m: np.ndarray  # (bounce, 3)
    rotation: np.ndarray  # (3, 3) and
    shift_m: np.ndarray  # (3,): image of a transmitter at x is rotation @ x + shift
    echoes: SlabEchoes  # products of the slabs' echoes and the tapers, (echo,)

    @property
    def length_m(self) -> float:
        """Path length over the front surfaces of the slabs, in metres."""
        return float(np.linalg.norm(self.shift_m))


def specular_paths(
    reflectors: list[SpecularReflector], wavelength_m: float, frequency_hz: float, most_echoes: int = SLAB_ECHOES
) -> list[SpecularPath]:
    """All paths of one, two and three bounces from the radar to itself; each image counts once.

    Args:
        reflectors: Flat faces.
        wavelength_m: Wavelength at the centre of the band.
        frequency_hz: Centre frequency of the band.
        most_echoes: Maximum number of echoes per slab; with 1 the reflection is that at the band's centre.

    Returns:
        Paths whose strongest echo has a coefficient of at least 1e-5.
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
    """The path over some faces with the radar's images (bounce + 1) in them; None where it misses a face or is weak."""
    corners = _corners(faces, images)
    if corners is None:
        return None
    length = float(np.linalg.norm(images[-1]))
    tapers, end, gone = [], np.zeros(3), 0.0
    field, longer_m = vertical_field(unit(corners[0]))[None].astype(complex), np.zeros(1)
    for face, image, corner in zip(reversed(faces), reversed(images[1:]), corners, strict=True):
        gone += float(np.linalg.norm(corner - end))
        fresnel_m = fresnel_radius_m(np.array(gone), np.array(length - gone), wavelength_m)
        tapers.append(float(face.inside(corner, fresnel_m)))
        direction = unit(image - end)
        te, tm, own_m = face.both_echoes(np.abs(direction @ face.plane.normal), frequency_hz, most)
        across, before, after = incidence_axes(direction, face.plane.normal)
        field = np.multiply.outer(field @ across, te)[..., None] * across + (
            np.multiply.outer(field @ before, tm)[..., None] * after
        )
        slab = SlabEchoes(field.reshape(-1, 3), np.add.outer(longer_m, own_m).ravel()).merged(frequency_hz)
        field, longer_m = slab.coefficient, slab.longer_m
        end = corner
    share = _share_of_wave(np.array(corners), min(tapers), length)
    echoes = SlabEchoes(share * (field @ vertical_field(unit(-end))), longer_m)
    if abs(echoes.coefficient).max() < 1e-5:
        return None
    rotation = np.eye(3)
    for face in faces:
        rotation = (np.eye(3) - 2 * np.outer(face.plane.normal, face.plane.normal)) @ rotation
    return SpecularPath(corners_m=np.array(corners[::-1]), rotation=rotation, shift_m=images[-1], echoes=echoes)


def _corners(faces: list[SpecularReflector], images: list[np.ndarray]) -> list[np.ndarray] | None:
    """Reflection points of a path back to the radar, the last one first; None where it passes behind a face."""
    corners, end = [], np.zeros(3)
    for face, image in zip(reversed(faces), reversed(images[1:]), strict=True):
        if face.side(end) < -1e-6 or face.side(image) >= 0:
            return None
        end = face.crossing(end, image)
        corners.append(end)
    return corners


def _share_of_wave(corners_m: np.ndarray, taper: float, length_m: float) -> float:
    """Share of the wave that takes this path.

    Where right-angled faces meet, the image lies straight behind their common edge; half of the wave meets one face
    first, the other half the other. All orders of such a corner form one image, which is counted once.
    """
    steps = np.linalg.norm(np.diff(corners_m, axis=0), axis=1)
    orders = math.factorial(1 + int((steps < 1e-3 * length_m).sum()))
    return min(1.0, orders * taper)
