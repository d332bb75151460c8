"""Chooses, among many placements of a motion, the one whose body collides least with the room."""

from collections import Counter
from collections.abc import Callable, Sequence
from dataclasses import dataclass

from mmweaver.core.errors import InputError
from mmweaver.core.records import PoseSequence
from mmweaver.motion.planning.collision import CollisionMap
from mmweaver.motion.planning.placement import Placement

MOST_ANIMATED = 40  # placements that are animated and tested, of those that an attempt gives
REPORTED_PENETRATION_M = 0.03  # deeper collisions are reported to the user
MARGIN_M = 0.03  # depth is noisy, and furniture is seen from one side only
# A sitter's occluded trunk and legs count as a collision of this depth: nobody knows what is there.
_OCCLUDED_TRUNK_M, _OCCLUDED_LEGS_M = 0.075, 0.04
_NEGLIGIBLE_M = 0.01  # less occlusion than this is no reason to test further placements
# The most that a placement may cost before the next attempt is made; attempt 2 leaves the room's seats.
_ENOUGH_M = {1: 0.0, 2: REPORTED_PENETRATION_M}


@dataclass(frozen=True, kw_only=True)
class RankedPlacement:
    """A placement, the body animated along it, and how deep that collides (negative: the distance it keeps)."""

    placement: Placement
    pose: PoseSequence
    penetration_m: float
    trunk_cost_m: float = 0.0  # for an occluded trunk
    legs_cost_m: float = 0.0  # for occluded legs, which those under a table often are

    @property
    def cost_m(self) -> float:
        """What placements are ranked by."""
        return self.penetration_m + self.trunk_cost_m + self.legs_cost_m

    @property
    def notes(self) -> tuple[str, ...]:
        """What is reported to the user where the body collides."""
        if self.penetration_m <= REPORTED_PENETRATION_M:
            return ()
        penetration_cm = 100 * self.penetration_m
        return (
            f"the body gets {penetration_cm:.0f} cm into furniture or a wall, because the room leaves no better place",
        )  # fmt: skip


def least_collision(
    candidates: Callable[[int], Sequence[Placement]],
    animate: Callable[[Placement], PoseSequence],
    obstacles: CollisionMap,
) -> RankedPlacement:
    """The first placement whose motion keeps a margin to everything, hands included; else the one that costs least.

    `candidates(attempt)` gives placements, the best first. Attempt 1 is made where none of attempt 0 is clear, attempt
    2, which leaves the room's seats, where the collision is so deep that it would be reported.
    """
    best = _best(candidates(0), animate, obstacles)
    for attempt in (1, 2):
        # Occluded legs alone are no reason to leave the room's seats.
        cost_m = best.cost_m if attempt == 1 else best.penetration_m + best.trunk_cost_m
        if cost_m <= _ENOUGH_M[attempt]:
            break
        try:
            other = _best(candidates(attempt), animate, obstacles)
        except InputError:  # this attempt finds no placement
            continue
        best = other if other.cost_m < best.cost_m else best
    return best


def _best(
    placements: Sequence[Placement], animate: Callable[[Placement], PoseSequence], obstacles: CollisionMap
) -> RankedPlacement:
    best: RankedPlacement | None = None
    for placement in _seats_varied(placements)[:MOST_ANIMATED]:
        pose = animate(placement)
        # Beyond the margin all are equally good.
        penetration_m = obstacles.penetration_m(pose, placement.seats_m, margin_m=MARGIN_M) - MARGIN_M
        trunk, legs = obstacles.occluded_shares(pose) if placement.seats_m else (0.0, 0.0)
        ranked = RankedPlacement(
            placement=placement, pose=pose, penetration_m=penetration_m, trunk_cost_m=_OCCLUDED_TRUNK_M * trunk,
            legs_cost_m=_OCCLUDED_LEGS_M * legs,
        )  # fmt: skip
        if best is None or ranked.cost_m < best.cost_m:
            best = ranked
        if ranked.penetration_m <= -MARGIN_M and ranked.trunk_cost_m + ranked.legs_cost_m <= _NEGLIGIBLE_M:
            break
    assert best is not None
    return best


def _seats_varied(placements: Sequence[Placement]) -> list[Placement]:
    """In the same order, but all beyond the first two of each way to sit come last."""
    count: Counter[tuple[object, ...]] = Counter()
    first, later = [], []
    for placement in placements:
        sitting = (*placement.seats_m, round(placement.path.heading_rad, 2))
        count[sitting] += 1
        (later if placement.seats_m and count[sitting] > 2 else first).append(placement)
    return first + later
