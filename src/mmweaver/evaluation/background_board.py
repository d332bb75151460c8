"""The board that made a background recording, so that the person in it has the errors of the recorded clutter."""

from dataclasses import replace

import numpy as np

from mmweaver.core.board import Board
from mmweaver.core.records import RadarCube


class BackgroundBoard:
    """The board of the latest recording; its leakage and noise are in the recording and left out."""

    def __init__(self) -> None:
        self._latest: tuple[RadarCube, Board] | None = None

    def of(self, recording: RadarCube, known: Board | None = None) -> Board:
        """The board that is `known`, or as far as the recording shows it, fitted once for each. Raises InputError."""
        if known is not None:
            return _remove_noise(known)
        latest = self._latest
        if latest is None or latest[0] is not recording:
            from mmweaver.evaluation.calibrate import calibrate

            found = calibrate(recording, name="of the background recording").board
            latest = self._latest = recording, _remove_noise(found)
        return latest[1]


def _remove_noise(board: Board) -> Board:
    none = np.zeros(0)
    return replace(board, noise_figure_db=None, leakage_range_m=none, leakage_level_db=none, leakage_phase_deg=none)
