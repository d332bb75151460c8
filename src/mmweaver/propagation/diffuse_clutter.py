"""Static clutter that neither photo nor mesh resolves: cables, textures, rims, objects outside the picture.

Many weak patches on, behind and a little in front of the room's surfaces, several per range-angle cell of a radar. They
belong to the room: their places are fixed in the camera's level frame, so that two radars see the same patches, and a
radar that moves sees their phases change. Their cross sections are gamma distributed about a mean, so amplitudes are K
distributed; the mean gives each view the level that was fitted to recordings, see docs/decisions/diffuse-clutter.md.
Reference: Ward, Tough and Watts, "Sea clutter", 2013, chapter 4 (K distribution).
"""

import zlib

import numpy as np

from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.records import Scene
from mmweaver.core.rotations import directions, unit
from mmweaver.core.seeding import stream
from mmweaver.propagation.antenna import pattern, scatterer_gain
from mmweaver.propagation.paths import Interaction, StaticPaths
from mmweaver.propagation.static_paths import scattered_paths

# In a recording of a furnished room the received power per metre of range is constant from 1 to 6 m, and 18 dB lower
# nearer, since radars have free space in front. Given as the equivalent cross section per metre of range at AT_M.
SQUARE_METRES_A_METRE = 1.5e-4
LEVELS_DB = (0.0, 12.0)  # range of levels between rooms relative to that: a recorded hall has 12 dB more
AT_M = 2.0
MAX_RANGE_M = 8.0  # beyond it the mean cross section no longer grows
MIN_RANGE_M = 1.0
PATCHES = 5000  # per room; some 3,400 of them in the view of a radar at the camera
BEHIND_M, BEHIND, BEFORE = 9.0, 0.6, 0.25  # how far behind the surfaces, shares of patches behind and in front of them
SHAPE = 0.5  # of the gamma distribution; smaller is spikier
# The level is the same at all azimuths (1 to 6 m, up to 75 degrees, within 5 dB), up to 5 m to either side.
AZIMUTH_RAD, ASIDE_M, ELEVATION_RAD = np.radians(75.0), 5.0, np.radians(40.0)
SMOOTH_M = 0.5  # of the density of patches over range, to which their mean cross section is inverse
SPARSE_A_METRE = 30.0  # where fewer patches are in view, the level falls with their number


def diffuse_clutter(config: RadarConfig, micro_seed: int, scene: Scene) -> StaticPaths:
    """The diffuse clutter of a room as one radar sees it.

    Args:
        config: The radar, for its maximum range and antennas.
        micro_seed: Seed of the room.
        scene: The room in the radar's frame.

    Returns:
        Static paths of kind CLUTTER, (path,), amplitudes in sqrt(mW).
    """
    level_m, texture, phase = _patches(scene, micro_seed)
    place_m = scene.radar_pose.seen(level_m)
    range_m = np.linalg.norm(place_m, axis=1)
    azimuth = np.arctan2(place_m[:, 0], place_m[:, 1])
    elevation = np.arcsin(np.clip(place_m[:, 2] / np.maximum(range_m, 1e-6), -1, 1))
    seen = (range_m > MIN_RANGE_M) & (range_m < config.max_range_m) & (np.abs(azimuth) < AZIMUTH_RAD)
    seen &= (np.abs(elevation) < ELEVATION_RAD) & (np.abs(place_m[:, 0]) < ASIDE_M)
    place_m, range_m, elevation = place_m[seen], range_m[seen], elevation[seen]
    gain = pattern(directions(np.zeros(len(range_m)), elevation), config) ** 2
    # the level holds for the sum over all directions, weighted by the antenna pattern
    wanted = room_level(micro_seed) * SQUARE_METRES_A_METRE * (np.minimum(range_m, MAX_RANGE_M) / AT_M) ** 4
    cross_section_m2 = texture[seen] * wanted / _density(range_m, gain**2)
    amplitude = scatterer_gain(config) * gain * np.sqrt(cross_section_m2) / range_m**2
    return scattered_paths(place_m, amplitude * phase[seen], Interaction.CLUTTER, config)


def _patches(scene: Scene, micro_seed: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Patches of a room: places (patch, 3) in the camera's level frame, relative cross sections and phases (patch,)."""
    rng = stream(micro_seed, "room", "unresolved clutter")
    if not len(scene.faces):
        return np.zeros((0, 3)), np.zeros(0), np.zeros(0, complex)
    corners = scene.radar_pose.in_level_frame(scene.vertices_m.astype(float))[scene.faces]  # (face, 3, 3)
    area = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1)
    within = np.cumsum(area) / max(float(area.sum()), 1e-12)
    draws = rng.random((PATCHES, 6))
    face = np.minimum(np.searchsorted(within, draws[:, 0]), len(area) - 1)
    flip = draws[:, 1] + draws[:, 2] > 1
    u, v = (np.where(flip, 1 - draws[:, index], draws[:, index]) for index in (1, 2))
    one, other, third = corners[face].transpose(1, 0, 2)
    place = one + u[:, None] * (other - one) + v[:, None] * (third - one)
    texture, cycles = rng.gamma(SHAPE, 1 / SHAPE, PATCHES), rng.random(PATCHES)
    outward = place * [1.0, 1.0, 0.0]  # away from the camera, level
    distance = np.linalg.norm(outward, axis=1)
    behind = np.where(draws[:, 3] < BEHIND, BEHIND_M * draws[:, 4], 0.0)
    before = np.where(draws[:, 3] > 1 - BEFORE, -0.7 * distance * draws[:, 4], 0.0)
    place = place + unit(outward + 1e-9) * (behind + before)[:, None]
    return place, texture, np.exp(2j * np.pi * cycles)


def _density(range_m: np.ndarray, weight: np.ndarray) -> np.ndarray:
    """Weighted number of patches per metre of range at each of them, smoothed over SMOOTH_M."""
    order = np.argsort(range_m)
    at, total = range_m[order], np.concatenate([[0.0], np.cumsum(weight[order])])
    first, last = (np.searchsorted(at, range_m + step) for step in (-SMOOTH_M, SMOOTH_M))
    width = range_m + SMOOTH_M - np.maximum(range_m - SMOOTH_M, MIN_RANGE_M)
    least = SPARSE_A_METRE * float(weight.mean()) if len(weight) else 1.0
    return np.maximum((total[last] - total[first]) / width, least)


def seed_of_room(scene: Scene) -> int:
    """A seed that depends on the room's mesh alone: every room has its own clutter, the same in every sequence.

    It is computed from the faces' vertex indices, which are integers: coordinates differ in their last bits between
    processors.

    Args:
        scene: The room.
    """
    return zlib.crc32(np.ascontiguousarray(scene.faces, dtype="<i4").tobytes())


def room_level(micro_seed: int) -> float:
    """Power of a room's clutter relative to the weakest recorded one, sampled log-uniformly from LEVELS_DB.

    Args:
        micro_seed: Seed of the room.
    """
    return float(10 ** (stream(micro_seed, "room", "clutter level").uniform(*LEVELS_DB) / 10))
