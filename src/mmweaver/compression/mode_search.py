"""Which modes, coarse steps and noise layer a file of a size has (encoder side).

All is decided by counted chunks, whose errors are exact and whose sizes are estimated to some percent: see
`ChunkEncoder.encode`. What they would be with exactly the bytes allowed follows from a sample of their cells.
"""

import math
from dataclasses import dataclass

from mmweaver.compression.coded_chunk import ChunkMode
from mmweaver.compression.segment import SegmentEncoder
from mmweaver.compression.step_search import COUNT_AIM, LEAST_ERROR, Found, Plan, step_of_error, step_of_size, sum_at

DECISIONS = 2
SAME_MODE = 1.0  # difference of log(step) beyond which modes are chosen again
# difference of log(bytes) up to which counted chunks tell the errors of those with the bytes allowed; most counts
CLOSE, CLOSE_WITH_RANK, COUNTS = 0.2, 0.02, 4
EVEN_DB = 0.15  # dB that the error over all cells may exceed that of an even coder
SPARE = 1.25  # times the bytes: an even coder by the estimate has no less error than a real one of fewer bytes
CLOSE_ERROR = 1.01  # times the error allowed that is as good
OVER_RANGE_LOSES = 1.7  # times the error estimated: cells are predicted by neighbours, which no estimate knows
CLEARLY_FINER = 0.9  # steps that a noise layer must have where there need not be one
NOISE_SHARE = 0.97  # of the error allowed that a noise layer may leave
NOISE_ERROR = 0.5  # of the error over all cells: with less in active cells, all may be coded as noise
PICTURE_BYTES = 0.6  # of the bytes: with so many a noise layer of everything is as good as codecs of pictures with all
MOST_SHARE = 0.9  # of the bytes that the noise may have
NOISE_STEPS, NOISE_TRIALS = 12, 7
NOISE_COUNTS, SAME_NOISE = 2, 0.05  # counts of a noise layer; share of the signal's bytes that an estimate may mistake
AS_GOOD = 0.97  # of the product of errors as counted first: what a file without a layer must have to be decided on
SURELY = 0.8  # of the errors that are planned, which the bytes of counted files mistake by some percent
CLEARLY_BETTER = 0.8  # of the product of errors: with this advantage by estimates, no file without layers is counted


def best_plans(segment: SegmentEncoder, num_bytes: int) -> list[Plan]:
    """The best file found, and where it has scatterers and is not clearly better, the best one without: both are coded.

    Files without a layer are counted first as they begin: only where they are about as good then, the rest is decided.
    Where scatterers were considered and left, the file is the one that is found without.
    """
    best, first = _best(segment, num_bytes)
    has_points = any(chunk.mode.with_points for chunk in best.found.coded)
    if not segment.had_points or (has_points and _is_clear(segment, num_bytes)):
        return [best]
    segment.start_again("scatterers")
    begun = _first(segment, num_bytes)
    is_behind = _as_begun(segment, num_bytes, begun).is_behind(_as_begun(segment, num_bytes, first), AS_GOOD)
    if has_points and is_behind:
        return [best]
    other, _ = _best(segment, num_bytes, "scatterers", begun=begun)
    if not has_points or best.is_behind(other, SURELY):
        return [other]
    return [best] if other.is_behind(best, SURELY) else [best, other]


def _best(segment: SegmentEncoder, num_bytes: int, *left_out: str, begun: Found | None = None) -> tuple[Plan, Found]:
    """The best of the files with all layers that pay by estimates and without low rank, and its first count."""
    plan, first = _plan(segment, num_bytes, begun)
    if not any(chunk.mode.with_rank for chunk in plan.found.coded):
        return plan, first
    segment.start_again(*left_out, "low rank")
    other = _first(segment, num_bytes)
    if _as_begun(segment, num_bytes, other).badness * AS_GOOD > _as_begun(segment, num_bytes, first).badness:
        return plan, first
    return min((plan, first), _plan(segment, num_bytes, other), key=lambda one: one[0].badness)


def _as_begun(segment: SegmentEncoder, num_bytes: int, first: Found) -> Plan:
    return Plan.of(first, num_bytes, segment.bounds)


def _is_clear(segment: SegmentEncoder, num_bytes: int) -> bool:
    """Whether the modes decided on are better than those without layers by so much that no count is needed."""
    badness = []
    for samples in (segment.decided_samples(), segment.samples()):
        step = step_of_size(samples, num_bytes, segment.coarser, segment.bounds)
        errors = sum_at(samples, step, segment.coarser)
        badness.append(errors.active_error * errors.all_error)
    return badness[0] < CLEARLY_BETTER * badness[1]


def _first(segment: SegmentEncoder, num_bytes: int) -> Found:
    """The chunks in the modes that cost least by estimates, counted at about the step that they need."""
    step = step_of_size(segment.samples(), num_bytes, segment.coarser, segment.bounds)
    for _ in range(DECISIONS):
        decided_at = step
        segment.decide(step)
        step = step_of_size(segment.decided_samples(), COUNT_AIM * num_bytes, segment.coarser, segment.bounds)
        if abs(math.log(step / decided_at)) < SAME_MODE:
            break
    return _counted(segment, num_bytes, step, segment.coarser)


def _plan(segment: SegmentEncoder, num_bytes: int, first: Found | None = None) -> tuple[Plan, Found]:
    """The file with all layers that pay by estimates, and as it was counted `first`."""
    first = first or _first(segment, num_bytes)
    if segment.coarser == 1:
        return Plan.of(first, num_bytes, segment.bounds), first
    plan = _evened(segment, num_bytes, first)
    return (plan if "DCT of ranges" in segment.without else _over_range(segment, num_bytes, plan)), first


def _counted(segment: SegmentEncoder, num_bytes: int, step: float, coarser: int, noise_step: float = 0.0) -> Found:
    """Counted chunks at a step, or at one at which their size is closer to that allowed.

    With low rank much closer: rank and size jump with the step, which no estimate knows.
    """
    for _ in range(COUNTS):
        chunks = segment.encode(step, coarser, noise_step, only_size=True)
        one = Found(coded=chunks, step=step, coarser=coarser, noise_step=noise_step)
        close = CLOSE_WITH_RANK if any(chunk.mode.with_rank for chunk in chunks) else CLOSE
        if abs(math.log(one.num_bytes / num_bytes)) < close:
            break
        step = one.step_of_size(num_bytes, segment.bounds)
    return one


def _evened(segment: SegmentEncoder, num_bytes: int, first: Found) -> Plan:
    """The chunks whose error over all cells is about that of an even coder, with the finest step.

    Where those of the mode counted `first` have more, either cells without signal have less coarse steps, or a noise
    layer holds them.
    """
    bounds, samples = segment.bounds, first.samples
    own = Plan.of(first, num_bytes, bounds)
    evens = _even_plans(segment, num_bytes, first, own)
    if not evens:
        return _with_noise(segment, num_bytes, own.all_error, first, CLEARLY_FINER * own.step) or own
    even = min(evens, key=lambda plan: plan.all_error)
    allowed = even.all_error * 10 ** (EVEN_DB / 10)
    if own.all_error <= allowed:
        return _with_noise(segment, num_bytes, own.all_error, first, CLEARLY_FINER * own.step) or own
    error_factor = first.all_error / sum_at(samples, first.step, first.coarser).all_error
    for coarser in (3, 2, 1):
        share = math.log(coarser) / math.log(segment.coarser)
        factor = first.bytes_factor**share * even.found.bytes_factor ** (1 - share)
        step = step_of_size(samples, num_bytes / factor, coarser, bounds)
        if coarser == 1 or error_factor * sum_at(samples, step, coarser).all_error <= allowed:
            break
    noisy = _with_noise(segment, num_bytes, allowed, first, step)
    if noisy is not None:
        return noisy
    while coarser > 1:
        plan = Plan.of(_counted(segment, num_bytes, step, coarser), num_bytes, bounds)
        if plan.all_error <= allowed * CLOSE_ERROR:
            return plan
        coarser -= 1
    if segment.decide(step, 1):  # modes were chosen for cells without signal that count less
        size = COUNT_AIM * num_bytes / even.found.bytes_factor
        step = step_of_size(segment.decided_samples(), size, 1, bounds)
    by_cell = Plan.of(_counted(segment, num_bytes, step, 1), num_bytes, bounds)
    if not all(chunk.mode.only_noise for chunk in even.found.coded):
        return by_cell
    return min(by_cell, Plan.of(even.found, num_bytes, bounds), key=lambda plan: plan.badness)


def _even_plans(segment: SegmentEncoder, num_bytes: int, first: Found, own: Plan) -> list[Plan]:
    """Even coders that by estimates have less error over all cells: of cells, and of a noise layer of everything.

    The latter has fewer bytes, about as many as codecs of pictures make use of: the rest is for the signal, if any.
    """
    plans, bounds = [], segment.bounds
    step = step_of_size(segment.samples(), SPARE * num_bytes / first.bytes_factor, 1, bounds)
    if own.all_error > sum_at(segment.samples(), step, 1).all_error:
        plans.append(_in_modes(segment, segment.plain_modes(), num_bytes))
    has_signal = segment.active_share < 1
    is_noise = own.active_error < NOISE_ERROR * own.all_error or not has_signal
    if is_noise and "noise layer" not in segment.without:
        size = num_bytes * (PICTURE_BYTES if has_signal else 1)
        step = step_of_size(segment.samples_as_noise(), size, 1, bounds)
        if own.all_error > sum_at(segment.samples_as_noise(), step, 1).all_error:
            found = _in_modes(segment, segment.modes_as_noise(), num_bytes).found
            plans.append(Plan.at(found, found.step_of_size(COUNT_AIM * size, bounds)))
    return plans


def _in_modes(segment: SegmentEncoder, modes: list[ChunkMode], num_bytes: int) -> Plan:
    """The chunks in given modes, all cells alike."""
    before = segment.modes()
    segment.take_modes(modes)
    step = step_of_size(segment.mode_samples(), num_bytes, 1, segment.bounds)
    plan = Plan.of(_counted(segment, num_bytes, step, 1), num_bytes, segment.bounds)
    segment.take_modes(before)
    return plan


def _with_noise(
    segment: SegmentEncoder, num_bytes: int, allowed: float, first: Found, coarsest_step: float
) -> Plan | None:
    """The chunks with a noise layer and no more error than allowed; None where they need a step coarser than that."""
    if "noise layer" in segment.without:
        return None
    factors = _Factors(signal_bytes=first.bytes_factor)
    noise_step, step = _noise_steps(segment, num_bytes, allowed, first, factors)
    for _ in range(NOISE_COUNTS):
        if not noise_step or step >= coarsest_step:
            return None
        trial = _counted(segment, num_bytes, step, 0, noise_step)
        signal, noise = sum_at(first.samples, trial.step, 0), sum_at(segment.noise_samples(), noise_step, 1)
        noise_bytes = sum(chunk.draft.noise_bytes for chunk in trial.coded)
        factors = _Factors(
            signal_bytes=(trial.num_bytes - noise_bytes) / signal.num_bytes, noise_bytes=noise_bytes / noise.num_bytes,
            error=trial.all_error / noise.all_error,
        )  # fmt: skip
        noise_step, step = _noise_steps(segment, num_bytes, allowed, first, factors)
        if not noise_step:
            return None
        # bytes of the noise that an estimate mistakes are the signal's
        if abs(math.log(noise_step / trial.noise_step)) * noise_bytes < SAME_NOISE * (num_bytes - noise_bytes):
            break
    if step >= coarsest_step:
        return None
    left = sum_at(segment.noise_samples(), noise_step, 1).all_error
    plan = Plan.at(trial, step, noise_step, left / noise.all_error)
    return plan if plan.all_error <= allowed * CLOSE_ERROR else None


@dataclass(frozen=True, kw_only=True)
class _Factors:
    """Bytes of the signal and of the noise layer, and the error that this leaves, in estimated ones."""

    signal_bytes: float
    noise_bytes: float = 1.0
    error: float = 1.0


def _noise_steps(
    segment: SegmentEncoder, num_bytes: int, allowed: float, first: Found, factors: _Factors
) -> tuple[float, float]:
    """Steps of a noise layer that leaves the error allowed, and of the signal; 0 where there is no room for one.

    The noise has more bytes where the signal's step would be finer than 1 / NOISE_STEPS of its own.
    """
    noise, bounds = segment.noise_samples(), segment.bounds

    def signal_step(noise_step: float) -> float:
        left = num_bytes - factors.noise_bytes * sum_at(noise, noise_step, 1).num_bytes
        return step_of_size(first.samples, max(left, 1) / factors.signal_bytes, 0, bounds)

    enough = step_of_error(noise, NOISE_SHARE * allowed / factors.error, 1, bounds, lambda one: one.all_error)
    if factors.noise_bytes * sum_at(noise, enough, 1).num_bytes > MOST_SHARE * num_bytes:
        return 0.0, 0.0
    noise_step, step = enough, signal_step(enough)
    low = math.log(step_of_size(noise, MOST_SHARE * num_bytes / factors.noise_bytes, 1, bounds))
    high = math.log(enough)
    for _ in range(NOISE_TRIALS):
        middle = math.exp((low + high) / 2)
        one = signal_step(middle)
        if middle > NOISE_STEPS * one:
            noise_step, step, high = middle, one, math.log(middle)
        else:
            low = math.log(middle)
    return noise_step, step


def _over_range(segment: SegmentEncoder, num_bytes: int, plan: Plan) -> Plan:
    """The chunks after a DCT of the ranges, all cells alike, where that is better in active cells and over all."""
    errors = []
    for samples in (segment.samples(), segment.samples_over_range()):
        step = step_of_size(samples, num_bytes, 1, segment.bounds)
        errors.append(sum_at(samples, step, 1).all_error)
    by_cell = plan.active_error / segment.active_share, plan.all_error
    if OVER_RANGE_LOSES * errors[1] / max(errors[0], LEAST_ERROR) * max(by_cell) > min(by_cell):
        return plan
    other = _in_modes(segment, segment.modes_over_range(), num_bytes)
    return other if other.all_error < plan.all_error and other.active_error < plan.active_error else plan
