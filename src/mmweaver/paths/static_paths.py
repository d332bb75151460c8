"""The room without the person: diffuse surfaces, mirrors and edges, as echoes that stay."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from mmweaver.core.constants import SPEED_OF_LIGHT_MPS
from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.records import Scene
from mmweaver.core.seeding import stream
from mmweaver.geometry.ray_caster import RayCaster
from mmweaver.paths.adc_synthesis import fast_time, phasor
from mmweaver.paths.antenna import pattern, scatterer_gain, specular_gain
from mmweaver.paths.edge_scattering import find_edges
from mmweaver.paths.image_method import SpecularReflector, specular_paths, specular_reflectors
from mmweaver.paths.materials import MATERIALS, reflection

AZIMUTH_CELLS, ELEVATION_CELLS = 128, 64
AZIMUTH_LIMIT_RAD, ELEVATION_LIMIT_RAD = np.radians(62.0), np.radians(50.0)
EDGE_RADIUS_M = 0.008  # of table rims and legs: how round an edge counts
EDGE_LOBE = 0.08  # cosine between an edge and the line of sight at which its glint is gone
NEAREST_M = 0.15
KINDS = ("diffuse", "specular", "edges")


@dataclass(frozen=True, kw_only=True)
class StaticEchoes:
    """Echoes of the room, one row each."""

    way_m: np.ndarray  # (row, tx, rx) out and back
    amplitude: np.ndarray  # (row,) complex, sqrt(mW)
    first_m: np.ndarray  # (row, 3) where the wave first meets the room: a body before it casts a shadow
    last_m: np.ndarray  # (row, 3) where it last leaves it

    def __len__(self) -> int:
        return len(self.amplitude)

    def part(self, rows: np.ndarray) -> "StaticEchoes":
        return StaticEchoes(
            way_m=self.way_m[rows], amplitude=self.amplitude[rows], first_m=self.first_m[rows], last_m=self.last_m[rows]
        )


class PreparedRoom:
    """What of a room needs no more rays: its mirrors and its static echoes, for one radar.

    `counts` says how many of the echoes, in this order, are of which of KINDS. `prepared` keeps such rooms as arrays.
    """

    def __init__(
        self, config: RadarConfig, mirrors: list[SpecularReflector], echoes: StaticEchoes, counts: dict[str, int]
    ):
        self.config, self.mirrors, self.echoes, self.counts = config, mirrors, echoes, counts

    @cached_property
    def adc(self) -> np.ndarray:
        """Samples of all echoes, (tx, rx, sample)."""
        return static_adc(self.echoes, self.config)

    @cached_property
    def adc_rate(self) -> np.ndarray:
        """Their rate over time, for jitter, (tx, rx, sample)."""
        delay_s = self.echoes.way_m.mean(axis=(1, 2)) / SPEED_OF_LIGHT_MPS
        rate = 2j * np.pi * self.config.chirp_slope_hz_per_s * delay_s
        return static_adc(self.echoes, self.config, self.echoes.amplitude * rate)


class RayTracedRoom(PreparedRoom):
    """A scene made ready for one radar: its ray caster, its mirrors and its static echoes.

    `micro_seed` draws the phases of its surfaces: another one is the same room seen with other micro-phases.
    """

    def __init__(self, scene: Scene, config: RadarConfig, micro_seed: int = 0):
        self.config, self.micro_seed = config, micro_seed
        self.caster = RayCaster(scene.vertices_m, scene.faces)
        self.mirrors = specular_reflectors(scene.planes)
        parts = [self._diffuse(scene), self._specular(), self._edges(scene)]
        echoes = StaticEchoes(
            way_m=np.concatenate([part.way_m for part in parts]),
            amplitude=np.concatenate([part.amplitude for part in parts]),
            first_m=np.concatenate([part.first_m for part in parts]),
            last_m=np.concatenate([part.last_m for part in parts]),
        )
        super().__init__(config, self.mirrors, echoes, dict(zip(KINDS, map(len, parts), strict=True)))

    def is_clear(self, start_m: np.ndarray, end_m: np.ndarray, margin_m: float) -> np.ndarray:
        """True where nothing of the room lies between; shapes (..., 3)."""
        shape = np.broadcast_shapes(start_m.shape, end_m.shape)
        start = np.broadcast_to(start_m, shape).reshape(-1, 3).astype(float)
        end = np.broadcast_to(end_m, shape).reshape(-1, 3).astype(float)
        return self.caster.is_clear(start, end, margin_m).reshape(shape[:-1])

    def _diffuse(self, scene: Scene) -> StaticEchoes:
        """Every cell of a grid of rays is a patch that scatters as Lambert's law says."""
        rng = stream(self.micro_seed, "room", "diffuse")
        shape = (ELEVATION_CELLS, AZIMUTH_CELLS)
        step_az, step_el = 2 * AZIMUTH_LIMIT_RAD / AZIMUTH_CELLS, 2 * ELEVATION_LIMIT_RAD / ELEVATION_CELLS
        azimuth = (np.arange(AZIMUTH_CELLS)[None] + rng.random(shape)) * step_az - AZIMUTH_LIMIT_RAD
        elevation = (np.arange(ELEVATION_CELLS)[:, None] + rng.random(shape)) * step_el - ELEVATION_LIMIT_RAD
        turns = rng.random(azimuth.size)
        solid_angle = (np.cos(elevation) * step_az * step_el).ravel()
        way = np.stack(
            [np.sin(azimuth) * np.cos(elevation), np.cos(azimuth) * np.cos(elevation), np.sin(elevation)], -1
        ).reshape(-1, 3)  # fmt: skip
        distance, face = self.caster.first_hit(np.zeros_like(way), way)
        hit = (face >= 0) & (distance > NEAREST_M) & (distance < self.config.max_range_m)
        way, distance, face = way[hit], distance[hit], face[hit]
        corners = scene.vertices_m[scene.faces[face]].astype(float)
        normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        normal /= np.maximum(np.linalg.norm(normal, axis=1, keepdims=True), 1e-12)
        cos = np.abs((normal * way).sum(axis=1))
        cross_section = 4 * cos * distance**2 * solid_angle[hit]
        cross_section *= self._diffuse_share(scene, scene.face_material[face], cos, np.abs(normal[:, 2]) > 0.7)
        return self._at_points(way * distance[:, None], cross_section, turns[hit])

    def _diffuse_share(self, scene: Scene, kind: np.ndarray, cos: np.ndarray, flat: np.ndarray) -> np.ndarray:
        """|S Gamma|^2 of each patch (effective roughness)."""
        share = np.zeros(len(cos))
        for index, name in enumerate(scene.material_names):
            material = MATERIALS[name]
            for is_flat, polarisation in ((True, "tm"), (False, "te")):
                of = (kind == index) & (flat == is_flat)
                gamma = reflection(material, cos[of], self.config.centre_frequency_hz, polarisation=polarisation)
                share[of] = material.scattering**2 * np.abs(gamma) ** 2
        return share

    def _specular(self) -> StaticEchoes:
        tx, rx = np.asarray(self.config.tx_position_m), np.asarray(self.config.rx_position_m)
        ways, amplitudes, first, last = [], [], [], []
        for path in specular_paths(self.mirrors, self.config.wavelength_m, self.config.centre_frequency_hz):
            stops = np.concatenate([np.zeros((1, 3)), path.corners_m, np.zeros((1, 3))])
            if path.length_m / 2 > self.config.max_range_m or not self.is_clear(stops[:-1], stops[1:], 0.12).all():
                continue
            image = tx @ path.turn.T + path.shift_m
            ways.append(np.linalg.norm(image[:, None] - rx[None], axis=-1))
            ends = np.stack([stops[1], stops[-2]])
            gains = pattern(ends / np.linalg.norm(ends, axis=1, keepdims=True), self.config)
            amplitudes.append(specular_gain(self.config) * gains.prod() * path.coefficient / path.length_m)
            first.append(stops[1])
            last.append(stops[-2])
        return StaticEchoes(
            way_m=np.array(ways).reshape(-1, len(tx), len(rx)),
            amplitude=np.array(amplitudes, complex),
            first_m=np.array(first).reshape(-1, 3),
            last_m=np.array(last).reshape(-1, 3),
        )

    def _edges(self, scene: Scene) -> StaticEchoes:
        """Rims and legs that lie across the line of sight flash: sigma = k a L^2 |Gamma|^2."""
        edges = find_edges(scene, self.caster)
        rng = stream(self.micro_seed, "room", "edges")
        distance = np.maximum(np.linalg.norm(edges.place_m, axis=1), 1e-6)
        cos = np.abs((edges.direction * edges.place_m).sum(axis=1)) / distance
        gamma = np.array(
            [
                np.abs(reflection(MATERIALS[n], np.float64(1.0), self.config.centre_frequency_hz))
                for n in scene.material_names
            ]
        )
        wave_number = 2 * np.pi / self.config.wavelength_m
        cross_section = wave_number * EDGE_RADIUS_M * edges.length_m**2 * gamma[edges.material] ** 2
        cross_section *= np.exp(-2 * (cos / EDGE_LOBE) ** 2)
        turns = rng.random(len(cos))
        keep = (cross_section > 1e-7) & (distance > NEAREST_M) & (distance < self.config.max_range_m)
        return self._at_points(edges.place_m[keep], cross_section[keep], turns[keep])

    def _at_points(self, place_m: np.ndarray, cross_section_m2: np.ndarray, turns: np.ndarray) -> StaticEchoes:
        distance = np.linalg.norm(place_m, axis=1)
        gain = pattern(place_m / np.maximum(distance, 1e-9)[:, None], self.config) ** 2
        amplitude = scatterer_gain(self.config) * gain * np.sqrt(cross_section_m2) / np.maximum(distance, 1e-3) ** 2
        return StaticEchoes(
            way_m=path_lengths_m(place_m, self.config),
            amplitude=amplitude * np.exp(2j * np.pi * turns),
            first_m=place_m,
            last_m=place_m,
        )


def path_lengths_m(place_m: np.ndarray, config: RadarConfig) -> np.ndarray:
    """Out from each transmitter to places (row, 3) and back to each receiver, (row, tx, rx)."""
    tx, rx = np.asarray(config.tx_position_m), np.asarray(config.rx_position_m)
    out = np.linalg.norm(place_m[:, None] - tx, axis=-1)
    back = np.linalg.norm(place_m[:, None] - rx, axis=-1)
    return out[:, :, None] + back[:, None, :]


def static_adc(echoes: StaticEchoes, config: RadarConfig, amplitude: np.ndarray | None = None) -> np.ndarray:
    """ADC samples of resting echoes, complex64 (tx, rx, sample); the same in every loop."""
    adc = np.zeros((config.num_tx, config.num_rx, config.num_samples), np.complex64)
    weight = (echoes.amplitude if amplitude is None else amplitude).astype(np.complex64)
    for start in range(0, len(echoes), 2048):
        chunk = slice(start, start + 2048)
        slow = phasor(echoes.way_m[chunk] / config.wavelength_m) * weight[chunk, None, None]
        for m in range(config.num_tx):
            delay_s = echoes.way_m[chunk, m].mean(axis=1) / SPEED_OF_LIGHT_MPS
            adc[m] += slow[:, m].T @ fast_time(delay_s, 0.0, config)
    return adc
