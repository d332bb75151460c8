"""The kinds of rooms from rooms.toml: size, surfaces and furniture."""

from dataclasses import dataclass
from typing import Any

from mmweaver.core.registry import Registry
from mmweaver.scene.procedural.palette import TABLES

Range = tuple[float, float]


@dataclass(frozen=True, kw_only=True)
class RoomKind:
    """What rooms of a kind are sampled from.

    Attributes:
        name: Name of the kind.
        width_m: Range of the inner width in metres.
        walls: Kinds of walls to choose from.
        floors: Kinds of floors to choose from.
        required: Groups of furniture that are placed in any case, in this order.
        optional: Probability and name of further groups.
        wall_distance_m: Range of the distance from the radar to the wall that it faces.
        num_windows: Number of windows.
    """

    name: str
    width_m: Range
    walls: tuple[str, ...]
    floors: tuple[str, ...]
    required: tuple[str, ...]
    optional: tuple[tuple[float, str], ...]
    wall_distance_m: Range = (2.9, 3.35)
    num_windows: int = 1


def _room_kind(name: str, *, small_objects: bool = True, optional: tuple, **row: Any) -> RoomKind:
    """Makes a kind from a row of [kinds] in rooms.toml."""
    return RoomKind(name=name, optional=optional + (TABLES["small_objects"] if small_objects else ()), **row)


KINDS: Registry[RoomKind] = Registry(
    "kind of room", [(name, _room_kind(name, **row)) for name, row in TABLES["kinds"].items()]
)
