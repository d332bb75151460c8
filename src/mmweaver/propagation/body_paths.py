"""Paths of one person, direct and over one face of the room, and the static paths that the person occludes."""

from copy import copy
from dataclasses import dataclass, replace

import numpy as np
import torch

from mmweaver.core.ray_caster import RayCaster
from mmweaver.propagation.body_model import ScatteringBody
from mmweaver.propagation.image_method import SpecularReflector, fresnel_radius_m
from mmweaver.propagation.occlusion import Visibility
from mmweaver.propagation.paths import FrameClock, Interaction, Paths, StaticPaths
from mmweaver.propagation.second_order import BodyRoomPaths
from mmweaver.propagation.static_paths import PreparedRoom
from mmweaver.propagation.visible_body import BodyAtFrames, VisibleBody, occluded_by

GHOST_POINTS = 200
GHOST_SLAB_ECHOES = 2  # per face in body-wall paths: front, and back with all internal reflections
SKIN_MARGIN_M = 0.03  # a point on the skin is not occluded by its own capsule's hull
ROOM_MARGIN_M = 0.05  # nor by the seat it touches
WALL_MARGIN_M = 0.12  # largest distance between the mesh of a wall and its fitted plane
MIN_SHARE = 1e-4  # ghosts over one face with less than this share of the direct power are omitted,
LEFT_OUT = 0.02  # and the faintest paths of the others, up to this share of their power
CONE_MARGIN = 0.02  # around the skin as seen from the radar, in the cosine of the angle to its centre,
SIDE_MARGIN = 0.05  # and in the sine of the angle to its right and left


class BodyPaths(VisibleBody):
    """Paths of one person in one room, frame by frame.

    With a `known` visibility no ray is cast, and the room needs no ray caster.
    """

    def __init__(
        self,
        room: PreparedRoom,
        body: ScatteringBody,
        clock: FrameClock,
        joints_m: np.ndarray,
        trunk_m: np.ndarray | None = None,
        hulls: list[RayCaster] | None = None,
        known: Visibility | None = None,
    ):
        """Poses the person, and determines which paths are clear.

        Args:
            room: The room; a `RayTracedRoom` unless the visibility is known.
            body: The person's skin points.
            clock: Clock of the radar's frame.
            joints_m: Joints (frame, node, 22, 3) in metres at the clock's nodes.
            trunk_m: Outward displacement of chest and belly (frame, node, 2) in metres; by default none.
            hulls: One occluding mesh per frame, of all people present; by default the body's own.
            known: Visibility of an earlier run, used instead of rays.
        """
        super().__init__(room, body, BodyAtFrames.of(body, clock, joints_m, trunk_m, hulls if known is None else []))
        self.known = known
        self.over_faces: list[np.ndarray | None] = [None] * len(room.reflectors)
        self.visible = self._visible()
        self.parts = [SkinPaths(None, None, np.arange(len(body.micro_phase)), self.direct, self.visible)]
        direct = self.direct_power
        for index in range(len(room.reflectors)):
            self.parts += self._ghosts(index, direct)
        self.second: BodyRoomPaths | None = None
        if room.propagation.bounces > 1 and known is None:
            # a copy: a reference cycle would stay in memory until the garbage collector runs
            self.second = BodyRoomPaths(copy(self))

    def paths(self, frame: int) -> list[Paths]:
        """All paths over the person in one frame, one record (path,) per time segment."""
        of_segments = [
            Paths.cat([part.paths(frame, motion) for part in self.parts]) for motion in self.posed.motion[frame]
        ]
        if self.second is None:
            return of_segments
        second = self.second.paths(slice(frame, frame + 1))
        return [Paths.cat([first, second[index]]) for index, first in enumerate(of_segments)]

    def occluded_paths(self, frame: int) -> StaticPaths:
        """The static paths that the person occludes in one frame, (path,)."""
        return self.room.paths[torch.from_numpy(self.occluded(frame))]

    def occluded(self, frame: int) -> np.ndarray:
        """Indices of the static paths that the person occludes in one frame."""
        if self.known is not None:
            return np.flatnonzero(self.known.occluded[frame])
        return occluded_by(self.posed.hulls[frame], self.room.paths, self.occludable(frame))

    def visibility(self) -> Visibility:
        """The results of all ray casts, to be stored and passed as `known`."""
        occluded = np.zeros((self.num_frames, len(self.room.paths)), bool)
        for frame, row in enumerate(occluded):
            row[self.occluded(frame)] = True
        nothing = np.zeros((self.num_frames, len(ghost_points(self.body))), bool)
        over_faces = [nothing if clear is None else clear for clear in self.over_faces]
        return Visibility(
            skin=self.visible,
            over_faces=np.stack(over_faces, 1) if over_faces else nothing[:, None][:, :0],
            occluded=occluded,
        )

    def occludable(self, frame: int) -> np.ndarray:
        """Indices of the static paths that the body may occlude: those within a cone and a wedge around it."""
        away = -self.towards[frame]
        axis = self.posed.place_m[frame].mean(axis=0)
        ahead = axis / np.linalg.norm(axis)
        right = np.array([axis[1], -axis[0], 0.0]) / max(np.hypot(axis[0], axis[1]), 1e-9)
        opening, across = (away @ ahead).min() - CONE_MARGIN, away @ right
        first, last = across.min() - SIDE_MARGIN, across.max() + SIDE_MARGIN
        near = np.zeros(len(self.room.paths), bool)
        for directions in self.room.vertex_directions:
            sideways = directions @ right
            near |= (directions @ ahead > opening) & (sideways > first) & (sideways < last)
        return np.flatnonzero(near)

    def _visible(self) -> np.ndarray:
        if self.known is not None:
            return self.known.skin
        facing = self.cos > self.body.echo.least_cos
        facing &= self.traced.is_clear(np.zeros(3), self.posed.place_m, ROOM_MARGIN_M)
        return self.posed.is_clear(np.zeros(3), self.posed.place_m, SKIN_MARGIN_M, facing)

    def _ghosts(self, index: int, direct_power: np.ndarray) -> list["SkinPaths"]:
        """Paths over one face on departure or arrival, and over that face on both."""
        face, count, chosen = self.room.reflectors[index], len(self.body.micro_phase), ghost_points(self.body)
        place, normal = self.posed.place_m[:, chosen], self.posed.normal[:, chosen]
        area_m2 = self.body.area_m2 * self.body.brightness[chosen] * count / len(chosen)
        image = face.image(place)
        length_m = np.linalg.norm(image, axis=-1)
        corner = face.crossing(np.zeros(3), image)
        leg_m = np.linalg.norm(corner, axis=-1)
        to_corner = (corner - place) / np.maximum(length_m - leg_m, 1e-6)[..., None]
        cos = np.clip((normal * to_corner).sum(-1), -1, 1)  # undefined where skin touches the face
        taper = face.inside(corner, fresnel_radius_m(leg_m, length_m - leg_m, self.config.wavelength_m))
        seen = (cos > 0.02) & (face.side(place) > 0.02) & (taper > 0.02) & (length_m < 2 * self.config.max_range_m)
        if not seen.any():
            return []
        most = min(GHOST_SLAB_ECHOES, self.room.propagation.slab_echoes)
        slab = face.echoes(to_corner, self.config.centre_frequency_hz, most)
        over = self.gain * self.pattern(corner / np.maximum(leg_m, 1e-6)[..., None]) / length_m * taper
        micro = self.body.micro_phase[chosen]
        direct = self.pattern(-self.towards[:, chosen]) / self.distance_m[:, chosen]
        half = to_corner + self.towards[:, chosen]
        cos_half = (normal * half).sum(-1) / np.maximum(np.linalg.norm(half, axis=-1), 1e-6)
        skin = self.body.echo
        mixed = over * direct * np.sqrt(skin.bistatic(self.cos[:, chosen], cos, cos_half) * area_m2) * micro
        double = over**2 / self.gain * np.sqrt(skin.monostatic(cos) * area_m2) * micro
        once = seen & self.visible[:, chosen]
        ghosts = [
            *(SkinPaths(None, face, chosen, mixed * echo, once, longer_m) for echo, longer_m in slab),
            *(SkinPaths(face, face, chosen, double * echo, seen, longer_m) for echo, longer_m in slab.doubled),
        ]
        ghosts = [ghost for ghost in (ghost.strongest(direct_power) for ghost in ghosts) if ghost.present.any()]
        if not ghosts:
            return []
        asked = np.any([ghost.present for ghost in ghosts], axis=0)
        clear = self._clear_legs(corner, place, asked) if self.known is None else self.known.over_faces[:, index]
        self.over_faces[index] = clear
        return [replace(ghost, present=ghost.present & clear) for ghost in ghosts]

    def _clear_legs(self, corner: np.ndarray, place: np.ndarray, ask: np.ndarray) -> np.ndarray:
        """Whether the legs from radar to face and from face to skin are clear of the room and of the body."""
        which = np.nonzero(ask)
        clear = ask.copy()
        for start, end in ((np.zeros_like(corner), corner), (corner, place)):
            clear[which] &= self.traced.is_clear(start[which], end[which], WALL_MARGIN_M)
        clear = self.posed.is_clear(np.zeros(3), corner, SKIN_MARGIN_M, clear)
        return self.posed.is_clear(corner, place, SKIN_MARGIN_M, clear)


def ghost_points(body: ScatteringBody) -> np.ndarray:
    """Indices of the few skin points that represent the body in specular multipath."""
    count = len(body.micro_phase)
    return np.unique(np.linspace(0, count - 1, min(GHOST_POINTS, count)).astype(int))


@dataclass(frozen=True)
class SkinPaths:
    """One kind of path over selected skin points in all frames.

    `departure` and `arrival` are the faces that the wave meets before and after the skin. A path over one face counts
    in both directions of travel.
    """

    departure: SpecularReflector | None
    arrival: SpecularReflector | None
    points: np.ndarray  # (path,)
    amplitude: np.ndarray  # (frame, path) complex
    present: np.ndarray  # (frame, path) bool
    longer_m: np.ndarray | None = None  # (frame, path) excess length over the reflection at the face's front

    def strongest(self, direct_power: np.ndarray) -> "SkinPaths":
        """The relevant paths: without frames whose ghosts are negligible, and without the faintest paths of the others.

        Args:
            direct_power: Power (frame,) of the direct paths in mW.

        Returns:
            The same paths, with fewer marked as present.
        """
        power = np.abs(self.amplitude) ** 2 * self.present
        order = np.argsort(power, axis=1)
        below: np.ndarray = np.cumsum(np.take_along_axis(power, order, axis=1), axis=1)
        total = below[:, -1:]
        strong = np.zeros_like(self.present)
        np.put_along_axis(strong, order, below > LEFT_OUT * total, axis=1)
        return replace(self, present=self.present & strong & (total > MIN_SHARE * direct_power[:, None]))

    def paths(self, frame: int, motion: np.ndarray) -> Paths:
        """The paths present in one time segment of a frame.

        Args:
            frame: Index of the frame.
            motion: Position, velocity and acceleration (point, 3, 3) of all skin points in m, m/s, m/s2.

        Returns:
            Paths (path,).
        """
        there = self.present[frame]
        skin = motion[self.points[there]]
        departure, arrival = (skin if face is None else face.image_of_motion(skin) for face in self.faces)
        if self.longer_m is not None:
            arrival[:, 0] *= 1 + (self.longer_m[frame, there] / np.linalg.norm(arrival[:, 0], axis=1))[:, None]
        is_reciprocal = self.departure is not self.arrival
        amplitude = self.amplitude[frame, there]
        return Paths.of(amplitude, departure, arrival, self.interaction, is_reciprocal=is_reciprocal)

    @property
    def faces(self) -> tuple[SpecularReflector | None, SpecularReflector | None]:
        """The faces met on departure and on arrival, None for a direct leg."""
        return self.departure, self.arrival

    @property
    def interaction(self) -> Interaction:
        """The kind of path, by the number of its legs that lead over a face."""
        kinds = (Interaction.BODY, Interaction.BODY_WALL, Interaction.WALL_BODY_WALL)
        return kinds[sum(face is not None for face in self.faces)]
