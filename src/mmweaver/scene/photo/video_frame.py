"""Reads one frame of a video by PyAV (extras `capture` and `phone`)."""

from pathlib import Path

from mmweaver.core.errors import InputError
from mmweaver.core.optional_packages import need
from mmweaver.core.safe_files.regular_files import foreign_errors, open_regular
from mmweaver.core.safe_files.safe_pictures import MAX_PIXELS
from mmweaver.core.shapes import RgbPixels

NO_VIDEO = "damaged or no video ({reason}); is it whole? or give the picture with --rgb"


def read_video_frame(path: Path, index: int, extra: str = "capture") -> RgbPixels:
    """Decodes one frame of a video; the frames before it are decoded too, since most codecs store differences.

    Args:
        path: Video, by its suffix MP4/MOV or AVI.
        index: Number of the frame, from 0.
        extra: Extra to suggest if PyAV is missing.

    Returns:
        The frame, uint8 RGB, (height, width, 3).

    Raises:
        InputError: If PyAV is missing, or the file is not a video, is damaged, or has no such frame.
    """
    need(extra, f"{path} is a video, which", "av")
    import av

    kind = "mov" if path.suffix.lower() in (".mp4", ".mov", ".m4v") else "avi"
    if index < 0:
        raise InputError(f"{path} has no frame {index}; choose one from 0")
    count = 0
    # One fixed format on the opened file: playlists, which name other files and hosts, are not followed.
    with (
        open_regular(path) as file,
        foreign_errors(path, NO_VIDEO),
        av.open(file, "r", format=kind) as container,
    ):
        if not container.streams.video:
            raise InputError(f"{path} holds no video")
        # A damaged frame is an error; by default it would be filled from its neighbours.
        container.streams.video[0].codec_context.options = {"err_detect": "explode"}
        for frame in container.decode(video=0):
            if count == index:
                if frame.width * frame.height > MAX_PIXELS:
                    raise InputError(f"{path} has frames of {frame.width} x {frame.height} pixels; give a smaller one")
                return frame.to_ndarray(format="rgb24")
            count += 1
    raise InputError(f"{path} has {count} frames; choose one from 0 to {count - 1}")
