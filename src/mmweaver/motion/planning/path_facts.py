"""What a candidate's path does in every step, and what it loses of the sentence, before any joint is solved."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from mmweaver.motion.language.plan import Step
from mmweaver.motion.planning.asked import Quantity
from mmweaver.motion.planning.trajectory import Trajectory

EARLY_S = 0.2  # a turn before a walk begins this much before the walk's step


@dataclass(frozen=True, kw_only=True)
class PathFacts:
    """The facts of `verification.facts.Facts` that a path has."""

    path_m: float
    net_m: tuple[float, float]
    towards_m: float
    ahead_m: float
    left_m: float
    speed_mps: float
    turn_deg: float
    heading_rad: float
    place_m: tuple[float, float]


def path_facts(trajectory: Trajectory, steps: Sequence[Step]) -> list[PathFacts]:
    """Facts of every step of a laid out trajectory.

    Args:
        trajectory: The trajectory.
        steps: Its steps, scheduled.
    """
    place, heading, found = np.array(trajectory.start_m), trajectory.start_heading_rad, []
    turns = sorted(trajectory.turns, key=lambda turn: turn.start_s)
    for k, (step, moves) in enumerate(zip(steps, trajectory.moves, strict=True)):
        ends = np.inf if k == len(steps) - 1 else step.end_s - EARLY_S
        own = [turn for turn in turns if turn.start_s < ends]
        turns = turns[len(own) :]
        before = [turn.angle_rad for turn in own if not moves or turn.start_s <= moves[0].start_s + EARLY_S]
        ahead_rad = heading + sum(before)
        bend = sum(move.curvature_per_m * move.length_m for move in moves)
        net = sum((move.end_shift_m for move in moves), np.zeros(2))
        turned = sum(turn.angle_rad for turn in own) + bend
        after = place + net
        found.append(
            PathFacts(
                path_m=float(sum(move.length_m for move in moves)),
                net_m=(float(net[0]), float(net[1])),
                towards_m=float(np.hypot(*place) - np.hypot(*after)),
                ahead_m=float(net @ (np.cos(ahead_rad), np.sin(ahead_rad))),
                left_m=float(net @ (-np.sin(ahead_rad), np.cos(ahead_rad))),
                speed_mps=float(max((move.speed_mps for move in moves), default=0.0)),
                turn_deg=float(np.degrees(turned)),
                heading_rad=float(heading + turned),
                place_m=(float(after[0]), float(after[1])),
            )
        )
        place, heading = after, heading + turned
    return found


def lost_share(quantities: Sequence[Sequence[Quantity]], facts: Sequence[PathFacts]) -> float:
    """Sum over steps and quantities of the share that a path loses of what is asked.

    Args:
        quantities: What each step asks for.
        facts: What each step of the path does.
    """
    lost = 0.0
    for asked, shown in zip(quantities, facts, strict=True):
        for quantity in asked:
            deviation = quantity.deviation(shown)
            lost += 0.0 if deviation is None else 0.3 + deviation.lost
    return lost
