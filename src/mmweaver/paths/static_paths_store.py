"""Rooms that rays have been cast in, as arrays: what a machine without a ray caster needs of them.

Kept is each resting echo's place and complex amplitude (float32: 0.3 micrometres of a way, a phase of 1e-3), the ways
of mirrored ones, and the faces as they are. The rest follows.
"""

import numpy as np

from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.records import Plane
from mmweaver.core.seeding import stream
from mmweaver.paths.image_method import SpecularReflector
from mmweaver.paths.static_paths import KINDS, PreparedRoom, StaticEchoes, path_lengths_m

VECTORS = ("centre_m", "normal", "axis_u", "axis_v")


def room_arrays(room: PreparedRoom) -> dict[str, np.ndarray]:
    """A room as numbers, without its faces' words (`room_words`)."""
    echoes, mirrored = room.echoes, _mirrored(room.counts)
    planes = [mirror.plane for mirror in room.mirrors]
    return {
        "count": np.array([room.counts[kind] for kind in KINDS]),
        "place_m": echoes.first_m.astype(np.float32),
        "amplitude": np.stack([np.real(echoes.amplitude), np.imag(echoes.amplitude)], axis=-1).astype(np.float32),
        "mirrored_last_m": echoes.last_m[mirrored].astype(np.float32),
        "mirrored_way_m": echoes.way_m[mirrored],
        "face": np.array([[getattr(plane, name) for name in VECTORS] for plane in planes]).reshape(-1, 4, 3),
        "face_half_m": np.array([plane.half_size_m for plane in planes]).reshape(-1, 2),
    }


def room_words(room: PreparedRoom) -> list[list[str]]:
    """Kind and material of each face."""
    return [[mirror.plane.kind, mirror.plane.material] for mirror in room.mirrors]


def room_of(arrays: dict[str, np.ndarray], words: list[list[str]], config: RadarConfig) -> PreparedRoom:
    """The room again, for the radar that it was prepared for."""
    counts = {kind: int(count) for kind, count in zip(KINDS, arrays["count"], strict=True)}
    mirrored = _mirrored(counts)
    first_m = arrays["place_m"].astype(float)
    last_m, way_m = first_m.copy(), path_lengths_m(first_m, config)
    last_m[mirrored], way_m[mirrored] = arrays["mirrored_last_m"], arrays["mirrored_way_m"]
    amplitude = arrays["amplitude"].astype(float)
    echoes = StaticEchoes(way_m=way_m, amplitude=amplitude[:, 0] + 1j * amplitude[:, 1], first_m=first_m, last_m=last_m)
    mirrors = []
    for vectors, half, (kind, material) in zip(arrays["face"], arrays["face_half_m"], words, strict=True):
        plane = Plane(
            kind=kind, material=material, half_size_m=(float(half[0]), float(half[1])),
            **dict(zip(VECTORS, vectors, strict=True)),
        )  # fmt: skip
        mirrors.append(SpecularReflector(plane=plane, offset_m=float(plane.normal @ plane.centre_m)))
    return PreparedRoom(config, mirrors, echoes, counts)


def with_new_phases(room: PreparedRoom, seed: int) -> PreparedRoom:
    """The same room with other micro-phases; what mirrors return keeps its phase, for geometry says it."""
    turns = stream(seed, "room", "other phases").random(len(room.echoes))
    turns[_mirrored(room.counts)] = 0.0
    old = room.echoes
    echoes = StaticEchoes(
        way_m=old.way_m, amplitude=old.amplitude * np.exp(2j * np.pi * turns), first_m=old.first_m, last_m=old.last_m
    )
    return PreparedRoom(room.config, room.mirrors, echoes, room.counts)


def _mirrored(counts: dict[str, int]) -> slice:
    return slice(counts["diffuse"], counts["diffuse"] + counts["specular"])
