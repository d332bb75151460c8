"""The rough surfaces of a room as a few hundred patches, over which second bounces are computed."""

from dataclasses import dataclass, replace

import numpy as np

from mmweaver.core.rotations import unit
from mmweaver.core.tensor_files import TensorRecord

VOXEL_M = 0.25  # patches within a voxel of this size are merged
GRAZING_COS = 0.02  # lower bound of the cosine at which a face is seen


@dataclass(frozen=True, kw_only=True)
class RoomPatches(TensorRecord):
    """Patches of rough surface that the radar sees, and pieces of edge, which scatter alike in all directions."""

    place_m: np.ndarray  # (patch, 3)
    normal: np.ndarray  # (patch, 3) unit, on the radar's side; zero for edges
    cross_section_m2: np.ndarray  # (patch,) from the radar's direction into that along the normal
    phase: np.ndarray  # (patch,) complex, of magnitude 1
    material: np.ndarray  # (patch,) index into the scene's material_names

    def __len__(self) -> int:
        return len(self.place_m)

    def cross_sections(self, direction: np.ndarray) -> np.ndarray:
        """Cross sections by Lambert's law.

        Args:
            direction: Unit vectors (..., patch, 3) of the scattered wave.

        Returns:
            Cross sections (..., patch) in m2.
        """
        cos = (direction * self.normal).sum(axis=-1)
        is_edge = ~self.normal.any(axis=-1)
        return self.cross_section_m2 * np.where(is_edge, 1.0, np.maximum(cos, 0.0))

    @classmethod
    def surfaces(
        cls, place_m: np.ndarray, normal: np.ndarray, monostatic_m2: np.ndarray, phase: np.ndarray, material: np.ndarray
    ) -> "RoomPatches":
        """Patches of rough surface.

        Args:
            place_m: Centres (patch, 3) in metres.
            normal: Unit normals (patch, 3), of either sign.
            monostatic_m2: Monostatic cross sections (patch,) in m2.
            phase: Unit phasors (patch,).
            material: Index (patch,) into the scene's material names.
        """
        cos = -(normal * unit(place_m)).sum(axis=1)
        upright = normal * np.where(cos < 0, -1.0, 1.0)[:, None]
        return cls(
            place_m=place_m,
            normal=upright,
            cross_section_m2=monostatic_m2 / np.maximum(np.abs(cos), GRAZING_COS),
            phase=phase,
            material=material,
        )

    @classmethod
    def edges(
        cls, place_m: np.ndarray, cross_section_m2: np.ndarray, phase: np.ndarray, material: np.ndarray
    ) -> "RoomPatches":
        """Pieces of edge.

        Args:
            place_m: Centres (patch, 3) in metres.
            cross_section_m2: Cross sections (patch,) in m2, the same in all directions.
            phase: Unit phasors (patch,).
            material: Index (patch,) into the scene's material names.
        """
        normal = np.zeros_like(place_m)
        return cls(place_m=place_m, normal=normal, cross_section_m2=cross_section_m2, phase=phase, material=material)

    def merged(self, rng: np.random.Generator) -> "RoomPatches":
        """One patch per voxel with the total cross section, at the place of one of them, sampled by cross section."""
        if not len(self):
            return self
        _, voxel = np.unique(np.floor(self.place_m / VOXEL_M).astype(np.int64), axis=0, return_inverse=True)
        voxel = voxel.ravel()
        # the largest u^(1/w) belongs to each with a probability proportional to its weight w
        key = np.log(rng.random(len(self))) / np.maximum(self.cross_section_m2, 1e-12)
        order = np.lexsort((key, voxel))
        last = np.flatnonzero(np.diff(voxel[order], append=-1))
        return replace(self[order[last]], cross_section_m2=np.bincount(voxel, self.cross_section_m2))


def roulette(power: np.ndarray, luck: np.ndarray, most: int) -> tuple[np.ndarray, np.ndarray]:
    """Russian roulette: keeps fewer than `most` of some powers without changing their mean.

    Each is kept with a probability proportional to its power; the strongest are always kept.

    Args:
        power: Powers (n,).
        luck: Uniform numbers (n,) in [0, 1) that decide, so that the same are kept from frame to frame.
        most: Maximum number kept.

    Returns:
        Indices of those kept, and the factor of power by which each is to be raised, at least 1.
    """
    least = power.sum() / most
    kept = np.flatnonzero(power > least * luck)
    return kept, np.maximum(1.0, least / power[kept])


def sampled_pairs(power: np.ndarray, luck: np.ndarray, most: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Fewer than `most` pairs by `roulette`.

    Args:
        power: Powers (first, second) of all pairs.
        luck: Uniform numbers in [0, 1) of the same size.
        most: Maximum number of pairs.

    Returns:
        Indices of first and second (pair,), and amplitudes (pair,) raised so that the mean power is that of all pairs.
    """
    pair, standing_for = roulette(power.ravel(), luck.ravel(), most)
    first, second = np.unravel_index(pair, power.shape)
    return first, second, np.sqrt(power.ravel()[pair] * standing_for)
