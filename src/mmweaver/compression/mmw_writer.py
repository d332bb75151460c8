"""Writes a long recording to a .mmw file piece by piece with constant memory, or appends to one."""

import os
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from types import TracebackType

import numpy as np

from mmweaver.compression.mmw_codec import check_encodable, encoded
from mmweaver.compression.mmw_container import LISTED, MmwFile, MmwHeader, header_for, pack_header, pack_record
from mmweaver.core.errors import InputError
from mmweaver.core.output_checks import cannot_write
from mmweaver.core.records import RadarCube
from mmweaver.core.staging import sync

HEADER_MARGIN = 24  # a period with many digits takes more bytes than that of a single frame


class MmwWriter:
    """Appends pieces of a recording to a file; every record is on disk before the next one is encoded.

    The file is readable up to its last complete record at any time, however the program ends.
    """

    def __init__(self, path: Path | str, *, append: bool = False):
        """Opens the file.

        Args:
            path: Path of the file.
            append: Whether an existing file is continued; an incomplete last record is removed first.

        Raises:
            InputError: If the file exists and `append` is not set, or it cannot be continued.
        """
        self.path = Path(path)
        self.last_chunks: list[bytes] = []  # of the piece written last
        self._header: MmwHeader | None = None
        self._last_s: float | None = None
        self._end = 0
        if self.path.exists():
            if not append:
                raise InputError(f"{path} exists; choose another name or append to it")
            file = MmwFile(self.path)
            if file.version in LISTED:
                raise InputError(f"{path} is of version {file.version}, which cannot be appended to; compress it again")
            self._header, self._end = file.header, file.num_bytes - file.cut_short
            self._last_s = float(file.records[-1].frame_time_s[-1])
        self._first_end, self._joined_s = self._end, self._last_s
        try:
            # without a buffer, which after a failed write truncate() and close() would try to flush again
            self._stream = self.path.open("r+b" if self._header else "xb", buffering=0)
            self._stream.truncate(self._end)
            self._stream.seek(self._end)
            if self._header is None:
                sync(self.path.parent)
        except OSError as error:
            raise cannot_write(self.path, error) from None

    def append(
        self,
        cube: RadarCube,
        *,
        num_bytes: int | None = None,
        quality_db: float | None = None,
        keep_noise: bool = False,
        effort: str = "full",
    ) -> int:
        """Encodes and writes a piece whose frame times continue those of the recording.

        Args:
            cube: The piece.
            num_bytes: Maximum size of its records; give either this or `quality_db`.
            quality_db: Signal-to-error ratio in active cells.
            keep_noise: Whether all cells have the same error.
            effort: "full" or "fast".

        Returns:
            Bytes written, without the header of a new file.

        Raises:
            InputError: If the piece has another radar or scale, or cannot be stored.
        """
        check_encodable(cube, num_bytes, quality_db)
        if self._header is None:
            self._header = header_for(cube.config, cube.scale, cube.grid.frame_time_s)
            self._write(pack_header(self._header))
        same_scale = cube.scale == self._header.scale or (np.isnan(cube.scale) and np.isnan(self._header.scale))
        if cube.config != self._header.config or not same_scale:
            raise InputError(
                f"{self.path} holds frames of another radar or scale; write these into a file of their own"
            )
        time_s = cube.grid.frame_time_s
        parts, self.last_chunks = encoded(
            cube,
            lambda parts: sum(len(one) for one in self._records([b""] * len(parts), parts, time_s)),
            num_bytes=num_bytes,
            quality_db=quality_db,
            keep_noise=keep_noise,
            effort=effort,
        )
        before = self._end
        for record in self._records(self.last_chunks, parts, time_s):
            self._write(record)
        self._last_s = float(time_s[-1])
        return self._end - before

    def following(self, cube: RadarCube, frames_before: int) -> RadarCube:
        """A piece of a recording, with times that follow the frames the file had when it was opened.

        Args:
            cube: The piece.
            frames_before: Frames of the recording that precede the piece.
        """
        if self._joined_s is None or self._header is None:
            return cube
        first_s = self._joined_s + self._header.period_s * (1 + frames_before)
        time_s = cube.grid.frame_time_s
        return replace(cube, grid=replace(cube.grid, frame_time_s=first_s + time_s - time_s[0]))

    def num_bytes_of_header(self, cube: RadarCube) -> int:
        """Upper bound of the bytes of the header that the first piece adds; 0 if the file has one."""
        if self._header is not None:
            return 0
        return len(pack_header(header_for(cube.config, cube.scale, cube.grid.frame_time_s))) + HEADER_MARGIN

    def undo(self) -> None:
        """Removes everything written since the file was opened; a new file is then empty."""
        self._stream.truncate(self._first_end)

    def _records(self, chunks: list[bytes], parts: list[range], time_s: np.ndarray) -> Iterator[bytes]:
        """The records of the chunks of a piece with these frame times."""
        assert self._header is not None
        last_s = self._last_s
        for chunk, part in zip(chunks, parts, strict=True):
            yield pack_record(chunk, time_s[part.start : part.stop], self._header, last_s)
            last_s = float(time_s[part.stop - 1])

    def close(self) -> None:
        """Closes the file."""
        self._stream.close()

    def _write(self, data: bytes) -> None:
        try:
            left = memoryview(data)
            while left:
                left = left[self._stream.write(left) :]
            os.fsync(self._stream.fileno())
        except OSError as error:
            raise cannot_write(self.path, error) from None
        self._end += len(data)

    def __enter__(self) -> "MmwWriter":
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()
