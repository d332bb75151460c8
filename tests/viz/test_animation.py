"""The animation has a picture a frame, in real time, and its body moves."""

from pathlib import Path

import numpy as np
from PIL import Image, ImageSequence

from mmweaver.viz.animation import draw_animation
from mmweaver.viz.figure_data import FigureData


def frames_of(path: Path) -> list[np.ndarray]:
    with Image.open(path) as picture:
        return [np.asarray(frame.convert("RGB")).astype(int) for frame in ImageSequence.Iterator(picture)]


def test_one_picture_per_frame_in_real_time(view: FigureData, tmp_path: Path):
    draw_animation(view, tmp_path / "a.gif")
    with Image.open(tmp_path / "a.gif") as picture:
        assert picture.size == (900, 370)
        assert getattr(picture, "n_frames", 1) == 12
        assert picture.info["duration"] == 100
        assert picture.info["loop"] == 0


def test_the_body_and_the_maps_move(view: FigureData, tmp_path: Path):
    draw_animation(view, tmp_path / "a.gif")
    frames = frames_of(tmp_path / "a.gif")
    changed = np.abs(frames[-1] - frames[0]).max(axis=2) > 60
    for columns in (slice(0, 320), slice(370, 540), slice(560, 900)):
        assert changed[:, columns].sum() > 100, columns
    yellow = [frame[:, :320, 0] - frame[:, :320, 2] > 60 for frame in frames]
    heights = [np.ptp(np.argwhere(mask)[:, 0]) for mask in (yellow[0], yellow[-1])]
    assert heights[1] > heights[0] > 20  # nearer is taller
