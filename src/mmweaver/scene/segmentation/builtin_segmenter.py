"""The built-in segmenter: a small U-Net from features of the depth grid to a class of each cell.

    13 channels per cell (about 80 x 60)                    class scores per cell
      see `segmenter_features`                                   |
         |                                                       |
        32 --/2-- 48 --/2-- 80 --/2-- 128 -x2-- 80 --x2-- 48 --x2-- 32
                   \\________________\\____________/______________/

It works offline and knows thirteen groups of COCO-Stuff's classes. It was trained on procedural rooms only, see
`studies.scene.segmenter_training` and model_cards/segmenter.md.

Input features of the built-in segmenter: mostly geometry, which is similar in rendered and in real rooms.
"""

from pathlib import Path
from typing import Any

import numpy as np
from jaxtyping import Float, Int

from mmweaver.core.records import ClassMask, RgbdPhoto
from mmweaver.core.safe_files.regular_files import foreign_errors
from mmweaver.core.safe_files.safe_tensors import read_tensors
from mmweaver.core.shapes import Array
from mmweaver.scene.coco_stuff import NAMES, SEGMENTER_GROUPS
from mmweaver.scene.layout.gravity import AlignedRoom, align_room
from mmweaver.scene.layout.height_map import CELL_M
from mmweaver.scene.photo.depth_grid import DepthGrid, GridFloat, make_grid

# Standardised colour (3), height, slope (up . normal), 1 / depth, whether measured, proximity to a wall, membership of
# a wall, a vertical panel, a horizontal top, a ceiling, and the height of what is above the same floor square.
CHANNELS = 13
COLOURS, MEASURED, HEIGHT, SLOPE = slice(0, 3), 6, 3, 4
HEIGHT_UNIT_M = 2.5
STRIDE = 2  # of the depth grid's rows and columns
_NEAR_WALL_M, _ABOVE_M, _WIDTH_M = 1.0, 1.5, 0.15
_KINDS = ("wall", "panel", "top", "ceiling")

Features = Float[Array, "13 row column"]


def grid_features(grid: DepthGrid) -> Features:
    """Features of every second row and column of a depth grid.

    Args:
        grid: Depth grid of a photo.

    Returns:
        The 13 channels, float32, (13, row, column); 0 where nothing was measured.

    Raises:
        InputError: If the depth shows no surfaces.
    """
    return room_features(grid, align_room(grid))


def room_features(grid: DepthGrid, room: AlignedRoom) -> Features:
    """Features of a grid that is already aligned.

    Args:
        grid: Depth grid of a photo.
        room: Result of `gravity.align_room` for this grid.

    Returns:
        The 13 channels, float32, (13, row, column).
    """
    aligned = room.grid
    height = aligned.points_m[..., 2] - aligned.floor_z_m
    geometry = [
        height / HEIGHT_UNIT_M,
        aligned.normals[..., 2],
        1 / grid.depth_m,
        np.isfinite(grid.depth_m).astype(float),
        _wall_proximity(room),
    ]
    for kind in _KINDS:
        cells = [surface.cells for surface in room.surfaces if surface.plane.kind == kind]
        geometry.append(np.any(cells, axis=0).astype(float) if cells else np.zeros(height.shape))
    geometry.append(_height_above(aligned.points_m[..., 0], aligned.points_m[..., 1], height))
    stacked = np.concatenate([_standardised(grid.rgb), np.stack(geometry)])
    return np.nan_to_num(stacked[:, ::STRIDE, ::STRIDE]).astype(np.float32)


def _standardised(rgb: Float[Array, "row column 3"]) -> Float[Array, "3 row column"]:
    """Colours normalized for exposure and white balance: minus their mean, over the brightness' standard deviation."""
    spread = max(float(rgb.mean(axis=2).std()), 0.05)
    return np.moveaxis((rgb - rgb.mean(axis=(0, 1))) / spread, -1, 0) / 3


def _wall_proximity(room: AlignedRoom) -> GridFloat:
    """Proximity to a wall: 1 on or behind it, 0 from a metre in front of it; 0 beyond its ends."""
    near = np.zeros(room.grid.depth_m.shape)
    for surface in room.surfaces:
        if surface.plane.kind != "wall":
            continue
        offset = room.grid.points_m - surface.plane.centre_m
        inside = np.abs(offset @ surface.plane.axis_u) < surface.plane.half_size_m[0] + 0.3
        share = 1 - np.clip(np.nan_to_num(offset @ surface.plane.normal, nan=9.0) / _NEAR_WALL_M, 0, 1)
        near = np.maximum(near, np.where(inside, share, 0.0))
    return near


def _height_above(x: GridFloat, y: GridFloat, height: GridFloat) -> GridFloat:
    """Height of the highest point over the same place, above the cell, 0 to 1 in units of 1.5 m."""
    from scipy import ndimage

    known = np.isfinite(height)
    column = np.floor(np.where(known, x, 0) / CELL_M).astype(int)
    row = np.floor(np.where(known, y, 0) / CELL_M).astype(int)
    column, row = column - column[known].min(initial=0), row - row[known].min(initial=0)
    shape = (min(int(row[known].max(initial=0)) + 1, 400), min(int(column[known].max(initial=0)) + 1, 400))
    known &= (row >= 0) & (row < shape[0]) & (column >= 0) & (column < shape[1])
    top = np.full(shape, -1.0)
    np.maximum.at(top, (row[known], column[known]), np.minimum(height[known], 2.0))
    top = ndimage.maximum_filter(top, size=round(_WIDTH_M / CELL_M))
    there = top[np.where(known, row, 0), np.where(known, column, 0)]
    return np.where(known, np.clip((there - height) / _ABOVE_M, 0, 1), 0.0)


WEIGHTS = Path(__file__).parents[2] / "weights" / "segmenter.safetensors"
WIDTHS = (32, 48, 80, 128)
GROUP_NAMES = tuple(group[0] for group in SEGMENTER_GROUPS)


def group_of_classes(names: tuple[str, ...]) -> Int[Array, " name"]:
    """Index into SEGMENTER_GROUPS of each class name, (name,); 0 for a class in no group."""
    group = {name: index for index, members in enumerate(SEGMENTER_GROUPS) for name in members}
    return np.array([group.get(name, 0) for name in names])


def make_network() -> Any:
    """The network with random weights: (batch, 13, row, column) features to (batch, group, row, column) scores."""
    import torch
    from torch import nn

    def block(inside: int, outside: int, stride: int = 1) -> nn.Module:
        return nn.Sequential(
            nn.Conv2d(inside, outside, 3, stride, 1, bias=False),
            nn.BatchNorm2d(outside),
            nn.ReLU(),
            nn.Conv2d(outside, outside, 3, 1, 1, bias=False),
            nn.BatchNorm2d(outside),
            nn.ReLU(),
        )

    class Network(nn.Module):
        def __init__(self) -> None:
            super().__init__()
            a, b, c, d = WIDTHS
            self.stem = block(CHANNELS, a)
            self.down = nn.ModuleList([block(a, b, 2), block(b, c, 2), block(c, d, 2)])
            self.up = nn.ModuleList([block(d + c, c), block(c + b, b), block(b + a, a)])
            self.head = nn.Conv2d(a, len(SEGMENTER_GROUPS), 1)

        def forward(self, cells: torch.Tensor) -> torch.Tensor:
            levels = [self.stem(cells)]
            for step in self.down:
                levels.append(step(levels[-1]))
            out = levels.pop()
            for step in self.up:
                skip = levels.pop()
                out = nn.functional.interpolate(out, size=skip.shape[-2:], mode="bilinear", align_corners=False)
                out = step(torch.cat([out, skip], dim=1))
            return self.head(out)

    return Network()


def load_network(path: Path = WEIGHTS) -> Any:
    """Loads the trained network in evaluation mode.

    Args:
        path: Weights, by default the bundled ones.

    Raises:
        InputError: If the file is missing or holds other tensors.
    """
    network = make_network()
    tensors, _ = read_tensors(path)
    with foreign_errors(path, "no file of weights of the built-in segmenter ({reason}); reinstall mmweaver"):
        network.load_state_dict({name: value.float() for name, value in tensors.items()}, strict=False)
    return network.eval()


def groups_of_cells(features: Float[Array, "13 row column"], network: Any) -> Int[Array, "row column"]:
    """The most likely group of each cell.

    Args:
        features: Result of `segmenter_features.grid_features`, (13, row, column).
        network: Result of `load_network`.

    Returns:
        Index into SEGMENTER_GROUPS, (row, column).
    """
    import torch

    with torch.inference_mode():
        return network(torch.from_numpy(features)[None])[0].argmax(dim=0).numpy()


def segment_builtin(photo: RgbdPhoto) -> ClassMask:
    """Segments a photo by the built-in network; needs no network access.

    Args:
        photo: Photo with depth.

    Returns:
        Class mask of the photo's size, in groups of COCO-Stuff classes.
    """
    grid = make_grid(photo)
    groups = groups_of_cells(grid_features(grid), load_network())
    size = STRIDE * (photo.intrinsics.width // grid.intrinsics.width)  # pixels of a cell
    class_of_group = np.array([NAMES.index(name) for name in GROUP_NAMES], np.uint8)
    cells = np.repeat(np.repeat(class_of_group[groups], size, axis=0), size, axis=1)
    height, width = photo.intrinsics.height, photo.intrinsics.width
    index = np.pad(cells, ((0, max(0, height - len(cells))), (0, max(0, width - cells.shape[1]))))[:height, :width]
    return ClassMask(index=index, names=NAMES)
