"""Searches the step of a file of so many bytes, or of a quality (encoder side).

A coded file calibrates an estimate of sizes at other steps, so that two or three files are coded as a rule.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from mmweaver.compression.cell_choice import active_cells
from mmweaver.compression.cell_sample import CellSample
from mmweaver.compression.chunk import CodedChunk, decode_chunk
from mmweaver.compression.residual_stream import PRICE
from mmweaver.compression.segment import SegmentEncoder
from mmweaver.core.errors import InputError
from mmweaver.core.shapes import CubeValues

EXACT_SHARE = 0.7  # a file without loss is tried where the bytes allowed are at least this share of the cube's
TRIALS, EVALUATIONS = 9, 24
SMALL_EXCESS = 3e-3  # relative error of a size or error that an estimate is asked for
DECISIONS = 2
CLOSE_ENOUGH, AIM = 0.988, 0.994  # of the bytes allowed
CLOSER, AIM_CLOSER = 0.995, 0.998  # with a noise layer, which has most of the bytes and is coded once
TRIALS_SHARE = 0.01  # less of the bytes is enough from the third trial on
CLOSEST = 1.002  # ratio of steps that are tried one after the other, at least
CLOSE_FIRST = 0.2  # difference of log(bytes) up to which the first file tells the error of one of the bytes allowed
SAME_MODE = 1.0  # difference of log(step) beyond which modes are chosen again
EVEN_DB = 0.15  # dB that the error over all cells may exceed that of an even coder
SPARE = 1.25  # times the bytes: an even coder by the estimate has no less error than a real one of fewer bytes
MOST_PRICE, PRICES = 1000.0, 10  # squared steps a bit, where a quality jumps; how many are tried
WITHIN_DB, AIM_DB = 0.2, 0.08  # better than the quality asked for

EXACT_DB = -300.0  # said of a cube without any error
LEAST_ERROR = 1e-30  # relative to the squared peak
SAME_ERROR = 0.1  # difference of log(error) within which an estimate is trusted
CLOSE_ERROR = 1.01  # times the error allowed that is as good
OVER_RANGE_LOSES = 1.7  # times the error estimated: cells are predicted by neighbours, which no estimate knows
CLEARLY_FINER = 0.9  # steps that a noise layer must have where there need not be one
NOISE_SHARE = 0.97  # of the error allowed that a noise layer may leave
MOST_SHARE = 0.9  # of the bytes that the noise may have
NOISE_STEPS, NOISE_TRIALS = 8, 5
SAME_STEP = 0.03  # difference of log(step) of noise layers that are taken for the same

Progress = Callable[[str], None]


@dataclass(frozen=True, kw_only=True)
class Found:
    """Chunks of a step that fit."""

    coded: list[CodedChunk]
    step: float
    coarser: int
    noise_step: float = 0.0

    @property
    def num_bytes(self) -> int:
        """Of all chunks."""
        return sum(len(chunk.data) for chunk in self.coded)

    @property
    def aim(self) -> float:
        """Share of the bytes allowed that the next trial aims at."""
        return AIM_CLOSER if self.noise_step else AIM

    @property
    def active_error(self) -> float:
        """Energy of the error in active cells."""
        return sum(chunk.active_error for chunk in self.coded)

    @property
    def all_error(self) -> float:
        """Energy of the error in all cells."""
        return sum(chunk.all_error for chunk in self.coded)


def within_bytes(segment: SegmentEncoder, num_bytes: int, progress: Progress) -> list[bytes]:
    """The finest step whose file fits. Cells without signal err more only while that costs little over all cells."""
    if num_bytes < 1:
        raise InputError(f"the bytes are too few for so many frames; give at least {1 - num_bytes} more")
    if num_bytes >= EXACT_SHARE * segment.cube.values.nbytes or not np.any(segment.cube.values):
        exact = segment.exact()
        if sum(map(len, exact)) <= num_bytes:
            return exact
    found = _best_of_modes(segment, num_bytes, progress)
    if segment.has_rank:  # sizes jump with the rank, which no estimate knows
        segment.leave_out_rank()
        other = _best_of_modes(segment, num_bytes, progress)
        fits = [one for one in (found, other) if one.num_bytes <= num_bytes]
        found = min(fits or [found, other], key=lambda one: one.active_error * one.all_error)
    if found.num_bytes > num_bytes:
        more = found.num_bytes - num_bytes
        raise InputError(f"the bytes are too few for this recording; give at least {more} more")
    return [chunk.data for chunk in found.coded]


def _best_of_modes(segment: SegmentEncoder, num_bytes: int, progress: Progress) -> Found:
    """The chunks in the modes that cost least by estimates, at the finest step that fits."""
    step = _decided_step(segment, num_bytes)
    first = _coded(segment, step, segment.coarser, 0.0)
    if abs(math.log(first.num_bytes / num_bytes)) > CLOSE_FIRST:
        step = _estimated_step(first, num_bytes, segment.finest_step, segment.coarsest_step)
        first = _coded(segment, step, segment.coarser, 0.0)
    found = _evened(segment, num_bytes, first, progress) if segment.coarser > 1 else None
    if found is None:
        found = _finest(segment, num_bytes, step, segment.coarser, progress, first=first)
    if segment.coarser > 1:
        found = found if "DCT of ranges" in segment.without else _over_range(segment, num_bytes, found, progress)
    return found


def _decided_step(segment: SegmentEncoder, num_bytes: int) -> float:
    """Decides on the modes at the step that they will have; returns it."""
    bounds = segment.finest_step, segment.coarsest_step
    step = _step_of_size(segment.samples(), num_bytes, segment.coarser, *bounds)
    for _ in range(DECISIONS):
        decided_at = step
        segment.decide(step)
        step = _step_of_size(segment.decided_samples(), AIM * num_bytes, segment.coarser, *bounds)
        if abs(math.log(step / decided_at)) < SAME_MODE:
            break
    return step


def _step_of_size(
    samples: list[CellSample], num_bytes: int | float, coarser: int, finest: float, coarsest: float
) -> float:
    def excess(step: float) -> float:
        return math.log(sum(sample.at(step, coarser).num_bytes for sample in samples) / max(num_bytes, LEAST_ERROR))

    return _step_where(excess, finest, coarsest)


def _step_where(excess: Callable[[float], float], finest: float, coarsest: float) -> float:
    """The step at which a falling function of it is zero, by false position over its logarithm."""
    low, high = math.log(finest), math.log(coarsest)
    above, below = excess(math.exp(low)), excess(math.exp(high))
    if above <= 0 or below >= 0:
        return finest if above <= 0 else coarsest
    side = 0
    for _ in range(EVALUATIONS):
        middle = low + (high - low) * min(max(above / (above - below), 0.02), 0.98)
        here = excess(math.exp(middle))
        if abs(here) < SMALL_EXCESS or high - low < SMALL_EXCESS:
            return math.exp(middle)
        if here > 0:
            low, above, below, side = middle, here, below / 2 if side > 0 else below, 1
        else:
            high, below, above, side = middle, here, above / 2 if side < 0 else above, -1
    return math.exp(middle)


def _finest(
    segment: SegmentEncoder, num_bytes: int, step: float, coarser: int, progress: Progress, noise_step: float = 0.0,
    *, over_range: bool = False, first: Found | None = None,
) -> Found:  # fmt: skip
    """The chunks with the finest step that fit; larger ones where none does.

    `over_range`: after a DCT of ranges. `first`: a trial at this step that was made before.
    """

    def coded(step: float) -> Found:
        if over_range:
            return Found(coded=segment.encode_over_range(step), step=step, coarser=1)
        return _coded(segment, step, coarser, noise_step)

    fits: Found | None = None
    larger: Found | None = None
    low, high = segment.finest_step, segment.coarsest_step
    for trial in range(TRIALS):
        one = coded(step) if trial or first is None else first
        progress(f"trial {trial + 1}")
        if one.num_bytes <= num_bytes:
            fits, high = one if fits is None or one.num_bytes > fits.num_bytes else fits, step
            enough = (CLOSER if noise_step else CLOSE_ENOUGH) - TRIALS_SHARE * (trial > 1)
            if one.num_bytes >= enough * num_bytes or step <= segment.finest_step:
                break
        else:
            larger, low = one, step
        if high < low * 1.0001:
            break
        if fits is None or larger is None:
            step = _estimated_step(one, num_bytes, low, high)
        else:
            step = _between(larger, fits, num_bytes, is_even=bool(trial % 3 == 2))
    if fits is None:
        fits = coded(segment.coarsest_step)
    return fits


def _coded(segment: SegmentEncoder, step: float, coarser: int, noise_step: float) -> Found:
    coded = segment.encode(step, coarser, noise_step)
    return Found(coded=coded, step=step, coarser=coarser, noise_step=noise_step)


def _estimated_step(one: Found, num_bytes: int, low: float, high: float) -> float:
    """Where the estimate, calibrated by a trial, has the size."""
    samples = [chunk.sample for chunk in one.coded]
    estimated = sum(sample.at(one.step, one.coarser).num_bytes for sample in samples)
    wanted = one.aim * num_bytes * estimated / one.num_bytes
    step = _step_of_size(samples, wanted, one.coarser, max(low, one.step / 8), min(high, one.step * 8))
    return min(step, high / CLOSEST) if one.num_bytes <= num_bytes else max(step, low * CLOSEST)


def _between(larger: Found, fits: Found, num_bytes: int, *, is_even: bool) -> float:
    """Interpolates the logarithms of sizes and steps, or halves."""
    low, high = math.log(larger.step), math.log(fits.step)
    above = math.log(larger.num_bytes / num_bytes / fits.aim)
    below = math.log(fits.num_bytes / num_bytes / fits.aim)
    share = 0.5 if is_even else min(max(above / (above - below), 0.05), 0.95)
    return math.exp(low + share * (high - low))


def _evened(segment: SegmentEncoder, num_bytes: int, first: Found, progress: Progress) -> Found | None:
    """The chunks whose error over all cells is about that of an even coder, with the finest step.

    Either cells without signal have less coarse steps, or a noise layer holds them. None where those of the mode tried
    `first` have no more error than that once they have the bytes allowed.
    """
    bounds, plain = (segment.finest_step, segment.coarsest_step), segment.samples()
    samples = [chunk.sample for chunk in first.coded]
    here = [sample.at(first.step, first.coarser) for sample in samples]
    factor = first.num_bytes / sum(one.num_bytes for one in here)
    own_step = _step_of_size(samples, AIM * num_bytes / factor, first.coarser, *bounds)
    before = max(sum(one.all_error for one in here), LEAST_ERROR)
    own_error = first.all_error * sum(sample.at(own_step, first.coarser).all_error for sample in samples) / before
    step = _step_of_size(plain, SPARE * num_bytes / factor, 1, *bounds)
    if own_error <= sum(sample.at(step, 1).all_error for sample in plain):
        return _with_noise(segment, num_bytes, own_error, samples, factor, own_step, progress, CLEARLY_FINER)
    even, even_factor = _even_error(segment, num_bytes, plain, factor)
    allowed = even * 10 ** (EVEN_DB / 10)
    if own_error <= allowed:
        return _with_noise(segment, num_bytes, own_error, samples, factor, own_step, progress, CLEARLY_FINER)
    error_factor = first.all_error / before
    for coarser in (3, 2, 1):
        share = math.log(coarser) / math.log(segment.coarser)
        step = _step_of_size(samples, num_bytes / (factor**share * even_factor ** (1 - share)), coarser, *bounds)
        if coarser == 1 or error_factor * sum(sample.at(step, coarser).all_error for sample in samples) <= allowed:
            break
    noisy = _with_noise(segment, num_bytes, allowed, samples, factor, step, progress)
    if noisy is not None:
        return noisy
    while coarser > 1:
        one = _finest(segment, num_bytes, step, coarser, progress)
        if one.all_error <= allowed * CLOSE_ERROR:
            return one
        coarser -= 1
    if segment.decide(step, 1):  # modes were chosen for cells without signal that count less
        step = _step_of_size(segment.decided_samples(), AIM * num_bytes / even_factor, 1, *bounds)
    return _finest(segment, num_bytes, step, 1, progress)


def _with_noise(
    segment: SegmentEncoder, num_bytes: int, allowed: float, samples: list[CellSample], factor: float, step: float,
    progress: Progress, clearly: float = 1.0,
) -> Found | None:  # fmt: skip
    """The chunks with a noise layer and no more error than allowed; None where their step is no finer than `step`.

    `clearly`: share of `step` below which the first estimate must be.
    """
    if "noise layer" in segment.without:
        return None
    noise_step, with_noise = _noise_steps(segment, num_bytes, allowed, samples, factor)
    if not noise_step or with_noise >= clearly * step:
        return None
    trial = _coded(segment, with_noise, 0, noise_step)
    noise_bytes = sum(chunk.sample.front_bytes for chunk in trial.coded)
    noise_bytes -= sum(one.front_at(with_noise) for one in samples)
    estimated = sum(one.at(noise_step, 1).num_bytes for one in segment.noise_samples())
    noise_factor = max(noise_bytes, 1.0) / max(estimated, 1.0)
    noise_step, with_noise = _noise_steps(segment, num_bytes, allowed, samples, factor, noise_factor)
    tried = None
    if noise_step and abs(math.log(noise_step / trial.noise_step)) < SAME_STEP:
        noise_step, with_noise, tried = trial.noise_step, trial.step, trial
    if not noise_step or with_noise >= step:
        return None
    one = _finest(segment, num_bytes, with_noise, 0, progress, noise_step, first=tried)
    return one if one.num_bytes <= num_bytes and one.all_error <= allowed * CLOSE_ERROR else None


def _over_range(segment: SegmentEncoder, num_bytes: int, found: Found, progress: Progress) -> Found:
    """The chunks after a DCT of the ranges, all cells alike, where that is better in active cells and over all."""
    bounds, errors = (segment.finest_step, segment.coarsest_step), []
    for samples in (segment.samples(), segment.samples_over_range()):
        step = _step_of_size(samples, num_bytes, 1, *bounds)
        errors.append(sum(sample.at(step, 1).all_error for sample in samples))
    by_cell = found.active_error / segment.active_share, found.all_error
    if OVER_RANGE_LOSES * errors[1] / max(errors[0], LEAST_ERROR) * max(by_cell) > min(by_cell):
        return found
    one = _finest(segment, num_bytes, step, 1, progress, over_range=True)
    is_better = one.all_error < found.all_error and one.active_error < found.active_error
    return one if is_better and one.num_bytes <= num_bytes else found


def _noise_steps(
    segment: SegmentEncoder, num_bytes: int, allowed: float, samples: list[CellSample], factor: float,
    noise_factor: float = 1.0,
) -> tuple[float, float]:  # fmt: skip
    """Steps of a noise layer that leaves the error allowed, and of the signal; 0 where there is no room for one.

    The noise has more bytes where the signal's step would be finer than 1 / NOISE_STEPS of its own. `noise_factor`: its
    bytes in estimated ones.
    """
    noise, bounds = segment.noise_samples(), (segment.finest_step, segment.coarsest_step)

    def signal_step(noise_step: float) -> float:
        left = num_bytes - noise_factor * sum(one.at(noise_step, 1).num_bytes for one in noise)
        return _step_of_size(samples, max(left, 1) / factor, 0, *bounds)

    limit = NOISE_SHARE * allowed
    enough = _step_of_error(noise, limit, bounds, lambda one, step: one.at(step, 1).all_error)
    if noise_factor * sum(one.at(enough, 1).num_bytes for one in noise) > MOST_SHARE * num_bytes:
        return 0.0, 0.0
    noise_step, step = enough, signal_step(enough)
    low = math.log(_step_of_size(noise, MOST_SHARE * num_bytes / noise_factor, 1, *bounds))
    high = math.log(enough)
    for _ in range(NOISE_TRIALS):
        middle = math.exp((low + high) / 2)
        one = signal_step(middle)
        if middle > NOISE_STEPS * one:
            noise_step, step, high = middle, one, math.log(middle)
        else:
            low = math.log(middle)
    return noise_step, step


def _even_error(segment: SegmentEncoder, num_bytes: int, plain: list[CellSample], factor: float) -> tuple[float, float]:
    """Error of a coder of so many bytes that treats all cells alike and has no layers; bytes in estimated ones.

    Where such a file is not tried it is estimated, with `factor` bytes in estimated ones.
    """
    if "trial of all cells alike" in segment.without:
        step = _step_of_size(plain, num_bytes / factor, 1, segment.finest_step, segment.coarsest_step)
        return sum(sample.at(step, 1).all_error for sample in plain), factor
    step = _step_of_size(plain, num_bytes, 1, segment.finest_step, segment.coarsest_step)
    seen: list[tuple[float, float]] = []  # logarithms of size and error
    while True:
        coded = segment.encode_plain(step)
        size = sum(len(chunk.data) for chunk in coded)
        seen.append((math.log(size / num_bytes), math.log(sum(chunk.all_error for chunk in coded) + LEAST_ERROR)))
        here = [sample.at(step, 1) for sample in plain]
        factor = size / sum(one.num_bytes for one in here)
        if len(seen) == 2 and abs(seen[1][0] - seen[0][0]) > 0.01:
            slope = (seen[1][1] - seen[0][1]) / (seen[1][0] - seen[0][0])
            return math.exp(seen[1][1] - slope * seen[1][0]), factor
        step = _step_of_size(plain, num_bytes / factor, 1, segment.finest_step, segment.coarsest_step)
        after = sum(sample.at(step, 1).all_error for sample in plain)
        change = math.log(max(after, LEAST_ERROR) / max(sum(one.all_error for one in here), LEAST_ERROR))
        if abs(change) < SAME_ERROR or len(seen) == 2:
            return math.exp(seen[-1][1] + change), factor


def within_error(segment: SegmentEncoder, quality_db: float, progress: Progress) -> list[bytes]:
    """The fewest bytes found whose error-to-signal ratio in active cells is at most -quality_db.

    They are those of the quality asked for, but where one or two numbers hold the signal: then the smallest file is
    better already, since the offsets of its levels hold eight bits of each.
    """
    cube = segment.cube
    if not np.any(cube.values):
        return segment.exact()
    is_active = active_cells(cube.values)
    best: tuple[int, float, float, list[bytes]] | None = None  # bytes, quality, logarithm of the step
    low, high = math.log(segment.finest_step), math.log(segment.coarsest_step)

    def is_enough(log_step: float, price: float = PRICE) -> tuple[list[CodedChunk], float]:
        """Encodes; keeps the smallest that is good enough."""
        nonlocal best
        coded = segment.encode(math.exp(log_step), segment.coarser, price=price)
        found_db = -error_db(cube.values, _values_of(coded, cube), is_active)
        size = sum(len(chunk.data) for chunk in coded)
        if found_db >= quality_db and (best is None or (size, found_db) < best[:2]):
            best = size, found_db, log_step, [chunk.data for chunk in coded]
        return coded, found_db

    guess = math.log(_step_of_quality(segment, quality_db, is_active))
    segment.decide(math.exp(guess))
    for trial in range(TRIALS):
        coded, found_db = is_enough(guess)
        progress(f"trial {trial + 1}")
        if quality_db <= found_db <= quality_db + WITHIN_DB:
            break
        low, high = (guess, high) if found_db >= quality_db else (low, guess)
        guess = _next_quality(coded, guess, found_db - quality_db - AIM_DB, low, high, is_late=trial > TRIALS // 2)
    if best is not None and best[1] > quality_db + WITHIN_DB:  # the quality jumps here: levels are lowered instead
        cheap, dear, log_step = math.log(PRICE), math.log(MOST_PRICE), best[2]
        for _ in range(PRICES):
            _, found_db = is_enough(log_step, math.exp((cheap + dear) / 2))
            if quality_db <= found_db <= quality_db + WITHIN_DB:
                break
            middle = (cheap + dear) / 2
            cheap, dear = (middle, dear) if found_db >= quality_db else (cheap, middle)
    if best is None:
        raise InputError(f"a quality of {quality_db:g} dB cannot be reached; ask for less")
    return best[3]


def _step_of_quality(segment: SegmentEncoder, quality_db: float, is_active: np.ndarray) -> float:
    signal = float(np.sum(np.abs(segment.cube.values[is_active]) ** 2)) / segment.scale.peak**2
    bounds = segment.finest_step, segment.coarsest_step
    error = signal * 10 ** (-quality_db / 10)
    return _step_of_error(
        segment.samples(), error, bounds, lambda one, step: one.at(step, segment.coarser).active_error
    )


def _step_of_error(
    samples: list[CellSample], error: float, bounds: tuple[float, float], error_of: Callable[[CellSample, float], float]
) -> float:
    def room(step: float) -> float:
        return -math.log(max(sum(error_of(sample, step) for sample in samples), LEAST_ERROR) / max(error, LEAST_ERROR))

    return _step_where(room, *bounds)


def _next_quality(
    coded: list[CodedChunk], guess: float, too_good_db: float, low: float, high: float, *, is_late: bool
) -> float:
    samples, step = [chunk.sample for chunk in coded], math.exp(guess)

    def error(sample: CellSample, step: float) -> float:
        return sample.at(step, 1).active_error  # in which coarse cells have no part

    here = sum(error(sample, step) for sample in samples)
    bounds = math.exp(max(low, guess - 2)), math.exp(min(high, guess + 2))
    found = math.log(_step_of_error(samples, here * 10 ** (too_good_db / 10), bounds, error))
    edge = 0.02 * (high - low)
    inside = low + edge < found < high - edge
    return found if inside and not is_late else (max(low, guess - 4) + min(high, guess + 4)) / 2


def _values_of(coded: list[CodedChunk], cube) -> CubeValues:
    return np.concatenate([decode_chunk(chunk.data, cube.config).cube_values() for chunk in coded])


def error_db(truth: CubeValues, ours: CubeValues, is_active: np.ndarray) -> float:
    """Error-to-signal ratio in dB in some cells (frame, range, doppler)."""
    error, signal = (float(np.sum(np.abs(values)[is_active] ** 2)) for values in (truth - ours, truth))
    return ratio_db(error, signal)


def ratio_db(error: float, signal: float) -> float:
    """Error-to-signal ratio in dB of two energies; EXACT_DB where there is no error."""
    return 10 * math.log10(error / max(signal, LEAST_ERROR)) if error else EXACT_DB
