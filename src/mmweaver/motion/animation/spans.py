"""Repetitions as spans of time, and smooth keyframes within them."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from jaxtyping import Float

from mmweaver.core.safe_files.safe_text import read_toml
from mmweaver.motion.animation.profiles import plateau

PerTime = Float[np.ndarray, " n"]
Number = float | int
Curve = Float[np.ndarray, "..."] | Number  # a function of time, or the same value at all times
MOVEMENTS: dict[str, dict[str, Any]] = read_toml(Path(__file__).with_name("library") / "movements.toml")


def spline_through(time_s: PerTime, times: Sequence[Number], values: Sequence[Number]) -> PerTime:
    """Quintic spline through keyframes, at rest at both ends and constant beyond; C2.

    Args:
        time_s: Times (n,) in seconds.
        times: Times of the keyframes, increasing.
        values: Values of the keyframes.
    """
    from scipy.interpolate import make_interp_spline

    rest = [(1, 0.0), (2, 0.0)]
    curve = make_interp_spline(np.asarray(times), np.asarray(values, dtype=float), k=5, bc_type=(rest, rest))
    return np.asarray(curve(np.clip(time_s, times[0], times[-1])))


@dataclass(frozen=True)
class Span:
    """One repetition of a movement; its methods take shares of its duration."""

    time_s: PerTime
    begin_s: float
    lasts_s: float

    def at(self, share: Number) -> float:
        """Time in seconds at a share of the duration."""
        return self.begin_s + share * self.lasts_s

    def plateau(self, begin: Number, end: Number, up: Number, down: Number) -> PerTime:
        """`profiles.plateau` at shares of the duration.

        Args:
            begin: Start.
            end: End.
            up: Duration of the rise.
            down: Duration of the fall.
        """
        return plateau(self.time_s, self.at(begin), self.at(end), up * self.lasts_s, down * self.lasts_s)

    def progress(self) -> PerTime:
        """Share of the duration that has passed (n,), not limited to 0 to 1."""
        return (self.time_s - self.begin_s) / self.lasts_s

    def keys(self, shares: Sequence[Number], values: Sequence[Number]) -> PerTime:
        """`spline_through` keyframes at shares of the duration.

        Args:
            shares: Shares of the keyframes, increasing.
            values: Values of the keyframes.
        """
        return spline_through(self.time_s, [self.at(share) for share in shares], values)

    def rows(self, movement: str, *names: str) -> list[PerTime]:
        """Keyframes of a movement in `movements.toml`, smoothly interpolated.

        Args:
            movement: Name of the movement.
            *names: Rows of its table.

        Returns:
            One curve (n,) per row.
        """
        record = MOVEMENTS[movement]
        return [self.keys(record["at"], record[name]) for name in names]


def sum_plateaus(spans: list[Span], begin: Number, end: Number, up: Number, down: Number) -> PerTime:
    """Sum over repetitions of the same plateau, (n,).

    Args:
        spans: Repetitions.
        begin: Start as a share of each repetition.
        end: End as a share.
        up: Duration of the rise as a share.
        down: Duration of the fall as a share.
    """
    return np.sum([span.plateau(begin, end, up, down) for span in spans], axis=0)
