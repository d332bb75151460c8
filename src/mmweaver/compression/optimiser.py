"""Rate-distortion optimiser: one step for all chunks of a file, and per chunk the mode of least cost at that step.

The slope of distortion over rate of a quantiser is proportional to its squared step, so the step represents the
Lagrange multiplier: at a given step every chunk uses the mode of least D + PRICE step² R, by estimates (`rate_model`),
and a bisection finds the step at which the estimates meet the requested size or quality. The file is then coded at
that step; the error of the estimates corrects them, until size or quality is met.

    plain modes -> step -> fit of scatterers -> modes, step again -> code, correct the step -> file
"""

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np

from mmweaver.compression.chunk import decode_chunk
from mmweaver.compression.chunk_encoder import ChunkEncoder, ChunkMode, Scale, some_frames, split
from mmweaver.compression.quantised_cells import active_mask
from mmweaver.compression.rate_model import TINY, CellSample, Estimate
from mmweaver.compression.transforms import MAX_DOPPLER, transform_choices
from mmweaver.core.errors import InputError
from mmweaver.core.records import RadarCube
from mmweaver.core.shapes import CubeValues

COARSER = 4  # step of cells without signal in steps of those with signal
EVEN_OPTIONS = ((1, True), (1, False))
OPTIONS = ((32, True), (16, True), (8, True), (4, True), (COARSER, False), (2, False), (1, False))
EVEN = 1.26  # 1 dB: limit of an option's error over all cells, relative to a coder that treats all cells alike
SHORT_CHUNK = 20  # frames
MAX_VALUES, MAX_FRAMES = 2**20, 2048  # of a chunk: complex numbers, frames
FINEST = 2.0**-27  # relative to the coarsest step; finer levels cannot be coded
BISECTIONS = 30
DECISIONS, SAME_MODES = 2, 1.0  # rounds of mode decision; difference of log(step) within which modes are kept
NOISE_CODED = 1.05  # ratio of bytes with and without quiet cells, above which their coding is optimised
CLOSEST = 1.0001  # ratio of steps that are considered equal
TRIALS, HALVED_FROM = 12, 4  # codings of a file; the trial from which on the range of steps is bisected
BYTES_AIM, BYTES_ENOUGH = 0.994, 0.98  # of the bytes allowed
QUALITY_AIM_DB, QUALITY_WITHIN_DB = 0.08, 0.2  # above the requested quality
EXACT_SHARE, EXACT_BELOW = 0.7, 0.97  # of the cube's bytes, and of those allowed: see `within_bytes`
SAMPLED, REPEATED = 4096, 0.05  # sample size, and share of distinct values below which a cube repeats itself
MIN_SIGNAL = 1e-150  # energy, so that a cube of zeros has a ratio
EXACT_DB = -300.0  # reported for a cube without any error

Progress = Callable[[str], None]
Option = tuple[int, bool]  # step of cells without signal over that of the others, whether in a layer of their own
Excess = Callable[[Estimate], float]  # decreases with the step, and is zero at the one sought


@dataclass(frozen=True, kw_only=True)
class _Chunk:
    """A chunk, how it is coded, and a sample of its cells."""

    encoder: ChunkEncoder
    mode: ChunkMode
    sample: CellSample


@dataclass(frozen=True, kw_only=True)
class _Plan:
    """All chunks of a file, and the step of cells without signal over that of the others."""

    chunks: list[_Chunk]
    coarser: int
    bounds: tuple[float, float]  # the finest step, and the coarsest

    def estimate(self, step: float, coarser: int | None = None) -> Estimate:
        """Estimate of all chunks together at a step."""
        coarser = self.coarser if coarser is None else coarser
        each = [chunk.encoder.estimate(chunk.sample, chunk.mode, step, coarser) for chunk in self.chunks]
        return Estimate(
            num_bytes=sum(one.num_bytes for one in each),
            active_error=sum(one.active_error for one in each),
            all_error=sum(one.all_error for one in each),
        )

    def step_where(self, excess: Excess, low: float = 0.0, high: float = math.inf) -> float:
        """The step within bounds at which an excess of the estimate is zero, by bisection of its logarithm."""
        low, high = max(low, self.bounds[0]), min(high, self.bounds[1])
        for _ in range(BISECTIONS):
            middle = math.sqrt(low * high)
            low, high = (middle, high) if excess(self.estimate(middle)) > 0 else (low, middle)
        return high

    def codes_noise(self, step: float) -> bool:
        """Whether cells without signal take many bytes at a step, or there are no others."""
        if any(chunk.encoder.is_active.all() for chunk in self.chunks):
            return True
        return self.estimate(step).num_bytes > NOISE_CODED * self.estimate(step, 0).num_bytes

    def encode(self, step: float) -> list[bytes]:
        """All chunks at a step."""
        return [chunk.encoder.encode(step, chunk.mode, self.coarser) for chunk in self.chunks]


class Optimiser:
    """Encodes the frames of a cube at a given quality in the fewest bytes, or in given bytes at the best quality."""

    def __init__(self, cube: RadarCube, *, keep_noise: bool = False, with_points: bool = True):
        """Prepares the optimisation.

        Args:
            cube: The cube.
            keep_noise: Whether all cells have the same error; by default cells without signal may have 12 dB more.
            with_points: Whether scatterers are fitted.
        """
        self.cube, self.scale, self.with_points = cube, Scale.of(cube), with_points
        self.coarser = 1 if keep_noise else COARSER
        frames, _, doppler, antennas = cube.values.shape
        # above the largest coefficient of any transform nothing is left
        coarsest = 2 * math.sqrt(min(frames, MAX_FRAMES) * antennas * min(doppler, MAX_DOPPLER))
        self.bounds = coarsest * FINEST, coarsest
        self.parts: list[range] = []
        self._encoders: list[ChunkEncoder] = []

    def divide(self, *, num_bytes: int | None = None, quality_db: float | None = None) -> list[range]:
        """Divides the frames into chunks: short ones, or as long as memory allows, whichever costs less.

        Args:
            num_bytes: Requested size; give either this or `quality_db`.
            quality_db: Requested signal-to-error ratio in active cells.

        Returns:
            Frames of each chunk.
        """
        num = len(self.cube.values)
        longest = max(1, min(MAX_FRAMES, MAX_VALUES // math.prod(self.cube.values.shape[1:])))
        short, long = split(num, min(SHORT_CHUNK, longest)), split(num, longest)
        if self._repeats():  # may be stored without loss, in as few chunks as possible
            short = long
        self._cut(short)
        if len(long) < len(short):
            encoders = self._encoders
            step = self._first_plan().step_where(self._excess(num_bytes, quality_db))
            short_cost = self._cheapest(step, (self.coarser, False)).estimate(step).cost(step, self.coarser)
            self._cut(long)
            if short_cost <= self._cheapest(step, (self.coarser, False)).estimate(step).cost(step, self.coarser):
                self.parts, self._encoders = short, encoders
        return self.parts

    def _cut(self, parts: list[range]) -> None:
        self.parts = parts
        self._encoders = [ChunkEncoder(some_frames(self.cube, part), self.scale) for part in parts]

    def within_bytes(self, num_bytes: int, progress: Progress) -> list[bytes]:
        """Encodes with the finest step that fits into the bytes, or without loss where that fits.

        Args:
            num_bytes: Bytes available for the chunks.
            progress: Called with the name of each step.

        Returns:
            The chunks.

        Raises:
            InputError: If the bytes are too few.
        """
        if num_bytes < 1:
            raise InputError(f"the bytes are too few for so many frames; give at least {1 - num_bytes} more")
        may_be_exact = num_bytes >= EXACT_SHARE * self.cube.values.nbytes or self._repeats()
        if may_be_exact and _size(exact := self._exact()) <= num_bytes:
            return exact
        progress("choosing modes")
        excess = self._excess(num_bytes=num_bytes)
        plan, step = self._decided(excess, OPTIONS if self.coarser > 1 else EVEN_OPTIONS)
        best: list[bytes] = []
        for chunks, found in self._trials(plan, step, excess, progress):
            size = _size(chunks)
            found.append(math.log(size / (BYTES_AIM * num_bytes)))
            if _size(best) < size <= num_bytes:
                best = chunks
                if size >= BYTES_ENOUGH * num_bytes:
                    break
        best = best or plan.encode(plan.bounds[1])
        if _size(best) > num_bytes:
            more = _size(best) - num_bytes
            raise InputError(f"the bytes are too few for this recording; give at least {more} more")
        if _size(best) < EXACT_BELOW * num_bytes and _size(exact := self._exact()) <= num_bytes:
            return exact
        return best

    def within_error(self, quality_db: float, progress: Progress) -> list[bytes]:
        """Encodes in the fewest bytes found with an error-to-signal ratio in active cells of at most -quality_db.

        Where a few levels represent the signal the result may be better than requested.

        Args:
            quality_db: Signal-to-error ratio in active cells.
            progress: Called with the name of each step.

        Returns:
            The chunks.

        Raises:
            InputError: If the quality cannot be reached.
        """
        values = self.cube.values
        if not np.any(values):
            return self._exact()
        progress("choosing modes")
        excess, is_active = self._excess(quality_db=quality_db), active_mask(values)
        plan, step = self._decided(excess, [(self.coarser, False)])
        best: list[bytes] = []
        best_db = math.inf
        for chunks, found in self._trials(plan, step, excess, progress):
            decoded = [decode_chunk(chunk, self.cube.config).cube_values() for chunk in chunks]
            over_db = -error_db(values, np.concatenate(decoded), is_active) - quality_db
            found.append(over_db - QUALITY_AIM_DB)
            if over_db >= 0 and (not best or _size(chunks) <= _size(best)):
                best, best_db = chunks, over_db
            if 0 <= over_db <= QUALITY_WITHIN_DB:
                break
        if not best:
            raise InputError(f"a quality of {quality_db:g} dB cannot be reached; ask for less")
        may_be_exact = best_db > QUALITY_WITHIN_DB or self._repeats()
        return exact if may_be_exact and _size(exact := self._exact()) <= _size(best) else best

    def _trials(
        self, plan: _Plan, step: float, excess: Excess, progress: Progress
    ) -> Iterator[tuple[list[bytes], list[float]]]:
        """Encodes the file at successively better steps. The caller appends the excess of each to the list."""
        low, high = plan.bounds
        for trial in range(TRIALS):
            progress(f"trial {trial + 1}")
            found: list[float] = []
            yield plan.encode(step), found
            low, high = (step, high) if found[0] > 0 else (low, step)
            if high < low * CLOSEST:
                return
            correction = found[0] - excess(plan.estimate(step))
            guess = plan.step_where(lambda one, by=correction: excess(one) + by, low, high)
            is_inside = low * CLOSEST < guess < high / CLOSEST
            step = guess if is_inside and trial < HALVED_FROM else math.sqrt(low * high)

    def _decided(self, excess: Excess, options: Sequence[Option]) -> tuple[_Plan, float]:
        """The modes of least cost at the step at which they meet the request, and that step, by estimates.

        Among the options for cells without signal, the one of least error in active cells whose error over all cells
        is at most 1 dB above that of a plain coder, which treats all cells alike and has no scatterers.
        """
        plan = self._first_plan()
        step = plan.step_where(excess)
        even = self._cheapest(step, (1, False))
        allowed = EVEN * even.estimate(even.step_where(excess)).all_error
        for chunk in plan.chunks if self.with_points else ():
            if chunk.encoder.can_have_points:
                chunk.encoder.fit(chunk.encoder.estimate(chunk.sample, chunk.mode, step, self.coarser).num_bytes)
        for _ in range(DECISIONS):
            decided_at = step
            plan = self._cheapest(step, (self.coarser, False))
            step = plan.step_where(excess)
            if len(options) > 1 and plan.codes_noise(step):
                plans = [self._cheapest(step, option) for option in options]
                steps = [one.step_where(excess) for one in plans]
                found = [one.estimate(at) for one, at in zip(plans, steps, strict=True)]
                errors = [(one.all_error > allowed, one.active_error) for one in found]
                best = min(range(len(plans)), key=errors.__getitem__)
                plan, step = plans[best], steps[best]
            if abs(math.log(step / decided_at)) < SAME_MODES:
                break
        return plan, step

    def _first_plan(self) -> _Plan:
        """All chunks with the default transform."""
        modes = [ChunkMode(transform=transform_choices(one.target.shape)[0]) for one in self._encoders]
        chunks = [
            _Chunk(encoder=one, mode=mode, sample=one.sample(mode, 1.0))
            for one, mode in zip(self._encoders, modes, strict=True)
        ]
        return _Plan(chunks=chunks, coarser=self.coarser, bounds=self.bounds)

    def _cheapest(self, step: float, option: Option) -> _Plan:
        """Each chunk in the mode of least Lagrangian cost at a step."""
        coarser, with_noise = option
        chunks = []
        for encoder in self._encoders:
            choices = transform_choices(encoder.target.shape)
            choices = choices if encoder.target.any() else choices[:1]
            modes = [ChunkMode(transform=choice, with_noise=with_noise) for choice in choices]
            if encoder.layers is not None:
                modes.append(replace(modes[0], with_points=True))
            each = [_Chunk(encoder=encoder, mode=mode, sample=encoder.sample(mode, step)) for mode in modes]
            costs = [encoder.estimate(one.sample, one.mode, step, coarser).cost(step, coarser) for one in each]
            chunks.append(each[int(np.argmin(costs))])
        return _Plan(chunks=chunks, coarser=coarser, bounds=self.bounds)

    def _excess(self, num_bytes: int | None = None, quality_db: float | None = None) -> Excess:
        """Difference of an estimate from a size, as a log ratio of bytes, or from a quality in dB."""
        if num_bytes is not None:
            return lambda one: math.log(one.num_bytes / max(num_bytes, 1))
        values = self.cube.values[active_mask(self.cube.values)] / np.float32(self.scale.peak)
        signal = float(np.sum(np.square(np.abs(values), dtype=np.float64)))
        wanted_db = ratio_db(signal, 1.0) - float(quality_db or 0)
        return lambda one: wanted_db - ratio_db(max(one.active_error, TINY), 1.0)

    def _exact(self) -> list[bytes]:
        return [encoder.exact() for encoder in self._encoders]

    def _repeats(self) -> bool:
        """Whether a few distinct numbers make up the cube, so that a lossless file may be the smallest."""
        some = self.cube.values.ravel()[:: max(1, self.cube.values.size // SAMPLED)]
        return len(np.unique(some)) < REPEATED * len(some)


def error_db(truth: CubeValues, ours: CubeValues, is_active: np.ndarray) -> float:
    """Error-to-signal ratio in dB.

    Args:
        truth: Original values (frame, range, doppler, antenna).
        ours: Decoded values.
        is_active: Mask (frame, range, doppler) of the cells that count.
    """
    error, signal = (
        float(np.sum(np.square(np.abs(values[is_active]), dtype=np.float64))) for values in (truth - ours, truth)
    )
    return ratio_db(error, signal)


def ratio_db(error: float, signal: float) -> float:
    """Error-to-signal ratio in dB of two energies; EXACT_DB without any error."""
    return 10 * math.log10(error / max(signal, MIN_SIGNAL)) if error else EXACT_DB


def _size(chunks: list[bytes]) -> int:
    return sum(map(len, chunks))
