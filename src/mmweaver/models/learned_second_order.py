"""Second-order paths in addition to those of the network: over people and rough surfaces, and over two people.

The network has learned first-order paths. These follow by physics from joints and room, as in `propagation`, with
fewer skin points, which the room and other people may occlude, but not the body itself.
Reference: docs/decisions/network-by-default.md.
"""

from collections.abc import Sequence
from functools import lru_cache
from itertools import combinations

import numpy as np
import torch
from torch import Tensor

from mmweaver.models.frame_motion import FrameMotion
from mmweaver.propagation.body_model import ScatteringBody
from mmweaver.propagation.frame_clock import FrameClock
from mmweaver.propagation.occlusion import occluded
from mmweaver.propagation.paths import Paths
from mmweaver.propagation.second_order import ROOM_MARGIN_M, BodyBodyPaths, BodyRoomPaths, PairSampling
from mmweaver.propagation.static_paths import RayTracedRoom
from mmweaver.propagation.visible_body import BodyAtFrames, VisibleBody

SKIN_POINTS = 200
SAMPLING = PairSampling(most_pairs=16, most_patches=100, every=5)  # parts of a stream begin at multiples of 5 frames


def second_order_paths(room: RayTracedRoom, motions: Sequence[FrameMotion], clock: FrameClock) -> Paths:
    """Second-order paths of all people.

    Args:
        room: The traced room.
        motions: Motion of each person.
        clock: Clock of the radar's frame.

    Returns:
        Paths (frame * segment, path).
    """
    seen = [_seen(room, motion, [one for one in motions if one is not motion], clock) for motion in motions]
    people = [BodyRoomPaths(one, SAMPLING) for one in seen]
    between = [BodyBodyPaths(*pair) for pair in combinations(people, 2)]
    count, every = seen[0].num_frames, SAMPLING.every
    blocks = [slice(first, min(first + every, count)) for first in range(0, count, every)]
    sources = (
        [one.room_paths for one in people] + [pair.paths for pair in between] + [one.radar_paths for one in people]
    )
    each = [Paths.padded([source(block) for block in blocks]) for source in sources]
    return Paths.cat(each, dim=1)


def _seen(room: RayTracedRoom, motion: FrameMotion, others: list[FrameMotion], clock: FrameClock) -> VisibleBody:
    body = _body(motion.subject, motion.height_m, motion.girth)
    one = VisibleBody(room, body, BodyAtFrames.of(body, clock, motion.node_joints_m(clock), None, []))
    clear = room.is_clear(np.zeros(3), one.posed.place_m[:: SAMPLING.every], ROOM_MARGIN_M)
    one.visible &= np.repeat(clear, SAMPLING.every, axis=0)[: one.num_frames]
    for other in others:
        one.visible &= ~occluded(_tensor(one.posed.place_m), other.middle_joints_m).numpy()
    return one


@lru_cache(maxsize=32)
def _body(subject: int, height_m: float, girth: float) -> ScatteringBody:
    return ScatteringBody(subject, height_m, SKIN_POINTS, girth=girth)


def _tensor(values: np.ndarray) -> Tensor:
    return torch.from_numpy(values).float()
