"""Building blocks of furniture: boxes, rounded boxes and cylinders, composed to pieces that are placed in a room."""

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from jaxtyping import Bool, Float

from mmweaver.core.shapes import Array

Colour = tuple[float, float, float]
Point = tuple[float, float, float]
_MANY_PARTS = 24
OVERLAP_M = 0.0005  # a smaller penetration is contact


@dataclass(frozen=True)
class Appearance:
    """Material appearance of a surface: colour in linear RGB, texture, radar material, and COCO-Stuff class."""

    colour: Colour
    material: str
    coco: str = ""
    pattern: str = "plain"  # a name in textures.PATTERNS
    emission: float = 0.0  # relative to the colour
    is_glass: bool = False  # depth cameras mostly measure nothing


@dataclass(frozen=True)
class Part:
    """A primitive inscribed in the box from `low_m` to `high_m` in the piece's own frame."""

    low_m: Point
    high_m: Point
    appearance: Appearance
    shape: str = "box"  # box | rounded | cylinder | cone


@dataclass(frozen=True)
class LocalSeat:
    """A seat of a piece, in its own frame; the sitter faces the piece's front (-y)."""

    x_m: float
    y_m: float
    height_m: float
    width_m: float
    depth_m: float


@dataclass(frozen=True, kw_only=True)
class Piece:
    """A piece of furniture in its own frame: origin on the floor, front towards -y, z up."""

    name: str
    parts: tuple[Part, ...]
    seats: tuple[LocalSeat, ...] = ()
    landmark: str = ""  # Landmark.kind, if it is a landmark
    on_wall: bool = False  # mounted on a wall at y = 0
    is_free: bool = False  # stands anywhere in a room, not only at a wall
    sizes: dict[str, Any] = field(
        default_factory=dict, repr=False, compare=False
    )  # as sampled, by their record's names

    @property
    def low_m(self) -> Float[Array, "3"]:
        return np.min([part.low_m for part in self.parts], axis=0)

    @property
    def high_m(self) -> Float[Array, "3"]:
        return np.max([part.high_m for part in self.parts], axis=0)

    @property
    def half_m(self) -> float:
        """Half the width, metres."""
        return float(self.high_m[0])

    @property
    def back_m(self) -> float:
        """From the origin to the back, metres."""
        return float(self.high_m[1])

    @property
    def depth_m(self) -> float:
        """From the origin to the front, metres."""
        return -float(self.low_m[1])

    @property
    def top_m(self) -> float:
        """Height of the surface for objects, metres: the highest top of a box that is larger than 0.1 m2."""
        sizes = [(part, np.subtract(part.high_m, part.low_m)) for part in self.parts if part.shape == "box"]
        return max((part.high_m[2] for part, size in sizes if size[0] * size[1] > 0.1), default=0.0)


@dataclass(frozen=True, kw_only=True)
class PlacedPiece:
    """A piece in the room: position of its origin, and rotation about the vertical."""

    piece: Piece
    x_m: float
    y_m: float
    z_m: float = 0.0
    yaw_rad: float = 0.0

    def transformed(self, x_m: float, y_m: float, yaw_rad: float) -> "PlacedPiece":
        """Transforms the piece from its group's frame: rotation by `yaw_rad`, then translation to (x, y)."""
        cosine, sine = float(np.cos(yaw_rad)), float(np.sin(yaw_rad))
        return PlacedPiece(
            piece=self.piece,
            x_m=x_m + cosine * self.x_m - sine * self.y_m,
            y_m=y_m + sine * self.x_m + cosine * self.y_m,
            z_m=self.z_m,
            yaw_rad=self.yaw_rad + yaw_rad,
        )

    def points(self, local_m: Float[Array, "*point 3"]) -> Float[Array, "*point 3"]:
        """Transforms points from the piece's own frame to the room's.

        Args:
            local_m: Points in metres, (..., 3).

        Returns:
            Points in the room's frame, metres, same shape.
        """
        cosine, sine = np.cos(self.yaw_rad), np.sin(self.yaw_rad)
        rotation = np.array([[cosine, -sine, 0.0], [sine, cosine, 0.0], [0.0, 0.0, 1.0]])
        return local_m @ rotation.T + np.array([self.x_m, self.y_m, self.z_m])


@dataclass(frozen=True, kw_only=True)
class Boxes:
    """Boxes rotated about the vertical, one row each."""

    centre_m: Float[Array, "box 3"]
    half_m: Float[Array, "box 3"]
    yaw_rad: Float[Array, " box"]
    names: tuple[str, ...] = field(default=())  # of the pieces they belong to
    piece: tuple[int, ...] = field(default=())  # index of the piece in the room

    def __len__(self) -> int:
        return len(self.centre_m)

    def corners_m(self) -> Float[Array, "box 4 2"]:
        """Corners (x, y) of the footprints in metres, (box, 4, 2)."""
        signs = np.array([(-1, -1), (1, -1), (1, 1), (-1, 1)])
        local = signs * self.half_m[:, None, :2]
        cosine, sine = np.cos(self.yaw_rad)[:, None], np.sin(self.yaw_rad)[:, None]
        x = cosine * local[..., 0] - sine * local[..., 1]
        y = sine * local[..., 0] + cosine * local[..., 1]
        return np.stack([x, y], axis=-1) + self.centre_m[:, None, :2]

    def overlap(self, other: "Boxes", slack_m: float = 0.0) -> Bool[Array, "box other"]:
        """Pairwise overlap by the separating-axis theorem in the plane and the interval in height.

        Args:
            other: Other boxes.
            slack_m: Penetration in metres that does not count; if negative, the gap below which boxes count as
                overlapping.

        Returns:
            Mask (box, other).
        """
        gap = np.abs(self.centre_m[:, None, 2] - other.centre_m[None, :, 2])
        is_separate = gap >= self.half_m[:, None, 2] + other.half_m[None, :, 2] - slack_m
        shape = (len(self), len(other), 2, 2)
        for axes in (_axes(self.yaw_rad)[:, None], _axes(other.yaw_rad)[None, :]):
            one, two = (
                np.einsum(f"{box}cx,abkx->abkc", boxes.corners_m(), np.broadcast_to(axes, shape))
                for box, boxes in (("a", self), ("b", other))
            )
            gaps = np.maximum(one.min(-1) - two.max(-1), two.min(-1) - one.max(-1))
            is_separate |= (gaps >= -slack_m).any(-1)
        return ~is_separate


def _axes(yaw_rad: Float[Array, " box"]) -> Float[Array, "box 2 2"]:
    """The two horizontal unit axes of each box."""
    cosine, sine = np.cos(yaw_rad), np.sin(yaw_rad)
    return np.stack([np.stack([cosine, sine], -1), np.stack([-sine, cosine], -1)], axis=1)


def part_boxes(placed: Sequence[PlacedPiece]) -> Boxes:
    """Boxes of all parts of the given pieces.

    Args:
        placed: Pieces with their positions.

    Returns:
        One box per part in the room's frame.
    """
    rows = [(number, item, part) for number, item in enumerate(placed) for part in item.piece.parts]
    low_m, high_m, origin_m = (
        np.array(values, float).reshape(-1, 3)
        for values in (
            [part.low_m for *_, part in rows],
            [part.high_m for *_, part in rows],
            [(item.x_m, item.y_m, item.z_m) for _, item, _ in rows],
        )
    )
    yaw_rad, local = np.array([item.yaw_rad for _, item, _ in rows], float), (low_m + high_m) / 2
    x = np.cos(yaw_rad) * local[:, 0] - np.sin(yaw_rad) * local[:, 1]
    y = np.sin(yaw_rad) * local[:, 0] + np.cos(yaw_rad) * local[:, 1]
    return Boxes(
        centre_m=np.stack([x, y, local[:, 2]], axis=1) + origin_m,
        half_m=(high_m - low_m) / 2,
        yaw_rad=yaw_rad,
        names=tuple(item.piece.name for _, item, _ in rows),
        piece=tuple(number for number, *_ in rows),
    )


def bounding_boxes(placed: Sequence[PlacedPiece]) -> Boxes:
    """Boxes of all parts; pieces with more than 24 parts (shelves full of books) are represented by their bounding box.

    Args:
        placed: Pieces with their positions.

    Returns:
        Boxes in the room's frame.
    """
    whole = []
    for item in placed:
        piece = item.piece
        if len(piece.parts) > _MANY_PARTS:
            low, high = (tuple(end.tolist()) for end in (piece.low_m, piece.high_m))
            piece = replace(piece, parts=(Part(low, high, piece.parts[0].appearance),))
        whole.append(replace(item, piece=piece))
    return part_boxes(whole)
