from dataclasses import replace
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


def test_nothing_is_cut_off(tmp_path: Path):
    draw_strip(act_out("a person falls").pose, tmp_path / "fall.png", title="a person falls")
    grey = np.asarray(Image.open(tmp_path / "fall.png").convert("L"))
    assert min(edge.min() for edge in (grey[0], grey[-1], grey[:, 0], grey[:, -1])) == 255


@pytest.mark.parametrize("text", ["a person crawls", "a person does push-ups"])
def test_bodies_near_the_floor_are_whole_and_above_the_seconds(text: str, tmp_path: Path):
    draw_strip(act_out(text, duration_s=3.0).pose, tmp_path / "low.png")
    rgb = np.asarray(Image.open(tmp_path / "low.png").convert("RGB"), int)
    limbs = np.ptp(rgb, axis=2) > 60  # red and blue
    first_column, last_row = np.flatnonzero(limbs.any(axis=0))[0], np.flatnonzero(limbs.any(axis=1))[-1]
    assert limbs[:, first_column].sum() < 10, "the hand ends there and is not cut off"
    assert (rgb[last_row + 1 :].max(axis=2) < 170).any(axis=1).sum() >= 4, "the seconds stand below"


def test_a_strip_is_the_same_wherever_the_body_faces(tmp_path: Path):
    pose = act_out("a person bows", duration_s=1.5).pose
    cos, sin = np.cos(2.0), np.sin(2.0)
    turn = np.array([[cos, -sin, 0.0], [sin, cos, 0.0], [0.0, 0.0, 1.0]])
    turned = replace(pose, joints_m=pose.joints_m @ turn.T)
    pictures = []
    for name, shown in (("one.png", pose), ("turned.png", turned)):
        draw_strip(shown, tmp_path / name, count=2)
        pictures.append(np.asarray(Image.open(tmp_path / name).convert("L"), float))
    assert pictures[0].shape == pictures[1].shape
    assert np.abs(pictures[0] - pictures[1]).mean() < 1.0
