"""The picture of recorded beside simulated clouds."""

import json
from pathlib import Path

from PIL import Image

from studies.physics.mars import Clouds, Setup
from studies.physics.mars_data import read_mars
from studies.physics.mars_pictures import draw, setup_of
from studies.physics.mars_pieces import cut
from tests.studies.physics.test_mars_data import write_split


def test_a_picture_is_drawn(tmp_path: Path):
    write_split(tmp_path, "validate", list(range(20)), moving=0.1)
    pieces = cut(read_mars(tmp_path, "validate"), 10, 2)
    real: Clouds = [piece.clouds for piece in pieces]
    draw(pieces, real, real, Setup(), tmp_path / "mars.png")
    with Image.open(tmp_path / "mars.png") as picture:
        assert picture.size[0] > picture.size[1] > 300


def test_settings_come_from_the_result(tmp_path: Path):
    held = {"shift_m": [0.1, 0.2, 0.3], "gain_db": -3.0, "threshold": 800, "height_m": 1.7}
    (tmp_path / "a.json").write_text(json.dumps({"config": {"estimated_on_validate": held}}))
    assert setup_of(tmp_path / "a.json") == Setup(shift_m=(0.1, 0.2, 0.3), gain_db=-3.0, threshold=800, height_m=1.7)
