"""Results as MP4 and WebM: the animation of the result folder, or of the maps if it has none."""

from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np

from mmweaver.core.optional_packages import need
from mmweaver.core.safe_files.safe_pictures import read_animation
from mmweaver.datasets.formats import export_format
from mmweaver.io.stored_result import StoredResult
from mmweaver.viz.animation import render_pictures
from mmweaver.viz.figure_data import FigureData

CODECS = {"mp4": ("libx264", {"crf": "23", "preset": "medium"}), "webm": ("libvpx-vp9", {"crf": "33", "b:v": "0"})}


@export_format("mp4", "video, H.264", ending=".mp4")
def write_mp4(result: StoredResult, out: Path) -> str:
    """Writes `result.mp4` (H.264). Raises InputError if PyAV is not installed."""
    return write_video(result, out / "result.mp4")


@export_format("webm", "video, VP9", ending=".webm")
def write_webm(result: StoredResult, out: Path) -> str:
    """Writes `result.webm` (VP9). Raises InputError if PyAV is not installed."""
    return write_video(result, out / "result.webm")


def write_video(result: StoredResult, file: Path) -> str:
    """Encodes the pictures of preview.gif in real time.

    Args:
        result: The result.
        file: Output file, .mp4 or .webm.

    Returns:
        Description of what was written.

    Raises:
        InputError: If PyAV is not installed.
    """
    need("export", "a video", "av")
    import av

    pictures = _pictures(result)
    period_s = result.cube.config.frame_period_s
    rate = Fraction(len(pictures), 1) / Fraction(len(result.cube.grid.frame_time_s) * period_s).limit_denominator(1000)
    codec, options = CODECS[file.suffix[1:]]
    height, width = (size // 2 * 2 for size in pictures[0].shape[:2])  # 4:2:0 needs even sizes
    with av.open(str(file), "w") as container:
        stream: Any = container.add_stream(codec, rate=rate.limit_denominator(1000), options=options)
        stream.width, stream.height, stream.pix_fmt = width, height, "yuv420p"
        for picture in pictures:
            frame = av.VideoFrame.from_ndarray(np.ascontiguousarray(picture[:height, :width]), format="rgb24")
            container.mux(stream.encode(frame))
        container.mux(stream.encode())
    return f"a video of {len(pictures)} pictures"


def _pictures(result: StoredResult) -> list[np.ndarray]:
    """Pictures of the animation, (height, width, 3) uint8 each."""
    animation = result.folder / "preview.gif"
    if animation.is_file():
        return read_animation(animation)
    view = FigureData(title=result.title, cube=result.cube, points=result.points, poses=result.poses)
    return render_pictures(view)
