"""Levenberg-Marquardt refinement of all scatterers of a frame jointly, batched over frames.

A scatterer is a product of a range, a Doppler and an antenna factor, so the normal matrix of hundreds of scatterers
is the elementwise product of three small Gram matrices: no Jacobian is ever formed.
"""

import math
from dataclasses import dataclass, replace

import torch
from torch import Tensor

from mmweaver.dsp.point_response import Axes, PointResponse, Points
from mmweaver.fields.scatterers.layers import select_points

LARGEST_STEP_BINS = 0.5
LARGEST_STEP_DIRECTION = 0.25
DAMPING_START, DAMPING_LEAST, DAMPING_MOST = 3e-2, 3e-3, 1e3
DAMPING_DOWN, DAMPING_UP = 1.5, 8.0  # a step that is rejected costs as much as one that is not
LEAST_BATCH, MOST_BATCHES, WORTH_BATCHES = 5, 2, 12  # frames, batches; points from which on they pay
HALO_BINS = 4  # range bins of the residual beyond those of a group of scatterers

# parameter: range bin, Doppler bin, direction x, direction z, real and imaginary amplitude
RANGE_FACTOR = (1, 0, 0, 0, 0, 0)  # 1 = slope of the kernel
DOPPLER_FACTOR = (0, 1, 0, 0, 0, 0)
ANTENNA_FACTOR = (0, 0, 1, 2, 3, 4)
SIGN = (-1.0, -1.0, 1.0, 1.0, 1.0, 1.0)


@dataclass(frozen=True, kw_only=True)
class Groups:
    """Scatterers (frame, group, point) that are solved for jointly, and their range bins of the residual."""

    points: Points
    first: Tensor  # (frame, group) index of the first range cell used
    num_cells: int


@dataclass
class Damping:
    """Levenberg-Marquardt damping of each frame (frame,)."""

    value: Tensor

    @classmethod
    def fresh(cls, num_frames: int) -> "Damping":
        return cls(torch.full((num_frames,), DAMPING_START))

    def learn(self, is_better: Tensor) -> None:
        """Lowers the damping of frames (frame,) whose step was accepted, raises that of the others."""
        changed = torch.where(is_better, self.value / DAMPING_DOWN, self.value * DAMPING_UP)
        self.value = changed.clamp(DAMPING_LEAST, DAMPING_MOST)


def refined(
    points: Points,
    target: Tensor,
    response: PointResponse,
    axes: Axes,
    damping: Damping,
    *,
    steps: int,
    largest: int,
    residual: Tensor | None = None,
) -> tuple[Points, Tensor]:
    """The points (frame, point) after `steps` steps, and the residual of the target.

    The target is (frame, range, doppler, antenna) in centred phase. Frames of more than `largest` scatterers are split
    into groups of neighbours in range, solved in turn. A step that would raise a frame's error is rejected. Padded
    points have amplitude zero and stay. `residual`: that of the points at the start, if known.
    """
    residual = target - response.render(points, axes) if residual is None else residual
    batches = _alike(points, largest)
    if len(batches) == 1:
        return _refined(points, target, response, axes, damping, steps, largest, residual)
    points, residual = points.map(lambda tensor: tensor.clone()), residual.clone()
    for frames, count in batches:
        own = Damping(damping.value[frames])
        some, rest = _refined(
            points[frames, :count], target[frames], response, axes, own, steps, largest, residual[frames]
        )
        for name in vars(points):
            getattr(points, name)[frames, :count] = getattr(some, name)
        residual[frames], damping.value[frames] = rest, own.value
    return points, residual


def _alike(points: Points, largest: int) -> list[tuple[Tensor, int]]:
    """Frames of about as many scatterers, and how many at most: of fewer, normal matrices are smaller.

    Without frames that have none, where others have many.
    """
    places = torch.arange(1, points.amplitude.shape[1] + 1)
    counts = (places * (points.amplitude != 0)).amax(dim=1) if len(places) else torch.zeros(0)
    most = int(counts.max()) if counts.numel() else 0
    if len(counts) < 2 * LEAST_BATCH or most < WORTH_BATCHES or most > largest:
        return [(torch.arange(len(counts)), points.range_bin.shape[1])]
    order = counts.argsort()
    batches = order.tensor_split(min(len(order) // LEAST_BATCH, MOST_BATCHES))
    return [(some, int(counts[some[-1]])) for some in batches if counts[some[-1]]]


def _refined(
    points: Points, target: Tensor, response: PointResponse, axes: Axes, damping: Damping, steps: int, largest: int,
    residual: Tensor,
) -> tuple[Points, Tensor]:  # fmt: skip
    """As `refined`, of frames that are padded to the same number of points."""
    cost = _energy(residual)
    for _ in range(steps):
        count = points.range_bin.shape[1]
        num_groups = max(1, math.ceil(count / largest))
        halves = 1 if num_groups == 1 else 2
        for half in range(halves):
            points = _sorted_by_range(points) if num_groups > 1 else points
            groups = _grouped(points, num_groups, axes)
            own = slice(half, None, halves)  # alternate groups: each sees the updates of its neighbours
            moved = _stepped(_some(groups, own), residual, response, axes, damping.value)
            trial = _ungrouped(_put_back(groups.points, moved, own), count)
            remainder = response.render(replace(trial, amplitude=-trial.amplitude), axes, target)
            trial_cost = _energy(remainder)
            is_better = trial_cost < cost
            damping.learn(is_better)
            points = _where(is_better, trial, points)
            all_better = bool(is_better.all())
            residual = remainder if all_better else torch.where(is_better[:, None, None, None], remainder, residual)
            cost = torch.where(is_better, trial_cost, cost)
    return points, residual


def _energy(residual: Tensor) -> Tensor:
    return torch.linalg.vector_norm(torch.view_as_real(residual).flatten(1), dim=1).square()


def _sorted_by_range(points: Points) -> Points:
    order = points.range_bin.argsort(dim=1)
    return select_points(points, order)


def _grouped(points: Points, num_groups: int, axes: Axes) -> Groups:
    frames, count = points.range_bin.shape
    each = math.ceil(count / num_groups)
    pad = each * num_groups - count
    padded = points
    if pad:  # silent points at the range of the last one
        last = points[:, -1:].map(lambda tensor: torch.zeros_like(tensor))
        last = replace(last, range_bin=points.range_bin[:, -1:])
        padded = Points.cat([points, *[last] * pad], dim=1)
    shaped = padded.map(lambda tensor: tensor.unflatten(1, (num_groups, each)))
    total = len(axes.range_bin)
    if num_groups == 1:
        return Groups(points=shaped, first=torch.zeros(frames, 1, dtype=torch.long), num_cells=total)
    low = (shaped.range_bin.amin(-1) - axes.range_bin[0]).floor().long() - HALO_BINS
    high = (shaped.range_bin.amax(-1) - axes.range_bin[0]).ceil().long() + HALO_BINS
    num_cells = min(total, int((high - low).max()) + 1)
    return Groups(points=shaped, first=low.clamp(0, total - num_cells), num_cells=num_cells)


def _some(groups: Groups, which: slice) -> Groups:
    return replace(groups, points=groups.points[:, which], first=groups.first[:, which])


def _put_back(points: Points, moved: Points, which: slice) -> Points:
    """The points with the groups `which` replaced by `moved`."""
    out = points.map(lambda tensor: tensor.clone())
    for name in vars(out):
        getattr(out, name)[:, which] = getattr(moved, name)
    return out


def _ungrouped(points: Points, count: int) -> Points:
    return points.map(lambda tensor: tensor.flatten(1, 2)[:, :count])


def _where(mask: Tensor, yes: Points, no: Points) -> Points:
    """The points of each frame from `yes` or `no` by a mask (frame,)."""
    return Points(
        range_bin=torch.where(mask[:, None], yes.range_bin, no.range_bin),
        doppler_bin=torch.where(mask[:, None], yes.doppler_bin, no.doppler_bin),
        direction=torch.where(mask[:, None, None], yes.direction, no.direction),
        amplitude=torch.where(mask[:, None], yes.amplitude, no.amplitude),
    )


def _stepped(groups: Groups, residual: Tensor, response: PointResponse, axes: Axes, damping: Tensor) -> Points:
    """Points of every group after one damped Gauss-Newton step."""
    points = groups.points
    cells = groups.first[..., None] + torch.arange(groups.num_cells)
    # frame, group, range, doppler, antenna
    is_whole = groups.num_cells == residual.shape[1]
    seen = residual[:, None] if is_whole else residual[torch.arange(len(residual))[:, None, None], cells]
    local = replace(axes, range_bin=axes.range_bin[cells][:, :, None, :])
    factors = response.factors(points, local)
    vectors = _antenna_vectors(points, factors[4], axes)
    num = 4 + response.num_directions
    free = [*range(2 + response.num_directions), 4, 5]
    gradient = _gradient(factors, vectors, seen)[..., free, :].flatten(-2)
    matrix = _normal_matrix(factors, vectors, free)
    diagonal = matrix.diagonal(dim1=-2, dim2=-1)
    # relative to each parameter's own curvature: they are of several kinds, and amplitudes of many decibels
    least = 1e-6 * diagonal.amax(dim=-1, keepdim=True) + 1e-30
    diagonal.add_(damping[:, None, None] * (diagonal + least))
    root, _ = torch.linalg.cholesky_ex(matrix)
    # two triangular systems: cholesky_solve copies the matrix, five times the time
    half = torch.linalg.solve_triangular(root, gradient[..., None], upper=False)
    step = torch.linalg.solve_triangular(root.mT, half, upper=True)[..., 0]
    step = torch.nan_to_num(step).unflatten(-1, (num, -1))
    is_real = (points.amplitude != 0).to(step.dtype)
    return _moved(points, step * is_real[..., None, :], response)


def _moved(points: Points, step: Tensor, response: PointResponse) -> Points:
    bins = step[..., :2, :].clamp(-LARGEST_STEP_BINS, LARGEST_STEP_BINS)
    direction = points.direction
    if response.num_directions:
        change = step[..., 2:-2, :].clamp(-LARGEST_STEP_DIRECTION, LARGEST_STEP_DIRECTION).transpose(-1, -2)
        direction = direction.clone()
        direction[..., : response.num_directions] += change
        direction = direction.clamp(-1.0, 1.0)
    return Points(
        range_bin=points.range_bin + bins[..., 0, :],
        doppler_bin=points.doppler_bin + bins[..., 1, :],
        direction=direction,
        amplitude=points.amplitude + torch.complex(step[..., -2, :], step[..., -1, :]),
    )


def _antenna_vectors(points: Points, steer: Tensor, axes: Axes) -> Tensor:
    """Real (..., kind, point, 2 antenna): echo, its derivatives by direction, and by the two parts of amplitude."""
    echo = points.amplitude[..., None] * steer
    slopes = [echo * (-2j * math.pi * axes.place[:, side]) for side in (0, 1)]
    stacked = torch.stack([echo, *slopes, steer, 1j * steer], dim=-3)
    return torch.view_as_real(stacked).flatten(-2)


def _normal_matrix(factors: tuple[Tensor, ...], vectors: Tensor, free: list[int]) -> Tensor:
    """(..., parameter and point, parameter and point); only the blocks on and below the diagonal are filled."""
    at_range, range_slope, at_doppler, doppler_slope, _ = factors
    by_range = _gram(torch.stack([at_range, range_slope], dim=-3))
    by_doppler = _gram(torch.stack([at_doppler, doppler_slope], dim=-3))
    by_antenna = _gram(vectors)
    count = at_range.shape[-2]
    matrix = by_range.new_empty(*by_range.shape[:-4], len(free) * count, len(free) * count)
    blocks = matrix.unflatten(-1, (len(free), count)).unflatten(-3, (len(free), count))
    by_cell: dict[tuple[int, ...], Tensor] = {}  # range and Doppler together, which most blocks share
    for row, i in enumerate(free):
        for column, j in enumerate(free[: row + 1]):
            kinds = RANGE_FACTOR[i], RANGE_FACTOR[j], DOPPLER_FACTOR[i], DOPPLER_FACTOR[j]
            if kinds not in by_cell:
                by_cell[kinds] = by_range[..., kinds[0], :, kinds[1], :] * by_doppler[..., kinds[2], :, kinds[3], :]
            by_steering = by_antenna[..., ANTENNA_FACTOR[i], :, ANTENNA_FACTOR[j], :]
            block = blocks[..., row, :, column, :]
            torch.mul(by_cell[kinds], by_steering, out=block)
            if SIGN[i] != SIGN[j]:
                block.neg_()
    return matrix


def _gram(stack: Tensor) -> Tensor:
    """(..., kind, point, entry) -> (..., kind, point, kind, point)."""
    kinds, count = stack.shape[-3:-1]
    flat = stack.flatten(-3, -2)
    return (flat @ flat.transpose(-1, -2)).unflatten(-1, (kinds, count)).unflatten(-3, (kinds, count))


def _gradient(factors: tuple[Tensor, ...], vectors: Tensor, seen: Tensor) -> Tensor:
    """(..., parameter, point): inner products of the residual with all derivatives."""
    at_range, range_slope, at_doppler, doppler_slope, _ = factors
    count = at_range.shape[-2]
    left = torch.cat([at_range, range_slope], dim=-2)
    flat = torch.view_as_real(seen).flatten(-3)
    shape = (*left.shape[:-1], seen.shape[-2], seen.shape[-1] * 2)
    by_range = (left @ flat).reshape(shape)  # 2 point, doppler, 2 antenna
    plain, sloped = by_range[..., :count, :, :], by_range[..., count:, :, :]
    middle = (at_doppler[..., None, :] @ plain)[..., 0, :]
    nearer = (at_doppler[..., None, :] @ sloped)[..., 0, :]
    faster = (doppler_slope[..., None, :] @ plain)[..., 0, :]
    echo = vectors[..., 0, :, :]
    parts = [-(nearer * echo).sum(-1), -(faster * echo).sum(-1)]
    parts += [(middle * vectors[..., kind, :, :]).sum(-1) for kind in (1, 2, 3, 4)]
    return torch.stack(parts, dim=-2)
