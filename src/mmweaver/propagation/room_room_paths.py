"""Second-order static paths: a rough surface and a flat face of the room, or two rough surfaces.

They fill the range cells between a room's strong echoes. A random subset of all pairs is kept, with the mean power of
all (`room_patches.roulette`). Reference: docs/radar_primer.md, section 5.
"""

from typing import TYPE_CHECKING

import numpy as np

from mmweaver.core.rotations import unit
from mmweaver.core.seeding import stream
from mmweaver.propagation.antenna import pattern, scatterer_gain
from mmweaver.propagation.image_method import SpecularReflector, fresnel_radius_m
from mmweaver.propagation.paths import Interaction, StaticPaths
from mmweaver.propagation.room_patches import RoomPatches, roulette, sampled_pairs

if TYPE_CHECKING:
    from mmweaver.propagation.static_paths import RayTracedRoom

MAX_FACE_PATHS = 600  # patch-face paths per direction of travel
MAX_PATCHES, MAX_PAIRS = 200, 300  # patches whose pairs are considered, and pairs per direction of travel
CLEAR_MARGIN_M = 0.06
FACE_MARGIN_M = 0.12  # largest distance between the mesh of a wall and its fitted plane
MIN_RANGE_M = 0.2  # between two patches: nearer ones are one surface


def room_room_paths(room: "RayTracedRoom") -> StaticPaths:
    """Patch-face and patch-patch paths of a room, in both directions of travel.

    Args:
        room: The traced room, with its patches and reflectors.

    Returns:
        Static paths of kind ROOM_ROOM, (path,), amplitudes in sqrt(mW).
    """
    patches = room.patches
    luck = stream(room.micro_seed, "room", "pairs of patches")
    return StaticPaths.cat([_face_paths(room, patches, luck), _patch_paths(room, patches, luck)])


def _face_paths(room: "RayTracedRoom", patches: RoomPatches, luck: np.random.Generator) -> StaticPaths:
    """Paths radar - patch - flat face - radar."""
    found = [_face_amplitudes(room, patches, face) for face in room.reflectors]
    if not found or not len(patches):
        return _paths(room, np.zeros((0, 3)), np.zeros((0, 3)), np.zeros((0, 3)), np.zeros(0, complex), np.zeros(0))
    amplitude, image_m, corner_m = (np.concatenate(parts) for parts in zip(*found, strict=True))
    power = np.abs(amplitude) ** 2
    kept, standing_for = roulette(power, luck.random(len(power)), MAX_FACE_PATHS)
    place_m = np.tile(patches.place_m, (len(found), 1))[kept]
    clear = room.is_clear(np.zeros(3), corner_m[kept], FACE_MARGIN_M)
    clear &= room.is_clear(corner_m[kept], place_m, FACE_MARGIN_M)
    kept, standing_for, place_m = kept[clear], standing_for[clear], place_m[clear]
    size = amplitude[kept] * np.sqrt(standing_for)
    return _paths(room, place_m, image_m[kept], corner_m[kept], size, np.zeros(len(kept)))


def _face_amplitudes(
    room: "RayTracedRoom", patches: RoomPatches, face: SpecularReflector
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Amplitudes (patch,), the patches' images in a face and the reflection points (patch, 3)."""
    config, place_m = room.config, patches.place_m
    image_m = face.image(place_m)
    corner_m = face.crossing(np.zeros(3), image_m)
    image_distance, corner_distance = np.linalg.norm(image_m, axis=1), np.linalg.norm(corner_m, axis=1)
    behind_m = np.maximum(image_distance - corner_distance, 1e-6)
    to_corner = (corner_m - place_m) / behind_m[:, None]
    share = face.inside(corner_m, fresnel_radius_m(corner_distance, behind_m, config.wavelength_m))
    share = share * (np.asarray(face.side(place_m)) > FACE_MARGIN_M)
    coefficient = face.echoes(to_corner, config.centre_frequency_hz, 1).coefficient[0]
    gains = pattern(unit(place_m), config) * pattern(unit(corner_m), config)
    size = scatterer_gain(config) * gains * np.sqrt(patches.cross_sections(to_corner))
    size /= np.linalg.norm(place_m, axis=1) * image_distance
    return size * share * coefficient * patches.phase, image_m, corner_m


def _patch_paths(room: "RayTracedRoom", patches: RoomPatches, luck: np.random.Generator) -> StaticPaths:
    """Paths radar - patch - another patch - radar."""
    config, distance = room.config, np.linalg.norm(patches.place_m, axis=1)
    gain = pattern(unit(patches.place_m), config)
    level = patches.cross_section_m2 * (gain / np.maximum(distance, 1e-3) ** 2) ** 2
    chosen, standing_for = roulette(level, luck.random(len(level)), MAX_PATCHES)
    some, gain, distance = patches[chosen], gain[chosen], distance[chosen]
    leg = some.place_m - some.place_m[:, None]  # (from, to, 3)
    leg_m = np.linalg.norm(leg, axis=2)
    towards = leg / np.maximum(leg_m, 1e-9)[..., None]
    power = some.cross_sections(towards.swapaxes(0, 1)).T * some.cross_sections(-towards) / (4 * np.pi)
    power *= scatterer_gain(config) ** 2 * np.outer(gain * standing_for**0.5, gain * standing_for**0.5) ** 2
    power /= (np.outer(distance, distance) * np.maximum(leg_m, MIN_RANGE_M)) ** 2
    power = np.triu(np.where(leg_m > MIN_RANGE_M, power, 0.0), 1)
    first, last, size = sampled_pairs(power, luck.random(power.size), MAX_PAIRS)
    clear = room.is_clear(some.place_m[first], some.place_m[last], CLEAR_MARGIN_M)
    first, last, size = first[clear], last[clear], size[clear]
    phase = some.phase[first] * some.phase[last]
    ends_m = some.place_m[first], some.place_m[last]
    return _paths(room, *ends_m, ends_m[1], size * phase, leg_m[first, last])


def _paths(
    room: "RayTracedRoom",
    departure_m: np.ndarray,
    arrival_m: np.ndarray,
    vertex_m: np.ndarray,
    amplitude: np.ndarray,
    between_m: np.ndarray,
) -> StaticPaths:
    """Paths in both directions between apparent ends (path, 3), the second one seen at a vertex.

    `between_m` (path,) is the length between the two ends.
    """
    tx, rx = (np.asarray(place)[:, None] for place in (room.config.tx_position_m, room.config.rx_position_m))
    orders = []
    for (start_m, start_vertex_m), (end_m, end_vertex_m) in (
        ((departure_m, departure_m), (arrival_m, vertex_m)),
        ((arrival_m, vertex_m), (departure_m, departure_m)),
    ):
        out, back = np.linalg.norm(start_m - tx, axis=2), np.linalg.norm(end_m - rx, axis=2)  # (antenna, path)
        length_m = out.T[:, :, None] + back.T[:, None, :] + between_m[:, None, None]
        seen = length_m.mean(axis=(1, 2)) / 2 < room.config.max_range_m
        orders.append(
            StaticPaths.of(
                amplitude[seen], length_m[seen], start_vertex_m[seen], end_vertex_m[seen], Interaction.ROOM_ROOM
            )
        )
    return StaticPaths.cat(orders)
