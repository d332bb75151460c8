"""Board of a background recording, so that a person added to it has the same hardware errors as the clutter."""

from dataclasses import replace

import numpy as np

from mmweaver.core.board import Board
from mmweaver.core.records import RadarCube


class BackgroundBoard:
    """Cached board of the latest recording, without leakage and noise, which the recording already contains."""

    def __init__(self) -> None:
        self._latest: tuple[RadarCube, Board] | None = None

    def of(self, recording: RadarCube, known: Board | None = None) -> Board:
        """Returns the board of a recording, fitted once per recording.

        Args:
            recording: Cube of the background.
            known: Board if it is known. Default: fitted to the recording.

        Returns:
            The board without leakage and noise figure.

        Raises:
            InputError: If the recording cannot be calibrated.
        """
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
