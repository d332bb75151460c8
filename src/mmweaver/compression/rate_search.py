"""Searches the step of a file of so many bytes, or of a quality (encoder side).

How a file is coded is decided by counted chunks (`mode_search`). It is coded a first time, which calibrates the
estimate of its size, and a second one, if that does not use the bytes allowed.
"""

import math
from collections.abc import Callable
from dataclasses import replace

import numpy as np

from mmweaver.compression.cell_choice import active_cells
from mmweaver.compression.chunk import decode_chunk
from mmweaver.compression.coded_chunk import CodedChunk
from mmweaver.compression.mode_search import best_plans
from mmweaver.compression.residual_stream import PRICE
from mmweaver.compression.segment import SegmentEncoder
from mmweaver.compression.step_search import AIM, LEAST_ERROR, Found, Plan, step_of_error, step_of_size, sum_at
from mmweaver.core.errors import InputError
from mmweaver.core.shapes import CubeValues

EXACT_SHARE = 0.7  # a file without loss is tried where the bytes allowed are at least this share of the cube's
TRIALS = 9
CLOSE_ENOUGH, ENOUGH_LATER, LATER = 0.98, 0.971, 2  # of the bytes allowed; the same after so many trials
CLOSEST = 1.002  # ratio of steps that are tried one after the other, at least
# a step so many times coarser costs more than a coarser noise layer; share of its bytes that one keeps at least
MUCH_COARSER, LEAST_NOISE = 1.08, 0.95
MOST_PRICE, PRICES = 1000.0, 10  # squared steps a bit, where a quality jumps; how many are tried
WITHIN_DB, AIM_DB = 0.2, 0.08  # better than the quality asked for
EXACT_DB = -300.0  # said of a cube without any error

Progress = Callable[[str], None]


def within_bytes(segment: SegmentEncoder, num_bytes: int, progress: Progress) -> list[bytes]:
    """The finest step whose file fits. Cells without signal err more only while that costs little over all cells."""
    if num_bytes < 1:
        raise InputError(f"the bytes are too few for so many frames; give at least {1 - num_bytes} more")
    if num_bytes >= EXACT_SHARE * segment.cube.values.nbytes or not np.any(segment.cube.values):
        exact = segment.exact()
        if sum(map(len, exact)) <= num_bytes:
            return exact
    plans = best_plans(segment, num_bytes)
    progress("coding")
    found = _best([_finest(segment, num_bytes, plan, progress) for plan in plans], num_bytes)
    if found.num_bytes > num_bytes:
        more = math.ceil(found.num_bytes - num_bytes)
        raise InputError(f"the bytes are too few for this recording; give at least {more} more")
    return [chunk.data for chunk in found.coded]


def _best(files: list[Found], num_bytes: int) -> Found:
    """The first file, unless the second one fits and is better in active cells or in the product of the errors."""
    first, *others = files
    for other in others:
        is_ahead = first.active_error <= other.active_error and first.badness <= other.badness
        if other.num_bytes <= num_bytes < first.num_bytes or (other.num_bytes <= num_bytes and not is_ahead):
            return other
    return first


def _finest(segment: SegmentEncoder, num_bytes: int, plan: Plan, progress: Progress) -> Found:
    """The planned chunks, coded with the finest step that fits; larger ones where none does."""
    coarser, noise_step, step = plan.found.coarser, plan.noise_step, plan.step
    segment.take_modes([replace(chunk.mode, noise_step=0.0) for chunk in plan.found.coded])

    def coded(step: float) -> Found:
        return Found(coded=segment.encode(step, coarser, noise_step), step=step, coarser=coarser, noise_step=noise_step)

    fits: Found | None = None
    larger: Found | None = None
    low, high = segment.bounds
    for trial in range(TRIALS):
        one = coded(step)
        progress(f"trial {trial + 1}")
        if one.num_bytes <= num_bytes:
            fits, high = one if fits is None or one.num_bytes > fits.num_bytes else fits, step
            enough = CLOSE_ENOUGH if trial < LATER else ENOUGH_LATER
            if one.num_bytes >= enough * num_bytes or step <= segment.finest_step:
                break
        else:
            nearer = one.step_of_size(AIM * num_bytes, (low, high))
            if not trial and noise_step and nearer > MUCH_COARSER * step:
                noise_step = _less_noise(segment, one, math.ceil(one.num_bytes - AIM * num_bytes))
                continue
            larger, low = one, step
        if high < low * 1.0001:
            break
        if fits is None or larger is None:
            step = one.step_of_size(AIM * num_bytes, (low, high))
            step = min(step, high / CLOSEST) if one is fits else max(step, low * CLOSEST)
        else:
            step = _between(larger, fits, num_bytes, is_even=bool(trial % 3 == 2))
    return fits or coded(segment.coarsest_step)


def _less_noise(segment: SegmentEncoder, one: Found, num_bytes: int) -> float:
    """The step of noise layers of so many bytes less."""
    samples, before = segment.noise_samples(), sum(chunk.draft.noise_bytes for chunk in one.coded)
    now = sum_at(samples, one.noise_step, 1).num_bytes
    least = now * max(1 - num_bytes / before, LEAST_NOISE)
    return step_of_size(samples, least, 1, segment.bounds)


def _between(larger: Found, fits: Found, num_bytes: int, *, is_even: bool) -> float:
    """Interpolates the logarithms of sizes and steps, or halves."""
    low, high = math.log(larger.step), math.log(fits.step)
    above = math.log(larger.num_bytes / num_bytes / AIM)
    below = math.log(fits.num_bytes / num_bytes / AIM)
    share = 0.5 if is_even else min(max(above / (above - below), 0.05), 0.95)
    return math.exp(low + share * (high - low))


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
    error = signal * 10 ** (-quality_db / 10)
    return step_of_error(segment.samples(), error, segment.coarser, segment.bounds, lambda one: one.active_error)


def _next_quality(
    coded: list[CodedChunk], guess: float, too_good_db: float, low: float, high: float, *, is_late: bool
) -> float:
    samples = [chunk.sample for chunk in coded]
    error = sum_at(samples, math.exp(guess), 1).active_error * 10 ** (
        too_good_db / 10
    )  # coarse cells have no part in it
    bounds = math.exp(max(low, guess - 2)), math.exp(min(high, guess + 2))
    found = math.log(step_of_error(samples, error, 1, bounds, lambda one: one.active_error))
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
