"""Frames of an .avi."""

import shutil
from pathlib import Path

import numpy as np
import pytest

from mmweaver.core.errors import InputError
from mmweaver.scene.photo.avi_frames import avi_frame
from tests.captures import avi_of
from tests.platforms import posix_only

PICTURES = [np.full((48, 65, 3), shade, np.uint8) + np.arange(65, dtype=np.uint8)[None, :, None] for shade in (10, 90)]


@pytest.mark.parametrize("codec", [b"MJPG", b"\0\0\0\0"])
def test_motion_jpeg_and_uncompressed(tmp_path: Path, codec: bytes):
    path = tmp_path / "color.avi"
    path.write_bytes(avi_of(PICTURES, codec=codec))
    for index, picture in enumerate(PICTURES):
        np.testing.assert_allclose(avi_frame(path, index).astype(int), picture, atol=4 if codec == b"MJPG" else 0)
    with pytest.raises(InputError, match="0 to 1"):
        avi_frame(path, 2)


def test_other_files_are_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    path = tmp_path / "color.avi"
    with pytest.raises(InputError, match="cannot read"):
        avi_frame(path, 0)
    for content, message in (
        (b"", "empty"),
        (b"RIFF1234WAVE", "not an .avi"),
        (b"RIFF\xff\0\0\0AVI " + bytes(30), "no video"),
    ):
        path.write_bytes(content)
        with pytest.raises(InputError, match=message):
            avi_frame(path, 0)
    whole = avi_of(PICTURES)
    at = whole.index(b"\xff\xd8")
    path.write_bytes(whole[:at] + bytes(300) + whole[at + 300 :])
    with pytest.raises(InputError, match="frame 0 is damaged"):
        avi_frame(path, 0)
    path.write_bytes(avi_of(PICTURES, codec=b"XVID"))
    monkeypatch.setattr(shutil, "which", lambda name: None)
    with pytest.raises(InputError, match="XVID, which needs ffmpeg"):
        avi_frame(path, 0)


@posix_only
def test_other_codecs_go_through_ffmpeg(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    """A fake ffmpeg that is asked for the right frame, and one that fails."""
    from PIL import Image

    Image.fromarray(PICTURES[1]).save(tmp_path / "frame.png")
    stand_in = tmp_path / "ffmpeg"
    stand_in.write_text(
        f"#!/bin/sh\ncase \"$*\" in *'eq(n\\,1)'*) cat {tmp_path}/frame.png;; *) echo bad >&2; exit 1;; esac\n"
    )
    stand_in.chmod(0o755)
    monkeypatch.setattr(shutil, "which", lambda name: str(stand_in))
    path = tmp_path / "color.avi"
    path.write_bytes(avi_of(PICTURES, codec=b"XVID"))
    assert np.array_equal(avi_frame(path, 1), PICTURES[1])
    with pytest.raises(InputError, match=r"frame 0 \(bad\)"):
        avi_frame(path, 0)
