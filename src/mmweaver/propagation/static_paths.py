"""The static paths of a room: diffuse surfaces, specular reflections and edges."""

from collections.abc import Callable
from copy import copy
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.ray_caster import RayCaster
from mmweaver.core.records import Scene
from mmweaver.core.rotations import directions, unit
from mmweaver.core.seeding import stream
from mmweaver.core.shapes import Values
from mmweaver.core.tensor_files import TensorRecord
from mmweaver.propagation.antenna import pattern, scatterer_gain, specular_gain
from mmweaver.propagation.edge_scattering import find_edges
from mmweaver.propagation.image_method import (
    SLAB_ECHOES,
    SpecularReflector,
    incidence_axes,
    specular_paths,
    specular_reflectors,
    vertical_field,
)
from mmweaver.propagation.materials import MATERIALS, Material, mean_reflectivity, transmission
from mmweaver.propagation.paths import STATIC_KINDS, Interaction, StaticPaths
from mmweaver.propagation.room_patches import RoomPatches
from mmweaver.propagation.room_room_paths import room_room_paths

AZIMUTH_CELLS, ELEVATION_CELLS = 128, 64
AZIMUTH_LIMIT_RAD, ELEVATION_LIMIT_RAD = np.radians(62.0), np.radians(50.0)
EDGE_RADIUS_M = 0.008  # radius of curvature of table rims and legs
EDGE_LOBE = 0.08  # cosine between an edge and the line of sight at which its specular lobe ends
MIN_RANGE_M = 0.15
THIN = ("plasterboard", "ceiling_board", "glass")  # a face of these is a whole wall; furniture has more faces behind
SAME_WALL_M = 0.3  # a hit closer behind a wall is the same wall: bumps of a photo's mesh, the other face of a scan


@dataclass(frozen=True, kw_only=True)
class Propagation:
    """Which paths of a room are traced."""

    bounces: int = 2  # 1: off rough surfaces once, off the body once; 2: body and room, room and room, body-radar-body
    clutter: bool = False  # whether there is static clutter that photo and mesh do not resolve
    slab_echoes: int = SLAB_ECHOES  # per face; 1: the reflection at the band's centre is used for the whole band
    straight_edges: bool = True  # whether pieces of edge are aligned with their neighbourhood
    through_walls: bool = True  # whether surfaces behind a thin wall return echoes through it
    fine_roughness: bool = True  # whether plaster, concrete and brick scatter by their fine roughness, too
    hidden_faces: bool = True  # whether a face directly in front of another (a locker's door, a window) hides it


ALL_PATHS = Propagation(clutter=True)  # everything that is modelled
FIRST_ORDER = Propagation(bounces=1)  # what the network learns, and what data sets with geometry contain
# The propagation of studies and data sets that were published before second-order paths were modelled.
AS_PUBLISHED = replace(
    FIRST_ORDER, slab_echoes=1, straight_edges=False, through_walls=False, fine_roughness=False, hidden_faces=False
)


@dataclass(frozen=True, kw_only=True)
class _Struck(TensorRecord):
    """Rays of the radar and the faces that they meet."""

    direction: np.ndarray  # (ray, 3) unit
    distance_m: np.ndarray  # (ray,)
    normal: np.ndarray  # (ray, 3) unit, of either sign
    cos: np.ndarray  # (ray,) of incidence
    material: np.ndarray  # (ray,) index into the scene's material_names
    solid_angle: np.ndarray  # (ray,)

    @classmethod
    def of(
        cls, scene: Scene, direction: np.ndarray, distance: np.ndarray, face: np.ndarray, solid_angle: np.ndarray
    ) -> "_Struck":
        """Rays that meet faces of these indices."""
        corners = scene.vertices_m[scene.faces[face]].astype(float)
        normal = unit(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]))
        return cls(
            direction=direction,
            distance_m=distance,
            normal=normal,
            cos=np.abs((normal * direction).sum(axis=1)),
            material=scene.face_material[face],
            solid_angle=solid_angle,
        )

    @property
    def place_m(self) -> np.ndarray:
        """(ray, 3)."""
        return self.direction * self.distance_m[:, None]

    @property
    def cross_section_m2(self) -> np.ndarray:
        """Cross section (ray,) of perfectly diffuse patches, by Lambert's law."""
        return 4 * self.cos * self.distance_m**2 * self.solid_angle

    def share(self, names: tuple[str, ...], of_material: Callable[[Material, np.ndarray, str], Values]) -> np.ndarray:
        """Power shares (ray,), a function of the material, the cosine of incidence and the polarisation."""
        across = (vertical_field(self.direction) * incidence_axes(self.direction, self.normal)[0]).sum(axis=1) ** 2
        share = np.zeros(len(self.cos))
        for index, name in enumerate(names):
            some = self.material == index
            te, tm = (of_material(MATERIALS[name], self.cos[some], one) for one in ("te", "tm"))
            share[some] = across[some] * te + (1 - across[some]) * tm
        return share


class PreparedRoom:
    """Specular reflectors and static paths of a room for one radar, without its mesh.

    The paths are in the order of STATIC_KINDS, followed by those of second order. `static_paths_store` stores the
    first-order ones as arrays.
    """

    def __init__(
        self, config: RadarConfig, reflectors: list[SpecularReflector], paths: StaticPaths, propagation: Propagation
    ):
        """Takes the results of a ray-traced room.

        Args:
            config: The radar.
            reflectors: Specular reflectors.
            paths: Static paths, (path,).
            propagation: Which paths were traced.
        """
        self.config, self.reflectors, self.paths, self.propagation = config, reflectors, paths, propagation

    @cached_property
    def counts(self) -> dict[Interaction, int]:
        """Number of first-order static paths per kind."""
        return {kind: int((self.paths.interaction == int(kind)).sum()) for kind in STATIC_KINDS}

    @property
    def first_order(self) -> StaticPaths:
        """The static paths of STATIC_KINDS, in their order."""
        return self.paths[: sum(self.counts.values())]

    @property
    def frequencies_hz(self) -> np.ndarray:
        """Frequencies over which the power scattered by faces and edges is averaged."""
        centre_hz, reach_hz = self.config.centre_frequency_hz, 0.4 * self.config.bandwidth_hz  # the window's weight
        if self.propagation.slab_echoes == 1:
            return np.array([centre_hz])
        return np.linspace(centre_hz - reach_hz, centre_hz + reach_hz, 9)

    @cached_property
    def vertex_directions(self) -> tuple[np.ndarray, np.ndarray]:
        """Unit vectors (path, 3) from the radar to the first and the last vertex of each static path."""
        return unit(self.paths.departure_vertex_m.numpy()), unit(self.paths.arrival_vertex_m.numpy())


class RayTracedRoom(PreparedRoom):
    """A scene prepared for one radar: its ray caster, specular reflectors and static paths."""

    def __init__(self, scene: Scene, config: RadarConfig, micro_seed: int = 0, propagation: Propagation | None = None):
        """Traces the static paths.

        Args:
            scene: The room, in the radar's coordinates.
            config: The radar.
            micro_seed: Seed of the phases of rough surfaces; another seed is another realization of the same room.
            propagation: Which paths are traced; by default `Propagation()`.
        """
        self.micro_seed, self.propagation = micro_seed, propagation or Propagation()
        self.caster = RayCaster(scene.vertices_m, scene.faces)
        self.config, self._scene = config, scene
        self.reflectors = specular_reflectors(
            scene.planes, rough=self.propagation.fine_roughness, hidden=self.propagation.hidden_faces
        )
        paths = StaticPaths.cat([*self._diffuse(), self._specular(), self._edges()])
        super().__init__(config, self.reflectors, paths, self.propagation)
        if self.propagation.bounces > 1:
            self.paths = StaticPaths.cat([paths, room_room_paths(self)])

    def for_radar(self, config: RadarConfig) -> "RayTracedRoom":
        """The same room for a radar that differs in its noise figure alone; the paths of the copy may be replaced."""
        other = copy(self)
        other.config = config
        return other

    @cached_property
    def patches_all_round(self) -> RoomPatches:
        """`patches`, and those to the sides, above, below and behind the radar, outside the rays of the static paths.

        Their own echoes are suppressed by two antenna patterns. A body's echo over them is suppressed by one only,
        appears at the body's velocity, and they are near.
        """
        rng = stream(self.micro_seed, "room", "patches all round")
        shape = (ELEVATION_CELLS, AZIMUTH_CELLS)
        azimuth = (np.arange(AZIMUTH_CELLS)[None] + rng.random(shape)) * 2 * np.pi / AZIMUTH_CELLS - np.pi
        height = (np.arange(ELEVATION_CELLS)[:, None] + rng.random(shape)) * 2 / ELEVATION_CELLS - 1
        is_new = (np.abs(azimuth) > AZIMUTH_LIMIT_RAD) | (np.abs(height) > np.sin(ELEVATION_LIMIT_RAD))
        azimuth, height = azimuth[is_new], height[is_new]
        level = np.sqrt(1 - height**2)
        direction = np.stack([np.sin(azimuth) * level, np.cos(azimuth) * level, height], axis=1)
        struck, _ = self._struck(direction, np.full(len(direction), 4 * np.pi / is_new.size))
        cross_section = struck.cross_section_m2 * self._diffuse_share(struck)
        phase = np.exp(2j * np.pi * rng.random(len(cross_section)))
        found = RoomPatches.surfaces(struck.place_m, struck.normal, cross_section, phase, struck.material)
        return RoomPatches.cat([self.patches, found.merged(rng)])

    @cached_property
    def patches(self) -> RoomPatches:
        """What second bounces of the static paths are computed over."""
        both = RoomPatches.cat([self._patches, self._edge_patches])
        return both.merged(stream(self.micro_seed, "room", "patches"))

    def is_clear(self, start_m: np.ndarray, end_m: np.ndarray, margin_m: float) -> np.ndarray:
        """Whether no part of the room lies between two points.

        Args:
            start_m: Start points (..., 3) in metres.
            end_m: End points (..., 3) in metres.
            margin_m: Distance from either end within which faces are ignored.

        Returns:
            Bool (...).
        """
        shape = np.broadcast_shapes(start_m.shape, end_m.shape)
        start = np.broadcast_to(start_m, shape).reshape(-1, 3).astype(float)
        end = np.broadcast_to(end_m, shape).reshape(-1, 3).astype(float)
        return self.caster.is_clear(start, end, margin_m).reshape(shape[:-1])

    def _diffuse(self) -> list[StaticPaths]:
        """One path per cell of a grid of rays: a patch that scatters by Lambert's law; and those behind thin walls."""
        rng = stream(self.micro_seed, "room", "diffuse")
        shape = (ELEVATION_CELLS, AZIMUTH_CELLS)
        step_az, step_el = 2 * AZIMUTH_LIMIT_RAD / AZIMUTH_CELLS, 2 * ELEVATION_LIMIT_RAD / ELEVATION_CELLS
        azimuth = (np.arange(AZIMUTH_CELLS)[None] + rng.random(shape)) * step_az - AZIMUTH_LIMIT_RAD
        elevation = (np.arange(ELEVATION_CELLS)[:, None] + rng.random(shape)) * step_el - ELEVATION_LIMIT_RAD
        cycles = rng.random(azimuth.size)
        solid_angle = (np.cos(elevation) * step_az * step_el).ravel()
        struck, hit = self._struck(directions(azimuth, elevation).reshape(-1, 3), solid_angle)
        cross_section = struck.cross_section_m2 * self._diffuse_share(struck)
        phase = np.exp(2j * np.pi * cycles[hit])
        self._patches = RoomPatches.surfaces(struck.place_m, struck.normal, cross_section, phase, struck.material)
        paths = [self._scattered(struck.place_m, cross_section, cycles[hit], Interaction.DIFFUSE)]
        return [*paths, self._behind_walls(struck)] if self.propagation.through_walls else paths

    def _struck(self, direction: np.ndarray, solid_angle: np.ndarray) -> tuple["_Struck", np.ndarray]:
        """The first faces that rays (ray, 3) from the radar hit, and the mask (ray,) of rays that hit one."""
        distance, face = self.caster.first_hit(np.zeros_like(direction), direction)
        hit = (face >= 0) & (distance > MIN_RANGE_M) & (distance < self.config.max_range_m)
        return _Struck.of(self._scene, direction[hit], distance[hit], face[hit], solid_angle[hit]), hit

    def _behind_walls(self, struck: "_Struck") -> StaticPaths:
        """Patches that rays hit behind the first thin wall, attenuated by the way through it and back."""
        names = np.array(self._scene.material_names)
        wall = struck[np.isin(names[struck.material], THIN)]
        distance, face = self.caster.first_hit(wall.place_m + SAME_WALL_M * wall.direction, wall.direction)
        distance += wall.distance_m + SAME_WALL_M
        hit = (face >= 0) & (distance < self.config.max_range_m)
        wall = wall[hit]
        behind = _Struck.of(self._scene, wall.direction, distance[hit], face[hit], wall.solid_angle)
        cross_section = behind.cross_section_m2 * self._diffuse_share(behind) * self._passed(wall) ** 2
        cycles = stream(self.micro_seed, "room", "behind walls").random(len(cross_section))
        return self._scattered(behind.place_m, cross_section, cycles, Interaction.DIFFUSE)

    def _passed(self, wall: "_Struck") -> np.ndarray:
        """Share of the power (ray,) that a wall transmits one way."""

        def passed(material: Material, cos: np.ndarray, polarisation: str) -> Values:
            each = [transmission(material, cos, one, polarisation=polarisation) for one in self.frequencies_hz]
            return np.mean(np.abs(each) ** 2, axis=0)

        return wall.share(self._scene.material_names, passed)

    def _diffuse_share(self, struck: "_Struck") -> np.ndarray:
        """Diffusely scattered share of the power of each patch: |S Gamma|^2 (effective roughness), or more."""

        def scattered(material: Material, cos: np.ndarray, polarisation: str) -> Values:
            part: Values = np.float64(material.scattering**2)
            if self.propagation.fine_roughness:
                part = part + (1 - part) * material.fine_loss(cos, self.config.centre_frequency_hz)
            return part * mean_reflectivity(material, cos, self.frequencies_hz, polarisation)

        return struck.share(self._scene.material_names, scattered)

    def _specular(self) -> StaticPaths:
        """One path per echo of each unobstructed specular reflection."""
        config, found = self.config, []
        tx, rx = np.asarray(config.tx_position_m), np.asarray(config.rx_position_m)
        for path in specular_paths(
            self.reflectors, config.wavelength_m, config.centre_frequency_hz, self.propagation.slab_echoes
        ):
            stops = np.concatenate([np.zeros((1, 3)), path.corners_m, np.zeros((1, 3))])
            if path.length_m / 2 > config.max_range_m or not self.is_clear(stops[:-1], stops[1:], 0.12).all():
                continue
            image = tx @ path.rotation.T + path.shift_m
            length_m = np.linalg.norm(image[:, None] - rx[None], axis=-1)
            gains = pattern(unit(stops[[1, -2]]), config)
            level = specular_gain(config) * gains.prod() / path.length_m
            for coefficient, longer_m in path.echoes:
                found.append((level * coefficient, length_m + longer_m, stops[1], stops[-2]))
        amplitude, length, first, last = zip(*found, strict=True) if found else ((), (), (), ())
        return StaticPaths.of(
            np.array(amplitude, complex),
            np.array(length).reshape(-1, len(tx), len(rx)),
            np.array(first).reshape(-1, 3),
            np.array(last).reshape(-1, 3),
            Interaction.SPECULAR,
        )

    def _edges(self) -> StaticPaths:
        """One path per piece of rim or leg.

        Sigma = k a L^2 |Gamma|^2 where it is perpendicular to the line of sight.
        """
        edges = find_edges(self._scene, self.caster, straight=self.propagation.straight_edges)
        rng = stream(self.micro_seed, "room", "edges")
        distance = np.maximum(np.linalg.norm(edges.place_m, axis=1), 1e-6)
        cos = np.abs((edges.direction * edges.place_m).sum(axis=1)) / distance
        lobe = np.exp(-2 * (cos / EDGE_LOBE) ** 2)
        materials = [MATERIALS[name] for name in self._scene.material_names]
        frontal = np.float64(1.0)
        reflectivity = np.array([mean_reflectivity(one, frontal, self.frequencies_hz, "te") for one in materials])
        wave_number = 2 * np.pi / self.config.wavelength_m
        cross_section = wave_number * EDGE_RADIUS_M * edges.length_m**2 * reflectivity[edges.material]
        cross_section *= lobe
        cycles = rng.random(len(cos))
        keep = (cross_section > 1e-7) & (distance > MIN_RANGE_M) & (distance < self.config.max_range_m)
        place_m, cross_section, cycles = edges.place_m[keep], cross_section[keep], cycles[keep]
        # bistatically an edge scatters as if seen from the side
        level = cross_section / lobe[keep] * EDGE_LOBE
        self._edge_patches = RoomPatches.edges(place_m, level, np.exp(2j * np.pi * cycles), edges.material[keep])
        return self._scattered(place_m, cross_section, cycles, Interaction.EDGE)

    def _scattered(
        self, place_m: np.ndarray, cross_section_m2: np.ndarray, cycles: np.ndarray, kind: Interaction
    ) -> StaticPaths:
        """Direct echoes of scatterers (path, 3) with cross section and phase (path,)."""
        distance = np.linalg.norm(place_m, axis=1)
        gain = pattern(unit(place_m), self.config) ** 2
        amplitude = scatterer_gain(self.config) * gain * np.sqrt(cross_section_m2) / np.maximum(distance, 1e-3) ** 2
        return scattered_paths(place_m, amplitude * np.exp(2j * np.pi * cycles), kind, self.config)


def scattered_paths(place_m: np.ndarray, amplitude: np.ndarray, kind: Interaction, config: RadarConfig) -> StaticPaths:
    """Direct echoes of static scatterers.

    Args:
        place_m: Positions (path, 3) in metres.
        amplitude: Amplitudes (path,), complex, in sqrt(mW).
        kind: Kind of all paths.
        config: The radar, for its antenna positions.

    Returns:
        Static paths, (path,).
    """
    tx, rx = np.asarray(config.tx_position_m), np.asarray(config.rx_position_m)
    out = np.linalg.norm(place_m[:, None] - tx, axis=-1)
    back = np.linalg.norm(place_m[:, None] - rx, axis=-1)
    return StaticPaths.of(amplitude, out[:, :, None] + back[:, None, :], place_m, place_m, kind)
