"""Several people at once: each occludes the others, their ghosts and the room as a body occludes itself.

Paths from one person over another to the radar are of second order: `second_order`; see docs/several_people.md.
"""

from itertools import combinations

import numpy as np
import torch

from mmweaver.paths.body_model import ScatteringBody
from mmweaver.paths.body_paths import BodyPaths
from mmweaver.paths.frame_clock import FrameClock
from mmweaver.paths.paths import Paths, ScenePaths
from mmweaver.paths.second_order import BodyBodyPaths
from mmweaver.paths.static_paths import RayTracedRoom
from mmweaver.paths.visible_body import hulls_of, occluded_by


class PeoplePaths:
    """Paths of all people in one room, frame by frame; nobody is an empty room.

    With `mutual` occlusion everybody occludes everybody else, and what two of them occlude of the room is taken away
    once. Without it each is as if alone, so that the whole is the plain sum of the people.
    """

    def __init__(
        self,
        room: RayTracedRoom,
        bodies: list[ScatteringBody],
        clock: FrameClock,
        joints_m: list[np.ndarray],
        chests_m: list[np.ndarray] | None = None,
        *,
        mutual: bool = True,
    ):
        """`joints_m`: (frame, node, 22, 3) for each body; `chests_m`: how far its chest is raised (frame, node)."""
        chests = chests_m or [None] * len(bodies)
        self.room, self.mutual, self.num_segments = room, mutual, len(clock.segments)
        self.hulls = hulls_of(bodies, joints_m) if mutual and bodies else []
        self.each = [
            BodyPaths(room, body, clock, own, chest, self.hulls or None)
            for body, own, chest in zip(bodies, joints_m, chests, strict=True)
        ]
        seconds = [one.second for one in self.each if one.second is not None] if mutual else []
        pairs = combinations(range(len(seconds)), 2)
        self.between = {(a, b): BodyBodyPaths(seconds[a], seconds[b]) for a, b in pairs}

    def scene(self, num_frames: int) -> ScenePaths:
        """The paths of the room and of all people in so many frames."""
        segments = [paths for frame in range(num_frames) for paths in self.paths(frame)]
        occluded = np.stack([self.occlusions(frame) for frame in range(num_frames)])
        moving = Paths.padded(segments)
        return ScenePaths(static=self.room.paths, moving=moving, occluded=torch.from_numpy(occluded))

    def paths(self, frame: int) -> list[Paths]:
        """All paths over people in one frame, a record (path,) for each time segment."""
        each = [one.paths(frame) for one in self.each]
        for between in self.between.values():
            paths = between.paths(slice(frame, frame + 1))
            each.append([paths[index] for index in range(self.num_segments)])
        return [Paths.cat(parts) for parts in zip(*each, strict=True)] if each else [Paths.none()] * self.num_segments

    def occlusions(self, frame: int) -> np.ndarray:
        """How many people take each static path away in one frame, uint8 (path,): at most one with mutual occlusion."""
        count = np.zeros(len(self.room.paths), np.uint8)
        if self.mutual and self.each:
            is_near = np.zeros(len(count), bool)
            for one in self.each:
                is_near[one.near_body(frame)] = True
            near = np.flatnonzero(is_near)
            count[occluded_by(self.hulls[frame], self.room.paths, near)] = 1
        elif not self.mutual:
            for one in self.each:
                count[one.occluded(frame)] += 1
        return count
