"""Neighbours in range and velocity are grouped as the task's firmware groups them, also where a recording's did not.

Of cells that touch, the strongest stays: one echo is then about as many points whether or not the board grouped them.
What firmware has grouped already has no neighbours, so nothing of it changes.
"""

from dataclasses import replace

import numpy as np
from jaxtyping import Bool, Float, Int

from mmweaver.recognition.point_recording import PointRecording
from mmweaver.recognition.radar_facts import RadarFacts

SLOWER = 0.05  # of two that are equal, what is at rest is the echo and what moves a step is its flank
AROUND = 2  # cells on either side that tell the middle of an echo


def grouped(window: PointRecording, facts: RadarFacts) -> PointRecording:
    """The window with one cell of those that touch, in the directions in which the task's firmware groups."""
    cloud = window.cloud
    if not len(cloud.frame) or not (facts.groups_range or facts.groups_velocity):
        return window
    columns = max(round(2 * facts.max_velocity_mps / facts.velocity_step_mps), 1)
    row = np.round(cloud.range_m / facts.range_step_m).astype(int)
    column = np.round(cloud.radial_velocity_mps / facts.velocity_step_mps).astype(int) % columns
    where = np.stack([cloud.frame.astype(int), row, column], axis=1)
    cells, cell = np.unique(where, axis=0, return_inverse=True)
    snr_db = np.full(len(cells), -np.inf)
    np.maximum.at(snr_db, cell.ravel(), np.nan_to_num(cloud.snr_db, nan=-np.inf))
    table = _Table(cells, columns)
    # a ratio to the noise of each velocity is the same on the flanks of an echo, so that its middle is the peak
    known = bool(np.isfinite(snr_db).all())
    strength = table.sum_around(np.maximum(snr_db, 0.0), 0) if known else table.sum_around(np.ones(len(cells)), AROUND)
    steps = np.minimum(cells[:, 2], columns - cells[:, 2])
    strength *= 1 - SLOWER * np.minimum(steps, AROUND)
    kept = table.peaks(strength, facts.groups_range, facts.groups_velocity)
    return window if kept.all() else replace(window, cloud=cloud.select(kept[cell.ravel()]))


class _Table:
    """Occupied cells (frame, range, velocity) of a window, sorted; velocities are cyclic."""

    def __init__(self, cells: Int[np.ndarray, "cell 3"], columns: int):
        self.columns, self.cells = columns, cells
        self._rows = int(cells[:, 1].max()) + 2 * AROUND + 2
        self._key = self._keys(cells[:, 0], cells[:, 1], cells[:, 2])

    def _keys(self, frame: np.ndarray, row: np.ndarray, column: np.ndarray) -> np.ndarray:
        return (frame * self._rows + row + AROUND) * self.columns + column % self.columns

    def neighbour(self, rows: int, columns: int) -> Int[np.ndarray, " cell"]:
        """The number of the cell so many steps from each; -1 where it is empty."""
        wanted = self._keys(self.cells[:, 0], self.cells[:, 1] + rows, self.cells[:, 2] + columns)
        place = np.minimum(np.searchsorted(self._key, wanted), len(self._key) - 1)
        return np.where(self._key[place] == wanted, place, -1)

    def sum_around(self, values: Float[np.ndarray, " cell"], rows: int) -> Float[np.ndarray, " cell"]:
        """The sum of each cell's value and of those near it, up to `rows` away in range; nearer ones weigh more."""
        total = np.zeros(len(self.cells))
        for row in range(-rows, rows + 1):
            for column in range(-AROUND, AROUND + 1):
                other = self.neighbour(row, column)
                total += np.where(other >= 0, values[other], 0.0) / (1.0 + row**2 + column**2)
        return total

    def peaks(
        self, strength: Float[np.ndarray, " cell"], in_range: bool, in_velocity: bool
    ) -> Bool[np.ndarray, " cell"]:
        """Cells that no neighbour exceeds; of equal ones the first stays."""
        kept = np.ones(len(self.cells), bool)
        here = np.arange(len(self.cells))
        for rows in (-1, 0, 1) if in_range else (0,):
            for columns in (-1, 0, 1) if in_velocity else (0,):
                other = self.neighbour(rows, columns)
                there = np.where(other >= 0, strength[other], -np.inf)
                kept &= (there < strength) | ((there == strength) & (other >= here)) | (other < 0)
        return kept
