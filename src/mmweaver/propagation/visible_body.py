"""One person's skin as seen by the radar, frame by frame: posed, with hull, distances and echoes."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from mmweaver.core.ray_caster import RayCaster
from mmweaver.propagation.antenna import pattern, scatterer_gain
from mmweaver.propagation.body_model import ScatteringBody
from mmweaver.propagation.paths import FrameClock, StaticPaths
from mmweaver.propagation.static_paths import PreparedRoom, RayTracedRoom


@dataclass(frozen=True, kw_only=True)
class BodyAtFrames:
    """One body posed in every frame. `motion` covers each time segment, the other arrays the frame's middle."""

    motion: np.ndarray  # (frame, segment, point, 3, 3) position, velocity, acceleration of the skin; m, m/s, m/s2
    place_m: np.ndarray  # (frame, point, 3)
    normal: np.ndarray  # (frame, point, 3)
    hulls: list[RayCaster]  # one per frame, with all people who may occlude

    @classmethod
    def of(
        cls,
        body: ScatteringBody,
        clock: FrameClock,
        joints_m: np.ndarray,
        trunk_m: np.ndarray | None,
        hulls: list[RayCaster] | None = None,
    ) -> "BodyAtFrames":
        """Poses a body.

        Args:
            body: The skin points.
            clock: Clock of the radar's frame.
            joints_m: Joints (frame, node, 22, 3) in metres at the clock's nodes.
            trunk_m: Outward displacement of chest and belly (frame, node, 2) in metres; None for none.
            hulls: Meshes of this body and all others that may occlude it, one per frame; by default the body's own.
                With an empty list no rays are cast.
        """
        frames, nodes = joints_m.shape[:2]
        skin = body.skin(joints_m.reshape(-1, 22, 3), None if trunk_m is None else trunk_m.reshape(-1, 2))
        places = skin.place_m.reshape(frames, nodes, -1, 3)
        normals = skin.normal.reshape(frames, nodes, -1, 3)
        return cls(
            motion=motion_through(places, clock),
            place_m=places[:, nodes // 2],
            normal=normals[:, nodes // 2],
            hulls=hulls_of([body], [joints_m]) if hulls is None else hulls,
        )

    def is_clear(self, start_m: np.ndarray, end_m: np.ndarray, margin_m: float, wanted: np.ndarray) -> np.ndarray:
        """Whether no body lies between two points.

        Args:
            start_m: Start points (frame, point, 3) in metres, or one (3,).
            end_m: End points (frame, point, 3) in metres.
            margin_m: Distance from either end within which faces are ignored.
            wanted: Mask (frame, point) of the pairs to test.

        Returns:
            Bool (frame, point), False where not wanted.
        """
        clear = wanted.copy()
        for frame, hull in enumerate(self.hulls):
            ask = np.flatnonzero(wanted[frame])
            start = np.broadcast_to(start_m, end_m.shape)[frame, ask].astype(float)
            clear[frame, ask] = hull.is_clear(start, end_m[frame, ask].astype(float), margin_m)
        return clear


def motion_through(nodes_m: np.ndarray, clock: FrameClock) -> np.ndarray:
    """Quadratics through positions at the nodes of each segment.

    Args:
        nodes_m: Positions (frame, segment * node, point, 3) in metres.
        clock: Clock of the radar's frame.

    Returns:
        Position, velocity and acceleration at the middle of each segment, (frame, segment, point, 3, 3), along the last
        but one axis.
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
    """One mesh per frame of all bodies together, posed at the middle of the frame.

    Args:
        bodies: The bodies.
        joints_m: Joints (frame, node, 22, 3) in metres of each.
    """
    posed = [body.hull(own[:, own.shape[1] // 2]) for body, own in zip(bodies, joints_m, strict=True)]
    first = np.cumsum([0, *(vertices.shape[1] for vertices, _ in posed)])
    faces = np.concatenate([faces + at for (_, faces), at in zip(posed, first, strict=False)])
    vertices = np.concatenate([vertices for vertices, _ in posed], axis=1)
    return [RayCaster(frame, faces) for frame in vertices]


def occluded_by(hull: RayCaster, paths: StaticPaths, asked: np.ndarray) -> np.ndarray:
    """Static paths that a body blocks before the first or after the last vertex.

    Args:
        hull: Mesh of the body.
        paths: Static paths, (path,).
        asked: Indices of the paths that are tested.

    Returns:
        Indices of the blocked ones.
    """
    first, last = paths.departure_vertex_m.numpy()[asked], paths.arrival_vertex_m.numpy()[asked]
    blocked = ~hull.is_clear(np.zeros_like(first), first, 0.02)
    other = np.flatnonzero(np.any(first != last, axis=1))
    blocked[other] |= ~hull.is_clear(last[other], np.zeros_like(last[other]), 0.02)
    return asked[blocked]


class VisibleBody:
    """One person in one room. Without rays, as here, all skin that faces the radar is visible."""

    def __init__(self, room: PreparedRoom, body: ScatteringBody, posed: BodyAtFrames):
        """Computes distances and angles of incidence.

        Args:
            room: The room.
            body: The person's skin points.
            posed: The body in every frame.
        """
        self.room, self.body, self.config, self.posed = room, body, room.config, posed
        self.num_frames = len(posed.place_m)
        self.distance_m = np.linalg.norm(posed.place_m, axis=-1)  # (frame, point)
        self.towards = -posed.place_m / np.maximum(self.distance_m, 1e-6)[..., None]  # (frame, point, 3) to the radar
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
        """Amplitudes (frame, point) of direct echoes as if all skin were visible, complex, in sqrt(mW)."""
        cross_section = self.body.echo.monostatic(self.cos) * self.body.area_m2 * self.body.brightness
        level = self.gain * self.pattern(-self.towards) ** 2 * np.sqrt(cross_section) / self.distance_m**2
        return level * self.body.micro_phase

    @property
    def direct_power(self) -> np.ndarray:
        """Power of the direct echoes (frame,), in mW."""
        return (np.abs(self.direct) ** 2 * self.visible).sum(axis=1)

    def pattern(self, direction: np.ndarray) -> np.ndarray:
        """Amplitude pattern (...) of one antenna in unit directions (..., 3)."""
        return pattern(direction.reshape(-1, 3), self.config).reshape(direction.shape[:-1])
