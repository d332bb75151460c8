"""Recordings of any length, read in pieces if the file format permits."""

from functools import cached_property
from pathlib import Path
from typing import Any

from mmweaver.core.records import RadarCube
from mmweaver.core.safe_files.safe_arrays import read_npy
from mmweaver.io.capture_std import is_capture
from mmweaver.io.stream_folder import is_stream, num_frames_of_stream
from mmweaver.recordings.read_recording import Recording, read_recording


class RecordingPieces:
    """Frames of a recording, read on demand.

    An adc_data.bin, DCA1000 packets, a .npy with "frame" as its first axis and a folder of `generate --stream` are read
    in part; a radar.npz is memory-mapped; anything else is read completely at first use.
    """

    def __init__(self, path: str | Path, radar: Any = None, **how: Any):
        """Opens a recording.

        Args:
            path: The recording, as in `read_recording`.
            radar: Its radar, as in `read_recording`.
            **how: Further arguments of `read_recording`.

        Raises:
            InputError: If the first frame cannot be read with these settings.
        """
        self.path, self._radar, self._how = Path(path), radar, how
        self._in_part = self._is_read_in_part(how.get("axes"))
        first = self._recording(slice(0, 1)) if self._in_part else None
        self._first, self._num_frames = (None, None) if first is None else (first.cube, first.num_frames)

    @cached_property
    def num_frames(self) -> int:
        """Number of frames."""
        if self._first is None:
            return len(self._whole.values)
        if self._num_frames is not None:
            return self._num_frames
        return num_frames_of_stream(self.path) if self.path.is_dir() else len(read_npy(self.path, mapped=True))

    @property
    def num_values_a_frame(self) -> int:
        """Complex values per frame of the cube."""
        one = self._whole if self._first is None else self._first
        return one.values[0].size

    def cube(self, frames: range) -> RadarCube:
        """Computes the range-Doppler cube of consecutive frames.

        Args:
            frames: Indices of the frames.

        Returns:
            Cube, (frame, range, doppler, antenna).

        Raises:
            InputError: If they cannot be read.
        """
        stretch = slice(frames.start, frames.stop)
        if self._in_part:
            return self._recording(stretch).cube
        return self._whole.select(stretch)

    def _recording(self, frames: slice) -> Recording:
        return read_recording(self.path, self._radar, frames=frames, **self._how)

    @cached_property
    def _whole(self) -> RadarCube:
        return read_recording(self.path, self._radar, mapped=True, **self._how).cube

    def _is_read_in_part(self, axes: str | None) -> bool:
        if self.path.suffix == ".npy":
            return axes is not None and axes.split(",")[0].strip() == "frame"
        if self.path.is_dir():
            return is_stream(self.path) or is_capture(self.path)
        return self.path.is_file() and self.path.suffix.lower() != ".npz"
