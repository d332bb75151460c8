"""Recordings of any length, read in pieces if the file format permits."""

from functools import cached_property
from pathlib import Path
from typing import Any

from mmweaver.core.records import RadarCube
from mmweaver.core.safe_files.safe_arrays import read_npy
from mmweaver.io.capture_folder import find_capture
from mmweaver.io.capture_std import is_capture
from mmweaver.io.infineon import infineon_folder
from mmweaver.io.stream_folder import is_stream, num_frames_of_stream
from mmweaver.recordings.read_recording import CUBE, Recording, read_recording


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
        self.in_part = self._is_read_in_part(how.get("axes"))
        self.first = self.recording(slice(0, 1)) if self.in_part else None
        self._first = None if self.first is None else self.first.cube

    @cached_property
    def num_frames(self) -> int:
        """Number of frames."""
        if self._first is None:
            return len(self._whole.values)
        if self.first is not None and self.first.num_frames is not None:
            return self.first.num_frames
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
        if self.in_part:
            return self.recording(stretch).cube
        return self._whole.select(stretch)

    def recording(self, frames: slice) -> Recording:
        """Reads frames of a recording that is read in part."""
        return read_recording(self.path, self._radar, frames=frames, **self._how)

    @cached_property
    def _whole(self) -> RadarCube:
        return read_recording(self.path, self._radar, mapped=True, **self._how).cube

    def _is_read_in_part(self, axes: str | None) -> bool:
        if self.path.suffix == ".npy":
            return axes is not None and axes.split(",")[0].strip() == "frame"
        if self.path.is_dir():
            if (self.path / CUBE).is_file():
                return False
            is_board = infineon_folder(self.path) is not None or find_capture(self.path) is not None
            return is_stream(self.path) or is_capture(self.path) or is_board
        return self.path.is_file() and self.path.suffix.lower() != ".npz"
