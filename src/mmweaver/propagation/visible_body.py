"""One person's skin as the radar sees it, frame by frame: posed, with its hull, its distances and its echoes."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from mmweaver.core.ray_caster import RayCaster
from mmweaver.propagation.antenna import pattern, scatterer_gain
from mmweaver.propagation.body_model import ScatteringBody
from mmweaver.propagation.frame_clock import FrameClock
from mmweaver.propagation.paths import StaticPaths
from mmweaver.propagation.static_paths import PreparedRoom, RayTracedRoom


@dataclass(frozen=True, kw_only=True)
class BodyAtFrames:
    """One body posed in every frame. `motion` covers each time segment, the other arrays the frame's middle."""

    motion: np.ndarray  # (frame, segment, point, 3, 3) position, velocity, acceleration of the skin; m, m/s, m/s2
    place_m: np.ndarray  # (frame, point, 3)
    normal: np.ndarray  # (frame, point, 3)
    hulls: list[RayCaster]  # one per frame, of all people who may occlude

    @classmethod
    def of(
        cls,
        body: ScatteringBody,
        clock: FrameClock,
        joints_m: np.ndarray,
        chest_m: np.ndarray | None,
        hulls: list[RayCaster] | None = None,
    ) -> "BodyAtFrames":
        """Joints (frame, node, 22, 3) and chest (frame, node) at the clock's nodes.

        `hulls` stand for this body and all others that may occlude it; the body's own if None, and no rays if empty.
        """
        frames, nodes = joints_m.shape[:2]
        skin = body.skin(joints_m.reshape(-1, 22, 3), None if chest_m is None else chest_m.ravel())
        places = skin.place_m.reshape(frames, nodes, -1, 3)
        normals = skin.normal.reshape(frames, nodes, -1, 3)
        return cls(
            motion=motion_through(places, clock),
            place_m=places[:, nodes // 2],
            normal=normals[:, nodes // 2],
            hulls=hulls_of([body], [joints_m]) if hulls is None else hulls,
        )

    def is_clear(self, start_m: np.ndarray, end_m: np.ndarray, margin_m: float, wanted: np.ndarray) -> np.ndarray:
        """Bool (frame, point): wanted, and no body lies between start (frame, point, 3) or (3,) and end."""
        clear = wanted.copy()
        for frame, hull in enumerate(self.hulls):
            ask = np.flatnonzero(wanted[frame])
            start = np.broadcast_to(start_m, end_m.shape)[frame, ask].astype(float)
            clear[frame, ask] = hull.is_clear(start, end_m[frame, ask].astype(float), margin_m)
        return clear


def motion_through(nodes_m: np.ndarray, clock: FrameClock) -> np.ndarray:
    """Positions (frame, segment * node, point, 3) -> the quadratics through them, (frame, segment, point, 3, 3).

    The last but one axis is position, velocity and acceleration at the middle of the segment.
    """
    frames, _, points, _ = nodes_m.shape
    out = np.empty((frames, len(clock.segments), points, 3, 3))
    for index, segment in enumerate(clock.segments):
        before, middle, after = (nodes_m[:, 3 * index + node] for node in range(3))
        reach_s = segment.node_s[2]
        out[:, index, :, 0] = middle
        out[:, index, :, 1] = (after - before) / (2 * reach_s)
        out[:, index, :, 2] = (before + after - 2 * middle) / reach_s**2
    return out


def hulls_of(bodies: list[ScatteringBody], joints_m: list[np.ndarray]) -> list[RayCaster]:
    """One mesh per frame of all bodies together, posed at the frame's middle; joints (frame, node, 22, 3) of each."""
    posed = [body.hull(own[:, own.shape[1] // 2]) for body, own in zip(bodies, joints_m, strict=True)]
    first = np.cumsum([0, *(vertices.shape[1] for vertices, _ in posed)])
    faces = np.concatenate([faces + at for (_, faces), at in zip(posed, first, strict=False)])
    vertices = np.concatenate([vertices for vertices, _ in posed], axis=1)
    return [RayCaster(frame, faces) for frame in vertices]


def occluded_by(hull: RayCaster, paths: StaticPaths, asked: np.ndarray) -> np.ndarray:
    """Which static paths a body blocks before the first or after the last vertex.

    Args:
        hull: of the body.
        paths: static paths.
        asked: indices of those that are tested.

    Returns:
        Indices of the blocked ones.
    """
    first, last = paths.departure_vertex_m.numpy()[asked], paths.arrival_vertex_m.numpy()[asked]
    blocked = ~hull.is_clear(np.zeros_like(first), first, 0.02)
    other = np.flatnonzero(np.any(first != last, axis=1))
    blocked[other] |= ~hull.is_clear(last[other], np.zeros_like(last[other]), 0.02)
    return asked[blocked]


class VisibleBody:
    """One person in one room. Without a ray, as here, all skin that faces the radar is visible."""

    def __init__(self, room: PreparedRoom, body: ScatteringBody, posed: BodyAtFrames):
        self.room, self.body, self.config, self.posed = room, body, room.config, posed
        self.num_frames = len(posed.place_m)
        self.distance_m = np.linalg.norm(posed.place_m, axis=-1)  # (frame, point)
        self.towards = -posed.place_m / np.maximum(self.distance_m, 1e-6)[..., None]  # (frame, point, 3) the radar
        self.cos = (posed.normal * self.towards).sum(-1)
        self.visible = self.cos > body.echo.least_cos
        self.gain = scatterer_gain(self.config)

    @property
    def traced(self) -> RayTracedRoom:
        """The room, with its ray caster."""
        assert isinstance(self.room, RayTracedRoom), "a room without a ray caster needs a known visibility"
        return self.room

    @cached_property
    def direct(self) -> np.ndarray:
        """Amplitudes (frame, point) of direct echoes, were all skin visible, complex, in sqrt(mW)."""
        cross_section = self.body.echo.monostatic(self.cos) * self.body.area_m2 * self.body.brightness
        level = self.gain * self.pattern(-self.towards) ** 2 * np.sqrt(cross_section) / self.distance_m**2
        return level * self.body.micro_phase

    @property
    def direct_power(self) -> np.ndarray:
        """Power of the direct echoes (frame,), in mW."""
        return (np.abs(self.direct) ** 2 * self.visible).sum(axis=1)

    def pattern(self, direction: np.ndarray) -> np.ndarray:
        """Amplitude of one antenna in unit directions (..., 3)."""
        return pattern(direction.reshape(-1, 3), self.config).reshape(direction.shape[:-1])
