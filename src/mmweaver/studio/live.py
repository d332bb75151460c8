"""Live mode: chunks of a stream, generated while the visitor types, for a rolling picture in the browser."""

from collections import deque
from collections.abc import Iterator
from time import perf_counter
from typing import Any

import numpy as np

from mmweaver.core.board import Board
from mmweaver.core.errors import InputError
from mmweaver.recognition.live_recogniser import LiveRecogniser
from mmweaver.recognition.recogniser import Recogniser
from mmweaver.studio.schemas import DEFAULT_BOARD, Form
from mmweaver.viz.body_in_photo import pack
from mmweaver.viz.sequence import make_playback
from mmweaver.weaver.front_door import Weaver
from mmweaver.weaver.generation import Room
from mmweaver.weaver.streaming import StreamChunk

CHUNK_FRAMES = 10


class Live:
    """One stream of one session. `next_chunk` is called for each chunk; `say` adds the next sentence."""

    def __init__(
        self,
        weaver: Weaver,
        room: Room,
        asked: Form,
        board: Board | str = DEFAULT_BOARD,
        recogniser: Recogniser | None = None,
    ):
        sentences = asked.text or []
        if len(sentences) > 1:
            raise InputError("Live has one person; leave the second sentence empty")
        self._sentences: deque[str] = deque(sentences)
        self._chunks: Iterator[StreamChunk] = weaver.stream(
            room,
            self._next_sentence(),
            seed=asked.seed,
            at=asked.request.at,
            chunk_frames=CHUNK_FRAMES,
            board=board,
            fps=None if recogniser is None else recogniser.settings.frame_rate_hz,
        )
        self._labels = None if recogniser is None else LiveLabels(recogniser)
        self._scale_db: tuple[float, float] | None = None
        self._frames = 0
        self._seconds = 0.0

    def say(self, text: str) -> None:
        """Adds the sentence that follows the current one."""
        self._sentences.append(text)

    def _next_sentence(self) -> Iterator[str | None]:
        while True:
            yield self._sentences.popleft() if self._sentences else None

    def next_chunk(self) -> bytes:
        """The next chunk, packed for the page, with its speed relative to real time.

        Raises:
            InputError: If the first sentence cannot be carried out.
        """
        begun = perf_counter()
        chunk = next(self._chunks)
        self._frames += chunk.num_frames
        self._seconds += perf_counter() - begun
        shown = make_playback(chunk.cube, chunk.points, chunk.poses, self._meta(chunk), scale_db=self._scale_db)
        if self._scale_db is None:  # the same scale for as long as it runs
            self._scale_db = (shown.header["db"]["low"], shown.header["db"]["high"])
        period_s = chunk.cube.config.frame_period_s
        live = {
            "frames": self._frames,
            "first_frame": chunk.first_frame,
            "refused": chunk.refused,
            "text": chunk.text,
            "label": None if self._labels is None else self._labels.push(chunk),
            "times_real_time": self._frames * period_s / max(self._seconds, 1e-6),
        }
        return pack({**shown.header, "live": live}, shown.arrays)

    def _meta(self, chunk: StreamChunk) -> dict[str, Any]:
        return {"text": chunk.text, **chunk.meta}


class LiveLabels:
    """Labels of the last complete window of a stream, by a recogniser of `mmweaver recognise train`."""

    def __init__(self, model: Recogniser):
        self._live = LiveRecogniser(model)
        self._last: dict[str, Any] | None = None

    def push(self, chunk: StreamChunk) -> dict[str, Any] | None:
        """Takes a chunk's frames.

        Args:
            chunk: The chunk.

        Returns:
            Label, its share of the votes, and whether its window is out of distribution; None before the first complete
            window.
        """
        points = chunk.points
        columns = (points.x_m, points.y_m, points.z_m, points.radial_velocity_mps, points.snr_db)
        table = np.stack(columns, axis=-1)
        for frame in range(chunk.num_frames):
            for found in self._live.push(table[points.frame == frame]):
                share = found.votes[found.label]
                self._last = {"label": found.label, "share": share, "is_outside": found.is_outside}
        return self._last
