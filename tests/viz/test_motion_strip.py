from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from mmweaver.motion.empty_floor import act_out
from mmweaver.viz.motion_strip import draw_sheet, draw_strip


def test_a_strip_and_a_sheet_are_drawn(tmp_path: Path):
    pose = act_out("a person bows", duration_s=1.5).pose
    draw_strip(pose, tmp_path / "one.png", title="bowing", count=4)
    draw_sheet([("one", pose), ("two", pose), ("three", pose)], tmp_path / "all.png", columns=2, count=3)
    one, many = Image.open(tmp_path / "one.png"), Image.open(tmp_path / "all.png")
    assert one.size[1] < many.size[1]
    assert len(one.convert("RGB").getcolors(1 << 24) or []) > 10, "something is drawn"


@pytest.mark.parametrize("text", ["a person crawls", "a person does push-ups"])
def test_bodies_near_the_floor_are_whole_and_above_the_seconds(text: str, tmp_path: Path):
    draw_strip(act_out(text, duration_s=3.0).pose, tmp_path / "low.png")
    rgb = np.asarray(Image.open(tmp_path / "low.png").convert("RGB"), int)
    limbs = np.ptp(rgb, axis=2) > 60  # red and blue
    first_column, last_row = np.flatnonzero(limbs.any(axis=0))[0], np.flatnonzero(limbs.any(axis=1))[-1]
    assert limbs[:, first_column].sum() < 10, "the hand ends there and is not cut off"
    assert (rgb[last_row + 1 :].max(axis=2) < 170).any(axis=1).sum() >= 4, "the seconds stand below"
