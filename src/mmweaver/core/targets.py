"""What can be put into a room besides people: reflectors of known cross section, and things that move.

Places are in the camera's level frame, as in sentences: x right of the camera, y ahead of it, z up, the camera at 0.
"""

import math
import re
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

from mmweaver.core.errors import InputError
from mmweaver.core.safe_files.safe_text import read_toml

SHAPES = ("corner", "sphere", "plate")
MAX_PLACE_M, DBSM_LIMITS = 100.0, (-60.0, 60.0)
MAX_TARGETS = 32


@dataclass(frozen=True, kw_only=True)
class Reflector:
    """A calibration target at rest. Corners and plates face the camera.

    Attributes:
        place_m: (x, y, z) in the camera's level frame.
        dbsm: Radar cross section on the axis, dB relative to 1 m2.
        shape: "corner" (trihedral, half the power 20 degrees off its axis), "sphere" (the same in all directions) or
            "plate" (square, of the size that has this cross section).
    """

    place_m: tuple[float, float, float]
    dbsm: float
    shape: str = "corner"

    @classmethod
    def of_words(cls, words: str) -> "Reflector":
        """Parses "X,Y,Z,DBSM" or "X,Y,Z,DBSM,SHAPE".

        Raises:
            InputError: If the text does not parse or a number is out of range.

        >>> Reflector.of_words("0.5,2,0,10").dbsm
        10.0
        """
        parts = [part.strip() for part in words.split(",")]
        shape = parts.pop() if len(parts) == 5 else SHAPES[0]
        values = _numbers(parts)
        if len(values) != 4 or shape not in SHAPES:
            raise InputError(
                f"{words[:60]!r} is no reflector; write X,Y,Z,DBSM in metres and dB, for example 0.5,2,0,10, and"
                f" perhaps its shape: {', '.join(SHAPES)}"
            )
        *place, dbsm = values
        if max(map(abs, place)) > MAX_PLACE_M or not DBSM_LIMITS[0] <= dbsm <= DBSM_LIMITS[1]:
            raise InputError(
                f"reflector {words[:60]!r}: places are within {MAX_PLACE_M:g} m, cross sections from"
                f" {DBSM_LIMITS[0]:g} to {DBSM_LIMITS[1]:g} dBsm"
            )
        return cls(place_m=(place[0], place[1], place[2]), dbsm=dbsm, shape=shape)

    @property
    def words(self) -> str:
        """The reflector in the form that `of_words` reads."""
        return ",".join([*(f"{value:g}" for value in (*self.place_m, self.dbsm)), self.shape])


@dataclass(frozen=True, kw_only=True)
class Thing:
    """A moving thing that is not a person; its kinds are the rows of things.toml.

    Attributes:
        kind: Name of the row.
        place_m: (x, y) of its middle on the floor, in the camera's level frame; None for a place sampled by the seed.
        heading_rad: Direction that it faces or moves in, from +x towards +y; None towards the camera, or across
            its line of sight for what travels.
        seed: Seed of what differs between two of a kind.
    """

    kind: str
    place_m: tuple[float, float] | None = None
    heading_rad: float | None = None
    seed: int = 0

    @classmethod
    def of_words(cls, words: str) -> "Thing":
        """Parses "fan", "fan=X,Y" or "fan=X,Y,DEG", with the heading in degrees: 0 towards the radar, 90 to the right.

        Raises:
            InputError: If the text does not parse or the kind is unknown.

        >>> Thing.of_words("fan=1,2").place_m
        (1.0, 2.0)
        """
        name, _, rest = words.partition("=")
        kind, values = name.strip().replace(" ", "_").replace("-", "_"), _numbers(rest.split(","))
        if kind not in thing_rows():
            raise InputError(f"{name[:40]!r} is no thing that moves; known: {', '.join(thing_rows())}")
        if not rest.strip() and "=" not in words:
            return cls(kind=kind)
        if len(values) not in (2, 3) or max(map(abs, values[:2])) > MAX_PLACE_M:
            raise InputError(
                f"{words[:60]!r} is no place of a thing; write {kind}=X,Y in metres right of and ahead of the camera,"
                " and perhaps a direction in degrees"
            )
        heading = math.radians(values[2]) - math.pi / 2 if len(values) == 3 else None
        return cls(kind=kind, place_m=(values[0], values[1]), heading_rad=heading)

    @property
    def words(self) -> str:
        """The thing in the form that `of_words` reads."""
        heading = "" if self.heading_rad is None else f",{math.degrees(self.heading_rad) + 90:.10g}"
        if self.place_m is None:
            return self.kind
        return f"{self.kind}={self.place_m[0]:g},{self.place_m[1]:g}{heading}"


@dataclass(frozen=True, kw_only=True)
class Interferer:
    """Another FMCW radar that faces the camera, in the same band with chirps of its own.

    Attributes:
        place_m: (x, y, z) in the camera's level frame.
        eirp_dbm: Radiated power towards the camera.
    """

    place_m: tuple[float, float, float]
    eirp_dbm: float = 22.5

    @classmethod
    def of_words(cls, words: str) -> "Interferer":
        """Parses "X,Y,Z" or "X,Y,Z,EIRP_DBM".

        Raises:
            InputError: If the text does not parse.
        """
        values = _numbers(words.split(","))
        is_known = len(values) in (3, 4) and max(map(abs, values[:3])) <= MAX_PLACE_M and math.hypot(*values[:3]) >= 0.1
        if not is_known or not -60 <= [*values, 0.0][3] <= 60:
            raise InputError(
                f"{words[:60]!r} is no interferer; write X,Y,Z in metres, at least 0.1 m away, and perhaps its EIRP in"
                " dBm"
            )
        return cls(place_m=(values[0], values[1], values[2]), **({"eirp_dbm": values[3]} if len(values) == 4 else {}))

    @property
    def words(self) -> str:
        """The interferer in the form that `of_words` reads."""
        return ",".join(f"{value:g}" for value in (*self.place_m, self.eirp_dbm))


@cache
def thing_rows() -> dict[str, dict[str, Any]]:
    """The rows of things.toml by name."""
    return read_toml(Path(__file__).with_name("things.toml"))


_GOES = (
    r"(?:(?:is|are|was) )?(?:switched |turned )?(?:on|running|runs?|turning|turns?|spinning|spins?|moving|moves?"
    r"|walking|walks?|strolling|trotting|passing|passes|driving|drives?|cleaning|cleans?|swaying|sways?|swinging|swings?|blowing|blows?"
    r"|fluttering|flutters?|opening|opens?|washing|oscillating)"
    r"(?: (?:by|past|around|about|through|slowly|fast|nearby|open|shut|and shut|and closed|and closes"
    r"|in (?:the |a )?(?:room|background|draught|draft|wind|breeze)|next to (?:him|her|them|it)|the (?:room|floor)))*"
)


@cache
def _phrases() -> list[tuple[str, re.Pattern[str]]]:
    """A pattern of each kind, those of two words first ("ceiling fan" before "fan")."""
    start = r"(?:,? ?\b(?:and|while|as|with|when)\b|,) (?:there is )?(?:an?|the|his|her|their|some|one) (?:\w+ )?"
    rows = sorted(thing_rows().items(), key=lambda item: "_" not in item[0])
    return [(kind, re.compile(rf"{start}(?:{row['words']}) {_GOES}\b", re.IGNORECASE)) for kind, row in rows]


def things_of_text(text: str) -> tuple[str, tuple[str, ...]]:
    """Takes things that move out of a sentence.

    Args:
        text: "a person sits while a fan is running".

    Returns:
        The rest of the sentence, and the kinds of the things.

    >>> things_of_text("a person sits while a fan is running, and a cat walks by")
    ('a person sits', ('fan', 'cat'))
    """
    found: list[tuple[int, str]] = []
    for kind, pattern in _phrases():
        while (match := pattern.search(text)) is not None:
            found.append((match.start(), kind))
            blank = " " * (match.end() - match.start())  # so that places stay those of the sentence
            text = f"{text[: match.start()]}{blank}{text[match.end() :]}"
    if not found:
        return text, ()
    return " ".join(text.split()).replace(" ,", ",").strip(" ,"), tuple(kind for _, kind in sorted(found))


def _numbers(words: list[str]) -> list[float]:
    """The words as finite numbers; empty if one is none."""
    try:
        values = [float(word) for word in words]
    except ValueError:
        return []
    return values if all(map(math.isfinite, values)) else []
