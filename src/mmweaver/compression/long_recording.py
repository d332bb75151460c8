"""Compresses a recording of any length piece by piece, with memory independent of its length.

Writes a long recording to a .mmw file piece by piece with constant memory, or appends to one.
"""

import os
from collections.abc import Callable, Iterator
from contextlib import ExitStack
from dataclasses import dataclass, replace
from pathlib import Path
from types import TracebackType
from typing import Any, Protocol, runtime_checkable

import numpy as np

from mmweaver.compression.chunk import decode_chunk
from mmweaver.compression.chunk_encoder import ChunkEncoder, ChunkMode, Scale, some_frames, split
from mmweaver.compression.mmw_codec import MIN_BYTES, check_encodable, check_request, check_writable, encoded
from mmweaver.compression.mmw_container import (
    LISTED,
    MAX_RATIO,
    MmwFile,
    MmwHeader,
    header_for,
    pack_header,
    pack_record,
)
from mmweaver.compression.optimiser import COARSER, SHORT_CHUNK, Progress, ratio_db
from mmweaver.compression.quantised_cells import active_mask
from mmweaver.compression.transforms import transform_choices
from mmweaver.core.atomic_files import atomic_file
from mmweaver.core.errors import InputError
from mmweaver.core.locks import locked
from mmweaver.core.output_checks import cannot_write
from mmweaver.core.records import RadarCube
from mmweaver.core.seeding import single_precision
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
        self._held = ExitStack()
        try:
            self._open(path, append)
        except BaseException:
            self._held.close()
            raise

    def _open(self, path: Path | str, append: bool) -> None:
        if self.path.exists():
            if not append:
                raise InputError(f"{path} exists; choose another name or append to it")
            self._held.enter_context(locked(self.path))  # another process may be appending
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
        self._held.close()

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


PIECE_VALUES = 2**22  # complex numbers per piece, for which the encoder needs 600 to 750 MB
CURVE_STEPS = np.geomspace(1e-7, 2, 36)  # relative to the peak of a piece
BISECTIONS = 40


@runtime_checkable
class LongRecording(Protocol):
    """A recording that can be read piece by piece, such as `recordings.recording_pieces.RecordingPieces`."""

    @property
    def num_frames(self) -> int: ...

    @property
    def num_values_a_frame(self) -> int: ...

    def cube(self, frames: range) -> RadarCube: ...


@dataclass(kw_only=True)
class ErrorSums:
    """Energies over all pieces, in squared units of the cube; each piece has its own noise floor."""

    active_signal: float = 0.0
    active_error: float = 0.0
    signal: float = 0.0
    error: float = 0.0

    def add(self, truth: np.ndarray, decoded: np.ndarray) -> None:
        """Adds the errors of a piece.

        Args:
            truth: Original values (frame, range, doppler, antenna).
            decoded: Decoded values of the same shape.
        """
        is_active = active_mask(truth)
        signal = np.sum(np.square(np.abs(truth), dtype=np.float64), axis=-1)
        error = np.sum(np.square(np.abs(truth - decoded), dtype=np.float64), axis=-1)
        self.active_signal += float(signal[is_active].sum())
        self.active_error += float(error[is_active].sum())
        self.signal += float(signal.sum())
        self.error += float(error.sum())

    def in_db(self) -> dict[str, float]:
        """Error-to-signal ratios as in `mmw_codec.errors_db`."""
        pairs = {"signal_error_db": (self.active_error, self.active_signal), "all_error_db": (self.error, self.signal)}
        return {name: round(ratio_db(*pair), 2) for name, pair in pairs.items()}


def compress_recording(
    recording: LongRecording,
    out: Path,
    *,
    num_bytes: int | None = None,
    quality_db: float | None = None,
    append: bool = False,
    progress: Progress = lambda _: None,
    **how: Any,
) -> dict[str, float]:
    """Compresses a recording piece by piece.

    A first pass distributes the bytes among the pieces as one step for all of them would.

    Args:
        recording: The recording.
        out: Path of the .mmw file.
        num_bytes: Maximum size of the file; give either this or `quality_db`.
        quality_db: Signal-to-error ratio in active cells.
        append: Whether frames are appended to an existing file; if that fails, the file remains as it was.
        progress: Called with the name of each step.
        how: Further arguments of `MmwWriter.append`.

    Returns:
        Errors in dB in active and in all cells.

    Raises:
        InputError: If a piece cannot be stored.
    """
    check_request(num_bytes, quality_db)
    parts = split(recording.num_frames, max(1, PIECE_VALUES // recording.num_values_a_frame))
    if num_bytes is not None and num_bytes * MAX_RATIO < 8 * recording.num_frames * recording.num_values_a_frame:
        raise InputError(f"{num_bytes} bytes are too few for {recording.num_frames} frames of this radar")

    def write(writer: MmwWriter) -> dict[str, float]:
        left = None if num_bytes is None else num_bytes - writer.num_bytes_of_header(recording.cube(range(1)))
        shares = [None] * len(parts) if left is None else _shares(recording, parts, left, progress)
        return _write(writer, recording, parts, shares, progress, how | {"quality_db": quality_db})

    if append:
        with MmwWriter(out, append=True) as writer:
            try:
                return write(writer)
            except BaseException:
                writer.undo()
                raise
    with atomic_file(out) as temporary:
        temporary.unlink()
        with MmwWriter(temporary) as writer:
            return write(writer)


def _write(writer: MmwWriter, recording: LongRecording, parts, shares, progress: Progress, how) -> dict[str, float]:
    sums, spare = ErrorSums(), 0
    for index, (part, share) in enumerate(zip(parts, shares, strict=True)):
        progress(f"piece {index + 1} of {len(parts)}")
        cube = writer.following(recording.cube(part), part.start)
        size = writer.append(cube, num_bytes=None if share is None else share + spare, **how)
        if share is not None:
            spare += share - size
        decoded = [decode_chunk(chunk, cube.config).cube_values() for chunk in writer.last_chunks]
        sums.add(cube.values, np.concatenate(decoded))
    return sums.in_db()


@single_precision()
def _shares(recording: LongRecording, parts: list[range], num_bytes: int, progress: Progress) -> list[int]:
    """Bytes per piece at the step at which all together have `num_bytes`, by estimates of their sizes."""
    if len(parts) == 1:
        return [num_bytes]
    curves = []
    for index, part in enumerate(parts):
        progress(f"estimate {index + 1} of {len(parts)}")
        curves.append(_size_curve(recording.cube(part)))
    low, high = -70.0, 70.0  # logarithms of a step in the units of the cubes
    for _ in range(BISECTIONS):
        middle = (low + high) / 2
        low, high = (middle, high) if sum(curve(middle) for curve in curves) > num_bytes else (low, middle)
    least = np.array([max(MIN_BYTES, 8 * len(part) * recording.num_values_a_frame // MAX_RATIO + 1) for part in parts])
    more = np.array([curve(high) for curve in curves])
    return [int(size) for size in np.floor(least + more * max(0, num_bytes - least.sum()) / more.sum())]


def _size_curve(cube: RadarCube) -> Callable[[float], float]:
    """Estimated bytes as a function of the logarithm of the step in the units of the cube."""
    check_writable(cube)
    scale = Scale.of(cube)
    samples = []
    for part in split(len(cube.values), SHORT_CHUNK):
        encoder = ChunkEncoder(some_frames(cube, part), scale)
        samples.append(encoder.sample(ChunkMode(transform=transform_choices(encoder.target.shape)[0]), 1.0))
    sizes = [sum(sample.estimate(step, COARSER).num_bytes for sample in samples) for step in CURVE_STEPS]
    steps = np.log(CURVE_STEPS) + np.log(scale.peak)
    return lambda log_step: float(np.interp(log_step, steps, sizes))
