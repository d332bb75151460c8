"""The rough surfaces of a room in a few hundred patches: what second bounces are computed over."""

from dataclasses import dataclass, replace

import numpy as np

from mmweaver.core.rotations import unit
from mmweaver.core.tensor_record import TensorRecord

VOXEL_M = 0.25  # patches within a cube of this size are one
GRAZING_COS = 0.02  # a face seen under less is taken as seen under so much


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
        """Cross sections (..., patch) into unit directions (..., patch, 3), by Lambert's law."""
        cos = (direction * self.normal).sum(axis=-1)
        is_edge = ~self.normal.any(axis=-1)
        return self.cross_section_m2 * np.where(is_edge, 1.0, np.maximum(cos, 0.0))

    @classmethod
    def surfaces(
        cls, place_m: np.ndarray, normal: np.ndarray, monostatic_m2: np.ndarray, phase: np.ndarray, material: np.ndarray
    ) -> "RoomPatches":
        """Of patches (patch,) with their cross sections straight back; normals of either sign."""
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
        """Of pieces of edge (patch,)."""
        normal = np.zeros_like(place_m)
        return cls(place_m=place_m, normal=normal, cross_section_m2=cross_section_m2, phase=phase, material=material)

    def merged(self, rng: np.random.Generator) -> "RoomPatches":
        """One patch per voxel, with the cross section of all in it, at a place sampled among them by cross section."""
        if not len(self):
            return self
        _, voxel = np.unique(np.floor(self.place_m / VOXEL_M).astype(np.int64), axis=0, return_inverse=True)
        voxel = voxel.ravel()
        # the largest of u^(1/w) is each with a probability as its weight w
        key = np.log(rng.random(len(self))) / np.maximum(self.cross_section_m2, 1e-12)
        order = np.lexsort((key, voxel))
        last = np.flatnonzero(np.diff(voxel[order], append=-1))
        return replace(self[order[last]], cross_section_m2=np.bincount(voxel, self.cross_section_m2))


def roulette(power: np.ndarray, luck: np.ndarray, most: int) -> tuple[np.ndarray, np.ndarray]:
    """Fewer than `most` of some powers, chosen so that the mean power stays.

    Each is kept with a probability as its power, the strong ones always.

    Args:
        power: (n,).
        luck: (n,) uniform in [0, 1), which decides, so that the same are kept from frame to frame.
        most: limit.

    Returns:
        Indices of those kept, and how much power of its kind each stands for, 1 or more.
    """
    least = power.sum() / most
    kept = np.flatnonzero(power > least * luck)
    return kept, np.maximum(1.0, least / power[kept])


def sampled_pairs(power: np.ndarray, luck: np.ndarray, most: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Fewer than `most` pairs of powers (first, second) by `roulette`.

    Returns:
        Indices of first and second (pair,), and the amplitude (pair,) of all that each stands for.
    """
    pair, standing_for = roulette(power.ravel(), luck.ravel(), most)
    first, second = np.unravel_index(pair, power.shape)
    return first, second, np.sqrt(power.ravel()[pair] * standing_for)
