from dataclasses import replace

import numpy as np
from PIL import Image

from studies.fields.field_pictures import draw_fields
from tests.cubes import point_cube


def test_a_picture_shows_what_is_there(tmp_path):
    truth = point_cube()
    empty = replace(truth, values=np.zeros_like(truth.values))
    draw_fields(tmp_path / "empty.png", truth, {"empty": empty}, 1)
    draw_fields(tmp_path / "same.png", truth, {"empty": truth}, 1)
    one, other = (np.asarray(Image.open(tmp_path / name).convert("RGB")) for name in ("empty.png", "same.png"))
    assert one.shape == other.shape
    assert min(one.shape[:2]) > 300
    assert (one != other).any(axis=2).mean() > 0.01
