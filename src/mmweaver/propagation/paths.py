"""Propagation paths from a radar back to itself: the output of both path solvers and the input of the renderers.

Coordinates are the radar's (x right, y away, z up, origin at the array's centre) in SI units. Amplitudes are those at
the receiver's port in sqrt(mW), without the phase of the carrier, exp(j 2 pi length / wavelength).
"""

from dataclasses import dataclass, replace
from enum import IntEnum

import numpy as np
import torch
from torch import Tensor

from mmweaver.core.tensor_record import TensorRecord


class Interaction(IntEnum):
    """What a wave interacts with along a path."""

    DIFFUSE = 0  # a rough surface of the room
    SPECULAR = 1  # one or more flat faces of the room
    EDGE = 2  # a rim or a leg of furniture
    BODY = 3
    BODY_WALL = 4  # the body, and a face before or after it
    WALL_BODY_WALL = 5  # the body, and the same face before and after it
    BODY_ROOM = 6  # the body, and a rough surface before or after it
    BODY_RADAR_BODY = 7  # the body, the radar's own board, and the body again
    ROOM_ROOM = 8  # two surfaces of the room, at least one of them rough
    CLUTTER = 9  # something in the room that photo and mesh do not resolve
    BODY_BODY = 10  # two people, one after the other
    TARGET = 11  # a reflector of known cross section
    THING = 12  # something that moves but is nobody


STATIC_KINDS = (Interaction.DIFFUSE, Interaction.SPECULAR, Interaction.EDGE)  # of first order, as a room has them


@dataclass(frozen=True, kw_only=True)
class ApparentPoint(TensorRecord):
    """Apparent position of one end of a path as seen from the array: the scatterer, or its image in a face.

    Quadratic in time about the middle of a time segment. Float64, since float32 resolves 4 m to 0.2 um, 1e-3 rad of
    phase.
    """

    position_m: Tensor  # (..., path, 3)
    velocity_mps: Tensor  # (..., path, 3)
    acceleration_mps2: Tensor  # (..., path, 3)

    @classmethod
    def of(cls, motion: np.ndarray) -> "ApparentPoint":
        """From position, velocity and acceleration (..., path, 3, 3), which lie along the last but one axis."""
        position, velocity, acceleration = (
            torch.from_numpy(np.ascontiguousarray(motion[..., order, :], np.float64)) for order in range(3)
        )
        return cls(position_m=position, velocity_mps=velocity, acceleration_mps2=acceleration)

    def positions_m(self, time_s: Tensor) -> Tensor:
        """Positions over time.

        Args:
            time_s: Times (time,) since the middle of the segment.

        Returns:
            Positions (..., time, 3, path) in metres, float64.
        """
        position, velocity, acceleration = (
            part.mT.contiguous()[..., None, :, :]
            for part in (self.position_m, self.velocity_mps, self.acceleration_mps2)
        )
        time = time_s[:, None, None]
        return (acceleration * (time**2 / 2)).addcmul_(velocity, time).add_(position)

    def later(self, time_s: float) -> "ApparentPoint":
        """The same motion about another middle, `time_s` seconds later."""
        return ApparentPoint(
            position_m=self.position_m + time_s * self.velocity_mps + time_s**2 / 2 * self.acceleration_mps2,
            velocity_mps=self.velocity_mps + time_s * self.acceleration_mps2,
            acceleration_mps2=self.acceleration_mps2,
        )

    @property
    def distance_m(self) -> Tensor:
        """Distance (..., path) from the array's centre, float64."""
        return self.position_m.norm(dim=-1)

    @property
    def direction(self) -> Tensor:
        """Unit vectors (..., path, 3) from the array's centre, float64."""
        return self.position_m / self.distance_m.clamp(min=1e-9)[..., None]

    @property
    def rate_mps(self) -> Tensor:
        """Rate of change (..., path) of the distance."""
        return (self.direction * self.velocity_mps).sum(-1)

    @property
    def distance_acceleration_mps2(self) -> Tensor:
        """Second derivative (..., path) of the distance, with the contribution of tangential motion."""
        across2 = self.velocity_mps.square().sum(-1) - self.rate_mps.square()
        return (self.direction * self.acceleration_mps2).sum(-1) + across2 / self.distance_m.clamp(min=1e-9)


@dataclass(frozen=True, kw_only=True)
class Paths(TensorRecord):
    """Moving paths, one row per time segment: one per frame, or several per frame with long chirp sequences.

    The wave seems to travel to `departure` and to return from `arrival`, which coincide for a direct echo. Between a
    transmitter at t and a receiver at r the path length is |departure - t| + |arrival - r|. A reciprocal path is
    travelled in the opposite direction, too, and both add coherently. Padding has zero amplitude.
    """

    amplitude: Tensor  # (..., path) complex64
    departure: ApparentPoint
    arrival: ApparentPoint
    is_reciprocal: Tensor  # (..., path) bool
    interaction: Tensor  # (..., path) uint8, an `Interaction`

    @classmethod
    def of(
        cls,
        amplitude: np.ndarray,
        departure: np.ndarray,
        arrival: np.ndarray,
        interaction: Interaction,
        *,
        is_reciprocal: bool = False,
    ) -> "Paths":
        """Paths of one kind, from arrays.

        Args:
            amplitude: Amplitudes (path,) in sqrt(mW).
            departure: Position, velocity and acceleration (..., path, 3, 3) of the departure points.
            arrival: The same of the arrival points.
            interaction: Kind of all paths.
            is_reciprocal: Whether the wave travels the paths in both directions.
        """
        shape = departure.shape[:-2]
        return cls(
            amplitude=torch.from_numpy(amplitude.astype(np.complex64)).expand(shape),
            departure=ApparentPoint.of(departure),
            arrival=ApparentPoint.of(arrival),
            is_reciprocal=torch.full(shape, is_reciprocal),
            interaction=torch.full(shape, int(interaction), dtype=torch.uint8),
        )

    @classmethod
    def direct(cls, amplitude: Tensor, scatterer: ApparentPoint) -> "Paths":
        """Direct echoes of moving scatterers.

        Args:
            amplitude: Amplitudes (..., path) in sqrt(mW).
            scatterer: The scatterers, (..., path).
        """
        return cls(
            amplitude=amplitude.to(torch.complex64),
            departure=scatterer,
            arrival=scatterer,
            is_reciprocal=torch.zeros(amplitude.shape, dtype=torch.bool),
            interaction=torch.full(amplitude.shape, int(Interaction.BODY), dtype=torch.uint8),
        )

    @staticmethod
    def padded(parts: list["Paths"]) -> "Paths":
        """Stacks the paths of several segments, padded at the end with amplitudes of zero.

        Args:
            parts: Paths (path,) of one segment each, or (segment, path) of several.

        Returns:
            Paths (segment, path).
        """
        longest = max((one.amplitude.shape[-1] for one in parts), default=0)
        axis = parts[0].amplitude.ndim - 1

        def filled(tensor: Tensor) -> Tensor:
            out = tensor.new_zeros((*tensor.shape[:axis], longest, *tensor.shape[axis + 1 :]))
            out.narrow(axis, 0, tensor.shape[axis]).copy_(tensor)
            return out

        each = [one if one.amplitude.shape[-1] == longest else one.map(filled) for one in parts]
        return Paths.cat(each) if axis else Paths.stack(each)

    @classmethod
    def none(cls) -> "Paths":
        """No paths, (0,)."""
        nothing = np.zeros((0, 3, 3))
        return cls.of(np.zeros(0), nothing, nothing, Interaction.BODY)

    def of_segment(self, source: int, count: int, frame: int = 0, late_s: float = 0.0) -> "Paths":
        """Paths (frame, path) of one time segment of every frame, or of the frames before or after.

        Where there is no frame before or after, the motion of the nearest segment goes on.

        Args:
            source: Number of the segment.
            count: Number of segments per frame.
            frame: -1, 0 or 1: which frames' segments, relative to every frame.
            late_s: Middle of the segment minus that of the nearest segment of the frame itself.
        """
        rows = self[source::count]
        if not frame:
            return rows
        nearest = self[:1] if frame < 0 else self[-1:]
        edge = replace(nearest, departure=nearest.departure.later(late_s), arrival=nearest.arrival.later(late_s))
        return Paths.cat([edge, rows[:-1]]) if frame < 0 else Paths.cat([rows[1:], edge])

    def __len__(self) -> int:
        return len(self.amplitude)

    @property
    def length_m(self) -> Tensor:
        """Path length (..., path) from the array's centre and back at the middle of the segment, float64."""
        return self.departure.distance_m + self.arrival.distance_m

    @property
    def rate_mps(self) -> Tensor:
        """Rate of change (..., path) of the path length: twice the radial velocity of a direct echo."""
        return self.departure.rate_mps + self.arrival.rate_mps

    @property
    def acceleration_mps2(self) -> Tensor:
        """Second derivative (..., path) of the path length."""
        return self.departure.distance_acceleration_mps2 + self.arrival.distance_acceleration_mps2


@dataclass(frozen=True, kw_only=True)
class StaticPaths(TensorRecord):
    """Paths of a room without people, the same in all frames.

    The length is kept per antenna pair, which is exact for specular paths, too, whose images rotate the array. A body
    in front of either vertex occludes the path.
    """

    amplitude: Tensor  # (..., path) complex128
    length_m: Tensor  # (..., path, tx, rx) float64
    departure_vertex_m: Tensor  # (..., path, 3) where the wave first meets the room, float64
    arrival_vertex_m: Tensor  # (..., path, 3) where it last leaves it, float64
    interaction: Tensor  # (..., path) uint8

    @classmethod
    def of(
        cls,
        amplitude: np.ndarray,
        length_m: np.ndarray,
        departure_m: np.ndarray,
        arrival_m: np.ndarray,
        interaction: Interaction,
    ) -> "StaticPaths":
        """Paths of one kind, from arrays.

        Args:
            amplitude: Amplitudes (path,) in sqrt(mW).
            length_m: Path lengths (path, tx, rx) in metres.
            departure_m: First vertices (path, 3) in metres.
            arrival_m: Last vertices (path, 3) in metres.
            interaction: Kind of all paths.
        """
        return cls(
            amplitude=torch.from_numpy(np.asarray(amplitude, np.complex128)),
            length_m=torch.from_numpy(np.asarray(length_m, np.float64)),
            departure_vertex_m=torch.from_numpy(np.asarray(departure_m, np.float64)),
            arrival_vertex_m=torch.from_numpy(np.asarray(arrival_m, np.float64)),
            interaction=torch.full((len(amplitude),), int(interaction), dtype=torch.uint8),
        )

    def __len__(self) -> int:
        return len(self.amplitude)

    def select(self, kind: Interaction) -> "StaticPaths":
        """The paths of one kind."""
        return self[self.interaction == int(kind)]


@dataclass(frozen=True, kw_only=True)
class ScenePaths:
    """All paths of some frames: the output of a path solver."""

    static: StaticPaths  # (path,)
    moving: Paths  # (frame * segment, path)
    # (frame + 1, static path): share of a path's amplitude that people take, at the start of each frame and one frame
    # period later, linear between; or (frame, static path), constant within a frame
    occluded: Tensor
