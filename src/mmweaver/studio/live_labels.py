"""Labels of a recogniser (`mmweaver recognise train`) for a stream while it is made."""

from pathlib import Path
from typing import Any

import numpy as np

from mmweaver.core.errors import InputError
from mmweaver.recognition.live_recogniser import LiveRecogniser
from mmweaver.recognition.recogniser import Recogniser, load_recogniser
from mmweaver.streaming import StreamChunk


class OfferedRecognisers:
    """Recognisers that every session may use in Live, by the names of their folders."""

    def __init__(self, folders: list[Path]):
        self._models: dict[str, Recogniser] = {}
        for folder in folders:
            name = folder.resolve().name
            while name in self._models:
                name += "-2"
            self._models[name] = load_recogniser(folder)

    @property
    def names(self) -> list[str]:
        """All names in the order of the command line."""
        return list(self._models)

    def get(self, name: str) -> Recogniser:
        """A recogniser by its name. Raises InputError where there is none."""
        if name not in self._models:
            raise InputError("this recogniser is not known here; choose another one")
        return self._models[name]


class LiveLabels:
    """The label of the last complete window of a stream."""

    def __init__(self, model: Recogniser):
        self._live = LiveRecogniser(model)
        self._last: dict[str, Any] | None = None

    def push(self, chunk: StreamChunk) -> dict[str, Any] | None:
        """Takes a chunk's frames; label, its share of the votes, and whether its window is unlike all that is known.

        None before the first window is complete.
        """
        points = chunk.points
        columns = (points.x_m, points.y_m, points.z_m, points.radial_velocity_mps, points.snr_db)
        table = np.stack(columns, axis=-1)
        for frame in range(chunk.num_frames):
            for found in self._live.push(table[points.frame == frame]):
                share = found.votes[found.label]
                self._last = {"label": found.label, "share": share, "is_outside": found.is_outside}
        return self._last
