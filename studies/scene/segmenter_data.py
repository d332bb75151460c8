"""Training data of the built-in segmenter: procedural rooms as at inference, and their augmentation."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from jaxtyping import Float, Int

from mmweaver.core.atomic_files import atomic_file
from mmweaver.core.errors import InputError
from mmweaver.core.safe_files.safe_arrays import read_npz
from mmweaver.core.seeding import stream
from mmweaver.core.shapes import Array
from mmweaver.scene.photo.depth_grid import make_grid
from mmweaver.scene.procedural.lighting import LIGHTINGS
from mmweaver.scene.procedural.procedural_room import make_room
from mmweaver.scene.segmentation.builtin_segmenter import (
    COLOURS,
    HEIGHT,
    HEIGHT_UNIT_M,
    MEASURED,
    SLOPE,
    STRIDE,
    grid_features,
    group_of_classes,
)

_CROP = (48, 64)  # cells; a multiple of the downsampling factor of the network
_MOST_PIECES = 40


@dataclass(frozen=True, kw_only=True)
class SegmenterExample:
    """One room: input features of its cells, and their groups."""

    kind: str
    features: Float[Array, "13 row column"]
    groups: Int[Array, "row column"]


def make_example(kind: str, seed: int) -> SegmenterExample:
    """A procedural room as seen at inference. Raises InputError where the room cannot be arranged."""
    rng = stream(seed, "segmenter", kind)
    lighting = list(LIGHTINGS)[int(rng.integers(len(LIGHTINGS)))]
    photo = make_room(kind, int(rng.integers(1000)), seed).photo(lighting, noise=True)
    assert photo.classes is not None
    grid = make_grid(photo)
    assert grid.class_index is not None
    groups = group_of_classes(photo.classes.names)[grid.class_index[::STRIDE, ::STRIDE]]
    return SegmenterExample(kind=kind, features=grid_features(grid), groups=groups.astype(np.int64))


def make_examples(
    kinds: tuple[str, ...], per_kind: int, first_seed: int, folder: Path | None = None
) -> list[SegmenterExample]:
    """`per_kind` rooms of each kind; seeds that give no room are skipped. `folder` caches them."""
    found = []
    for kind in kinds:
        seed, own = first_seed, 0
        while own < per_kind and seed < first_seed + 3 * per_kind:
            try:
                found.append(_cached_example(kind, seed, folder))
                own += 1
            except InputError:
                pass
            seed += 1
    return found


def _cached_example(kind: str, seed: int, folder: Path | None) -> SegmenterExample:
    if folder is None:
        return make_example(kind, seed)
    path = folder / f"{kind}-{seed}.npz"
    if not path.exists():
        example = make_example(kind, seed)
        folder.mkdir(parents=True, exist_ok=True)
        with atomic_file(path) as temporary, temporary.open("wb") as file:
            np.savez(file, features=example.features.astype(np.float16), groups=example.groups.astype(np.uint8))
    held = read_npz(path)
    return SegmenterExample(
        kind=kind, features=held.numbers("features").astype(np.float32), groups=held.numbers("groups").astype(np.int64)
    )


def augmented(example: SegmenterExample, rng: np.random.Generator) -> tuple[np.ndarray, np.ndarray]:
    """Features (feature, row, column) and groups (row, column) of a random crop: reflected, recoloured, with holes
    and errors in depth."""
    features, groups = _crop(example, rng)
    measured = features[MEASURED] > 0
    features[COLOURS] = _recoloured(features[COLOURS], groups, rng)
    features[HEIGHT] += (rng.normal(0, 0.02) / HEIGHT_UNIT_M) * measured
    features[SLOPE] *= 1 - np.abs(rng.normal(0, rng.uniform(0, 0.15), groups.shape)).astype(np.float32)
    for hole in _holes(groups.shape, rng):
        features[HEIGHT:, *hole] = 0.0
    return features.astype(np.float32), groups


def _crop(example: SegmenterExample, rng: np.random.Generator) -> tuple[np.ndarray, np.ndarray]:
    rows, columns = example.groups.shape
    top, left = (int(rng.integers(max(size - crop, 0) + 1)) for size, crop in zip((rows, columns), _CROP, strict=True))
    part = (slice(top, top + _CROP[0]), slice(left, left + _CROP[1]))
    features, groups = example.features[:, *part].copy(), example.groups[part]
    if rng.random() < 0.5:
        features, groups = features[:, :, ::-1].copy(), groups[:, ::-1].copy()
    return features, groups


def _recoloured(colours: np.ndarray, groups: np.ndarray, rng: np.random.Generator) -> np.ndarray:
    """Random contrast and tint; often a random colour per object, a gradient of light, or no colour."""
    colours = colours * rng.uniform(0.5, 1.5) + rng.normal(0, 0.1, (3, 1, 1))
    if rng.random() < 0.7:
        from scipy import ndimage

        for group in np.unique(groups):
            labels, count = ndimage.label(groups == group)
            tints = rng.normal(0, rng.choice([0.1, 0.35]), (min(count, _MOST_PIECES) + 1, 3))
            tints[0] = 0.0
            colours = colours + np.moveaxis(tints[np.minimum(labels, len(tints) - 1)], -1, 0)
    if rng.random() < 0.4:
        slope = rng.normal(0, 0.4, 2)
        light = slope[0] * np.linspace(-1, 1, groups.shape[0])[:, None] + slope[1] * np.linspace(-1, 1, groups.shape[1])
        colours = colours + light
    if rng.random() < 0.25:
        colours = np.broadcast_to(colours.mean(axis=0), colours.shape).copy()
    if rng.random() < 0.25:
        colours = np.zeros_like(colours)
    return colours + rng.normal(0, 0.06, colours.shape)


def _holes(shape: tuple[int, ...], rng: np.random.Generator) -> list[tuple[slice, slice]]:
    found = []
    for _ in range(int(rng.integers(0, 5))):
        height, width = int(rng.integers(2, 14)), int(rng.integers(2, 14))
        row, column = int(rng.integers(shape[0])), int(rng.integers(shape[1]))
        found.append((slice(row, row + height), slice(column, column + width)))
    return found
