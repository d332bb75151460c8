"""A person's echoes: direct, over one wall, over a wall both ways; and the shadow the person casts."""

from dataclasses import dataclass, replace

import numpy as np

from mmweaver.geometry.ray_caster import RayCaster
from mmweaver.paths.adc_synthesis import EchoRows
from mmweaver.paths.antenna import pattern, scatterer_gain
from mmweaver.paths.body_model import ScatteringBody
from mmweaver.paths.image_method import SpecularReflector, fresnel_radius_m
from mmweaver.paths.static_paths import PreparedRoom, RayTracedRoom, StaticEchoes
from mmweaver.paths.visibility import Visibility

GHOST_POINTS = 200
SKIN_MARGIN_M = 0.03  # a point on the skin is not hidden by its own capsule's hull
ROOM_MARGIN_M = 0.05  # nor by the seat it touches
WALL_MARGIN_M = 0.12  # the mesh of a wall and its fitted plane differ by so much at most
FAINTEST = 1e-4  # ghosts over one face of less power than this share of the direct echoes are left out,
LEFT_OUT = 0.02  # and so much of the others' power, in their faintest rows


@dataclass(frozen=True, kw_only=True)
class BodyAtFrames:
    """One body posed at the nodes of every frame; `middle` arrays belong to the frame's middle."""

    nodes_m: np.ndarray  # (frame, node, point, 3)
    place_m: np.ndarray  # (frame, point, 3)
    normal: np.ndarray  # (frame, point, 3)
    hulls: list[RayCaster]  # one a frame, of everybody who may stand in the way

    @classmethod
    def of(
        cls,
        body: ScatteringBody,
        joints_m: np.ndarray,
        chest_m: np.ndarray | None,
        hulls: list[RayCaster] | None = None,
    ) -> "BodyAtFrames":
        """Joints (frame, node, 22, 3), chest (frame, node); the middle node counts as the frame's middle.

        `hulls` stand for this body and all others that may hide it; the body's own if None, and no rays if empty.
        """
        frames, nodes = joints_m.shape[:2]
        skin = body.skin(joints_m.reshape(-1, 22, 3), None if chest_m is None else chest_m.ravel())
        places = skin.place_m.reshape(frames, nodes, -1, 3)
        normals = skin.normal.reshape(frames, nodes, -1, 3)
        return cls(
            nodes_m=places,
            place_m=places[:, nodes // 2],
            normal=normals[:, nodes // 2],
            hulls=hulls_of([body], [joints_m]) if hulls is None else hulls,
        )

    def is_clear(self, start_m: np.ndarray, end_m: np.ndarray, margin_m: float, wanted: np.ndarray) -> np.ndarray:
        """True where wanted and no body lies between; start (frame, point, 3) or (3,)."""
        clear = wanted.copy()
        for frame, hull in enumerate(self.hulls):
            ask = np.flatnonzero(wanted[frame])
            start = np.broadcast_to(start_m, end_m.shape)[frame, ask].astype(float)
            clear[frame, ask] = hull.is_clear(start, end_m[frame, ask].astype(float), margin_m)
        return clear


def hulls_of(bodies: list[ScatteringBody], joints_m: list[np.ndarray]) -> list[RayCaster]:
    """One mesh a frame of all bodies together, posed at the frame's middle; joints (frame, node, 22, 3) of each."""
    posed = [body.hull(own[:, own.shape[1] // 2]) for body, own in zip(bodies, joints_m, strict=True)]
    first = np.cumsum([0, *(vertices.shape[1] for vertices, _ in posed)])
    faces = np.concatenate([faces + at for (_, faces), at in zip(posed, first, strict=False)])
    vertices = np.concatenate([vertices for vertices, _ in posed], axis=1)
    return [RayCaster(frame, faces) for frame in vertices]


def occluded_by(hull: RayCaster, echoes: StaticEchoes, near: np.ndarray) -> np.ndarray:
    """Rows of the room's echoes (`near` are asked) whose way out or back a body blocks."""
    first, last = echoes.first_m[near], echoes.last_m[near]
    blocked = ~hull.is_clear(np.zeros_like(first), first, 0.02)
    other = np.flatnonzero(np.any(first != last, axis=1))
    blocked[other] |= ~hull.is_clear(last[other], np.zeros_like(last[other]), 0.02)
    return near[blocked]


class BodyEchoes:
    """Echo rows of one person in one room, frame by frame.

    With `known`, what rays once found out, nothing is asked of them, and the room needs no ray caster.
    """

    def __init__(
        self, room: PreparedRoom, body: ScatteringBody, joints_m: np.ndarray, chest_m: np.ndarray | None = None,
        hulls: list[RayCaster] | None = None, known: Visibility | None = None,
    ):  # fmt: skip
        self.room, self.body, self.config, self.known = room, body, room.config, known
        self.posed = BodyAtFrames.of(body, joints_m, chest_m, hulls if known is None else [])
        self.over_faces: list[np.ndarray | None] = [None] * len(room.mirrors)
        self.num_frames = len(joints_m)
        self.distance_m = np.linalg.norm(self.posed.place_m, axis=-1)
        self.towards = -self.posed.place_m / np.maximum(self.distance_m, 1e-6)[..., None]
        self.cos = (self.posed.normal * self.towards).sum(-1)
        self.visible = self._visible()
        self.gain = scatterer_gain(self.config)
        self.parts = [self._direct()]
        direct = self.parts[0].power()
        for index in range(len(room.mirrors)):
            self.parts += self._ghosts(index, direct)

    def rows(self, frame: int) -> EchoRows:
        """Everything of the person that arrives in one frame."""
        return EchoRows.joined([part.rows(frame, self.posed.nodes_m[frame]) for part in self.parts])

    def shadowed(self, frame: int) -> StaticEchoes:
        """The room's echoes that the person hides in one frame."""
        return self.room.echoes.part(self.hidden(frame))

    def hidden(self, frame: int) -> np.ndarray:
        """Rows of the room's echoes that the person hides in one frame."""
        echoes = self.room.echoes
        if self.known is not None:
            return np.flatnonzero(self.known.hidden[frame])
        return occluded_by(self.posed.hulls[frame], echoes, self.near_body(echoes, frame))

    def visibility(self) -> Visibility:
        """What the rays found out, to be kept."""
        hidden = np.zeros((self.num_frames, len(self.room.echoes)), bool)
        for frame, row in enumerate(hidden):
            row[self.hidden(frame)] = True
        nothing = np.zeros((self.num_frames, len(ghost_points(self.body))), bool)
        over_faces = [nothing if clear is None else clear for clear in self.over_faces]
        return Visibility(
            skin=self.visible, over_faces=np.stack(over_faces, 1) if over_faces else nothing[:, None][:, :0],
            hidden=hidden,
        )  # fmt: skip

    def near_body(self, echoes: StaticEchoes, frame: int) -> np.ndarray:
        """Rows within the cone that the body fills, seen from the radar."""
        axis = self.posed.place_m[frame].mean(axis=0)
        axis = axis / np.linalg.norm(axis)
        opening = (-self.towards[frame] @ axis).min() - 0.02
        unit = [
            ends / np.maximum(np.linalg.norm(ends, axis=1, keepdims=True), 1e-9)
            for ends in (echoes.first_m, echoes.last_m)
        ]
        return np.flatnonzero((unit[0] @ axis > opening) | (unit[1] @ axis > opening))

    def _visible(self) -> np.ndarray:
        if self.known is not None:
            return self.known.skin
        facing = self.cos > self.body.echo.least_cos
        facing &= self._traced.is_clear(np.zeros(3), self.posed.place_m, ROOM_MARGIN_M)
        return self.posed.is_clear(np.zeros(3), self.posed.place_m, SKIN_MARGIN_M, facing)

    @property
    def _traced(self) -> RayTracedRoom:
        assert isinstance(self.room, RayTracedRoom), "a room without rays needs a known visibility"
        return self.room

    def _direct(self) -> "Rows":
        cross_section = self.body.echo.back(self.cos) * self.body.area_m2 * self.body.brightness
        amplitude = self.gain * self._pattern(-self.towards) ** 2 * np.sqrt(cross_section) / self.distance_m**2
        return Rows(
            None, None, np.arange(len(self.body.micro_phase)), amplitude * self.body.micro_phase, self.visible, False
        )

    def _ghosts(self, index: int, direct_power: np.ndarray) -> list["Rows"]:
        """Out directly and back over a face (and the reverse), and over the face both ways."""
        mirror, count, chosen = self.room.mirrors[index], len(self.body.micro_phase), ghost_points(self.body)
        place, normal = self.posed.place_m[:, chosen], self.posed.normal[:, chosen]
        area_m2 = self.body.area_m2 * self.body.brightness[chosen] * count / len(chosen)
        image = mirror.image(place)
        way_m = np.linalg.norm(image, axis=-1)
        corner = mirror.crossing(np.zeros(3), image)
        leg_m = np.linalg.norm(corner, axis=-1)
        to_corner = (corner - place) / np.maximum(way_m - leg_m, 1e-6)[..., None]
        cos = np.clip((normal * to_corner).sum(-1), -1, 1)  # skin that touches the face has no direction to it
        taper = mirror.inside(corner, fresnel_radius_m(leg_m, way_m - leg_m, self.config.wavelength_m))
        cos_face = np.abs(to_corner @ mirror.plane.normal)
        seen = (cos > 0.02) & (mirror.side(place) > 0.02) & (taper > 0.02) & (way_m < 2 * self.config.max_range_m)
        if not seen.any():
            return []
        coefficient = taper * mirror.coefficient(cos_face, self.config.centre_frequency_hz)
        over = self.gain * self._pattern(corner / np.maximum(leg_m, 1e-6)[..., None]) / way_m * coefficient
        micro = self.body.micro_phase[chosen]
        direct = self._pattern(-self.towards[:, chosen]) / self.distance_m[:, chosen]
        half = to_corner + self.towards[:, chosen]
        cos_half = (normal * half).sum(-1) / np.maximum(np.linalg.norm(half, axis=-1), 1e-6)
        skin = self.body.echo
        mixed = over * direct * np.sqrt(skin.over(self.cos[:, chosen], cos, cos_half) * area_m2) * micro
        double = over**2 / self.gain * np.sqrt(skin.back(cos) * area_m2) * micro
        ghosts = [
            Rows(None, mirror, chosen, mixed, seen & self.visible[:, chosen], True),
            Rows(mirror, mirror, chosen, double, seen, False),
        ]
        ghosts = [ghost for ghost in (ghost.strongest(direct_power) for ghost in ghosts) if ghost.present.any()]
        if not ghosts:
            return []
        asked = np.any([ghost.present for ghost in ghosts], axis=0)
        clear = self._clear_legs(corner, place, asked) if self.known is None else self.known.over_faces[:, index]
        self.over_faces[index] = clear
        return [replace(ghost, present=ghost.present & clear) for ghost in ghosts]

    def _clear_legs(self, corner: np.ndarray, place: np.ndarray, ask: np.ndarray) -> np.ndarray:
        """Radar to face and face to skin, past the room and past the body."""
        which = np.nonzero(ask)
        clear = ask.copy()
        for start, end in ((np.zeros_like(corner), corner), (corner, place)):
            clear[which] &= self._traced.is_clear(start[which], end[which], WALL_MARGIN_M)
        clear = self.posed.is_clear(np.zeros(3), corner, SKIN_MARGIN_M, clear)
        return self.posed.is_clear(corner, place, SKIN_MARGIN_M, clear)

    def _pattern(self, direction: np.ndarray) -> np.ndarray:
        return pattern(direction.reshape(-1, 3), self.config).reshape(direction.shape[:-1])


def ghost_points(body: ScatteringBody) -> np.ndarray:
    """Those of a body's points that stand for it in mirrors."""
    count = len(body.micro_phase)
    return np.unique(np.linspace(0, count - 1, min(GHOST_POINTS, count)).astype(int))


@dataclass(frozen=True)
class Rows:
    """One kind of echo of the chosen skin points in all frames."""

    out: SpecularReflector | None
    back: SpecularReflector | None
    points: np.ndarray  # (row,)
    amplitude: np.ndarray  # (frame, row) complex
    present: np.ndarray  # (frame, row)
    is_mixed: bool

    def power(self) -> np.ndarray:
        """(frame,) of all rows that are present."""
        return (np.abs(self.amplitude) ** 2 * self.present).sum(axis=1)

    def strongest(self, direct_power: np.ndarray) -> "Rows":
        """Without the frames that hardly add to the direct echoes, and without the faintest rows of the others."""
        power = np.abs(self.amplitude) ** 2 * self.present
        order = np.argsort(power, axis=1)
        below = np.cumsum(np.take_along_axis(power, order, axis=1), axis=1)
        total = below[:, -1:]
        strong = np.zeros_like(self.present)
        np.put_along_axis(strong, order, below > LEFT_OUT * total, axis=1)
        return replace(self, present=self.present & strong & (total > FAINTEST * direct_power[:, None]))

    def rows(self, frame: int, nodes_m: np.ndarray) -> EchoRows:
        """The rows of one frame; `nodes_m` (node, point, 3)."""
        there = self.present[frame]
        place = nodes_m[:, self.points[there]].transpose(1, 0, 2)
        return EchoRows(
            out_m=self.out.image(place) if self.out else place,
            back_m=self.back.image(place) if self.back else place,
            amplitude=self.amplitude[frame, there],
            is_mixed=np.full(int(there.sum()), self.is_mixed),
        )
