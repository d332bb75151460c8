"""Several people at once: each hides the others, their ghosts and the room as a body hides itself.

What goes from one person to another and then to the radar is not modelled; see docs/several_people.md.
"""

import numpy as np

from mmweaver.paths.adc_synthesis import EchoRows
from mmweaver.paths.body_model import ScatteringBody
from mmweaver.paths.body_paths import BodyEchoes, hulls_of, occluded_by
from mmweaver.paths.static_paths import RayTracedRoom, StaticEchoes


class PeopleEchoes:
    """Echo rows of all people in one room, frame by frame; none is an empty room.

    With `mutual` everybody stands in everybody's way, and what two of them hide of the room is hidden once. Without
    it each is as if alone, so that the whole is the plain sum of the people.
    """

    def __init__(
        self,
        room: RayTracedRoom,
        bodies: list[ScatteringBody],
        joints_m: list[np.ndarray],
        chests_m: list[np.ndarray] | None = None,
        *,
        mutual: bool = True,
    ):
        """`joints_m`: (frame, node, 22, 3) for each body; `chests_m`: how far its chest is raised (frame, node)."""
        chests = chests_m or [None] * len(bodies)
        self.room, self.mutual = room, mutual
        self.hulls = hulls_of(bodies, joints_m) if mutual and bodies else []
        self.each = [
            BodyEchoes(room, body, own, chest, self.hulls or None)
            for body, own, chest in zip(bodies, joints_m, chests, strict=True)
        ]

    def rows(self, frame: int) -> EchoRows:
        """Everything of the people that arrives in one frame."""
        if not self.each:
            nothing = np.zeros((0, 1, 3))
            return EchoRows(out_m=nothing, back_m=nothing, amplitude=np.zeros(0, complex), is_mixed=np.zeros(0, bool))
        return EchoRows.joined([one.rows(frame) for one in self.each])

    def shadowed(self, frame: int) -> list[StaticEchoes]:
        """The room's echoes that the people hide in one frame: those hidden by any, or by each."""
        if not self.mutual:
            return [one.shadowed(frame) for one in self.each]
        if not self.each:
            return []
        echoes = self.room.echoes
        near = np.unique(np.concatenate([one.near_body(echoes, frame) for one in self.each]))
        return [echoes.part(occluded_by(self.hulls[frame], echoes, near))]
