"""Frames of a video."""

from pathlib import Path

import numpy as np
import pytest

from mmweaver.core.errors import InputError
from mmweaver.scene.photo.picture_files import read_video_frame
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
    with pytest.raises(InputError, match=r"read .*color\.avi"):
        read_video_frame(path, 0)
    for content in (b"", b"RIFF1234WAVE", b"RIFF\xff\0\0\0AVI " + bytes(30), avi_of(PICTURES)[:200]):
        path.write_bytes(content)
        with pytest.raises(InputError, match=r"color\.avi"):
            read_video_frame(path, 0)


PLAYLISTS = {
    "hls": "#EXTM3U\n#EXT-X-VERSION:3\n#EXT-X-TARGETDURATION:1\n#EXTINF:1.0,\n{other}\n#EXT-X-ENDLIST\n",
    "concat": "ffconcat version 1.0\nfile '{other}'\n",
    "dash": '<MPD xmlns="urn:mpeg:dash:schema:mpd:2011" type="static"><Period><AdaptationSet><Representation id="0">'
            "<BaseURL>{other}</BaseURL></Representation></AdaptationSet></Period></MPD>",
}  # fmt: skip


@pytest.mark.parametrize("suffix", [".avi", ".mp4", ".mov"])
@pytest.mark.parametrize("kind", PLAYLISTS)
def test_a_playlist_is_refused_whatever_it_is_called(tmp_path: Path, kind: str, suffix: str):
    """It would make the reader open another file, or ask another host."""
    (tmp_path / "other.avi").write_bytes(avi_of(PICTURES))
    path = tmp_path / f"color{suffix}"
    for other in ("other.avi", str(tmp_path / "other.avi"), "http://127.0.0.1:9/other.ts"):
        path.write_text(PLAYLISTS[kind].format(other=other))
        with pytest.raises(InputError, match="no video"):
            read_video_frame(path, 0)


@pytest.mark.parametrize("container", ["matroska", "gif", "mpegts", "flv"])
def test_no_other_demultiplexer_can_be_reached(tmp_path: Path, container: str):
    """Only AVI, and MP4 by its ending (docs/security.md); what a file holds chooses no other."""
    av = pytest.importorskip("av")
    codec, pixels = {"gif": ("gif", "rgb8"), "mpegts": ("mpeg2video", "yuv420p"), "flv": ("flv", "yuv420p")}.get(
        container, ("mpeg4", "yuv420p")
    )
    made = tmp_path / "made"
    with av.open(str(made), "w", format=container) as file:
        stream = file.add_stream(codec, rate=25)
        stream.width, stream.height, stream.pix_fmt = 64, 48, pixels
        for picture in PICTURES:
            file.mux(stream.encode(av.VideoFrame.from_ndarray(picture, format="rgb24").reformat(format=pixels)))
        file.mux(stream.encode())
    for suffix in (".avi", ".mp4", ".mkv", ".gif"):
        path = tmp_path / f"color{suffix}"
        path.write_bytes(made.read_bytes())
        with pytest.raises(InputError, match="no video"):
            read_video_frame(path, 0)
