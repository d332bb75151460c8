"""Compresses a recording of any length piece by piece, with memory independent of its length."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Protocol, runtime_checkable

import numpy as np

from mmweaver.compression.active_mask import active_mask
from mmweaver.compression.chunk import decode_chunk
from mmweaver.compression.chunk_encoder import ChunkEncoder, ChunkMode, Scale, some_frames, split
from mmweaver.compression.mmw_codec import MIN_BYTES, check_request, check_writable
from mmweaver.compression.mmw_container import MAX_RATIO
from mmweaver.compression.mmw_writer import MmwWriter
from mmweaver.compression.optimiser import COARSER, SHORT_CHUNK, Progress, ratio_db
from mmweaver.compression.transforms import transform_choices
from mmweaver.core.atomic_files import atomic_file
from mmweaver.core.default_precision import single_precision
from mmweaver.core.errors import InputError
from mmweaver.core.records import RadarCube

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
