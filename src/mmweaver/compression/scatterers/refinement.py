"""Levenberg-Marquardt refinement of all scatterers of a frame jointly, frame by frame.

A scatterer is a product of a range, a Doppler and an antenna factor, so the normal matrix of hundreds of scatterers
is the elementwise product of three small Gram matrices, and no Jacobian is formed. The arrays of one frame fit into
the cache, while those of all frames together would be copied to and from memory in every operation.
"""

import math
from dataclasses import dataclass

import numpy as np
import torch
from jaxtyping import Float
from scipy.linalg import get_lapack_funcs
from torch import Tensor

from mmweaver.compression.scatterers.point_factors import PointFactors
from mmweaver.signal.point_response import Axes, PointResponse, Points

Array = np.ndarray
SOLVE = get_lapack_funcs("posv", dtype=np.float32)
MAX_STEP_BINS = 0.5
MAX_STEP_DIRECTION = 0.25
DAMPING_START, DAMPING_MIN, DAMPING_MAX = 3e-2, 3e-3, 1e3
DAMPING_DOWN, DAMPING_UP = 1.5, 8.0  # a rejected step costs as much as an accepted one
HALO_BINS = 4  # range bins of the residual beyond those of a group of scatterers


@dataclass
class Damping:
    """Levenberg-Marquardt damping of each frame (frame,)."""

    value: Float[Array, "frame"]

    @classmethod
    def fresh(cls, num_frames: int) -> "Damping":
        """The initial damping."""
        return cls(np.full(num_frames, DAMPING_START))

    def learn(self, frame: int, *, is_better: bool) -> None:
        """Lowers the damping of a frame whose step was accepted, raises it otherwise."""
        changed = self.value[frame] / DAMPING_DOWN if is_better else self.value[frame] * DAMPING_UP
        self.value[frame] = min(max(changed, DAMPING_MIN), DAMPING_MAX)


def refined(
    points: Points,
    target: Tensor,
    response: PointResponse,
    axes: Axes,
    damping: Damping,
    *,
    steps: int,
    largest: int,
) -> tuple[Points, Tensor]:
    """Levenberg-Marquardt refinement of all scatterers.

    Frames of more than `largest` scatterers are split into groups of neighbours in range, solved in turn. A step that
    would raise a frame's error is rejected. Padded points of zero amplitude are unchanged.

    Args:
        points: Scatterers (frame, point).
        target: Working frames (frame, range, doppler, antenna) in centred phase.
        response: Point response of the radar.
        axes: Cells of the target.
        damping: Damping of each frame, changed in place.
        steps: Number of steps.
        largest: Maximum number of scatterers that are solved for jointly.

    Returns:
        The points after the steps, and the residual of the target.
    """
    residual = target - response.render(points, axes)
    received, rest = (torch.view_as_real(values.contiguous()).flatten(2).numpy() for values in (target, residual))
    found = refined_factors(
        PointFactors.of(points, response, axes), received, rest, damping, steps=steps, largest=largest
    )
    return found.points(), residual


def refined_factors(
    points: PointFactors,
    received: Float[Array, "frame range cells"],
    rest: Float[Array, "frame range cells"],
    damping: Damping,
    *,
    steps: int,
    largest: int,
) -> PointFactors:
    """`refined` on factors.

    Args:
        points: Scatterers with their factors.
        received: The target, real (frame, range, (doppler, antenna, part)).
        rest: The residual, of the same shape; changed in place.
        damping: Damping of each frame, changed in place.
        steps: Number of steps.
        largest: Maximum number of scatterers that are solved for jointly.
    """
    counts = points.counts().tolist()
    filled = [frame for frame, count in enumerate(counts) if count]
    cost = [np.vdot(one, one) for one in rest]
    for _ in range(steps):
        for half in (0, 1) if max(counts, default=0) > largest else (0,):  # each sees the updates of its neighbours
            moves = np.zeros((*points.amplitude.shape, 6), np.float32)
            for frame in filled:
                for group, cells in _groups(points, frame, counts[frame], largest)[half::2]:
                    moves[frame, group] = _step(points, frame, group, rest[frame], cells, float(damping.value[frame]))
            trial = points.moved(moves, MAX_STEP_BINS, MAX_STEP_DIRECTION)
            for frame in filled:
                left = received[frame] - trial.rendered(frame, counts[frame])
                trial_cost = np.vdot(left, left)
                is_better = bool(trial_cost < cost[frame])
                damping.learn(frame, is_better=is_better)
                if is_better:
                    rest[frame], cost[frame] = left, trial_cost
                else:
                    trial.take(points, frame)
            points = trial
    return points


def _groups(points: PointFactors, frame: int, count: int, largest: int) -> list[tuple[Array, slice]]:
    """Indices of a frame's scatterers that are solved for jointly, by range, and the range cells that they affect."""
    num_range = points.axes.num_range
    if count <= largest:
        return [(np.arange(count), slice(0, num_range))]
    bins = points.bins[0, frame, :count]
    found = []
    for group in np.array_split(bins.argsort(kind="stable"), math.ceil(count / largest)):
        low, high = (math.floor(float(bins[group[side]]) - points.axes.first_range) for side in (0, -1))
        found.append((group, slice(max(low - HALO_BINS, 0), min(high + 2 + HALO_BINS, num_range))))
    return found


def _step(points: PointFactors, frame: int, group: Array, rest: Array, cells: slice, damping: float) -> Array:
    """Damped Gauss-Newton step (point, 6) of some scatterers: bins, directions, real and imaginary amplitude."""
    num, sides = len(group), points.axes.response.num_directions
    at_range = points.at_range[:, frame, group, cells].reshape(2 * num, -1)
    at_doppler = points.at_doppler[:, frame, group]
    vectors = _antenna_vectors(points, frame, group)
    gradient = _gradient(at_range, at_doppler, vectors, rest[cells])
    matrix = _normal_matrix(at_range, at_doppler.reshape(2 * num, -1), vectors)
    diagonal = matrix.reshape(-1)[:: len(matrix) + 1]
    # relative to each parameter's own curvature, since parameters differ in kind and amplitudes by many decibels
    diagonal += damping * (diagonal + (1e-6 * diagonal.max() + 1e-30))
    # the lower triangle in row order is the upper one in column order, which saves a copy
    _, found, info = SOLVE(matrix.T, gradient, lower=0, overwrite_a=1, overwrite_b=1)
    out = np.zeros((num, 6), np.float32)
    if not info and np.isfinite(found).all():
        steps = found.reshape(-1, num).T
        out[:, : 2 + sides], out[:, 4:] = steps[:, :-2], steps[:, -2:]
    return out


def _antenna_vectors(points: PointFactors, frame: int, group: Array) -> Array:
    """Real (kind, point, 2 antenna): echo, its derivatives by direction, and by both parts of the amplitude."""
    steer, place = points.steer[frame, group], points.axes.place
    sides = points.axes.response.num_directions
    out = np.empty((3 + sides, *steer.shape), np.complex64)
    echo = np.multiply(points.amplitude[frame, group, None], steer, out=out[0])
    for side in range(sides):
        np.multiply(echo, (-2j * math.pi) * place[:, side], out=out[1 + side])
    out[-2] = steer
    np.multiply(steer, np.complex64(1j), out=out[-1])
    return out.view(np.float32)


def _normal_matrix(at_range: Array, at_doppler: Array, vectors: Array) -> Array:
    """Normal matrix over (parameter, point); only the blocks on and below the diagonal are filled."""
    kinds, num = len(vectors), vectors.shape[1]
    flat = vectors.reshape(kinds * num, -1)
    by_range, by_doppler, by_antenna = at_range @ at_range.T, at_doppler @ at_doppler.T, flat @ flat.T
    own, slope = slice(0, num), slice(num, None)
    out = np.empty(((1 + kinds) * num,) * 2, np.float32)
    rest = out[2 * num :].reshape(kinds - 1, num, -1)
    # echo with echo, then echo with the other kinds
    echo = by_antenna[own, own]
    out[own, own] = by_range[slope, slope] * by_doppler[own, own] * echo
    out[slope.start : 2 * num, own] = by_range[own, slope] * by_doppler[slope, own] * echo
    out[num : 2 * num, num : 2 * num] = by_range[own, own] * by_doppler[slope, slope] * echo
    others = by_antenna[num:].reshape(kinds - 1, num, -1)
    np.multiply(others[..., own], -by_range[own, slope] * by_doppler[own, own], out=rest[..., own])
    np.multiply(others[..., own], -by_range[own, own] * by_doppler[own, slope], out=rest[..., num : 2 * num])
    cell = by_range[own, own] * by_doppler[own, own]
    np.multiply(
        others[..., num:].reshape(kinds - 1, num, kinds - 1, num),
        cell[:, None],
        out=rest[..., 2 * num :].reshape(kinds - 1, num, kinds - 1, num),
    )
    return out


def _gradient(at_range: Array, at_doppler: Array, vectors: Array, rest: Array) -> Array:
    """Inner products (parameter and point,) of the residual (range, ...) with all derivatives."""
    num = at_doppler.shape[1]
    seen = (at_range @ rest).reshape(2, num, at_doppler.shape[2], -1)
    along = at_doppler.transpose(1, 0, 2) @ seen[0]  # by the values of the kernel, and by its slopes
    nearer = at_doppler[0][:, None] @ seen[1]
    out = np.empty((1 + len(vectors), num), np.float32)
    np.einsum("pa,pa->p", nearer[:, 0], vectors[0], out=out[0])
    np.einsum("pa,pa->p", along[:, 1], vectors[0], out=out[1])
    np.negative(out[:2], out=out[:2])
    np.einsum("pa,kpa->kp", along[:, 0], vectors[1:], out=out[2:])
    return out.reshape(-1)
