"""Ground truth of a procedural room in the radar's frame: materials, planes, free floor, seats and landmarks."""

from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import numpy as np
from jaxtyping import Float

from mmweaver.core.records import FreeSpace, Landmark, Plane, Seat
from mmweaver.core.shapes import Array, Vec3
from mmweaver.scene.layout.height_map import grid_axes
from mmweaver.scene.procedural.arrangement import Shell, covered
from mmweaver.scene.procedural.palette import Palette
from mmweaver.scene.procedural.parts import Boxes, Part, PlacedPiece

_MIN_FACE_M2 = 0.15  # of furniture, to count as a flat rectangle of the room
_MIN_DISTANCE_M = 0.5  # of a body from the radar
_REACH_M = 0.45  # distance from which a landmark is used


class RadarFrame:
    """Transform from the room's frame (z = 0 on the floor) to the radar's.

    Args:
        shell: The room with the radar in it.
    """

    def __init__(self, shell: Shell):
        cosine, sine = np.cos(shell.radar_yaw_rad), np.sin(shell.radar_yaw_rad)
        self.room_from_radar = np.array([[cosine, -sine, 0.0], [sine, cosine, 0.0], [0.0, 0.0, 1.0]])
        self.origin_m = np.array(shell.radar_m, float)
        self.yaw_rad = shell.radar_yaw_rad

    def points(self, room_m: Float[Array, "*n 3"]) -> Float[Array, "*n 3"]:
        """Transforms points (..., 3) in metres."""
        return (room_m - self.origin_m) @ self.room_from_radar

    def vectors(self, room: Float[Array, "*n 3"]) -> Float[Array, "*n 3"]:
        """Rotates directions (..., 3)."""
        return room @ self.room_from_radar

    def angle(self, room_rad: float) -> float:
        """Transforms an azimuth in radians, from +x towards +y; the result is in -pi to pi."""
        return float(np.angle(np.exp(1j * (room_rad - self.yaw_rad))))

    def boxes(self, boxes: Boxes) -> Boxes:
        """Transforms centres and yaw of boxes."""
        return replace(boxes, centre_m=self.points(boxes.centre_m), yaw_rad=boxes.yaw_rad - self.yaw_rad)

    def plane(
        self, kind: str, centre_m: Any, normal: Vec3, axis_u: Vec3, half_m: tuple[float, float], material: str
    ) -> Plane:
        """Makes a plane in the radar's frame.

        Args:
            kind: Kind of the plane, as in `Plane`.
            centre_m: Centre in the room's frame, metres.
            normal: Unit normal in the room's frame.
            axis_u: First axis in the room's frame; the second is normal x axis_u.
            half_m: Half sizes along the axes, metres.
            material: Name of the material.
        """
        normal, axis_u = self.vectors(normal), self.vectors(axis_u)
        return Plane(
            kind=kind,
            centre_m=self.points(np.array(centre_m, float)),
            normal=normal,
            axis_u=axis_u,
            axis_v=np.cross(normal, axis_u),
            half_size_m=half_m,
            material=material,
        )


def planes_of(shell: Shell, placed: tuple[PlacedPiece, ...], palette: Palette, frame: RadarFrame) -> tuple[Plane, ...]:
    """Floor, ceiling, walls, and the large faces of box-shaped furniture, as tops and panels.

    Args:
        shell: The room.
        placed: All pieces in it.
        palette: Surfaces, for the materials of the shell.
        frame: Transform to the radar's frame.

    Returns:
        Planes in the radar's frame, floor first; faces of furniture count from 0.15 m2.
    """
    w, d, h = shell.size_m
    x, y, z = np.eye(3)
    shell_planes = (
        ("floor", (w / 2, d / 2, 0.0), z, x, (w / 2, d / 2)),
        ("ceiling", (w / 2, d / 2, h), -z, x, (w / 2, d / 2)),
        ("wall", (w / 2, d, h / 2), -y, x, (w / 2, h / 2)),
        ("wall", (0.0, d / 2, h / 2), x, y, (d / 2, h / 2)),
        ("wall", (w, d / 2, h / 2), -x, y, (d / 2, h / 2)),
        ("wall", (w / 2, 0.0, h / 2), y, x, (w / 2, h / 2)),
    )
    found = [frame.plane(*row, palette[row[0]].material) for row in shell_planes]
    boxes = ((item, part) for item in placed for part in item.piece.parts if part.shape == "box")
    return (*found, *(face for item, part in boxes for face in _faces(item, part, frame)))


def _faces(item: PlacedPiece, part: Part, frame: RadarFrame) -> Iterator[Plane]:
    """The large faces of a box, except the lower one."""
    low, high, unit = np.array(part.low_m), np.array(part.high_m), np.eye(3)
    half, middle = (high - low) / 2, (low + high) / 2
    for axis, sign, along in ((2, 1.0, 0), (0, 1.0, 1), (0, -1.0, 1), (1, 1.0, 0), (1, -1.0, 0)):
        size = (float(half[along]), float(half[3 - axis - along]))
        if 4 * size[0] * size[1] >= _MIN_FACE_M2:
            ends = item.points(
                np.stack([middle + sign * half[axis] * unit[axis], sign * unit[axis], unit[along], 0 * low])
            )
            kind = "top" if axis == 2 else "panel"
            yield frame.plane(kind, ends[0], ends[1] - ends[3], ends[2] - ends[3], size, part.appearance.material)


def seats_of(placed: tuple[PlacedPiece, ...], frame: RadarFrame) -> tuple[Seat, ...]:
    """All seats of the furniture.

    Args:
        placed: All pieces in the room.
        frame: Transform to the radar's frame.

    Returns:
        Seats in the radar's frame, facing the front of their piece.
    """
    return tuple(
        Seat(
            position_m=frame.points(item.points(np.array([[seat.x_m, seat.y_m, seat.height_m]]))[0]),
            facing_rad=frame.angle(item.yaw_rad - np.pi / 2),
            size_m=(seat.width_m, seat.depth_m),
        )
        for item in placed
        for seat in item.piece.seats
    )


def landmarks_of(placed: tuple[PlacedPiece, ...], free: FreeSpace, frame: RadarFrame) -> tuple[Landmark, ...]:
    """Doors, windows, tables, beds and counters, approached from the front or from the side with the most room.

    Args:
        placed: All pieces in the room.
        free: Free floor in the radar's frame.
        frame: Transform to the radar's frame.

    Returns:
        Landmarks in the radar's frame.
    """
    found = []
    for item in placed:
        if not item.piece.landmark:
            continue
        low, high = item.piece.low_m, item.piece.high_m
        middle = (low + high) / 2
        best_share, approach, facing = -np.inf, middle, middle
        for side, (u, v) in enumerate(((0, -1), (0, 1), (1, 0), (-1, 0))[: 1 if item.piece.on_wall else 4]):
            ahead = np.array([u, v, 0.0])
            stand = middle + ahead * ((high - low) / 2 + _REACH_M)
            stand[2] = 0.0
            place, before = frame.points(item.points(np.stack([stand, stand - ahead])))
            share = _free_share(free, place[:2])
            if share > best_share + 0.1 * side:
                best_share, approach, facing = share, place, before - place
        found.append(
            Landmark(
                kind=item.piece.landmark,
                position_m=frame.points(item.points(middle[None]))[0],
                approach_m=(float(approach[0]), float(approach[1])),
                facing_rad=float(np.arctan2(facing[1], facing[0])),
            )
        )
    return tuple(found)


def _free_share(free: FreeSpace, place: Float[Array, "2"]) -> float:
    """Share of the squares within a body's reach of a place that are free."""
    x, y = np.meshgrid(free.x_m - place[0], free.y_m - place[1])
    near = np.hypot(x, y) < 0.28
    return float(free.is_free[near].mean()) if near.any() else 0.0


def free_space_of(shell: Shell, boxes: Boxes, frame: RadarFrame) -> FreeSpace:
    """Free floor on the grid of reconstructed scenes, all marked as seen.

    Args:
        shell: The room.
        boxes: Boxes of all pieces in the radar's frame.
        frame: Transform to the radar's frame.

    Returns:
        Floor inside the room that no box covers, more than half a metre from the radar.
    """
    x_m, y_m = grid_axes()
    above = replace(boxes, centre_m=boxes.centre_m + np.array([0.0, 0.0, shell.radar_m[2]]))
    x, y = np.meshgrid(x_m, y_m)
    in_room = np.stack([x, y, np.zeros_like(x)], axis=-1) @ frame.room_from_radar.T + frame.origin_m
    inside = (in_room[..., 0] > 0) & (in_room[..., 0] < shell.size_m[0])
    inside &= (in_room[..., 1] > 0) & (in_room[..., 1] < shell.size_m[1])
    is_free = inside & ~covered(above, x_m, y_m) & (np.hypot(x, y) > _MIN_DISTANCE_M)
    return FreeSpace(x_m=x_m, y_m=y_m, is_free=is_free, is_seen=is_free.copy())
