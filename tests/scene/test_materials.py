"""Material guesses: the names are those of the standard, and nothing daring is guessed."""

import numpy as np
import pytest

from mmweaver.scene.materials import MATERIAL_NAMES, floor_material


@pytest.mark.parametrize(
    ("colour", "name"),
    [
        ((0.62, 0.42, 0.24), "floorboard"),
        ((0.45, 0.45, 0.46), "concrete"),
        ((0.2, 0.3, 0.6), "concrete"),
        ((0.72, 0.68, 0.62), "concrete"),
    ],
)
def test_floor_by_colour(colour: tuple[float, ...], name: str):
    assert floor_material(np.tile(colour, (50, 1))) == name


def test_names():
    assert MATERIAL_NAMES == (
        "concrete", "brick", "plasterboard", "wood", "glass", "ceiling_board", "chipboard", "plywood", "marble",
        "floorboard", "metal", "fabric",
    )  # fmt: skip
