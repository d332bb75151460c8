"""Static clutter that neither photo nor mesh resolves: cables, textures, rims, objects outside the picture.

Many weak patches in all directions and at all ranges, several per range-angle cell. Their cross sections are gamma
distributed about a mean, so amplitudes are K distributed. Level and density are fitted to recordings, see
docs/decisions/diffuse-clutter.md. Reference: Ward, Tough and Watts, "Sea clutter", 2013, chapter 4 (K distribution).
"""

import zlib

import numpy as np

from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.records import Scene
from mmweaver.core.rotations import directions
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
PATCHES_A_METRE = 300
SHAPE = 0.5  # of the gamma distribution; smaller is spikier
# The level is the same at all azimuths (1 to 6 m, up to 75 degrees, within 5 dB), up to 5 m to either side.
AZIMUTH_RAD, ASIDE_M, ELEVATION_RAD = np.radians(75.0), 5.0, np.radians(40.0)


def diffuse_clutter(config: RadarConfig, micro_seed: int) -> StaticPaths:
    """Samples the diffuse clutter of one room and radar.

    Args:
        config: The radar, for its maximum range and antennas.
        micro_seed: Seed of the room.

    Returns:
        Static paths of kind CLUTTER, (path,), amplitudes in sqrt(mW).
    """
    rng = stream(micro_seed, "room", "unresolved clutter")
    count = int(PATCHES_A_METRE * max(config.max_range_m - MIN_RANGE_M, 0.0))
    range_m = np.sort(rng.uniform(MIN_RANGE_M, max(config.max_range_m, MIN_RANGE_M), count))
    widest = np.minimum(np.sin(AZIMUTH_RAD), ASIDE_M / np.maximum(range_m, MIN_RANGE_M))
    azimuth = np.arcsin(widest * rng.uniform(-1, 1, count))
    elevation = rng.uniform(-ELEVATION_RAD, ELEVATION_RAD, count)
    gain = pattern(directions(np.zeros(count), elevation), config) ** 2
    texture = rng.gamma(SHAPE, 1 / SHAPE, count)
    each_m2 = room_level(micro_seed) * SQUARE_METRES_A_METRE / PATCHES_A_METRE
    mean_m2 = each_m2 * (np.minimum(range_m, MAX_RANGE_M) / AT_M) ** 4
    # the level holds for the sum over all directions, weighted by the antenna pattern
    cross_section_m2 = mean_m2 * texture / max(float((gain**2).mean()) if count else 1.0, 1e-9)
    amplitude = scatterer_gain(config) * gain * np.sqrt(cross_section_m2) / range_m**2
    phase = np.exp(2j * np.pi * rng.random(count))
    return scattered_paths(
        directions(azimuth, elevation) * range_m[:, None], amplitude * phase, Interaction.CLUTTER, config
    )


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
