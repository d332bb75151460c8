"""Continuous signals: sentences come in one after the other, chunks of cube, points and poses go out (`Weaver.stream`).

    sentences --ContinuousMotion--> motion of each --method, BLOCK_FRAMES at a time--> signal --> StreamChunk

The frames of every sentence are computed in blocks of fixed size, wherever chunks end, so the chunk size changes no
bit. Reference: docs/decisions/streams.md.
"""

import inspect
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, TypeVar

import numpy as np

from mmweaver.core.errors import InputError
from mmweaver.core.record_values import ShownByFacts
from mmweaver.core.records import AdcCube, CubeGrid, PointCloud, PoseSequence, RadarCube
from mmweaver.core.seeding import single_precision
from mmweaver.core.stages import Stages
from mmweaver.models.methods import Method, Signal
from mmweaver.motion.animation.root_path import resample
from mmweaver.motion.continuous import ContinuousMotion, MotionPart
from mmweaver.signal.detection import detect, needs_adc
from mmweaver.weaver.generation import Room
from mmweaver.weaver.parsed_request import ParsedRequest, parsed_text

if TYPE_CHECKING:
    from mmweaver.weaver.front_door import Weaver

SignalT = TypeVar("SignalT", "StreamChunk", Signal)
BLOCK_FRAMES = 10
CHUNK_FRAMES = 10
_MARGIN_S = 0.05  # of the dense motion around a chunk


@dataclass(frozen=True, kw_only=True, repr=False)
class StreamChunk(ShownByFacts):
    """Some frames of a stream. Times count from the stream's first frame, frame numbers of points from the chunk's.

    `meta` describes the current sentence: its plan, its clauses, the assumptions. `refused` states why the last
    sentence could not be carried out ("" if it could); the person then remains as they are.
    """

    cube: RadarCube
    points: PointCloud
    adc: AdcCube | None
    poses: tuple[PoseSequence, ...]  # at the radar's frames
    motions: tuple[PoseSequence, ...]  # 120 Hz, from just before the chunk to just after it
    first_frame: int
    text: str
    refused: str
    meta: dict[str, Any]

    @property
    def num_frames(self) -> int:
        return len(self.cube.values)

    @property
    def pose(self) -> PoseSequence:
        """The person's joints at the radar's frames."""
        return self.poses[0]

    @property
    def motion(self) -> PoseSequence:
        """The person's joints densely in time."""
        return self.motions[0]

    def first(self, count: int) -> "StreamChunk":
        """The first frames of the chunk; dense motions are unchanged."""
        return replace(
            frames_of(self, 0, count),
            points=self.points.select(self.points.frame < count),
            poses=tuple(replace(one, time_s=one.time_s[:count], joints_m=one.joints_m[:count]) for one in self.poses),
        )

    def facts(self) -> dict[str, str]:
        """Frames, text and points in short, for display."""
        return {
            "frames": f"{self.first_frame} to {self.first_frame + self.num_frames - 1}",
            "text": self.text,
            "points": str(len(self.points.frame)),
            "radar": self.cube.config.name,
        }


class Streamer:
    """The state of a stream; `chunks` runs it."""

    def __init__(
        self, weaver: "Weaver", room: Room, request: ParsedRequest, motion: ContinuousMotion, chunk_frames: int
    ) -> None:
        """Prepares a stream.

        Args:
            weaver: Method, radar and point detector.
            room: The room.
            request: Parsed request with the options of the stream.
            motion: Motion of the person.
            chunk_frames: Radar frames per chunk, 1 to 1000.

        Raises:
            InputError: For an invalid number of frames.
        """
        if not (isinstance(chunk_frames, int | np.integer) and 1 <= chunk_frames <= 1000):
            raise InputError(f"chunk_frames must be 1 to 1000, not {chunk_frames}")
        self.weaver, self.room, self.request, self.motion = weaver, room, request, motion
        self.chunk_frames = int(chunk_frames)
        own, self.board = weaver.board_of(request, room)  # the method's argument for it, if it is not ideal
        self.firmware = weaver.firmware_of(own)
        self.meta = {
            "seed": request.seed,
            "points": weaver.points,
            "weights": weaver.weights,
            "inputs": room.inputs,
            "board": own.meta(),
        }

    def chunks(self, sentences: Iterable[str | None]) -> Iterator[StreamChunk]:
        """Yields chunks for as long as there are sentences.

        Args:
            sentences: As for `Weaver.stream`.

        Raises:
            InputError: If the first sentence cannot be carried out.
        """
        waiting: Iterator[StreamChunk] = iter(())  # the rest of a motion that the next sentence may end
        has_begun = False
        for sentence in sentences:
            text = (sentence or "").strip()
            refused = ""
            if text:
                waiting = iter(())
                try:
                    acted = self.motion.act(parsed_text(text, self.request.parser))
                except InputError as error:
                    if not has_begun:
                        raise
                    refused = str(error)
                else:
                    has_begun = True
                    yield from self._of_part(acted)
                    continue
            has_begun = True
            chunk = next(waiting, None)
            if chunk is None:
                waiting = self._of_part(self.motion.go_on(refused))
                chunk = next(waiting)
            self.motion.cut(chunk.first_frame + chunk.num_frames)
            yield chunk

    def _of_part(self, part: MotionPart) -> Iterator[StreamChunk]:
        """The chunks of one motion; the last may be shorter."""
        blocks = self._blocks(part)
        ready: list[Signal] = []
        for first in range(part.first_frame, part.end_frame, self.chunk_frames):
            count = min(self.chunk_frames, part.end_frame - first)
            while sum(len(one.cube.values) for one in ready) < count:
                ready.append(next(blocks))
            whole = ready[0] if len(ready) == 1 else _together(ready)
            yield self._chunk(part, frames_of(whole, 0, count), first)
            ready = [frames_of(whole, count, None)] if len(whole.cube.values) > count else []

    def _blocks(self, part: MotionPart) -> Iterator[Signal]:
        for first in range(part.first_frame, part.end_frame, BLOCK_FRAMES):
            yield self._block(part, first, min(BLOCK_FRAMES, part.end_frame - first))

    @single_precision()
    def _block(self, part: MotionPart, first: int, count: int) -> Signal:
        request, weaver = self.request, self.weaver
        return weaver.method(
            self.room.scene,
            (part.pose,),
            request.config,
            num_frames=count,
            seed=request.seed,
            keep_adc=request.keep_adc or needs_adc(weaver.points),
            stages=Stages(),
            background=self.room.background,
            first_frame=first,
            **self.board,
        )

    def _chunk(self, part: MotionPart, signal: Signal, first: int) -> StreamChunk:
        time_s = signal.cube.grid.frame_time_s
        pose, period_s = part.pose, self.request.config.frame_period_s
        shown = (pose.time_s > time_s[0] - _MARGIN_S) & (pose.time_s < time_s[-1] + period_s + _MARGIN_S)
        dense = replace(pose, time_s=pose.time_s[shown], joints_m=pose.joints_m[shown])
        motion = part.motion
        refused = part.refused if first == part.first_frame else ""
        notes = (*self.room.scene.assumptions, *motion.assumptions, *signal.assumptions)
        meta = {
            **self.meta,
            "text": part.text,
            "refused": refused,
            "method": signal.method or self.weaver.method_name,
            "plan": motion.plan,
            "clauses": motion.clauses,
            "assumed": list(dict.fromkeys(notes)),
        }
        return StreamChunk(
            cube=signal.cube,
            points=detect(signal.cube, signal.adc, self.weaver.points, self.firmware),
            adc=signal.adc if self.request.keep_adc else None,
            poses=(resample(pose, time_s),),
            motions=(dense,),
            first_frame=first,
            text=part.text,
            refused=refused,
            meta=meta,
        )


def check_streams(method: Method, name: str) -> None:
    """Checks that a method can make parts of a longer signal.

    Args:
        method: The method.
        name: Its name, for the error.

    Raises:
        InputError: If it cannot.
    """
    if not takes_argument(method, "first_frame"):
        raise InputError(
            f"method {name!r} makes no streams, for it has no argument 'first_frame' (docs/extend.md); take weaver or"
            " physics"
        )


def takes_argument(method: Method, name: str) -> bool:
    """Whether a method accepts an optional argument of `methods.Method`.

    Args:
        method: The method.
        name: Name of the argument.
    """
    call = method if inspect.isfunction(method) else type(method).__call__
    parameters = inspect.signature(call).parameters
    return name in parameters or any(one.kind is one.VAR_KEYWORD for one in parameters.values())


def frames_of(signal: SignalT, begin: int, end: int | None) -> SignalT:
    """Some frames of the cube and samples of a signal or chunk.

    Args:
        signal: The signal or chunk.
        begin: First frame.
        end: Frame after the last; None for all remaining.
    """
    some, cube = slice(begin, end), signal.cube
    grid = replace(cube.grid, frame_time_s=cube.grid.frame_time_s[some])
    adc = None if signal.adc is None else replace(signal.adc, samples=signal.adc.samples[some])
    return replace(signal, cube=replace(cube, values=cube.values[some], grid=grid), adc=adc)


def _together(signals: list[Signal]) -> Signal:
    first = signals[0]
    time_s = np.concatenate([one.cube.grid.frame_time_s for one in signals])
    grid: CubeGrid = replace(first.cube.grid, frame_time_s=time_s)
    cube = replace(first.cube, values=np.concatenate([one.cube.values for one in signals]), grid=grid)
    samples = [one.adc.samples for one in signals if one.adc is not None]
    adc = None if first.adc is None else replace(first.adc, samples=np.concatenate(samples))
    return replace(first, cube=cube, adc=adc)
