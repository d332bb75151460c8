"""Reads one picture of an .avi: motion JPEG, PNG and uncompressed directly, other codecs through ffmpeg.

Reference: Microsoft, "AVI RIFF File Reference".
"""

import io
import shutil
import struct
import subprocess
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from mmweaver.core.errors import InputError
from mmweaver.core.shapes import RgbPixels

PICTURE_CODECS = {b"MJPG", b"mjpg", b"MPNG", b"png ", b"PNG "}
FFMPEG_TIMEOUT_S = 120.0


@dataclass(frozen=True)
class _Video:
    codec: bytes
    width: int
    height: int
    chunks: list[tuple[int, int]]  # first byte and length of each frame


def avi_frame(path: Path, index: int) -> RgbPixels:
    """Frame `index` of an .avi as uint8 RGB (height, width, 3).

    Raises InputError where the file is not an .avi, has no such frame, or needs an ffmpeg that is not installed.
    """
    try:
        data = path.read_bytes()
    except OSError as error:
        raise InputError(f"cannot read {path}: {error.strerror or error}") from None
    if data[:4] != b"RIFF" or data[8:12] != b"AVI ":
        raise InputError(f"{path} is not an .avi file{' (it is empty)' if not data else ''}")
    video = _video(path, data)
    if not 0 <= index < len(video.chunks):
        raise InputError(f"{path} has {len(video.chunks)} frames; choose one from 0 to {len(video.chunks) - 1}")
    first, length = video.chunks[index]
    if video.codec in PICTURE_CODECS:
        return _decoded(path, data[first : first + length], index)
    if video.codec in (b"\0\0\0\0", b"DIB ") and length >= 3 * video.width * video.height:
        return _uncompressed(data[first : first + length], video)
    return _through_ffmpeg(path, video.codec, index)


def _video(path: Path, data: bytes) -> _Video:
    """Codec, size and frame positions of the first video stream."""
    codec, width, height, chunks = b"", 0, 0, []
    stream, video_stream = -1, -1
    for name, first, length in _chunks(data, 0, len(data)):
        if name == b"strh":
            stream += 1
            if data[first : first + 4] == b"vids" and video_stream < 0:
                video_stream = stream
        elif name == b"strf" and stream == video_stream and not width and length >= 20:
            width, height = struct.unpack_from("<ii", data, first + 4)
            codec = data[first + 16 : first + 20]
        elif video_stream >= 0 and name in (b"%02ddc" % video_stream, b"%02ddb" % video_stream) and length:
            chunks.append((first, length))
    if not width or not chunks:
        raise InputError(f"{path} holds no video, or it is damaged")
    return _Video(codec, width, abs(height), chunks)


def _chunks(data: bytes, position: int, end: int) -> Iterator[tuple[bytes, int, int]]:
    """Every chunk, depth first: name, first byte, length. A truncated chunk ends the iteration."""
    while position + 8 <= end:
        name, length = data[position : position + 4], int.from_bytes(data[position + 4 : position + 8], "little")
        if name in (b"RIFF", b"LIST"):
            yield from _chunks(data, position + 12, min(position + 8 + length, end))
        elif position + 8 + length <= end:
            yield name, position + 8, length
        else:
            return
        position += 8 + length + length % 2


def _decoded(path: Path, content: bytes, index: int) -> RgbPixels:
    from PIL import Image

    try:
        return np.array(Image.open(io.BytesIO(content)).convert("RGB"))
    except (OSError, ValueError, SyntaxError):
        raise InputError(f"{path}: frame {index} is damaged; choose another") from None


def _uncompressed(content: bytes, video: _Video) -> RgbPixels:
    """BGR pixels, stored from the lowest row up in rows padded to four bytes."""
    row = -(-3 * video.width // 4) * 4
    rows = np.frombuffer(content, np.uint8, row * video.height).reshape(video.height, row)
    return rows[::-1, : 3 * video.width].reshape(video.height, video.width, 3)[:, :, ::-1].copy()


def _through_ffmpeg(path: Path, codec: bytes, index: int) -> RgbPixels:
    name = codec.decode("ascii", "replace").strip("\0 ")
    ffmpeg = shutil.which("ffmpeg")
    if ffmpeg is None:
        raise InputError(
            f"{path} is encoded as {name}, which needs ffmpeg: install it, or save the picture yourself and give it"
            " with --rgb"
        )
    command = [
        ffmpeg, "-v", "error", "-i", str(path), "-vf", f"select=eq(n\\,{index})", "-frames:v", "1", "-f", "image2pipe",
        "-c:v", "png", "-",
    ]  # fmt: skip
    try:
        done = subprocess.run(command, capture_output=True, timeout=FFMPEG_TIMEOUT_S, stdin=subprocess.DEVNULL)
    except (OSError, subprocess.TimeoutExpired) as error:
        raise InputError(f"{path}: ffmpeg failed ({error}); save the picture and give it with --rgb") from None
    if done.returncode or not done.stdout:
        reason = done.stderr.decode(errors="replace").strip().splitlines()[-1:] or ["no picture came out"]
        raise InputError(f"{path}: ffmpeg cannot read frame {index} ({reason[0]}); give the picture with --rgb")
    return _decoded(path, done.stdout, index)
