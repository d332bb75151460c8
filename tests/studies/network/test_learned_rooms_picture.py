"""Both methods side by side."""

from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from mmweaver.scene.photo_files import SAMPLE_FOLDER
from studies.network.learned_rooms_picture import METHODS, draw_rooms, views_of


@pytest.mark.slow  # a picture of a study
def test_the_same_motion_by_both_methods(tmp_path: Path):
    views = views_of(SAMPLE_FOLDER, frames=16)
    first, second = (views[name] for name in METHODS)
    assert np.array_equal(first.poses[0].joints_m, second.poses[0].joints_m)
    assert not np.array_equal(first.cube.values, second.cube.values)
    path = tmp_path / "rooms.png"
    draw_rooms(path, [views])
    assert Image.open(path).width > 1000
