"""Arranges furniture by rejection sampling: groups at walls and in the middle, without overlap, with room to walk.

Room frame: x along the wall that the radar faces, y towards it, z up; origin in the corner behind the radar on its
left.

The kinds of rooms from rooms.toml: size, surfaces and furniture.

Groups of furniture that stand together, from the [groups] of furniture.toml.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from jaxtyping import Bool, Float

from mmweaver.core.registry import Registry
from mmweaver.core.shapes import Array
from mmweaver.scene.procedural.furniture import RECORDS, Builder, evaluate, make_piece
from mmweaver.scene.procedural.palette import TABLES, Palette
from mmweaver.scene.procedural.parts import OVERLAP_M, Boxes, Part, Piece, PlacedPiece, bounding_boxes

WALL, BACK, MIDDLE = "wall", "back", "middle"
_GROUPS_MAX_DRAWS = 20
GAP_M = 0.02  # between furniture and the wall behind it


@dataclass(frozen=True, kw_only=True)
class FurnitureGroup:
    """Pieces in the group's own frame, and where in a room the group may stand."""

    items: tuple[PlacedPiece, ...]
    site: str = WALL  # wall (any), back, middle


def sample_group(name: str, palette: Palette, rng: np.random.Generator) -> FurnitureGroup:
    """Samples a group, or a single piece, until its pieces do not penetrate each other.

    Args:
        name: Name of the group's record, or of the piece's.
        palette: Surfaces by name.
        rng: Random stream of sizes and positions.

    Returns:
        The group in its own frame.

    Raises:
        RuntimeError: If the pieces overlap in 20 samples.
    """
    for _ in range(_GROUPS_MAX_DRAWS):
        if name in RECORDS["groups"]:
            record = RECORDS["groups"][name]
            items, site = _placed(record, palette, rng), record.get("site", WALL)
        else:
            piece = make_piece(name, palette, rng)
            stands_back = not (piece.on_wall or piece.is_free)
            items = [PlacedPiece(piece=piece, x_m=0.0, y_m=-float(piece.high_m[1]) - GAP_M if stands_back else 0.0)]
            site = MIDDLE if piece.is_free else WALL
        boxes = bounding_boxes(items)
        number = np.array(boxes.piece)
        if not (boxes.overlap(boxes, OVERLAP_M) & (number[:, None] != number[None, :])).any():
            return FurnitureGroup(items=tuple(items), site=site)
    raise RuntimeError(f"the pieces of {name!r} always overlap")


def _placed(record: dict[str, Any], palette: Palette, rng: np.random.Generator) -> list[PlacedPiece]:
    """Makes and places the pieces of a group's record in order."""
    draw = Builder(palette, rng, "")
    known = draw.sampled(record.get("sizes", {}))
    items = []
    for piece_name, *place, options in (
        (*row, {}) if not isinstance(row[-1], dict) else row for row in record["items"]
    ):
        name = options.get("name", piece_name.replace(" ", "_"))
        known[name] = False
        if ("chance" in options and not draw.chance(options["chance"])) or not evaluate(options.get("if", "1"), known):
            continue
        known["drawn"] = draw.uniform(*options["draw"]) if "draw" in options else None
        sizes = {size: evaluate(value, known) for size, value in options.get("sizes", {}).items()}
        piece = make_piece(piece_name, palette, rng, **sizes)
        known |= {f"{name}_{size}": value for size, value in piece.sizes.items()} | {name: True}
        known |= {f"{name}_{size}": getattr(piece, size) for size in ("half_m", "depth_m", "back_m", "top_m")}
        known |= draw.sampled(options.get("then", {}))
        if options.get("wall"):
            place = [*(place or [0.0]), -float(piece.high_m[1]) - GAP_M]
        values = (evaluate(value, known) for value in (*place, *[0.0] * (4 - len(place))))
        x, y, z, turn = (float(draw.uniform(*v) if isinstance(v, tuple) else v) for v in values)
        turn += draw.uniform(-options["sway"], options["sway"]) if "sway" in options else 0.0
        known |= {f"{name}_x_m": x, f"{name}_y_m": y}
        items.append(PlacedPiece(piece=piece, x_m=x, y_m=y, z_m=z, yaw_rad=float(np.deg2rad(turn))))
    return items


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


HEAD_M, STEP_OVER_M = 1.9, 0.03  # what stands between these heights obstructs a walker
BODY_RADIUS_M = 0.25
WINDOW_M = (0.7, 3.45)  # ground distance covered by the radar's range bins
HALF_VIEW_RAD = float(np.deg2rad(38))
MIN_FREE_M2, MIN_WALKABLE_M2 = 2.0, 0.8
CELL_M = 0.05
_MAX_DRAWS, _NUM_CANDIDATES, _MAX_ATTEMPTS, _ATTEMPTS_PER_SHELL = 60, 5, 150, 15


@dataclass(frozen=True, kw_only=True)
class Shell:
    """The empty room in its own frame (z = 0 on the floor) and the radar in it."""

    size_m: tuple[float, float, float]  # inner width, depth, height
    openings: tuple[Piece, ...]  # door and windows
    lamp: Piece
    fixed: tuple[PlacedPiece, ...]  # lamps and, once placed, doors and windows
    radar_m: tuple[float, float, float]
    radar_yaw_rad: float  # from +y towards -x


def sample_shell(kind: RoomKind, palette: Palette, rng: np.random.Generator, layout: np.random.Generator) -> Shell:
    """Samples the empty room.

    Args:
        kind: Kind of room: ranges of its size, number of windows.
        palette: Surfaces by name.
        rng: Random stream of size, door and windows.
        layout: Random stream of the radar's position and yaw.

    Returns:
        The shell; doors and windows are not placed yet.
    """
    behind = float(rng.uniform(0.3, 1.4))
    size = (
        float(rng.uniform(*kind.width_m)),
        behind + float(rng.uniform(*kind.wall_distance_m)),
        float(rng.uniform(2.4, 2.8)),
    )
    openings = [make_piece(name, palette, rng) for name in ("door", *["window"] * kind.num_windows)]
    empty = Shell(
        size_m=size,
        openings=tuple(openings),
        lamp=make_piece("ceiling lamp", palette, rng),
        fixed=(),
        radar_m=(size[0] / 2, behind, float(layout.uniform(0.5, 1.5))),
        radar_yaw_rad=0.0,
    )
    return place_radar(empty, layout)


def place_radar(shell: Shell, rng: np.random.Generator) -> Shell:
    """Samples the radar's position in the middle third of the room and its yaw of up to 14 degrees; less in a corridor.

    Args:
        shell: The room; the radar's distance from the back wall and its height are kept.
        rng: Random stream.

    Returns:
        The shell with the radar moved.
    """
    narrow = shell.size_m[0] < 2.6
    across = rng.uniform(0.42, 0.58) if narrow else rng.uniform(0.32, 0.68)
    yaw_deg = rng.uniform(-5, 5) if narrow else rng.uniform(-14, 14)
    _, y, z = shell.radar_m
    return replace(shell, radar_m=(shell.size_m[0] * float(across), y, z), radar_yaw_rad=float(np.deg2rad(yaw_deg)))


def place_openings(shell: Shell, rng: np.random.Generator) -> Shell:
    """Samples positions of door and windows in the walls, and adds lamps.

    Args:
        shell: The room with its openings.
        rng: Random stream.

    Returns:
        The shell with `fixed` filled; an opening that finds no position is omitted.
    """
    width, depth, height = shell.size_m
    fixed = [PlacedPiece(piece=shell.lamp, x_m=width / 2, y_m=y * depth, z_m=height) for y in (0.3, 0.75)]
    for piece in shell.openings:
        for _ in range(_MAX_DRAWS):
            wall = ("left", "right", "back")[int(rng.choice(3, p=(0.35, 0.35, 0.3)))]
            nearest = shell.radar_m[1] + 0.9
            along = float(rng.uniform(0.5, width - 0.5) if wall == "back" else rng.uniform(nearest, depth - 0.5))
            candidate = _moved_to_wall((PlacedPiece(piece=piece, x_m=0.0, y_m=0.0),), wall, along, shell.size_m)
            if (
                _fits(bounding_boxes(candidate), shell.size_m)
                and not bounding_boxes(candidate).overlap(bounding_boxes(fixed), -0.15).any()
            ):
                fixed += candidate
                break
    return replace(shell, fixed=tuple(fixed))


def arrange(
    kind: RoomKind, shell: Shell, wanted: Sequence[tuple[FurnitureGroup, bool]], rng: np.random.Generator
) -> tuple[Shell, tuple[PlacedPiece, ...], tuple[float, float]]:
    """Places door and windows, then the groups of furniture, while keeping floor free.

    After 15 failed attempts the radar is moved for each further one, and every 15 attempts the room is widened by 0.25
    m.

    Args:
        kind: Kind of room, for the error message.
        shell: The empty room.
        wanted: Groups of furniture, each with whether it is required.
        rng: Random stream.

    Returns:
        The shell, the placed pieces, and the areas of `free_floor_m2`.

    Raises:
        RuntimeError: If all 150 attempts fail, which has not been observed.
    """
    for attempt in range(_MAX_ATTEMPTS):
        if attempt >= _ATTEMPTS_PER_SHELL:
            width, depth, height = shell.size_m
            wider = 0.25 if attempt % _ATTEMPTS_PER_SHELL == 0 and attempt > _ATTEMPTS_PER_SHELL else 0.0
            shell = place_radar(replace(shell, size_m=(width + wider, depth, height)), rng)
        furnished = place_openings(shell, rng)
        placed = _try_once(furnished, wanted, rng, omit_share=min(attempt / 40, 1.0))
        if placed is None or not _has_furniture_in_view(furnished, placed):
            continue
        free_m2, walkable_m2 = free_floor_m2(furnished, placed)
        if free_m2 >= MIN_FREE_M2 and walkable_m2 >= MIN_WALKABLE_M2:
            return furnished, placed, (free_m2, walkable_m2)
    raise RuntimeError(f"no arrangement of a {kind.name} leaves enough floor to walk")


def free_floor_m2(shell: Shell, placed: Sequence[PlacedPiece]) -> tuple[float, float]:
    """Areas of free floor in the radar's range window and the picture.

    Free is what has no obstacle up to head height and is more than half a metre from the radar.

    Args:
        shell: The room with its fixed pieces.
        placed: Furniture.

    Returns:
        Area in m2 of the free floor, and of its largest connected part for the centre of a body (radius 0.25 m).
    """
    from scipy import ndimage

    width, depth, _ = shell.size_m
    x_m = np.arange(CELL_M / 2, width, CELL_M)
    y_m = np.arange(CELL_M / 2, depth, CELL_M)
    x, y = np.meshgrid(x_m - shell.radar_m[0], y_m - shell.radar_m[1])
    distance = np.hypot(x, y)
    bearing = np.arctan2(-x, y) - shell.radar_yaw_rad
    in_view = (distance > WINDOW_M[0]) & (distance < WINDOW_M[1]) & (np.abs(bearing) < HALF_VIEW_RAD)
    is_free = ~covered(bounding_boxes([*shell.fixed, *placed]), x_m, y_m) & (distance > 0.5)
    inner = np.asarray(ndimage.distance_transform_edt(np.pad(is_free, 1)))[1:-1, 1:-1] * CELL_M > BODY_RADIUS_M
    labels = np.asarray(ndimage.label(inner & in_view)[0])  # type: ignore[index]
    largest = np.bincount(labels.ravel())[1:].max(initial=0)
    return float((is_free & in_view).sum() * CELL_M**2), float(largest * CELL_M**2)


def covered(boxes: Boxes, x_m: Float[Array, " x"], y_m: Float[Array, " y"]) -> Bool[Array, "y x"]:
    """Squares covered by a box that obstructs a walker.

    Args:
        boxes: Boxes with z above the floor.
        x_m: Centres of the columns, metres.
        y_m: Centres of the rows, metres.

    Returns:
        Mask (y, x).
    """
    low, high = boxes.centre_m[:, 2] - boxes.half_m[:, 2], boxes.centre_m[:, 2] + boxes.half_m[:, 2]
    stops = (high > STEP_OVER_M) & (low < HEAD_M)
    x, y = np.meshgrid(x_m, y_m)
    taken = np.zeros(x.shape, bool)
    reach = CELL_M / 2
    for centre, half, yaw in zip(boxes.centre_m[stops], boxes.half_m[stops], boxes.yaw_rad[stops], strict=True):
        cosine, sine = np.cos(yaw), np.sin(yaw)
        a, b = x - centre[0], y - centre[1]
        taken |= (np.abs(cosine * a + sine * b) < half[0] + reach) & (np.abs(cosine * b - sine * a) < half[1] + reach)
    return taken


def _try_once(
    shell: Shell, wanted: Sequence[tuple[FurnitureGroup, bool]], rng: np.random.Generator, omit_share: float
) -> tuple[PlacedPiece, ...] | None:
    """One attempt: the placed pieces; None where a required group found no place."""
    placed: list[PlacedPiece] = []
    for group, is_required in wanted:
        if not is_required and rng.random() < omit_share:
            continue
        taken = bounding_boxes([*shell.fixed, *_clear_zones(shell), *placed])
        found = _best_place(shell, group, taken, rng)
        if found is None and is_required:
            return None
        placed += found or ()
    return tuple(placed)


def _best_place(
    shell: Shell, group: FurnitureGroup, taken: Boxes, rng: np.random.Generator
) -> tuple[PlacedPiece, ...] | None:
    """Among the first few samples without overlap, the one most central in the radar's view."""
    best, found = None, 0
    for _ in range(_MAX_DRAWS):
        candidate = _candidate(shell, group, rng)
        boxes = bounding_boxes(candidate)
        if not _fits(boxes, shell.size_m) or boxes.overlap(taken, -0.01).any():
            continue
        middle = boxes.centre_m[:, :2].mean(axis=0) - shell.radar_m[:2]
        bearing = np.arctan2(-middle[0], middle[1]) - shell.radar_yaw_rad
        score = abs(float(bearing)) + max(0.0, float(np.hypot(*middle)) - 3.2) + float(rng.uniform(0, 0.5))
        if best is None or score < best[0]:
            best = (score, candidate)
        found += 1
        if found >= _NUM_CANDIDATES:
            break
    return None if best is None else best[1]


def _candidate(shell: Shell, group: FurnitureGroup, rng: np.random.Generator) -> tuple[PlacedPiece, ...]:
    width, depth, _ = shell.size_m
    if group.site == MIDDLE:
        yaw_rad = float(rng.integers(4)) * np.pi / 2 + float(rng.normal(0, 0.05))
        x, y = float(rng.uniform(0.3, width - 0.3)), float(rng.uniform(shell.radar_m[1] + 0.6, depth - 0.3))
        return tuple(item.transformed(x, y, yaw_rad) for item in group.items)
    sites = ("back",) if group.site == BACK else ("back", "left", "right")
    wall = sites[int(rng.integers(len(sites)))]
    along = float(rng.uniform(0.0, width) if wall == "back" else rng.uniform(shell.radar_m[1] + 0.5, depth))
    return tuple(_moved_to_wall(group.items, wall, along, shell.size_m))


def _moved_to_wall(
    items: Sequence[PlacedPiece], wall: str, along_m: float, size_m: tuple[float, float, float]
) -> tuple[PlacedPiece, ...]:
    x, y, yaw_rad = {
        "back": (along_m, size_m[1], 0.0),
        "left": (0.0, along_m, np.pi / 2),
        "right": (size_m[0], along_m, -np.pi / 2),
    }[wall]
    return tuple(item.transformed(x, y, float(yaw_rad)) for item in items)


def _fits(boxes: Boxes, size_m: tuple[float, float, float]) -> bool:
    corners = boxes.corners_m()
    inside = (corners > -1e-6).all() and (corners[..., 0] < size_m[0] + 1e-6).all()
    top = (boxes.centre_m[:, 2] + boxes.half_m[:, 2]).max()
    return bool(inside and (corners[..., 1] < size_m[1] + 1e-6).all() and top < size_m[2])


def _clear_zones(shell: Shell) -> list[PlacedPiece]:
    """Zones without furniture: in front of doors, and around and in front of the radar."""
    x, y, _ = shell.radar_m
    zones = [_zone(0.45, 0.85, PlacedPiece(piece=shell.lamp, x_m=x, y_m=y + 0.35))]
    for item in shell.fixed:
        if item.piece.landmark == "door":
            ahead = item.points(np.array([[0.0, -0.42, 0.0]]))[0]
            zones.append(_zone(0.45, 0.33, replace(item, x_m=float(ahead[0]), y_m=float(ahead[1]))))
    return zones


def _zone(x: float, y: float, place: PlacedPiece) -> PlacedPiece:
    """A box of these half sizes in place of the piece."""
    part = Part((-x, -y, 0.06), (x, y, 2.0), place.piece.parts[0].appearance)
    return replace(place, piece=Piece(name="clear", parts=(part,)))


def _has_furniture_in_view(shell: Shell, placed: Sequence[PlacedPiece]) -> bool:
    """Whether some furniture is near and in the radar's view."""
    for item in placed:
        x, y = item.x_m - shell.radar_m[0], item.y_m - shell.radar_m[1]
        bearing = np.arctan2(-x, y) - shell.radar_yaw_rad
        if not item.piece.on_wall and np.hypot(x, y) < 3.2 and abs(bearing) < HALF_VIEW_RAD:
            return True
    return False
