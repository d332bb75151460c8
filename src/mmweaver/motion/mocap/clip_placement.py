"""Placement of a recorded motion in a scene: feet on the floor, the whole track free and in view."""

import itertools
import math
from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float

from mmweaver.core.errors import InputError
from mmweaver.core.records import PoseSequence, Scene
from mmweaver.core.seeding import stream
from mmweaver.core.skeleton import joint
from mmweaver.motion.animation.skeleton_proportions import ANKLE_HEIGHT
from mmweaver.motion.compose import Motion
from mmweaver.motion.language.plan import MotionPlan
from mmweaver.motion.mocap.clip import MotionClip, resampled_clip
from mmweaver.motion.planning.floor_map import FloorMap

Array = np.ndarray
SOLE_UNDER_BALL = ANKLE_HEIGHT - 0.034  # of the height: from the floor to the foot joint of a standing body
HEADINGS = 24  # tried, evenly spaced
MAX_STARTS = 400
TRACK_POINTS = 48
LOW_PELVIS = 0.75  # of the pelvis height on straight legs: lower means sitting, crouching or lying
TO_RADAR_RAD = -math.pi / 2


@dataclass(frozen=True)
class _Track:
    """Displacement of the pelvis over the floor from its start, and the heading there."""

    shift_m: Float[Array, "point 2"]
    facing_rad: float
    reach_m: float  # how far hands and feet reach from the pelvis


def place_clip(
    clip: MotionClip,
    scene: Scene,
    *,
    duration_s: float,
    seed: int,
    range_window_m: tuple[float, float],
    start_m: tuple[float, float] | None = None,
    heading_rad: float | None = None,
    as_recorded: bool = False,
) -> Motion:
    """Places the beginning of a clip in a scene.

    Args:
        clip: The recorded motion.
        scene: The room, in the radar's frame.
        duration_s: Duration to take from the clip, in seconds.
        seed: Chooses between equally good places.
        range_window_m: Nearest and farthest slant range in metres that the radar keeps.
        start_m: Start (x, y) of the pelvis in metres; None searches one for which the whole track is free and in view.
        heading_rad: Initial heading in radians, from +x towards +y; None searches one, towards the radar if possible.
        as_recorded: Whether the clip's positions are in the radar's frame already; nothing is then moved or checked.

    Returns:
        The motion at 120 Hz with notes on the assumptions.

    Raises:
        InputError: If there is no room, reporting the free area.
    """
    time_s, joints_m = resampled_clip(clip, duration_s)
    height_m = clip.height_m
    notes = list(clip.notes)
    if as_recorded:
        notes.append("the positions of the motion file are used unchanged; nothing was checked against the room")
    else:
        joints_m = joints_m - np.array([0.0, 0.0, floor_under(clip.joints_m, height_m)])
        floor = FloorMap(scene, range_window_m, height_m)
        track = _track_of(joints_m, time_s, duration_s)
        start, heading = _found(track, floor, clip, seed=seed, start_m=start_m, heading_rad=heading_rad)
        joints_m = _moved(joints_m, track, time_s, start, heading)
        joints_m[..., 2] += scene.floor_z_m
        notes += _posture_note(clip, joints_m[..., 2] - scene.floor_z_m)
    pose = PoseSequence(time_s=time_s, joints_m=joints_m, height_m=height_m)
    return Motion(pose=pose, plan=MotionPlan(text=clip.label, steps=()), assumptions=tuple(dict.fromkeys(notes)))


def floor_under(joints_m: Float[Array, "frame 22 3"], height_m: float) -> float:
    """Height of the recording's floor: the lowest joints minus the height of a standing foot's joint.

    Uses the second percentile of the lowest joint over time, so that a single bad frame does not count.

    Args:
        joints_m: Joints (frame, 22, 3) in metres, z up.
        height_m: Height of the body in metres.

    Returns:
        z of the floor in metres.
    """
    lowest = joints_m[..., 2].min(axis=1)
    return float(np.percentile(lowest, 2)) - SOLE_UNDER_BALL * height_m


def facing_of(joints_m: Float[Array, "22 3"]) -> float:
    """Heading of a body by its hips and shoulders.

    Args:
        joints_m: Joints of one frame, (22, 3), z up.

    Returns:
        Radians from +x towards +y.
    """
    across = joints_m[joint("left_hip")] - joints_m[joint("right_hip")]
    across = across + joints_m[joint("left_shoulder")] - joints_m[joint("right_shoulder")]
    return float(np.arctan2(-across[0], across[1]))


def _track_of(joints_m: Float[Array, "frame 22 3"], time_s: Float[Array, " frame"], duration_s: float) -> _Track:
    inside = (time_s >= -1e-9) & (time_s <= duration_s + 1e-9)
    shown = joints_m[inside]
    pelvis = shown[:, 0, :2]
    points = pelvis[np.unique(np.linspace(0, len(pelvis) - 1, TRACK_POINTS).astype(int))]
    reach = np.linalg.norm(shown[..., :2] - pelvis[:, None], axis=-1).max(axis=1)
    return _Track(shift_m=points - pelvis[0], facing_rad=facing_of(shown[0]), reach_m=float(np.percentile(reach, 95)))


def _found(
    track: _Track,
    floor: FloorMap,
    clip: MotionClip,
    *,
    seed: int,
    start_m: tuple[float, float] | None,
    heading_rad: float | None,
) -> tuple[Float[Array, "2"], float]:
    """The start (x, y) and heading of least cost."""
    if not floor.walkable.any():
        raise InputError(
            "there is no free floor in the picture and the radar's window; take a radar with a longer window (--radar),"
            " a photo with more floor, or --as-recorded"
        )
    if start_m is not None:
        floor.check_start(start_m)
    rng = stream(seed, "motion", "placement", "clip")
    starts = np.array([start_m], float) if start_m is not None else _starts(floor, rng)
    headings = TO_RADAR_RAD + 2 * math.pi * np.arange(HEADINGS) / HEADINGS
    if heading_rad is not None:
        headings = np.array([heading_rad])
    best: tuple[float, Float[Array, 2], float] | None = None
    for heading in headings:
        tracks = starts[:, None] + _turned(track.shift_m, heading - track.facing_rad)
        free = np.flatnonzero(floor.can_stand(tracks).all(axis=1))
        if not len(free):
            continue
        cost = _cost(tracks[free], floor, track.reach_m, float(heading) if heading_rad is None else None)
        cost = cost + rng.uniform(0, 0.3, len(free))
        k = int(cost.argmin())
        if best is None or cost[k] < best[0]:
            best = float(cost[k]), starts[free[k]], float(heading)
    if best is None:
        raise InputError(_no_room(track, floor, clip, start_m, heading_rad))
    return best[1], best[2]


def _starts(floor: FloorMap, rng: np.random.Generator) -> Float[Array, "start 2"]:
    cells = floor.cell_centres_m[floor.walkable]
    if len(cells) > MAX_STARTS:
        cells = cells[np.sort(rng.choice(len(cells), MAX_STARTS, replace=False))]
    return cells


def _cost(
    tracks: Float[Array, "start point 2"], floor: FloorMap, reach_m: float, heading: float | None
) -> Float[Array, " start"]:
    """Cost (start,) of positions, of limbs that exceed the clearance, and of facing away from the radar."""
    tight = np.clip(reach_m - floor.clearance_at(tracks), 0.0, None).max(axis=1)
    cost = floor.cost_at(tracks).mean(axis=1) + 2.0 * tight
    if heading is not None:
        to_radar = np.arctan2(-tracks[:, 0, 1], -tracks[:, 0, 0])
        cost = cost + 0.5 * (1 - np.cos(heading - to_radar))
    return cost


def _turned(shift_m: Float[Array, "*shape 2"], angle_rad: float) -> Float[Array, "*shape 2"]:
    cos, sin = math.cos(angle_rad), math.sin(angle_rad)
    return shift_m @ np.array([[cos, sin], [-sin, cos]])


def _moved(
    joints_m: Float[Array, "frame 22 3"],
    track: _Track,
    time_s: Float[Array, " frame"],
    start_m: Float[Array, "2"],
    heading_rad: float,
) -> Float[Array, "frame 22 3"]:
    first = int(np.argmin(np.abs(time_s)))
    moved = joints_m.copy()
    moved[..., :2] = start_m + _turned(joints_m[..., :2] - joints_m[first, 0, :2], heading_rad - track.facing_rad)
    return moved


def _posture_note(clip: MotionClip, height_over_floor: Float[Array, "frame 22"]) -> list[str]:
    """Reports a recorded body that sits or lies: this room has no furniture under it."""
    names = ("hip", "knee", "ankle")
    positions = [clip.joints_m[:, joint(f"left_{name}")] for name in names]
    leg = float(np.median(sum(np.linalg.norm(a - b, axis=-1) for a, b in itertools.pairwise(positions))))
    low = height_over_floor[:, 0] < LOW_PELVIS * leg
    if low.mean() < 0.3:
        return []
    return ["the recorded body is low for a while (it sits, crouches or lies); no furniture is placed under it"]


def _no_room(
    track: _Track,
    floor: FloorMap,
    clip: MotionClip,
    start_m: tuple[float, float] | None,
    heading_rad: float | None,
) -> str:
    spread = track.shift_m[:, None] - track.shift_m[None]
    longest = float(np.linalg.norm(spread, axis=-1).max())
    free: Bool[Array, "y x"] = floor.walkable
    asked = "" if start_m is None else f" from {start_m[0]:g},{start_m[1]:g}"
    asked += "" if heading_rad is None else " in the given heading"
    size = f"{free.sum() * floor.cell_m**2:.1f} m2 of floor are free in the picture and the radar's window"
    return (
        f"there is no room for {clip.label}{asked}: its track is {longest:.1f} m across, {size}; try fewer --frames,"
        " another --motion-set start=S, --at or --heading, a smaller --height, or --as-recorded"
    )
