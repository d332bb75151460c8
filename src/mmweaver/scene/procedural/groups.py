"""Groups of furniture that stand together, from the [groups] of furniture.toml."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from mmweaver.scene.procedural.furniture import RECORDS, Builder, evaluate, make_piece
from mmweaver.scene.procedural.palette import Palette
from mmweaver.scene.procedural.parts import OVERLAP_M, PlacedPiece, bounding_boxes

WALL, BACK, MIDDLE = "wall", "back", "middle"
_MAX_DRAWS = 20
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
    for _ in range(_MAX_DRAWS):
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
