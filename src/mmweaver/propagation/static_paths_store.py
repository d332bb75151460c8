"""Prepared rooms as arrays, for machines without a ray caster.

Stored are each static path's vertex and complex amplitude (float32: 0.3 micrometres of path length, a phase of 1e-3
rad), the lengths of specular paths, and the reflectors. Everything else follows.
"""

from dataclasses import replace

import numpy as np
import torch

from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.records import Plane
from mmweaver.core.seeding import stream
from mmweaver.propagation.image_method import SpecularReflector, layered_faces
from mmweaver.propagation.paths import STATIC_KINDS, Interaction, StaticPaths
from mmweaver.propagation.static_paths import PreparedRoom, Propagation, scattered_paths

VECTORS = ("centre_m", "normal", "axis_u", "axis_v")


def room_arrays(room: PreparedRoom) -> dict[str, np.ndarray]:
    """A room as named arrays, without the kinds and materials of its reflectors (`room_words`).

    Args:
        room: The room; its paths must be of first order.

    Returns:
        Arrays by name, the inverse of `room_of`.
    """
    paths, specular = room.paths, room.paths.select(Interaction.SPECULAR)
    planes = [reflector.plane for reflector in room.reflectors]
    return {
        "count": np.array([room.counts[kind] for kind in STATIC_KINDS]),
        "place_m": paths.departure_vertex_m.numpy().astype(np.float32),
        "amplitude": torch.view_as_real(paths.amplitude).numpy().astype(np.float32),
        "mirrored_last_m": specular.arrival_vertex_m.numpy().astype(np.float32),
        "mirrored_way_m": specular.length_m.numpy(),
        "face": np.array([[getattr(plane, name) for name in VECTORS] for plane in planes]).reshape(-1, 4, 3),
        "face_half_m": np.array([plane.half_size_m for plane in planes]).reshape(-1, 2),
    }


def room_words(room: PreparedRoom) -> list[list[str]]:
    """Kind and material of each reflector, [[kind, material], ...]."""
    return [[reflector.plane.kind, reflector.plane.material] for reflector in room.reflectors]


def room_of(
    arrays: dict[str, np.ndarray], words: list[list[str]], config: RadarConfig, propagation: Propagation
) -> PreparedRoom:
    """Restores a room with its first-order paths.

    Args:
        arrays: As given by `room_arrays`.
        words: As given by `room_words`.
        config: The radar that the room was prepared for.
        propagation: The propagation that it was prepared with.
    """
    place_m, amplitude = arrays["place_m"].astype(float), arrays["amplitude"].astype(float) @ np.array([1, 1j])
    parts, first = [], 0
    for kind, count in zip(STATIC_KINDS, arrays["count"], strict=True):
        some = slice(first, first + int(count))
        if kind is Interaction.SPECULAR:
            length_m, last_m = arrays["mirrored_way_m"], arrays["mirrored_last_m"]
            parts.append(StaticPaths.of(amplitude[some], length_m, place_m[some], last_m, kind))
        else:
            parts.append(scattered_paths(place_m[some], amplitude[some], kind, config))
        first = some.stop
    reflectors = []
    for vectors, half, (kind, material) in zip(arrays["face"], arrays["face_half_m"], words, strict=True):
        plane = Plane(
            kind=kind,
            material=material,
            half_size_m=(float(half[0]), float(half[1])),
            **dict(zip(VECTORS, vectors, strict=True)),
        )
        offset_m = float(plane.normal @ plane.centre_m)
        reflectors.append(SpecularReflector(plane=plane, offset_m=offset_m, is_rough=propagation.fine_roughness))
    if propagation.hidden_faces:
        reflectors = layered_faces(reflectors)
    return PreparedRoom(config, reflectors, StaticPaths.cat(parts), propagation)


def resampled_phases(room: PreparedRoom, seed: int) -> PreparedRoom:
    """Another realization of the room: other phases of rough surfaces and edges.

    Phases of specular paths follow from geometry and are kept.

    Args:
        room: The room.
        seed: Seed of the phases.
    """
    cycles = stream(seed, "room", "other phases").random(len(room.paths))
    cycles[room.paths.interaction.numpy() == int(Interaction.SPECULAR)] = 0.0
    amplitude = room.paths.amplitude * torch.from_numpy(np.exp(2j * np.pi * cycles))
    return PreparedRoom(room.config, room.reflectors, replace(room.paths, amplitude=amplitude), room.propagation)
