"""Propagation paths from a radar back to itself: the output of both path solvers and the input of the renderers.

Coordinates are the radar's (x right, y away, z up, origin at the array's centre) in SI units. Amplitudes are those at
the receiver's port in sqrt(mW), without the phase of the carrier, exp(j 2 pi length / wavelength).

Times of the chirps within a frame, and the time segments within which motion is quadratic.
"""

from dataclasses import dataclass, replace
from enum import IntEnum
from functools import cached_property

import numpy as np
import torch
from torch import Tensor

from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.tensor_files import TensorRecord

NUM_NODES = 3  # instants per segment at which positions are evaluated
MAX_SEGMENT_S = 10e-3  # positions and path lengths are quadratic in time within a segment
BLOCK_S = 2.5e-3  # range is linear in time within a block; array phases are interpolated linearly between blocks


@dataclass(frozen=True, kw_only=True)
class FadedSegment:
    """A segment that reaches to the middles of its neighbours, with a weight per chirp; all weights add up to 1.

    Where frames follow each other without a pause, the last segment of the frame before and the first of the frame
    after reach into a frame, too.
    """

    segment: "Segment"
    share: np.ndarray  # (loop, tx) from 0 to 1
    source: int  # number of the segment within its frame
    frame: int = 0  # -1, 0 or 1: its frame relative to the one into which it reaches
    late_s: float = 0.0  # its middle minus that of the nearest segment of the frame itself


@dataclass(frozen=True, kw_only=True)
class Segment:
    """A run of loops of a frame. Times are relative to its middle, which is `middle_s` after the start of the frame."""

    first_loop: int
    middle_s: float
    chirp_s: np.ndarray  # (loop, tx) middle of each chirp's sampling
    node_s: np.ndarray  # (node,) Chebyshev points at which positions are evaluated, the second at 0
    blocks: tuple[slice, ...]  # of loops, counted from the segment's first

    @cached_property
    def loops(self) -> slice:
        """The segment's loops within the frame."""
        return slice(self.first_loop, self.first_loop + len(self.chirp_s))

    @cached_property
    def block_s(self) -> np.ndarray:
        """Middle of each block, (block,)."""
        return np.array([self.chirp_s[block].mean() for block in self.blocks])

    def weights(self, time_s: np.ndarray) -> np.ndarray:
        """Weights of Lagrange interpolation.

        Args:
            time_s: Times (time,) since the middle of the segment.

        Returns:
            (node, time): `values_at_nodes @ weights` are the values at these times.
        """
        others = self.node_s[:, None] - self.node_s[None, :]
        np.fill_diagonal(others, 1.0)
        gaps = time_s[None, :] - self.node_s[:, None]
        product = np.stack([np.delete(gaps, node, axis=0).prod(axis=0) for node in range(NUM_NODES)])
        return product / others.prod(axis=1)[:, None]

    def slopes(self, time_s: np.ndarray) -> np.ndarray:
        """Weights of differentiation, exact for quadratics.

        Args:
            time_s: Times (time,) since the middle of the segment.

        Returns:
            (node, time): `values_at_nodes @ slopes` are the time derivatives, per second.
        """
        step_s = np.ptp(self.node_s) / 2
        return (self.weights(time_s + step_s) - self.weights(time_s - step_s)) / (2 * step_s)


class FrameClock:
    """Chirps and time segments of a radar's frame: one segment for up to 10 ms, an odd number for longer frames.

    Attributes:
        chirp_s: Middle of each chirp's sampling since the start of the frame, (loop, tx).
        segments: The segments, in order.
        node_s: Nodes of all segments since the start of the frame, (segment * node,); the middle one is the frame's
            middle.
    """

    def __init__(self, config: RadarConfig):
        """Divides a frame into segments.

        Args:
            config: The radar, for its chirp and loop timing.
        """
        self.config = config
        middle_s = config.idle_time_s + config.adc_start_time_s + config.num_samples / config.sample_rate_hz / 2
        loop_s = np.arange(config.num_loops) * config.loop_period_s
        self.chirp_s = loop_s[:, None] + config.tx_delay_s[None, :] + middle_s
        count = int(np.ceil(config.active_time_s / MAX_SEGMENT_S))
        count = min(count + 1 - count % 2, config.num_loops)
        loops = np.array_split(np.arange(config.num_loops), count)
        self.segments = tuple(self._segment(part) for part in loops)
        self.node_s = np.concatenate([one.middle_s + one.node_s for one in self.segments])

    @cached_property
    def faded_segments(self) -> tuple[FadedSegment, ...]:
        """Segments whose weights rise and fall as a squared sine from middle to middle.

        Where motion and amplitude are known per segment only, paths jump from one segment to the next. A jump leaves
        spurs over all velocities; a smooth transition does not.
        """
        middle_s, period_s, last = self.middle_s, self.config.frame_period_s, len(self.segments) - 1
        own = [(at, 0, float(one_s)) for at, one_s in enumerate(middle_s)]
        if self.is_continuous:
            own = [(last, -1, middle_s[-1] - period_s), *own, (0, 1, middle_s[0] + period_s)]
        times = np.array([one_s for *_, one_s in own])
        before, after = (np.append(-np.inf, times[:-1]), np.append(times[1:], np.inf))
        faded = []
        for (source, frame, own_s), from_s, to_s in zip(own, before, after, strict=True):
            reached = np.flatnonzero(((self.chirp_s > from_s) & (self.chirp_s < to_s)).any(axis=1))
            time_s = self.chirp_s[reached]
            away = np.where(time_s < own_s, (own_s - time_s) / (own_s - from_s), (time_s - own_s) / (to_s - own_s))
            share = np.cos(np.pi / 2 * np.clip(away, 0.0, 1.0)) ** 2
            late_s = float(own_s - middle_s[{-1: 0, 0: source, 1: last}[frame]])
            faded.append(
                FadedSegment(
                    segment=self._segment(reached, float(own_s)), share=share, source=source, frame=frame, late_s=late_s
                )
            )
        return tuple(one for one in faded if len(one.share))

    @property
    def is_continuous(self) -> bool:
        """Whether the pause between frames is so short that motion is continuous over it."""
        return self.config.frame_period_s - self.config.active_time_s < min(
            MAX_SEGMENT_S, self.config.active_time_s / 2
        )

    def _segment(self, loops: np.ndarray, middle_s: float | None = None) -> Segment:
        """A run of loops; times are relative to the middle of its chirps, or to `middle_s`."""
        chirp_s = self.chirp_s[loops]
        if middle_s is None:
            middle_s = float((chirp_s.min() + chirp_s.max()) / 2)
        unit = -np.cos(np.pi * (np.arange(NUM_NODES) + 0.5) / NUM_NODES)
        unit[NUM_NODES // 2] = 0.0
        reach_s = np.ptp(chirp_s) / 2 or self.config.chirp_period_s  # a single chirp has no extent
        num_blocks = int(np.clip(np.ceil(len(loops) * self.config.loop_period_s / BLOCK_S), 1, len(loops)))
        cuts = np.array_split(np.arange(len(loops)), num_blocks)
        return Segment(
            first_loop=int(loops[0]),
            middle_s=middle_s,
            chirp_s=chirp_s - middle_s,
            node_s=reach_s * unit,
            blocks=tuple(slice(int(cut[0]), int(cut[-1]) + 1) for cut in cuts),
        )

    @property
    def middle_s(self) -> np.ndarray:
        """Middle of each segment since the start of the frame, (segment,)."""
        return np.array([one.middle_s for one in self.segments])


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
    THING = 12  # a moving thing that is not a person


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
    # (frame + 1, static path): share of a path's amplitude that people take, at the first node of each frame and one
    # frame period later, linear between; or (frame, static path), constant within a frame
    occluded: Tensor
