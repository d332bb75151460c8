"""How deep a moving body intersects the furniture and walls of a room whose boxes are known."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from mmweaver.core.body_capsules import CAPSULES, Capsule, scale_of
from mmweaver.core.records import PoseSequence
from mmweaver.core.skeleton import joint
from mmweaver.scene.procedural.parts import Boxes
from mmweaver.scene.procedural.procedural_room import ProceduralRoom

ALLOWED_M = 0.03  # clothes and cushions give way; boxes have sharp corners where furniture is round
ON_SEAT_M = 0.16  # what one sits or leans on: the flesh of a capsule sinks into it
FRAME_S = 1 / 15
_ALONG = np.array([0.0, 0.35, 0.7, 1.0])
_SEATED = {"pelvis", "spine1", "spine2", "spine3", "left_hip", "right_hip", "left_collar", "right_collar"}
_ARMS = {"shoulder", "elbow", "wrist"}


def signed_distance_m(boxes: Boxes, points_m: np.ndarray) -> np.ndarray:
    """Distance of each point to each box's surface, (point, box) metres; negative inside."""
    cosine, sine = np.cos(boxes.yaw_rad), np.sin(boxes.yaw_rad)
    x, y, z = np.moveaxis(points_m[:, None] - boxes.centre_m[None], -1, 0)
    beyond = np.abs(np.stack([cosine * x + sine * y, cosine * y - sine * x, z], -1)) - boxes.half_m
    return np.linalg.norm(np.maximum(beyond, 0), axis=-1) + np.minimum(beyond.max(axis=-1), 0)


@dataclass(frozen=True, kw_only=True)
class Contact:
    """Deepest intersection of a motion: of trunk, legs and head, and of the arms, in metres beyond the tolerance; 0 =
    none."""

    body_m: float
    arms_m: float
    body_where: str = ""
    arms_where: str = ""


def sampled(pose: PoseSequence, along: np.ndarray) -> Iterator[tuple[Capsule, np.ndarray, np.ndarray]]:
    """Each capsule of a body, points (point, 3) at shares `along` its bone 15 times a second, and the radii there."""
    steps = np.arange(pose.time_s[0], pose.time_s[-1], FRAME_S)
    rows = np.unique(np.clip(np.searchsorted(pose.time_s, steps), 0, len(pose.time_s) - 1))
    joints = pose.joints_m[rows].astype(float)
    for capsule in CAPSULES:
        start, end = joints[:, joint(capsule.start)], joints[:, joint(capsule.end)]
        share = along[:, None, None]
        points = (start * (1 - share) + end * share).reshape(-1, 3)
        radius = np.interp(along, [0, 1], [capsule.start_radius_m, capsule.end_radius_m])
        radius = np.repeat(radius * scale_of(pose.height_m), len(rows))
        yield capsule, points, radius


def contact(
    room: ProceduralRoom, pose: PoseSequence, seat_m: np.ndarray | None = None, *, is_moved: bool = False
) -> Contact:
    """Capsules of the body against all boxes and walls, 15 times a second.

    `seat_m`: where the person sits, if so; the piece under it (found within 0.4 m) may be sunk into, or is left out
    where it is taken as moved away from there.
    """
    boxes = _solid(room)
    own = _piece_under(boxes, seat_m)
    worst = {"body": (0.0, ""), "arms": (0.0, "")}
    for capsule, points, radius in sampled(pose, _ALONG):
        depth = radius[:, None] - signed_distance_m(boxes, points) - ALLOWED_M
        if own is not None and is_moved:
            depth[:, own] = -np.inf
        elif capsule.start in _SEATED and own is not None:
            depth[:, own] -= ON_SEAT_M - ALLOWED_M
        into_wall = radius - _wall_distance_m(room, points) - ALLOWED_M
        deepest = np.append(depth.max(axis=0), into_wall.max())
        at = int(np.argmax(deepest))
        part = "arms" if any(word in capsule.start for word in _ARMS) else "body"
        if deepest[at] > worst[part][0]:
            name = boxes.names[at] if at < len(boxes) else "wall"
            worst[part] = (float(deepest[at]), f"{capsule.start} in {name}")
    return Contact(
        body_m=worst["body"][0], arms_m=worst["arms"][0], body_where=worst["body"][1], arms_where=worst["arms"][1]
    )


def _solid(room: ProceduralRoom) -> Boxes:
    """The solids of a room: all boxes except those flat on the floor."""
    boxes = room.boxes
    keep = np.flatnonzero(boxes.centre_m[:, 2] + boxes.half_m[:, 2] - room.floor_z_m > 0.03)
    return Boxes(
        centre_m=boxes.centre_m[keep],
        half_m=boxes.half_m[keep],
        yaw_rad=boxes.yaw_rad[keep],
        names=tuple(boxes.names[i] for i in keep),
        piece=tuple(boxes.piece[i] for i in keep),
    )


def _piece_under(boxes: Boxes, seat_m: np.ndarray | None) -> np.ndarray | None:
    """Which boxes belong to the piece nearest to a seat; None where there is none within 0.4 m."""
    if seat_m is None:
        return None
    distance = signed_distance_m(boxes, np.asarray(seat_m, float)[None])[0]
    near = int(np.argmin(distance))
    return np.array(boxes.piece) == boxes.piece[near] if distance[near] < 0.4 else None


def _wall_distance_m(room: ProceduralRoom, points: np.ndarray) -> np.ndarray:
    walls = [plane for plane in room.planes if plane.kind == "wall"]
    return np.min([(points - wall.centre_m) @ wall.normal for wall in walls], axis=0)
