"""A thing of a room with its place, as the command line gives it: 'bed=0.5,2' or 'bed=0.5,2,180'."""

import math
from dataclasses import dataclass
from typing import Any

# Kinds of furniture that can be put into a room (`scene.furnished`).
FURNISHABLE = frozenset(
    {
        *("armchair", "bed", "bench", "cabinet", "chair", "couch", "counter", "desk", "door", "fridge", "lamp"),
        *("plant", "shelf", "sink", "sofa", "stool", "stove", "table", "tv", "wardrobe", "window"),
    }
)


@dataclass(frozen=True)
class PlacedThing:
    """A thing at a place in the room.

    Attributes:
        kind: What it is: a noun of sentences.
        place_m: Place (x, y) of its middle in metres right of and ahead of the radar.
        facing_deg: Direction that its front faces: 0 towards the radar, 90 to the right, 180 away; None: open.
    """

    kind: str
    place_m: tuple[float, float]
    facing_deg: float | None = None

    @classmethod
    def of_words(cls, word: str) -> "PlacedThing":
        """Parses KIND=X,Y or KIND=X,Y,FACING.

        Raises:
            ValueError: For any other form.
        """
        kind, equals, place = word.partition("=")
        numbers = [float(part) for part in place.split(",")]
        if not equals or not kind.strip() or len(numbers) not in (2, 3) or not all(map(math.isfinite, numbers)):
            raise ValueError
        x_m, y_m, *facing = numbers
        return cls(kind.strip().lower(), (x_m, y_m), facing[0] if facing else None)

    @classmethod
    def of(cls, given: "PlacedThing | tuple[Any, ...]") -> "PlacedThing":
        """The thing itself, or that of a tuple (kind, (x, y)) or (kind, (x, y), facing in degrees)."""
        return given if isinstance(given, PlacedThing) else cls(*given)

    @property
    def words(self) -> str:
        """The form that `of_words` parses."""
        facing = "" if self.facing_deg is None else f",{self.facing_deg:g}"
        return f"{self.kind}={self.place_m[0]:g},{self.place_m[1]:g}{facing}"

    @property
    def facing_rad(self) -> float | None:
        """Direction from +x towards +y; None if open."""
        return None if self.facing_deg is None else math.radians(self.facing_deg) - math.pi / 2
