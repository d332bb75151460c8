"""Live recognition of frames from a pipe, a serial port, or a signal that is being generated."""

import csv
from collections import deque
from collections.abc import Iterator
from io import TextIOWrapper
from itertools import chain
from typing import Any, cast

import numpy as np
from jaxtyping import Float

from mmweaver.core.errors import InputError
from mmweaver.core.records import PointCloud
from mmweaver.io.point_clouds.point_tables import csv_columns
from mmweaver.io.point_clouds.ti_uart import MAGIC, ByteSource, point_packets
from mmweaver.recognition.point_recordings import PointRecording
from mmweaver.recognition.recogniser import Recogniser, Recognition

FramePoints = Float[np.ndarray, "point 5"]  # x right, y ahead, z up in m, radial velocity (away +) in m/s, SNR in dB
MAX_EMPTY = 100_000  # maximum number of missing frames between two


class LiveRecogniser:
    """Takes frames one by one and returns complete windows, the same as those of `Recogniser.recognise`."""

    def __init__(self, model: Recogniser):
        self.model = model
        self._frame = 0  # number of the next one
        self._start: int | None = 0 if model.settings.gap_frames is None else None  # of the sample
        self._last = -1  # frame with points
        self._given = 0  # windows of the sample
        self._silent = 0  # first frame of the gap that is not yet part of a window
        self._points: deque[tuple[int, FramePoints]] = deque()

    def push(self, points: FramePoints) -> list[Recognition]:
        """Takes one more frame.

        Args:
            points: Points (point, 5) of the frame, possibly none.

        Returns:
            The windows that are now complete.
        """
        now, gap = self._frame, self.model.settings.gap_frames
        self._frame += 1
        if len(points):
            self._points.append((now, np.asarray(points, float)))
            self._start = now if self._start is None else self._start
            self._last = now
        elif gap is not None and (self._start is None or now - self._last > gap):
            return [*self._end_sample(), *self._silence()]
        return self._complete(now + 1 if gap is None else self._last + 1)

    def finish(self) -> list[Recognition]:
        """Ends the sample and returns the remaining windows, including a single performance shorter than a window."""
        return [*self._end_sample(), *self._silence()]

    def _end_sample(self) -> list[Recognition]:
        settings, found = self.model.settings, list[Recognition]()
        if self._start is not None:
            if settings.has_single_performances and not self._given:
                found = [self._window(self._start)]
            self._silent = self._last + 1
        self._start, self._given = None if settings.gap_frames is not None else self._frame, 0
        self._points.clear()
        return found

    def _silence(self) -> list[Recognition]:
        """Windows of a gap, if one of the labels is the empty room."""
        settings, found = self.model.settings, list[Recognition]()
        if settings.gap_frames is not None and settings.empty_label is not None:
            while self._frame - self._silent >= settings.window_frames:
                found.append(self._window(self._silent))
                self._silent += settings.window_frames
        return found

    def _complete(self, end: int) -> list[Recognition]:
        length, found = self.model.settings.window_frames, list[Recognition]()
        while self._start is not None and end - self._start >= (self._given + 1) * length:
            found.append(self._window(self._start + self._given * length))
            self._given += 1
        return found

    def _window(self, first: int) -> Recognition:
        """Labels the window that begins at a frame, and drops its points."""
        settings = self.model.settings
        end, rows = first + settings.window_frames, [np.zeros((0, 6))]
        while self._points and self._points[0][0] < end:
            frame, points = self._points.popleft()
            if frame >= first:
                rows.append(np.column_stack([np.full(len(points), frame - first), points]))
        frame, x, y, z, velocity, snr_db = np.concatenate(rows).T
        cloud = PointCloud(frame=frame.astype(int), x_m=x, y_m=y, z_m=z, radial_velocity_mps=velocity, snr_db=snr_db)
        window = PointRecording(
            name="live",
            cloud=cloud,
            num_frames=settings.window_frames,
            frame_rate_hz=settings.frame_rate_hz,
            first_frame=first,
        )
        return self.model.recognise_windows([window])[0]


def recognise_stream(model: Recogniser, source: ByteSource) -> Iterator[Recognition]:
    """Labels windows from a pipe: bytes of a TI demo's data port, or CSV lines with a header.

    Args:
        model: The recogniser.
        source: The bytes.

    Yields:
        Windows as they become complete.

    Raises:
        InputError: If the bytes are neither.
    """
    live = LiveRecogniser(model)
    for points in frames_of(source):
        yield from live.push(points)
    yield from live.finish()


def frames_of(source: ByteSource) -> Iterator[FramePoints]:
    """The points (point, 5) of each frame of a stream, including empty frames.

    Args:
        source: Bytes as for `recognise_stream`.

    Raises:
        InputError: If the bytes are not points.
    """
    head = source.read(len(MAGIC))
    if head.isascii() and head[:1].isalpha():
        rest = TextIOWrapper(cast("Any", source), encoding="utf-8", errors="replace")
        yield from _frames_of_csv(chain((head.decode() + rest.readline()).splitlines(), rest))
    elif head:
        yield from (packet[:, :5] for packet in point_packets(source, head))


def _frames_of_csv(lines: Iterator[str]) -> Iterator[FramePoints]:
    """Frame, X, Y, Z, Doppler, optionally SNR; missing frames are empty."""
    rows = csv.reader(lines)
    at = csv_columns(next(rows, []), "the stream")
    order = [at[name] for name in ("frame", "x", "y", "z", "velocity")]
    number: int | None = None
    points: list[list[float]] = []
    for row in rows:
        try:
            frame, *values = (float(row[column]) for column in order)
            snr_db = float(row[at["snr"]]) if "snr" in at else float("nan")
        except (ValueError, IndexError):
            raise InputError(f"the stream holds a line that is no point: {','.join(row)[:60]!r}") from None
        if not np.isfinite([frame, *values]).all() or (number is not None and not 0 <= frame - number < MAX_EMPTY):
            raise InputError(f"the stream holds values that cannot be, or frames out of order: {','.join(row)[:60]!r}")
        if number is not None and int(frame) > number:
            yield np.array(points)
            for _ in range(int(frame) - number - 1):
                yield np.zeros((0, 5))
            points = []
        number = int(frame)
        points.append([*values, snr_db])
    if points:
        yield np.array(points)
