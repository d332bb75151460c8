"""The pose of a further camera once both are level: a turn about the vertical and a place."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from mmweaver.core.records import FreeSpace, Landmark, Plane, Seat
from mmweaver.core.shapes import Array, Rotation, Vec3


@dataclass(frozen=True, kw_only=True)
class LevelPose:
    """From the level frame of a further camera to that of the first, in which the radar stands at the origin."""

    turn: Rotation  # about the vertical
    position_m: Vec3  # of the further camera

    def points(self, points_m: Float[Array, "*points 3"]) -> Float[Array, "*points 3"]:
        """Places in the first camera's level frame, metres."""
        return points_m @ self.turn.T + self.position_m

    def directions(self, vectors: Float[Array, "*points 3"]) -> Float[Array, "*points 3"]:
        """Directions in the first camera's level frame."""
        return vectors @ self.turn.T

    def turned(self, angle_rad: float) -> "LevelPose":
        """The camera at the same place, turned further, counterclockwise as seen from above."""
        return LevelPose(turn=about_vertical(angle_rad) @ self.turn, position_m=self.position_m)

    def moved(self, shift_m: Vec3) -> "LevelPose":
        """The camera turned alike, at another place."""
        return LevelPose(turn=self.turn, position_m=self.position_m + shift_m)

    @property
    def inverse(self) -> "LevelPose":
        """From the first camera's level frame to this one's."""
        return LevelPose(turn=self.turn.T, position_m=-self.turn.T @ self.position_m)

    @property
    def azimuth_rad(self) -> float:
        """How far the camera is turned, counterclockwise as seen from above."""
        return float(np.arctan2(self.turn[1, 0], self.turn[0, 0]))

    def plane(self, plane: Plane) -> Plane:
        """A plane in the first camera's level frame."""
        return Plane(
            kind=plane.kind, centre_m=self.points(plane.centre_m), normal=self.directions(plane.normal),
            axis_u=self.directions(plane.axis_u), axis_v=self.directions(plane.axis_v),
            half_size_m=plane.half_size_m, material=plane.material,
        )  # fmt: skip

    def seat(self, seat: Seat) -> Seat:
        """A seat in the first camera's level frame."""
        facing_rad = _wrapped(seat.facing_rad + self.azimuth_rad)
        return Seat(position_m=self.points(seat.position_m), facing_rad=facing_rad, size_m=seat.size_m)

    def landmark(self, landmark: Landmark) -> Landmark:
        """A landmark in the first camera's level frame."""
        x, y, _ = self.points(np.array([*landmark.approach_m, 0.0]))
        return Landmark(
            kind=landmark.kind, position_m=self.points(landmark.position_m), approach_m=(float(x), float(y)),
            facing_rad=_wrapped(landmark.facing_rad + self.azimuth_rad),
        )  # fmt: skip

    def looked_up(self, values: np.ndarray, of: FreeSpace, x_m: np.ndarray, y_m: np.ndarray) -> np.ndarray:
        """Values (y, x) of this camera's map of the floor at squares of the first camera's; False outside the map."""
        x, y = np.meshgrid(x_m, y_m)
        own = self.inverse.points(np.stack([x, y, np.zeros_like(x)], axis=-1))
        cell_m = of.x_m[1] - of.x_m[0]
        column = np.rint((own[..., 0] - of.x_m[0]) / cell_m).astype(int)
        row = np.rint((own[..., 1] - of.y_m[0]) / cell_m).astype(int)
        inside = (column >= 0) & (column < len(of.x_m)) & (row >= 0) & (row < len(of.y_m))
        return inside & values[np.where(inside, row, 0), np.where(inside, column, 0)]


AT_FIRST = LevelPose(turn=np.eye(3), position_m=np.zeros(3))


def about_vertical(angle_rad: float) -> Rotation:
    """The rotation counterclockwise as seen from above."""
    cosine, sine = np.cos(angle_rad), np.sin(angle_rad)
    return np.array([[cosine, -sine, 0.0], [sine, cosine, 0.0], [0.0, 0.0, 1.0]])


def _wrapped(angle_rad: float) -> float:
    return float(np.angle(np.exp(1j * angle_rad)))
