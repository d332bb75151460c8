"""Of many ways through a room the one on which the body keeps clear of what stands there."""

from collections import Counter
from collections.abc import Callable, Sequence
from dataclasses import dataclass

from mmweaver.core.errors import InputError
from mmweaver.core.records import PoseSequence
from mmweaver.motion.planning.collision import CollisionMap
from mmweaver.motion.planning.placement import Placement

MOST_MOVED, WORTH_A_NOTE_M = 40, 0.03
MARGIN_M = 0.03  # depth is noisy, and what stands there is seen from one side
_HIDDEN_M, _LEGS_HIDDEN_M = 0.075, 0.04  # a sitter's hidden trunk and legs count as this far in: none knows into what
_LITTLE_M = 0.01  # of it is no reason to look for another place
_AGAIN_M = 0.0  # whoever gets in is placed once more, with other ways and ways to sit


@dataclass(frozen=True, kw_only=True)
class RankedPlacement:
    """A placement, the body moved along it, and how far that gets into things (negative: how far it keeps away)."""

    placement: Placement
    pose: PoseSequence
    deep_m: float
    hidden_m: float = 0.0  # added for a hidden trunk
    legs_hidden_m: float = 0.0  # added for hidden legs: under a table's top they often are

    @property
    def bad_m(self) -> float:
        """By what placements are compared."""
        return self.deep_m + self.hidden_m + self.legs_hidden_m

    @property
    def notes(self) -> tuple[str, ...]:
        """What to say where the body gets in."""
        if self.deep_m <= WORTH_A_NOTE_M:
            return ()
        deep_cm = 100 * self.deep_m
        return (f"the body gets {deep_cm:.0f} cm into furniture or a wall, for the room leaves no better place",)


def most_clear(
    draw: Callable[[int], Sequence[Placement]], moved: Callable[[Placement], PoseSequence], obstacles: CollisionMap
) -> RankedPlacement:
    """The first placement whose motion keeps a margin to everything, hands and all; else the one that comes nearest.

    `draw(0)` gives placements, the best first; where none of them keeps clear, `draw(1)` gives others, and where those
    get in so far that it must be said, `draw(2)` such that leave the room's seats.
    """
    best = _best(draw(0), moved, obstacles)
    for again in (1, 2):
        # For hidden legs alone nobody leaves the room's seats.
        bad_m, enough_m = (best.bad_m, _AGAIN_M) if again == 1 else (best.deep_m + best.hidden_m, WORTH_A_NOTE_M)
        if bad_m <= enough_m:
            break
        try:
            other = _best(draw(again), moved, obstacles)
        except InputError:  # there is no other way
            continue
        best = other if other.bad_m < best.bad_m else best
    return best


def _best(
    placements: Sequence[Placement], moved: Callable[[Placement], PoseSequence], obstacles: CollisionMap
) -> RankedPlacement:
    best: RankedPlacement | None = None
    for placement in _varied(placements)[:MOST_MOVED]:
        pose = moved(placement)
        # From the margin on all are alike.
        deep_m = obstacles.deepest_m(pose, placement.seats_m, margin_m=MARGIN_M) - MARGIN_M
        trunk, legs = obstacles.hidden(pose) if placement.seats_m else (0.0, 0.0)
        one = RankedPlacement(
            placement=placement, pose=pose, deep_m=deep_m, hidden_m=_HIDDEN_M * trunk,
            legs_hidden_m=_LEGS_HIDDEN_M * legs,
        )  # fmt: skip
        if best is None or one.bad_m < best.bad_m:
            best = one
        if one.deep_m <= -MARGIN_M and one.hidden_m + one.legs_hidden_m <= _LITTLE_M:
            break
    assert best is not None
    return best


def _varied(placements: Sequence[Placement]) -> list[Placement]:
    """The same in their order, but after two of a seat the others of that seat last."""
    count: Counter[tuple[object, ...]] = Counter()
    first, later = [], []
    for placement in placements:
        sat = (*placement.seats_m, round(placement.path.heading_rad, 2))
        count[sat] += 1
        (later if placement.seats_m and count[sat] > 2 else first).append(placement)
    return first + later
