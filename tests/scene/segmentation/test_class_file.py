"""Pictures of class numbers."""

import json
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from mmweaver.core.errors import InputError
from mmweaver.scene.segmentation.class_file import read_class_file


@pytest.fixture
def path(tmp_path: Path) -> Path:
    """COCO-Stuff's pixel map: couch (63) on the left, unlabelled on the right."""
    numbers = np.full((48, 64), 62, np.uint8)
    numbers[:, 32:] = 255
    Image.fromarray(numbers).save(tmp_path / "classes.png")
    return tmp_path / "classes.png"


def test_coco_stuffs_own_numbers(path: Path):
    mask = read_class_file(path, 64, 48)
    assert mask.names[mask.index[5, 5]] == "couch"
    assert mask.names[mask.index[5, 50]] == "unlabeled"


def test_another_size_of_the_same_view(path: Path):
    mask = read_class_file(path, 128, 96)
    assert mask.index.shape == (96, 128)
    assert set(np.unique(mask.index).tolist()) == {0, 63}
    with pytest.raises(InputError, match=r"64 x 48.*64 x 64"):
        read_class_file(path, 64, 64)


def test_own_numbers_are_defined_by_a_json(path: Path):
    Image.fromarray(np.full((48, 64), 3, np.uint8)).save(path)
    path.with_suffix(".json").write_text(json.dumps({"3": "windowpane, window", "4": "wall-brick"}))
    mask = read_class_file(path, 64, 48)
    assert (mask.index == mask.names.index("window-other")).all()
