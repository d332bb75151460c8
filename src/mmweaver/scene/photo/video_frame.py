"""Reads one frame of a video, by PyAV (extra `capture`)."""

from pathlib import Path

from mmweaver.core.errors import InputError
from mmweaver.core.shapes import RgbPixels


def read_video_frame(path: Path, index: int) -> RgbPixels:
    """Frame `index` of a video as uint8 RGB (height, width, 3).

    The frames before it are decoded too, since most codecs store differences. Raises InputError where the file is not a
    video, is damaged, or has no such frame.
    """
    try:
        import av
        from av.error import FFmpegError
    except ImportError:
        raise InputError(
            f"{path} is a video; install the reader: pip install 'mmweaver[capture]', or give the picture with --rgb"
        ) from None
    if index < 0:
        raise InputError(f"{path} has no frame {index}; choose one from 0")
    count = 0
    try:
        with av.open(str(path)) as container:
            if not container.streams.video:
                raise InputError(f"{path} holds no video")
            # A damaged frame is an error; by default it would be filled from its neighbours.
            container.streams.video[0].codec_context.options = {"err_detect": "explode"}
            for frame in container.decode(video=0):
                if count == index:
                    return frame.to_ndarray(format="rgb24")
                count += 1
    except FileNotFoundError as error:
        raise InputError(f"cannot read {path}: {error.strerror}") from None
    except FFmpegError as error:
        raise InputError(
            f"cannot read frame {index} of {path}: {error.strerror or error}; is it a whole video? or give the picture"
            " with --rgb"
        ) from None
    raise InputError(f"{path} has {count} frames; choose one from 0 to {count - 1}")
