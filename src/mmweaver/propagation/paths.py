"""Propagation paths between a radar and itself: what both methods solve for, and what is rendered as a signal.

The frame of reference is the radar's (x right, y away, z up, origin at the array's centre), units are SI, amplitudes
those at the receiver's port in sqrt(mW). The carrier's phase, exp(j 2 pi length / wavelength), is not in the amplitude.
"""

from dataclasses import dataclass
from enum import IntEnum

import numpy as np
import torch
from torch import Tensor

from mmweaver.core.tensor_record import TensorRecord


class Interaction(IntEnum):
    """What a wave meets on its way."""

    DIFFUSE = 0  # a rough surface of the room
    SPECULAR = 1  # one or more flat faces of the room
    EDGE = 2  # a rim or a leg of furniture
    BODY = 3
    BODY_WALL = 4  # the body, and a face before or after it
    WALL_BODY_WALL = 5  # the body, and the same face before and after it
    BODY_ROOM = 6  # the body, and a rough surface before or after it
    BODY_RADAR_BODY = 7  # the body, the radar itself, and the body again
    ROOM_ROOM = 8  # two surfaces of the room, at least one of them rough
    CLUTTER = 9  # something in the room that photo and mesh do not resolve
    BODY_BODY = 10  # two people, one after the other


STATIC_KINDS = (Interaction.DIFFUSE, Interaction.SPECULAR, Interaction.EDGE)  # of first order, as a room has them


@dataclass(frozen=True, kw_only=True)
class ApparentPoint(TensorRecord):
    """Where one end of a path seems to be, seen from the array: the scatterer, or its image in a face of the room.

    Quadratic in time about the middle of a time segment. Float64: float32 knows 4 m to 0.2 um, 1e-3 rad of phase.
    """

    position_m: Tensor  # (..., path, 3)
    velocity_mps: Tensor  # (..., path, 3)
    acceleration_mps2: Tensor  # (..., path, 3)

    @classmethod
    def of(cls, motion: np.ndarray) -> "ApparentPoint":
        """Position, velocity and acceleration (..., path, 3, 3), the last but one axis naming which."""
        position, velocity, acceleration = (
            torch.from_numpy(np.ascontiguousarray(motion[..., order, :], np.float64)) for order in range(3)
        )
        return cls(position_m=position, velocity_mps=velocity, acceleration_mps2=acceleration)

    def positions_m(self, time_s: Tensor) -> Tensor:
        """Positions (..., time, 3, path) in metres, float64, at times (time,) since the segment's middle."""
        position, velocity, acceleration = (
            part.mT.contiguous()[..., None, :, :]
            for part in (self.position_m, self.velocity_mps, self.acceleration_mps2)
        )
        time = time_s[:, None, None]
        return (acceleration * (time**2 / 2)).addcmul_(velocity, time).add_(position)

    @property
    def distance_m(self) -> Tensor:
        """(..., path) from the array's centre, float64."""
        return self.position_m.norm(dim=-1)

    @property
    def direction(self) -> Tensor:
        """(..., path, 3) unit vectors from the array's centre, float64."""
        return self.position_m / self.distance_m.clamp(min=1e-9)[..., None]

    @property
    def rate_mps(self) -> Tensor:
        """(..., path) how fast the distance grows."""
        return (self.direction * self.velocity_mps).sum(-1)

    @property
    def distance_acceleration_mps2(self) -> Tensor:
        """(..., path) how fast that rate grows: by acceleration, and by moving past the array."""
        across2 = self.velocity_mps.square().sum(-1) - self.rate_mps.square()
        return (self.direction * self.acceleration_mps2).sum(-1) + across2 / self.distance_m.clamp(min=1e-9)


@dataclass(frozen=True, kw_only=True)
class Paths(TensorRecord):
    """Moving paths, one row for each time segment: of every frame, and of every part of a frame with long chirps.

    The wave seems to go to `departure` and to come from `arrival`: the same place for a direct echo. A transmitter at t
    and a receiver at r have a path length of |departure - t| + |arrival - r|. A path that is reciprocal is travelled in
    the other order too, and both add up. Padding has an amplitude of zero.
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
        """Paths of one kind, of amplitudes (path,) and of the motion of their ends (..., path, 3, 3)."""
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
        """Paths to moving scatterers and straight back."""
        return cls(
            amplitude=amplitude.to(torch.complex64),
            departure=scatterer,
            arrival=scatterer,
            is_reciprocal=torch.zeros(amplitude.shape, dtype=torch.bool),
            interaction=torch.full(amplitude.shape, int(Interaction.BODY), dtype=torch.uint8),
        )

    @staticmethod
    def padded(parts: list["Paths"]) -> "Paths":
        """Paths (path,) of a segment each, or (segment, path) of several, as one record (segment, path).

        Padded at the end with amplitudes of zero.
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

    def __len__(self) -> int:
        return len(self.amplitude)

    @property
    def length_m(self) -> Tensor:
        """(..., path) from the array's centre and back to it at the segment's middle, float64."""
        return self.departure.distance_m + self.arrival.distance_m

    @property
    def rate_mps(self) -> Tensor:
        """(..., path) how fast the length grows: twice the radial velocity of a direct echo."""
        return self.departure.rate_mps + self.arrival.rate_mps

    @property
    def acceleration_mps2(self) -> Tensor:
        """(..., path) how fast that rate grows."""
        return self.departure.distance_acceleration_mps2 + self.arrival.distance_acceleration_mps2


@dataclass(frozen=True, kw_only=True)
class StaticPaths(TensorRecord):
    """Paths of a room without people, the same in all frames.

    They are few and rendered once, so the length is kept for every pair of antennas: exact for specular paths too,
    whose images turn the array. A body before either vertex occludes the path.
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
        """Paths of one kind from arrays: amplitude (path,), length (path, tx, rx), vertices (path, 3)."""
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
        """Those of one kind."""
        return self[self.interaction == int(kind)]


@dataclass(frozen=True, kw_only=True)
class ScenePaths:
    """All paths of some frames: what a path solver gives."""

    static: StaticPaths  # (path,)
    moving: Paths  # (frame * segment, path)
    occluded: Tensor  # (frame, static path) uint8: 1 where a person occludes the path
