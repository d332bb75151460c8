"""Quantisation of points by the task's firmware: steps of range and velocity, static removal, grouping of neighbours.

Neighbours are grouped as the firmware does, even if a recording was not grouped: of adjacent cells the strongest
is kept, so that one echo gives about as many points whether or not the board grouped them.
"""

from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Bool, Float, Int

from mmweaver.recognition.point_recordings import PointRecording
from mmweaver.recognition.task_file import RecognitionTask
from mmweaver.signal.firmware import range_step_m

SLOWER = 0.05  # tie-break: of two equal cells the slower one is the echo, the other its flank
AROUND = 2  # cells on either side that determine the middle of an echo


@dataclass(frozen=True, kw_only=True)
class Quantisation:
    """Properties of a task's radar that are visible in its points."""

    range_step_m: float
    velocity_step_mps: float
    max_velocity_mps: float
    removes_static: bool
    groups_range: bool  # whether one of several neighbours in range, or in velocity, is reported
    groups_velocity: bool
    knows_place: bool  # whether there is a recording of the empty room

    @staticmethod
    def of(task: RecognitionTask) -> "Quantisation":
        """Properties of a task's radar and firmware."""
        return Quantisation(
            range_step_m=range_step_m(task.radar),
            velocity_step_mps=task.radar.velocity_resolution_mps,
            max_velocity_mps=task.radar.max_velocity_mps,
            removes_static=task.firmware.static_removal,
            groups_range=task.firmware.group_range,
            groups_velocity=task.firmware.group_doppler,
            knows_place=task.background is not None,
        )

    @staticmethod
    def read(values: object) -> "Quantisation | None":
        """Properties stored in meta.json; None where there are none, as in models before 0.3."""
        try:
            found = Quantisation(**values) if isinstance(values, dict) else None
            known = found and 0 < found.velocity_step_mps <= found.max_velocity_mps < np.inf
            return found if found and known and 0 < found.range_step_m < np.inf else None
        except TypeError:
            return None


def group_neighbours(window: PointRecording, radar: Quantisation) -> PointRecording:
    """The window without the points of `is_flank`."""
    flank = is_flank(window, radar)
    return replace(window, cloud=window.cloud.select(~flank)) if flank.any() else window


def is_flank(window: PointRecording, radar: Quantisation) -> Bool[np.ndarray, " point"]:
    """Mask (point,) of cells next to a stronger one, in the directions in which the task's firmware groups.

    Velocities are cyclic. Points that have been grouped already have no neighbours.

    Args:
        window: Points of one window.
        radar: Steps of range and velocity, and grouping.
    """
    cloud = window.cloud
    if not len(cloud.frame) or not (radar.groups_range or radar.groups_velocity):
        return np.zeros(len(cloud.frame), bool)
    columns = max(round(2 * radar.max_velocity_mps / radar.velocity_step_mps), 1)
    bins = [
        cloud.frame,
        np.round(cloud.range_m / radar.range_step_m),
        np.round(cloud.radial_velocity_mps / radar.velocity_step_mps) % columns,
    ]
    cells, cell = np.unique(np.stack(bins, axis=1).astype(int), axis=0, return_inverse=True)
    frame, row, column = cells.T
    num_rows = row.max() + 2 * AROUND + 2

    def key(rows: int, steps: int) -> Int[np.ndarray, " cell"]:
        return (frame * num_rows + row + rows + AROUND) * columns + (column + steps) % columns

    own = key(0, 0)

    def neighbour(rows: int, steps: int) -> Int[np.ndarray, " cell"]:
        """The index of the cell so many steps from each; -1 where it is empty."""
        wanted = key(rows, steps)
        place = np.minimum(np.searchsorted(own, wanted), len(own) - 1)
        return np.where(own[place] == wanted, place, -1)

    def sum_around(values: Float[np.ndarray, " cell"], most: int) -> Float[np.ndarray, " cell"]:
        """The sum of each cell's value and of those up to `most` rows away; nearer ones weigh more."""
        total = np.zeros(len(own))
        for rows in range(-most, most + 1):
            for steps in range(-AROUND, AROUND + 1):
                other = neighbour(rows, steps)
                total += np.where(other >= 0, values[other], 0.0) / (1.0 + rows**2 + steps**2)
        return total

    snr_db = np.full(len(own), -np.inf)
    np.maximum.at(snr_db, cell.ravel(), np.nan_to_num(cloud.snr_db, nan=-np.inf))
    # SNR relative to each velocity's own noise is equal on the flanks of an echo, so its middle is taken as the peak
    is_known = bool(np.isfinite(snr_db).all())
    strength = sum_around(np.maximum(snr_db, 0.0), 0) if is_known else sum_around(np.ones(len(own)), AROUND)
    strength *= 1 - SLOWER * np.minimum(np.minimum(column, columns - column), AROUND)
    kept, here = np.ones(len(own), bool), np.arange(len(own))
    for rows in (-1, 0, 1) if radar.groups_range else (0,):
        for steps in (-1, 0, 1) if radar.groups_velocity else (0,):
            other = neighbour(rows, steps)
            there = np.where(other >= 0, strength[other], -np.inf)
            kept &= (there < strength) | ((there == strength) & (other >= here))  # ties: the first
    return ~kept[cell.ravel()]
