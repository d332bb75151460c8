"""The floor of a scene as a person can use it: free cells within the radar's range window and the camera's view."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from jaxtyping import Bool, Float

from mmweaver.core.errors import InputError
from mmweaver.core.records import Scene
from mmweaver.geometry.aligned_photo import AlignedPhoto

Array = np.ndarray
Positions = Float[Array, "*shape 2"]

BODY_RADIUS_M = 0.25  # half the width of the shoulders
AZIMUTH_LIMIT_RAD = np.radians(40.0)
TORSO_HEIGHT = 0.68  # of the body's height
TORSO_HALF_DEPTH_M = 0.2
_UNSEEN_COST = 1.5  # of a position whose floor is assumed, not seen
_OFF_GRID_COST = 3.0
_AHEAD_DEG = 12.0  # azimuths up to this cost nothing: the antennas' beam is strongest straight ahead


@dataclass(frozen=True)
class FloorMap:
    """Clearance, visibility and cost of positions (x, y) in metres in the radar's frame, from the free-space grid."""

    scene: Scene
    range_window_m: tuple[float, float]
    height_m: float

    @cached_property
    def cell_m(self) -> float:
        x = self.scene.free_space.x_m
        return float(x[1] - x[0]) if len(x) > 1 else 0.1

    @cached_property
    def cell_centres_m(self) -> Float[Array, "y x 2"]:
        """Centres (x, y) of the cells in metres."""
        free = self.scene.free_space
        return np.stack(np.meshgrid(free.x_m, free.y_m), axis=-1).astype(float)

    @cached_property
    def clearance_m(self) -> Float[Array, "y x"]:
        """Distance in metres to the nearest cell that is not free; outside the grid nothing is free."""
        from scipy.ndimage import distance_transform_edt

        padded = np.pad(self.scene.free_space.is_free, 1)
        cells = np.asarray(distance_transform_edt(padded), dtype=float)[1:-1, 1:-1]
        return np.maximum(cells - 0.5, 0.0) * self.cell_m

    @cached_property
    def in_view(self) -> Bool[Array, "y x"]:
        """Whether radar and camera see a body that stands in a cell."""
        return self.sees(self.cell_centres_m)

    @cached_property
    def walkable(self) -> Bool[Array, "y x"]:
        """Whether a body can stand in a cell: enough clearance, and in view."""
        return (self.clearance_m >= BODY_RADIUS_M) & self.in_view

    @cached_property
    def cell_cost(self) -> Float[Array, "y x"]:
        """Soft cost of a cell: floor not seen, off the radar's axis, feet or head outside range window or picture."""
        ground = np.hypot(self.cell_centres_m[..., 0], self.cell_centres_m[..., 1])
        floor = self.scene.floor_z_m
        farthest = np.hypot(ground, max(-floor, floor + self.height_m, 0.0))
        low, high = self.range_window_m
        cell_cost = _UNSEEN_COST * self._unseen_share
        cell_cost = (
            cell_cost + 1.5 * np.clip((farthest - high) / 0.3, 0, 1) + 1.5 * np.clip((low + 0.4 - ground) / 0.3, 0, 1)
        )
        azimuth = np.degrees(np.abs(np.arctan2(self.cell_centres_m[..., 0], self.cell_centres_m[..., 1])))
        cell_cost = cell_cost + np.clip((azimuth - _AHEAD_DEG) / 20, 0, 1.4)
        for height in (0.03, self.height_m):
            cell_cost = cell_cost + 0.8 * ~self._in_picture(
                self.cell_centres_m, floor + height, margin=0.01, vertical=True
            )
        return cell_cost

    @cached_property
    def _unseen_share(self) -> Float[Array, "y x"]:
        """Share of the floor under a body that was assumed, not seen."""
        from scipy.ndimage import uniform_filter

        across = 2 * round(BODY_RADIUS_M / self.cell_m) + 1
        return np.asarray(uniform_filter((~self.scene.free_space.is_seen).astype(float), across, mode="nearest"))

    def sees(self, positions_m: Positions) -> Bool[Array, "*shape"]:
        """Whether the torso is in the range window, within 40 degrees of the radar's axis and the picture's width."""
        z = self.scene.floor_z_m + TORSO_HEIGHT * self.height_m
        distance = np.sqrt(positions_m[..., 0] ** 2 + positions_m[..., 1] ** 2 + z**2)
        low, high = self.range_window_m
        inside = (distance - TORSO_HALF_DEPTH_M >= low) & (distance + TORSO_HALF_DEPTH_M <= high)
        ahead = np.abs(np.arctan2(positions_m[..., 0], positions_m[..., 1])) <= AZIMUTH_LIMIT_RAD
        return np.asarray(inside & ahead & self._in_picture(positions_m, z, margin=0.06, vertical=False))

    def _in_picture(self, positions_m: Positions, z: float, *, margin: float, vertical: bool) -> Bool[Array, "*shape"]:
        points = np.concatenate([positions_m, np.full((*positions_m.shape[:-1], 1), z)], axis=-1)
        pixels, depth_m = AlignedPhoto.of(self.scene).project(points)
        intrinsics = self.scene.photo.intrinsics
        u, v = pixels[..., 0] / intrinsics.width, pixels[..., 1] / intrinsics.height
        inside = (depth_m > 0.1) & (u >= margin) & (u <= 1 - margin)
        if vertical:
            inside &= (v >= margin) & (v <= 1 - margin)
        return np.asarray(inside)

    def _cells(self, positions_m: Positions) -> tuple[Array, Array, Array]:
        """Row and column (*shape,) of each position, (0, 0) off the grid, and whether it is on the grid."""
        free = self.scene.free_space
        column = np.rint((positions_m[..., 0] - free.x_m[0]) / self.cell_m).astype(int)
        row = np.rint((positions_m[..., 1] - free.y_m[0]) / self.cell_m).astype(int)
        inside = (column >= 0) & (column < len(free.x_m)) & (row >= 0) & (row < len(free.y_m))
        return np.where(inside, row, 0), np.where(inside, column, 0), np.asarray(inside)

    def can_stand(self, positions_m: Positions) -> Bool[Array, "*shape"]:
        """Whether each position is walkable."""
        row, column, inside = self._cells(positions_m)
        return np.asarray(inside & self.walkable[row, column])

    def clearance_at(self, positions_m: Positions) -> Float[Array, "*shape"]:
        """Distance in metres to the nearest cell that is not free, 0 off the grid."""
        row, column, inside = self._cells(positions_m)
        return np.where(inside, self.clearance_m[row, column], 0.0)

    def cost_at(self, positions_m: Positions) -> Float[Array, "*shape"]:
        """`cell_cost` at each position."""
        row, column, inside = self._cells(positions_m)
        return np.where(inside, self.cell_cost[row, column], _OFF_GRID_COST)

    def free_length_m(
        self, position_m: Float[Array, "2"], direction_rad: float, wanted_m: float, excused_m: float = 0.0
    ) -> float:
        """How far in metres a body can go straight from a position, at most `wanted_m`.

        Within `excused_m` of the position it may be closer to furniture than a body's radius (the seat just left).
        """
        steps = np.append(np.arange(0.0, wanted_m, 0.04), wanted_m)
        line_m = position_m + steps[:, None] * np.array([np.cos(direction_rad), np.sin(direction_rad)])
        excused = (steps < excused_m) & (self.clearance_at(line_m) > 0.05)
        blocked = np.flatnonzero(~(self.can_stand(line_m) | excused))
        if not len(blocked):
            return float(wanted_m)
        return float(steps[blocked[0] - 1]) if blocked[0] else 0.0

    def nearest_walkable_m(self, position_m: Float[Array, "2"]) -> Float[Array, "2"] | None:
        """Centre (x, y) of the walkable cell nearest to a position, in metres; None where none is walkable."""
        if not self.walkable.any():
            return None
        positions_m = self.cell_centres_m[self.walkable]
        return positions_m[np.argmin(np.hypot(*(positions_m - position_m).T))]

    def check_start(self, start_m: tuple[float, float]) -> None:
        """Raises InputError, naming the nearest walkable position, where nobody can start at `start_m` (x, y)."""
        spot = np.array(start_m, dtype=float)
        if bool(self.can_stand(spot)):
            return
        near = self.nearest_walkable_m(spot)
        if not bool(self.sees(spot)):
            low, high = self.range_window_m
            why = f"is outside the radar's window ({low:.2f} to {high:.2f} m, within 40 degrees and the picture)"
        else:
            why = f"is not free: a body needs {BODY_RADIUS_M:g} m around it"
        hint = "there is no free position" if near is None else f"the nearest free place is {near[0]:.2f},{near[1]:.2f}"
        raise InputError(f"the start {spot[0]:g},{spot[1]:g} {why}; {hint}")
