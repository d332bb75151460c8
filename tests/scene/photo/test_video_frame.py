"""Frames of a video."""

from pathlib import Path

import numpy as np
import pytest

from mmweaver.core.errors import InputError
from mmweaver.scene.photo.video_frame import read_video_frame
from tests.captures import avi_of

RAMP = np.arange(64, dtype=np.uint8)[None, :, None]
PICTURES = [np.full((48, 64, 3), shade, np.uint8) + RAMP for shade in (10, 90, 50)]


@pytest.mark.parametrize(("codec", "tolerance"), [("png", 0), ("mjpeg", 6), ("mpeg4", 8)])
def test_frames_of_common_codecs(tmp_path: Path, codec: str, tolerance: int):
    """mpeg4 is what XVID writes: later frames are stored as differences."""
    path = tmp_path / "color.avi"
    path.write_bytes(avi_of(PICTURES, codec=codec))
    for index, picture in enumerate(PICTURES):
        found = read_video_frame(path, index)
        assert (found.shape, found.dtype) == ((48, 64, 3), np.uint8)
        np.testing.assert_allclose(found.astype(int), picture, atol=tolerance)
    for index in (3, -1):
        with pytest.raises(InputError, match="choose one from 0"):
            read_video_frame(path, index)


def test_other_files_are_refused(tmp_path: Path):
    path = tmp_path / "color.avi"
    with pytest.raises(InputError, match=r"cannot read .*color\.avi"):
        read_video_frame(path, 0)
    for content in (b"", b"RIFF1234WAVE", b"RIFF\xff\0\0\0AVI " + bytes(30), avi_of(PICTURES)[:200]):
        path.write_bytes(content)
        with pytest.raises(InputError, match=r"color\.avi"):
            read_video_frame(path, 0)


def test_a_damaged_frame_is_refused(tmp_path: Path):
    whole = avi_of(PICTURES, codec="mjpeg")
    start = whole.index(b"\xff\xd8")
    path = tmp_path / "color.avi"
    path.write_bytes(whole[:start] + bytes(300) + whole[start + 300 :])
    with pytest.raises(InputError, match=r"damaged or no video .*--rgb"):
        read_video_frame(path, 0)
