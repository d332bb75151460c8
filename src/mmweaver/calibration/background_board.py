"""The board that made a background recording, so that the person in it has the errors of the recorded clutter."""

from dataclasses import replace

import numpy as np

from mmweaver.core.board import Board
from mmweaver.core.records import RadarCube


class BackgroundBoard:
    """Of the latest recording asked for; its leakage and noise are in the recording and left out."""

    def __init__(self) -> None:
        self._latest: tuple[RadarCube, Board] | None = None

    def of(self, recording: RadarCube) -> Board:
        """The board, as far as the recording shows it; fitted once for a recording. Raises InputError."""
        latest = self._latest
        if latest is None or latest[0] is not recording:
            from mmweaver.calibration.calibrate import calibrate

            found = calibrate(recording, name="of the background recording").board
            none = np.zeros(0)
            latest = (
                recording,
                replace(
                    found, noise_figure_db=None, leakage_range_m=none, leakage_level_db=none, leakage_phase_deg=none
                ),
            )
            self._latest = latest
        return latest[1]
