"""The floor of a scene as usable by a person: free cells within the radar's range window and the camera's view.

Geometry on the floor: directions, distances and random choices among positions (x, y) in metres.
"""

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from jaxtyping import Bool, Float

from mmweaver.core.aligned_photo import AlignedPhoto
from mmweaver.core.errors import InputError
from mmweaver.core.records import Scene
from mmweaver.motion.language.places import Place
from mmweaver.motion.language.plan import Direction


def unit_vector(angle_rad: float) -> Float[np.ndarray, "2"]:
    """Unit vector (x, y) at an angle in radians from +x towards +y."""
    return np.array([np.cos(angle_rad), np.sin(angle_rad)])


def bearing_rad(vector: Any) -> float:
    """Angle of a vector (x, y) from +x towards +y, in radians."""
    return float(np.arctan2(vector[1], vector[0]))


def distance_m(one: Any, other: Any) -> float:
    """Distance between two positions (x, y), in metres."""
    return float(np.hypot(*(np.asarray(one) - np.asarray(other))))


def distances_m(positions: Float[np.ndarray, "position 2"], other: Any) -> Float[np.ndarray, " position"]:
    """Distance of each of many positions to another one.

    Args:
        positions: Positions (x, y) in metres, (position, 2).
        other: Position (x, y) in metres.

    Returns:
        Metres, (position,).
    """
    return np.hypot(*(positions - np.asarray(other)).T)


def random_sign(rng: np.random.Generator) -> float:
    """Samples -1 or 1."""
    return float(rng.choice([-1.0, 1.0]))


def random_choice(options: Any, rng: np.random.Generator) -> Any:
    """Samples one of a sequence, or of an array's rows, uniformly."""
    return options[int(rng.integers(len(options)))]


Array = np.ndarray
Positions = Float[Array, "*shape 2"]

BODY_RADIUS_M = 0.25  # half the width of the shoulders
SIDEWAYS_RADIUS_M = 0.15  # half the depth of the trunk
AZIMUTH_LIMIT_RAD = np.radians(40.0)
TORSO_HEIGHT = 0.68  # of the body's height
TORSO_HALF_DEPTH_M = 0.2
_UNSEEN_COST = 1.5  # cost of a position whose floor is assumed, not measured
_OFF_GRID_COST = 3.0
_MAX_STARTS, _FARTHEST_M = 300, 4.0  # places with tabulated straight paths, and their maximum length
_STEP_M = 0.04  # between the positions at which a path is tested
_SEAT_EDGE_M = 0.05  # clearance next to the seat that the body leaves
_AHEAD_DEG = 12.0  # no cost up to this azimuth: the antenna beam is strongest at boresight
HEIGHT_STEP_M, _MAX_CACHED = 0.05, 12
_latest: list["FloorMap"] = []


def _is_same_room(one: Scene, other: Scene) -> bool:
    """Whether two scenes differ at most by their landmarks."""
    same = one.vertices_m is other.vertices_m and one.free_space is other.free_space and one.photo is other.photo
    return same and one.seats is other.seats


@dataclass(frozen=True)
class FloorMap:
    """Clearance, visibility and cost of positions (x, y) in metres in the radar's frame, from the free-space grid.

    Attributes:
        scene: The room.
        range_window_m: Nearest and farthest slant range in metres that the radar keeps.
        height_m: Height of the body in metres.
        with_assumed: Whether assumed floor counts as free.
        is_tight: Whether a body that kneels, lies or stands in a gap may touch furniture.
    """

    scene: Scene
    range_window_m: tuple[float, float]
    height_m: float
    with_assumed: bool = False
    is_tight: bool = False

    @classmethod
    def of(
        cls,
        scene: Scene,
        range_window_m: tuple[float, float],
        height_m: float,
        *,
        with_assumed: bool = False,
        is_tight: bool = False,
    ) -> "FloorMap":
        """The map for a body of about this height; recent ones are cached, since many motions are placed in one scene.

        Heights are rounded to `HEIGHT_STEP_M`, which moves the visible region by less than a cell.

        Args:
            scene: The room, in the radar's frame.
            range_window_m: Nearest and farthest slant range in metres that the radar keeps.
            height_m: Height of the body in metres.
            with_assumed: Whether assumed floor counts as free.
            is_tight: Whether the body may touch furniture.
        """
        height_m = round(height_m / HEIGHT_STEP_M) * HEIGHT_STEP_M
        key = (range_window_m, height_m, with_assumed, is_tight)
        for floor in _latest:
            if floor.scene is scene and floor._key == key:
                return floor
        floor = cls(scene, *key)
        for other in _latest:  # the same room with other landmarks
            if other._key == key and _is_same_room(other.scene, scene):
                own = {name: value for name, value in vars(other).items() if name not in ("scene", "place_cells")}
                vars(floor).update(own)
                break
        _latest[:] = [floor, *(other for other in _latest if _is_same_room(other.scene, scene))][:_MAX_CACHED]
        return floor

    @property
    def _key(self) -> tuple[tuple[float, float], float, bool, bool]:
        return self.range_window_m, self.height_m, self.with_assumed, self.is_tight

    @cached_property
    def cell_m(self) -> float:
        x = self.scene.free_space.x_m
        return float(x[1] - x[0]) if len(x) > 1 else 0.1

    @cached_property
    def is_free(self) -> Bool[Array, "y x"]:
        """Free cells, including assumed floor with `with_assumed`."""
        free = self.scene.free_space
        return free.is_free if not self.with_assumed or free.is_assumed is None else free.is_free | free.is_assumed

    @cached_property
    def cell_centres_m(self) -> Float[Array, "y x 2"]:
        """Centres (x, y) of the cells in metres."""
        free = self.scene.free_space
        return np.stack(np.meshgrid(free.x_m, free.y_m), axis=-1).astype(float)

    @cached_property
    def clearance_m(self) -> Float[Array, "y x"]:
        """Distance in metres to the nearest cell that is not free; outside the grid nothing is free."""
        from scipy.ndimage import distance_transform_edt

        padded = np.pad(self.is_free, 1)
        cells = np.asarray(distance_transform_edt(padded), dtype=float)[1:-1, 1:-1]
        return np.maximum(cells - 0.5, 0.0) * self.cell_m

    @cached_property
    def place_cells(self) -> dict[Place, Float[Array, "cell 2"]]:
        """Walkable cells (x, y) in metres of the places named in a plan; filled by `placement`."""
        return {}

    @cached_property
    def seat_approaches(self) -> list[list[Any]]:
        """Approaches to the seats; filled by `approaches`."""
        return []

    @cached_property
    def in_view(self) -> Bool[Array, "y x"]:
        """Whether a body standing in a cell is visible to radar and camera."""
        return self.sees(self.cell_centres_m)

    @cached_property
    def walkable(self) -> Bool[Array, "y x"]:
        """Whether a body can stand in a cell: enough clearance, and in view; sideways on a tight floor without any."""
        is_wide = (self.clearance_m >= BODY_RADIUS_M) & self.in_view
        if self.is_tight and not is_wide.any():
            return (self.clearance_m >= SIDEWAYS_RADIUS_M) & self.in_view
        return is_wide

    @cached_property
    def walkable_m(self) -> Float[Array, "cell 2"]:
        """Centres (x, y) of the walkable cells in metres."""
        return self.cell_centres_m[self.walkable]

    @cached_property
    def cell_cost(self) -> Float[Array, "y x"]:
        """Soft cost of a cell: unmeasured floor, off the radar's axis, feet or head outside range window or picture."""
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
        """Share of the floor under a body that was assumed, not measured."""
        from scipy.ndimage import uniform_filter

        across = 2 * round(BODY_RADIUS_M / self.cell_m) + 1
        return np.asarray(uniform_filter((~self.scene.free_space.is_seen).astype(float), across, mode="nearest"))

    def sees(self, positions_m: Positions) -> Bool[Array, "*shape"]:
        """Whether a torso is in the range window, within 40 degrees of boresight, and within the picture's width.

        Args:
            positions_m: Positions (x, y) in metres, (..., 2).

        Returns:
            Mask of the positions.
        """
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

    def _cells(self, positions_m: Positions) -> tuple[Any, Any]:
        """Row and column (*shape,) of each position in a table with a border of one cell around the grid."""
        rows, columns = self.scene.free_space.is_free.shape
        scaled = positions_m * (1.0 / self.cell_m) + self._first_cell
        column = np.minimum(np.maximum(scaled[..., 0], 0.0), columns + 1).astype(np.intp)
        row = np.minimum(np.maximum(scaled[..., 1], 0.0), rows + 1).astype(np.intp)
        return row, column

    @cached_property
    def _first_cell(self) -> Float[Array, "2"]:
        free = self.scene.free_space
        return 1.5 - np.array([free.x_m[0], free.y_m[0]], dtype=float) / self.cell_m

    @cached_property
    def _bordered(self) -> tuple[Bool[Array, "y x"], Float[Array, "y x"], Float[Array, "y x"]]:
        """`walkable`, `clearance_m` and `cell_cost` with their values off the grid around them."""
        return (
            np.pad(self.walkable, 1),
            np.pad(self.clearance_m, 1),
            np.pad(self.cell_cost, 1, constant_values=_OFF_GRID_COST),
        )

    def can_stand(self, positions_m: Positions) -> Bool[Array, "*shape"]:
        """Whether a body can stand at each position.

        Args:
            positions_m: Positions (x, y) in metres, (..., 2).

        Returns:
            Mask of the positions; False off the grid.
        """
        return np.asarray(self._bordered[0][self._cells(positions_m)])

    def clearance_at(self, positions_m: Positions) -> Float[Array, "*shape"]:
        """Distance to the nearest cell that is not free.

        Args:
            positions_m: Positions (x, y) in metres, (..., 2).

        Returns:
            Metres, 0 off the grid.
        """
        return np.asarray(self._bordered[1][self._cells(positions_m)])

    def is_seen_floor(self, positions_m: Positions) -> Bool[Array, "*shape"]:
        """Whether the photo shows free floor at each position.

        Args:
            positions_m: Positions (x, y) in metres, (..., 2).

        Returns:
            Mask of the positions; False off the grid.
        """
        return np.asarray(self._seen_floor[self._cells(positions_m)])

    @cached_property
    def _seen_floor(self) -> Bool[Array, "y x"]:
        return np.pad(self.scene.free_space.is_free & self.scene.free_space.is_seen, 1)

    def cost_at(self, positions_m: Positions) -> Float[Array, "*shape"]:
        """`cell_cost` at each position.

        Args:
            positions_m: Positions (x, y) in metres, (..., 2).

        Returns:
            Cost of each position, 3 off the grid.
        """
        return np.asarray(self._bordered[2][self._cells(positions_m)])

    def free_length_m(
        self, position_m: Float[Array, "2"], direction_rad: float, wanted_m: float, excused_m: float = 0.0
    ) -> float:
        """Length of the free straight path from a position.

        Args:
            position_m: Position (x, y) in metres.
            direction_rad: Direction from +x towards +y.
            wanted_m: Maximum length in metres.
            excused_m: Distance in metres within which the body may be closer to furniture than its radius (the seat
                that it leaves).

        Returns:
            Metres, at most `wanted_m`.
        """
        return float(self.free_lengths_m(position_m, np.array([direction_rad]), wanted_m, excused_m)[0])

    def free_lengths_m(
        self,
        position_m: Float[Array, "2"],
        directions_rad: Float[Array, " way"],
        wanted_m: float,
        excused_m: float = 0.0,
    ) -> Float[Array, " way"]:
        """`free_length_m` in several directions.

        Args:
            position_m: Position (x, y) in metres.
            directions_rad: Directions (way,) from +x towards +y.
            wanted_m: Maximum length in metres.
            excused_m: As in `free_length_m`.

        Returns:
            Metres, (way,).
        """
        steps = np.append(np.arange(0.0, wanted_m, _STEP_M), wanted_m)
        ways = np.stack([np.cos(directions_rad), np.sin(directions_rad)], axis=-1)
        lines_m = position_m + steps[:, None] * ways[:, None]
        is_free = self.can_stand(lines_m)
        if excused_m:
            is_free |= (steps < excused_m) & (self.clearance_at(lines_m) > _SEAT_EDGE_M)
        first = np.argmin(is_free, axis=1)  # the first blocked one, 0 if all are free
        reached = steps[np.maximum(first - 1, 0)]
        return np.where(is_free.all(axis=1), wanted_m, reached)

    def are_free_ways(self, starts_m: Float[Array, "way 2"], ends_m: Float[Array, "way 2"]) -> Bool[Array, " way"]:
        """Whether a body can move straight from each start to its end.

        Args:
            starts_m: Starts (x, y) in metres, (way, 2).
            ends_m: Ends (x, y) in metres, (way, 2).

        Returns:
            Mask (way,).
        """
        gaps = ends_m - starts_m
        lengths, directions = np.hypot(*gaps.T), np.arctan2(gaps[:, 1], gaps[:, 0])
        longest = float(lengths.max(initial=0.0))
        steps = np.minimum(np.append(np.arange(0.0, longest, _STEP_M), longest), lengths[:, None])
        ways = np.stack([np.cos(directions), np.sin(directions)], axis=-1)
        return np.all(self.can_stand(starts_m[:, None] + steps[..., None] * ways[:, None]), axis=1)

    @cached_property
    def _starts(self) -> dict[Direction | None, tuple[Float[Array, "start 2"], Float[Array, " start"]]]:
        return {}

    def straight_starts(self, direction: Direction | None) -> tuple[Float[Array, "start 2"], Float[Array, " start"]]:
        """Walkable places with the length of their free straight path; cached, since walks of a room need the same few.

        Args:
            direction: left, right, towards or away (from the radar); None for the best of eight directions.

        Returns:
            Places (x, y) in metres, (start, 2), and lengths in metres, at most 4 m, (start,).
        """
        if direction not in self._starts:
            cells = self.walkable_m
            cells = cells[:: max(1, len(cells) // _MAX_STARTS)]
            radial = np.arctan2(cells[:, 1], cells[:, 0])
            ways = {"left": [np.pi + 0 * radial], "right": [0 * radial], "towards": [radial + np.pi], "away": [radial]}
            tried = ways.get(direction, [turn + 0 * radial for turn in np.arange(8) * np.pi / 4])
            free_m = [self._straight_m(cells, way) for way in tried]
            self._starts[direction] = (cells, np.max(free_m, axis=0) if len(cells) else np.zeros(0))
        return self._starts[direction]

    def _straight_m(
        self, places_m: Float[Array, "start 2"], directions_rad: Float[Array, " start"]
    ) -> Float[Array, " start"]:
        """Length in metres of the free straight path from each place in its direction."""
        steps = np.arange(0.0, _FARTHEST_M, 2 * _STEP_M)
        ways = np.stack([np.cos(directions_rad), np.sin(directions_rad)], axis=-1)
        is_free = self.can_stand(places_m[:, None] + steps[:, None] * ways[:, None])
        return np.where(is_free.all(axis=1), _FARTHEST_M, steps[np.maximum(np.argmin(is_free, axis=1) - 1, 0)])

    def longest_free_m(self, wanted_m: float) -> float:
        """Length of the longest straight path from some places in eight directions; cached.

        Args:
            wanted_m: Maximum length in metres.

        Returns:
            Metres, 0 without walkable floor.
        """
        if wanted_m not in self._longest_m:
            cells = self.walkable_m
            some = cells[:: max(1, len(cells) // 40)]
            angles = np.arange(8) * np.pi / 4
            free_m = (float(self.free_lengths_m(place, angles, wanted_m).max()) for place in some)
            self._longest_m[wanted_m] = max(free_m, default=0.0)
        return self._longest_m[wanted_m]

    @cached_property
    def _longest_m(self) -> dict[float, float]:
        return {}

    def nearest_walkable_m(self, position_m: Float[Array, "2"]) -> Float[Array, "2"] | None:
        """Centre of the nearest walkable cell.

        Args:
            position_m: Position (x, y) in metres.

        Returns:
            Centre (x, y) in metres; None if no cell is walkable.
        """
        positions_m = self.walkable_m
        if not len(positions_m):
            return None
        return positions_m[np.argmin(distances_m(positions_m, position_m))]

    def check_start(self, start_m: tuple[float, float]) -> None:
        """Checks that a motion can start at a position.

        Args:
            start_m: Position (x, y) in metres.

        Raises:
            InputError: If it is not walkable, naming the nearest walkable position.
        """
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
