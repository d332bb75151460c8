"""Searches the step of a file of so many bytes (encoder side).

How a file is coded is decided by counted chunks (`mode_search`). It is coded a first time, which calibrates the
estimate of its size, and a second one, if that does not use the bytes allowed.
"""

import math
from collections.abc import Callable
from dataclasses import replace

import numpy as np

from mmweaver.compression.mode_search import best_plans
from mmweaver.compression.residual_stream import USUAL_PRICE, Price
from mmweaver.compression.segment import SegmentEncoder
from mmweaver.compression.step_search import AIM, Found, Plan, step_of_size, sum_at
from mmweaver.core.errors import InputError
from mmweaver.core.shapes import CubeValues

EXACT_SHARE = 0.7  # a file without loss is tried where the bytes allowed are at least this share of the cube's
TRIALS = 9
CLOSE_ENOUGH, ENOUGH_LATER, LATER = 0.98, 0.971, 2  # of the bytes allowed; the same after so many trials
DEAR, SHARES = 1.0, 7  # squared steps a bit in a share of the cells, where no step uses the bytes; how many are tried
CLOSEST = 1.002  # ratio of steps that are tried one after the other, at least
# a step so many times coarser costs more than a coarser noise layer; share of its bytes that one keeps at least
MUCH_COARSER, LEAST_NOISE = 1.08, 0.95
LEAST_SIGNAL = 1e-150  # squared, so that a cube of zeros has a ratio
FLOAT32_DB = -115.0  # where the finest step is reached: what is left is the last digits of float32
EXACT_DB = -300.0  # said of a cube without any error

Progress = Callable[[str], None]


def within_bytes(segment: SegmentEncoder, num_bytes: int, progress: Progress) -> list[bytes]:
    """The finest step whose file fits. Cells without signal err more only while that costs little over all cells."""
    if num_bytes < 1:
        raise InputError(f"the bytes are too few for so many frames; give at least {1 - num_bytes} more")
    if num_bytes >= EXACT_SHARE * segment.cube.values.nbytes or segment.repeats():
        exact = segment.exact()
        if sum(map(len, exact)) <= num_bytes:
            return exact
    plans = best_plans(segment, num_bytes)
    progress("coding")
    found = _best([_finest(segment, num_bytes, plan, progress) for plan in plans], num_bytes)
    if found.num_bytes > num_bytes:
        more = math.ceil(found.num_bytes - num_bytes)
        raise InputError(f"the bytes are too few for this recording; give at least {more} more")
    if found.num_bytes < ENOUGH_LATER * num_bytes:  # nothing is left to be said but the last digits
        exact = segment.exact()
        if sum(map(len, exact)) <= num_bytes:
            return exact
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

    def coded(step: float, price: Price = USUAL_PRICE) -> Found:
        chunks = segment.encode(step, coarser, noise_step, price)
        return Found(coded=chunks, step=step, coarser=coarser, noise_step=noise_step)

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
    if (
        fits and larger and fits.num_bytes < ENOUGH_LATER * num_bytes
    ):  # one step more is too much: some levels are lower
        few, many = 0.0, 1.0
        for _ in range(SHARES):
            share = (few + many) / 2
            one = coded(larger.step, Price(dear=DEAR, share=share))
            few, many = (few, share) if one.num_bytes <= num_bytes else (share, many)
            fits = one if fits.num_bytes < one.num_bytes <= num_bytes else fits
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


def error_db(truth: CubeValues, ours: CubeValues, is_active: np.ndarray) -> float:
    """Error-to-signal ratio in dB in some cells (frame, range, doppler)."""
    error, signal = (
        float(np.sum(np.square(np.abs(values[is_active]), dtype=np.float64))) for values in (truth - ours, truth)
    )
    return ratio_db(error, signal)


def ratio_db(error: float, signal: float) -> float:
    """Error-to-signal ratio in dB of two energies; EXACT_DB where there is no error."""
    return 10 * math.log10(error / max(signal, LEAST_SIGNAL)) if error else EXACT_DB
