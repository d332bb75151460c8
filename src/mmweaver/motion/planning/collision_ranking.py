"""Chooses the placement of a motion whose body collides least with the room.

The placement of least cost is animated and tested. Only if it collides are all others compared, without animating
them: their bodies are estimated by moving the first one along their paths.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from jaxtyping import Float

from mmweaver.core.errors import InputError
from mmweaver.core.records import PoseSequence, Scene
from mmweaver.motion.planning.body_samples import BodySamples
from mmweaver.motion.planning.collision import CollisionMap
from mmweaver.motion.planning.floor_map import distance_m
from mmweaver.motion.planning.occluded_geometry import occluded_share, unseen_share
from mmweaver.motion.planning.placement import Placement

REPORTED_PENETRATION_M = 0.03  # deeper collisions are reported to the user
MARGIN_M = 0.03  # depth is noisy, and furniture is visible from one side only

MAX_TESTED, MAX_ANIMATED = 3, 1  # placements per attempt compared in detail; of those that move, animated
# A sitter's occluded trunk and legs count as a collision of this depth: the space there is unknown.
_OCCLUDED_TRUNK_M, _OCCLUDED_LEGS_M = 0.075, 0.04
# A detected seat has room for a trunk above it, though the seat's own back may occlude it.
_BEHIND_OWN_BACK_M = 0.03
# Cost of an invented stool if the room has a seat: a seat is preferred despite a small penetration.
_INVENTED_SEAT_M = 0.06
_ON_SEAT_M = 0.1  # a sitter within this distance is on the seat
_NEGLIGIBLE_M = 0.01  # smaller occlusion costs trigger no further tests
# Maximum cost before the next attempt is made; attempt 2 abandons the room's seats.
_ENOUGH_M = {1: 0.0, 2: REPORTED_PENETRATION_M}
_ENOUGH_SEATED_M = 0.02  # the same of attempt 2 for sitters: few points are visible in a bed's side
_SAME_LOSS = 0.01  # of a sentence: differences below it do not count
_KEPT_M = 0.02  # the first placement is accepted at this clearance
_WORTH_M = 0.003  # accuracy of estimates: smaller gains are not animated
_SAME_SEAT_M = 0.02  # seats whose heights differ by less are equivalent


@dataclass(frozen=True, kw_only=True)
class _Tested:
    """A placement with the tested or estimated penetration of its body (negative: clearance)."""

    placement: Placement
    penetration_m: float
    trunk_cost_m: float = 0.0  # for an occluded trunk
    legs_cost_m: float = 0.0  # for occluded legs, frequent under tables
    pose: PoseSequence | None = None  # if animated
    samples: BodySamples | None = None  # if estimated

    @property
    def cost_m(self) -> float:
        """Cost by which placements are ranked, metres."""
        invented_m = _INVENTED_SEAT_M if self.placement.invents_seat else 0.0
        return self.penetration_m + self.trunk_cost_m + self.legs_cost_m + invented_m

    @property
    def is_clear(self) -> bool:
        """Whether no other placement needs to be tested."""
        hidden_m = self.trunk_cost_m + self.legs_cost_m
        return self.penetration_m <= -MARGIN_M and hidden_m <= _NEGLIGIBLE_M and not self.placement.invents_seat


@dataclass(frozen=True, kw_only=True)
class RankedPlacement(_Tested):
    """A placement with the body animated along it."""

    pose: PoseSequence

    @property
    def notes(self) -> tuple[str, ...]:
        """Notes to the user if the body collides."""
        if self.penetration_m <= REPORTED_PENETRATION_M:
            return ()
        depth_cm = 100 * self.penetration_m
        return (f"the body gets {depth_cm:.0f} cm into furniture or a wall, because the room leaves no better place",)


def least_collision(
    candidates: Callable[[int], Sequence[Placement]],
    animate: Callable[[Placement], PoseSequence],
    obstacles: CollisionMap,
) -> RankedPlacement:
    """Finds the first placement whose motion keeps a margin to everything, hands included, else the one of least cost.

    Args:
        candidates: Called with an attempt; returns placements, the best first. Attempt 1 is made if no placement of
            attempt 0 is clear; attempt 2, which abandons the room's seats, if the collision would be reported.
        animate: Animates a placement.
        obstacles: Obstacles of the room.

    Returns:
        The placement with its animated body.
    """
    ranking = _Ranking(animate, obstacles)
    best = ranking.best_of(candidates(0))
    for attempt in (1, 2):
        # Occluded legs alone do not justify abandoning the room's seats.
        cost_m = best.cost_m if attempt == 1 else best.penetration_m + best.trunk_cost_m
        sits = attempt == 2 and bool(best.placement.seats_m)
        if best.is_clear or cost_m <= (_ENOUGH_SEATED_M if sits else _ENOUGH_M[attempt]):
            break
        try:
            others = candidates(attempt)
        except InputError:  # this attempt finds no placement
            continue
        best = ranking.best_of(others, better_than=best)
    chosen: dict[str, Any] = {**vars(best), "pose": best.pose or animate(best.placement)}
    return RankedPlacement(**chosen)


class _Ranking:
    """Tests and compares placements of one motion."""

    def __init__(self, animate: Callable[[Placement], PoseSequence], obstacles: CollisionMap) -> None:
        self._animate, self._obstacles = animate, obstacles
        self._sketches: dict[tuple[int, ...] | None, BodySamples] = {}  # relative to the root, by `_key`

    def best_of(self, placements: Sequence[Placement], *, better_than: _Tested | None = None) -> _Tested:
        """The first clear placement, else the one of least cost, including `better_than`."""
        best = better_than
        least = min((placement.lost for placement in placements), default=0.0) + _SAME_LOSS
        placements = sorted(placements, key=lambda one: (one.lost > least, one.invents_seat))  # stools last
        if best is None:
            best = self._animated(placements[0])
            if best.cost_m <= -_KEPT_M:
                return best
            placements = placements[1:]
        animations = MAX_ANIMATED
        for estimate in self._refined(self._estimated(placements)[:MAX_TESTED]):
            if estimate.cost_m > best.cost_m - _WORTH_M and not estimate.is_clear:
                continue
            if _loses_more(estimate, best):
                continue
            tested = estimate
            if not estimate.placement.is_still:
                if not animations:
                    break
                animations -= 1
                tested = self._animated(estimate.placement)
            best = tested if tested.cost_m < best.cost_m or tested.is_clear else best
            if tested.cost_m <= -_KEPT_M:
                break
        return best

    def _refined(self, estimates: Sequence[_Tested]) -> Iterator[_Tested]:
        """Estimates including objects ahead of a sitter: in order for still bodies, the best first for moving ones."""
        refined = (self._refined_ahead(estimate) for estimate in estimates)
        if all(estimate.placement.is_still for estimate in estimates):
            return refined
        return iter(_sorted(list(refined)))

    def _estimated(self, placements: Sequence[Placement]) -> list[_Tested]:
        """All placements with estimated collisions: first the clear ones in the given order, then by cost."""
        if not placements:
            return []
        bodies = [self._sketch(placement).along(placement.path) for placement in placements]
        seats = [placement.seats_m for placement in placements]
        depths_m = (
            self._obstacles.estimates_m(
                bodies, seats, margin_m=MARGIN_M, chairs=[placement.chair for placement in placements]
            )
            - MARGIN_M
        )
        trunk_m, legs_m = self._occlusion_costs_m(bodies, placements)
        costs = zip(placements, depths_m, trunk_m, legs_m, bodies, strict=True)
        estimates = [
            _Tested(
                placement=each,
                penetration_m=float(depth),
                trunk_cost_m=float(trunk),
                legs_cost_m=float(legs),
                samples=body,
            )
            for each, depth, trunk, legs, body in costs
        ]
        return _sorted(estimates)

    def _sketch(self, placement: Placement) -> BodySamples:
        """The body relative to its root, as animated for a placement with seats of the same height."""
        key = _key(placement)
        if key not in self._sketches:
            self._animated(placement)
        return self._sketches[key]

    def _animated(self, placement: Placement) -> _Tested:
        pose = self._animate(placement)
        samples = BodySamples.of(pose)
        if _key(placement) not in self._sketches:
            sketch = samples.relative_to(placement.path)
            is_still = placement.is_still
            self._sketches[_key(placement)] = sketch.deduplicated() if is_still else sketch.every_second_time()
        return self._tested(placement, samples, pose)

    def _refined_ahead(self, estimate: _Tested) -> _Tested:
        """An estimate including objects ahead of a sitter; estimates of other bodies are complete already."""
        if estimate.samples is None or not estimate.placement.seats_m:
            return estimate
        ahead_m = self._obstacles.beyond_seats_m(
            estimate.samples, estimate.placement.seats_m, margin_m=MARGIN_M, chair=estimate.placement.chair
        )
        return replace(estimate, penetration_m=max(estimate.penetration_m, ahead_m - MARGIN_M))

    def _tested(self, placement: Placement, samples: BodySamples, pose: PoseSequence) -> _Tested:
        # Beyond the margin, all placements are equally good.
        penetration_m = (
            self._obstacles.penetration_m(samples, placement.seats_m, margin_m=MARGIN_M, chair=placement.chair)
            - MARGIN_M
        )
        trunk_m, legs_m = self._occlusion_costs_m([samples], [placement])
        return _Tested(
            placement=placement,
            penetration_m=penetration_m,
            trunk_cost_m=float(trunk_m[0]),
            legs_cost_m=float(legs_m[0]),
            pose=pose,
        )

    def _occlusion_costs_m(
        self, bodies: Sequence[BodySamples], placements: Sequence[Placement]
    ) -> tuple[Float[np.ndarray, " body"], Float[np.ndarray, " body"]]:
        """Cost of occluded trunks and legs of sitters."""
        seats = [one.seats_m if one.chair is None else (one.chair.place_m,) for one in placements]
        sits = np.array([bool(each) for each in seats])
        if not sits.any():
            return np.zeros(len(bodies)), np.zeros(len(bodies))
        scene = self._obstacles.scene
        trunk = occluded_share(scene, np.stack([body.trunk_m for body in bodies]))
        legs = unseen_share(scene, np.stack([body.legs_m for body in bodies]))
        found = np.array([any(_is_found(scene, seat) for seat in each) for each in seats])
        trunk_m = np.where(found, _BEHIND_OWN_BACK_M, _OCCLUDED_TRUNK_M)
        return sits * trunk_m * trunk, sits * _OCCLUDED_LEGS_M * legs


def _loses_more(one: _Tested, best: _Tested) -> bool:
    """Whether a placement loses more of the sentence than another one that collides too little to be reported."""
    more = one.placement.lost > best.placement.lost + _SAME_LOSS
    return more and best.penetration_m <= REPORTED_PENETRATION_M


def _is_found(scene: Scene, seat: tuple[float, float]) -> bool:
    """Whether a sitter is on a detected seat of the room."""
    return any(distance_m(found.position_m[:2], seat) < max(found.size_m) / 2 + _ON_SEAT_M for found in scene.seats)


def _sorted(estimates: Sequence[_Tested]) -> list[_Tested]:
    """The clear ones in order, then the others by cost."""
    return sorted(estimates, key=lambda one: (not one.is_clear, 0.0 if one.is_clear else one.cost_m))


def _key(placement: Placement) -> tuple[int, ...] | None:
    """Key of placements that share one estimate of the body: on the spot those with equal seat heights, else all."""
    return placement.seat_heights(_SAME_SEAT_M) if placement.is_still else None
