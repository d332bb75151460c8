"""Times of the chirps within a frame, and the time segments within which motion is quadratic."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from mmweaver.core.radar_config import RadarConfig

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
        return self.config.frame_period_s - self.config.active_time_s < min(MAX_SEGMENT_S, self.config.active_time_s / 2)

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
