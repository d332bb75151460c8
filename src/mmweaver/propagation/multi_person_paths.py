"""Several people: each occludes the others, their multipath and the room as a body occludes itself.

Paths over two people are of second order, see `second_order` and docs/several_people.md.
"""

from itertools import combinations

import numpy as np
import torch
from torch import Tensor

from mmweaver.propagation.body_model import ScatteringBody
from mmweaver.propagation.body_paths import BodyPaths
from mmweaver.propagation.frame_clock import FrameClock
from mmweaver.propagation.occlusion import people_shadow
from mmweaver.propagation.paths import Paths, ScenePaths
from mmweaver.propagation.second_order import BodyBodyPaths
from mmweaver.propagation.static_paths import RayTracedRoom
from mmweaver.propagation.visible_body import hulls_of


class PeoplePaths:
    """Paths of all people in one room, frame by frame; an empty room without people.

    A static path that two of them occlude is removed once.
    """

    def __init__(
        self,
        room: RayTracedRoom,
        bodies: list[ScatteringBody],
        clock: FrameClock,
        joints_m: list[np.ndarray],
        trunks_m: list[np.ndarray] | None = None,
        starts_m: list[np.ndarray] | None = None,
    ):
        """Poses all people, and determines which paths are clear.

        Args:
            room: The room.
            bodies: Skin points of each person; may be empty.
            clock: Clock of the radar's frame.
            joints_m: Joints (frame, node, 22, 3) in metres of each person, at the clock's nodes.
            trunks_m: Outward displacement of chest and belly (frame, node, 2) in metres of each person; by default
                none.
            starts_m: Joints (frame + 1, 22, 3) in metres of each person at the start of each frame and after the last,
                where they occlude the room; by default as in the middle of each frame.
        """
        self.starts_m = [own[:, own.shape[1] // 2] for own in joints_m] if starts_m is None else starts_m
        self.room, self.num_segments = room, len(clock.segments)
        self.hulls = hulls_of(bodies, joints_m) if bodies else []
        self.each = [
            BodyPaths(room, body, clock, own, trunk, self.hulls)
            for body, own, trunk in zip(bodies, joints_m, trunks_m or [None] * len(bodies), strict=True)
        ]
        seconds = [one.second for one in self.each if one.second is not None]
        self.between = [BodyBodyPaths(*pair) for pair in combinations(seconds, 2)]

    def scene(self, num_frames: int) -> ScenePaths:
        """All paths of the room and of the people.

        Args:
            num_frames: Number of frames, from the first.
        """
        segments = [paths for frame in range(num_frames) for paths in self.paths(frame)]
        return ScenePaths(static=self.room.paths, moving=Paths.padded(segments), occluded=self.occluded(num_frames))

    def paths(self, frame: int) -> list[Paths]:
        """All paths over people in one frame, one record (path,) per time segment."""
        each = [one.paths(frame) for one in self.each]
        for between in self.between:
            paths = between.paths(slice(frame, frame + 1))
            each.append([paths[index] for index in range(self.num_segments)])
        return [Paths.cat(parts) for parts in zip(*each, strict=True)] if each else [Paths.none()] * self.num_segments

    def occluded(self, num_frames: int) -> Tensor:
        """Share of each static path's amplitude that people take, as `ScenePaths.occluded`."""
        if not self.starts_m:
            return torch.zeros(num_frames, len(self.room.paths))
        return people_shadow(self.room.paths, self.starts_m, self.room.config.wavelength_m)
