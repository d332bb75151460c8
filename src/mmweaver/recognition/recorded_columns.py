"""Which column of a stored point cloud is what: "x_right", "x_ahead", "y_left", "z_up", "velocity", ..."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from mmweaver.core.errors import InputError
from mmweaver.core.records import PointCloud

# direction: our axis (right, ahead, up) and sign
DIRECTIONS = {"right": (0, 1), "left": (0, -1), "ahead": (1, 1), "up": (2, 1), "down": (2, -1)}
VELOCITIES = {"velocity": 1, "velocity_away": 1, "velocity_towards": -1}
STRENGTHS = ("snr", "snr_db")
AXES = ("right or left", "ahead", "up or down")


@dataclass(frozen=True, kw_only=True)
class RecordedColumns:
    """Names of the columns of `pts`: `axis_direction`, `velocity` (away +) or `velocity_towards`, `snr`; others stand
    for columns that are not read."""

    names: tuple[str, ...]

    @staticmethod
    def of(names: object, place: str) -> "RecordedColumns":
        """Checks names of columns. Raises InputError where a direction or the velocity is missing or named twice."""
        if not isinstance(names, Sequence) or isinstance(names, str) or not all(isinstance(one, str) for one in names):
            raise InputError(f'{place}: columns must be a list such as ["x_right", "y_ahead", "z_up", "velocity"]')
        found = RecordedColumns(names=tuple(str(name) for name in names))
        axes = [axis for axis, _ in found._directions().values()]
        for axis, words in enumerate(AXES):
            if axes.count(axis) != 1:
                raise InputError(f'{place}: one column must point {words}; name it so, for example "x_right"')
        if sum(name in VELOCITIES for name in found.names) != 1:
            raise InputError(f'{place}: one column must be "velocity" (away +) or "velocity_towards"')
        return found

    def _directions(self) -> dict[int, tuple[int, int]]:
        """Axis and sign of each column that is a direction, by its place."""
        words = {place: name.rpartition("_")[2] for place, name in enumerate(self.names)}
        return {place: DIRECTIONS[word] for place, word in words.items() if word in DIRECTIONS}

    def cloud(self, frame: np.ndarray, pts: np.ndarray, place: str) -> PointCloud:
        """The points of frames (point,) and columns (point, column). Raises InputError for another number of them."""
        if pts.ndim != 2 or pts.shape[1] != len(self.names):
            raise InputError(f"{place}: pts is {pts.shape}, but {len(self.names)} columns are named")
        xyz = np.zeros((3, len(pts)))
        for column, (axis, sign) in self._directions().items():
            xyz[axis] = sign * pts[:, column]
        snr_db = np.full(len(pts), np.nan)
        velocity = np.zeros(len(pts))
        for column, name in enumerate(self.names):
            if name in STRENGTHS:
                snr_db = pts[:, column].astype(float)
            elif name in VELOCITIES:
                velocity = VELOCITIES[name] * pts[:, column].astype(float)
        return PointCloud(frame=frame, x_m=xyz[0], y_m=xyz[1], z_m=xyz[2], radial_velocity_mps=velocity, snr_db=snr_db)
