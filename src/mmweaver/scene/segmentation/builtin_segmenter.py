"""The built-in segmenter: a small U-Net from features of the depth grid to a class of each cell.

    13 channels per cell (about 80 x 60)                    class scores per cell
      see `segmenter_features`                                   |
         |                                                       |
        32 --/2-- 48 --/2-- 80 --/2-- 128 -x2-- 80 --x2-- 48 --x2-- 32
                   \\________________\\____________/______________/

It works offline and knows thirteen groups of COCO-Stuff's classes. It was trained on procedural rooms only, see
`studies.scene.segmenter_training` and model_cards/segmenter.md.
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
from mmweaver.scene.photo.depth_grid import make_grid
from mmweaver.scene.segmentation.segmenter_features import CHANNELS, STRIDE, grid_features

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
