"""Fits INRs to signals by Adam: one, or many of the same shape at once.

Reference: paper, "Model Training" (single signal: 500 epochs, Adam, 1e-4; 16,384 points per epoch).
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import torch
from torch import Tensor
from torch.func import functional_call, stack_module_state, vmap

from mmweaver.compression.quantised_cells import active_mask
from mmweaver.compression.scatterer_field import ScattererField
from mmweaver.compression.scatterers.fitting import FitRecipe, Progress
from mmweaver.compression.signal_field import SignalField
from mmweaver.core.errors import InputError
from mmweaver.core.records import RadarCube
from mmweaver.core.seeding import stream
from mmweaver.inr.inr_field import InrField, Network, normalised
from mmweaver.inr.networks import BaseINR, ModulatedINR, PositionalEncoding
from mmweaver.inr.separable import RATES, SeparableINR, ranks
from mmweaver.signal.point_response import Axes, PointResponse
from mmweaver.signal.spectra import moving_doppler, range_doppler_power

FIELDS = ("modulated", "base", "scatterers")
NUM_VALUES = 10_018  # the paper's: 4,898 shared and 5,120 of 20 frames
STAGES, GROWING = 8, 0.6  # in which terms are placed, and their share of the steps
REPORTED_EVERY = 10  # steps
RMS_OF_ONE = 3.0  # a network's 1.0 is so many times the rms of I and Q


@dataclass(frozen=True, kw_only=True)
class FitOptions:
    """How a network is fitted; the defaults are what works best, `PAPER` is what the paper states.

    Attributes:
        is_separable: A modulated INR of separable terms; otherwise of fully connected layers.
        is_centred: Whether the carrier is factored out analytically.
        by_energy: Whether half of the samples are of active cells, weighted back to uniform; otherwise half are of
            ranges in which something moves, as the paper has it. Separable networks see all cells in every step.
        encoded_share: Highest encoded frequency relative to what the cells resolve; None: the paper's octaves.
        activation: Of fully connected layers, a name of `networks.ACTIVATIONS`.
        steps: Number of steps; None: 600 of separable, 2,000 of fully connected networks.
        learning_rate: Of Adam; None: 0.05 (bins) of separable, 0.01 of fully connected networks.
        is_cosine: Whether the rate decays as a cosine.
        points: Samples per step of fully connected networks.
        seed: Of initial weights and samples.
    """

    is_separable: bool = True
    is_centred: bool = True
    by_energy: bool = True
    encoded_share: float | None = 0.3
    activation: str = "gauss"
    steps: int | None = None
    learning_rate: float | None = None
    is_cosine: bool = True
    points: int = 16_384
    seed: int = 0


PAPER = FitOptions(
    is_separable=False, is_centred=False, by_energy=False, encoded_share=None, activation="relu", steps=500,
    learning_rate=1e-4, is_cosine=False,
)  # fmt: skip


def fit(
    cube: RadarCube, field: str = "modulated", *, num_values: int = NUM_VALUES, options: FitOptions | None = None,
    progress: Progress | None = None,
) -> SignalField:  # fmt: skip
    """Fits a field to a sequence.

    Args:
        cube: The sequence.
        field: modulated, base (an INR over (t, r, d, a)) or scatterers.
        num_values: Most parameters that the field may have.
        options: Of networks.
        progress: Called with step, number of steps and error in dB.

    Returns:
        The field. The same seed gives the same bits on one machine.

    Raises:
        InputError: If the cube is all zeros or not finite, or the values do not suffice.
    """
    if field == "scatterers":
        _check(cube)
        recipe = FitRecipe(num_points=num_values, num_values=num_values, with_static=len(cube.values) > 1)
        scatterers = ScattererField.fit(cube, recipe, progress)
        if scatterers.num_values > num_values:
            raise InputError(f"{num_values} values are too few for this signal; give {scatterers.num_values} or more")
        return scatterers
    return fit_many([cube], field, num_values=num_values, options=options, progress=progress)[0]


def fit_many(
    cubes: Sequence[RadarCube], field: str = "modulated", *, num_values: int = NUM_VALUES,
    options: FitOptions | None = None, progress: Progress | None = None,
) -> list[InrField]:  # fmt: skip
    """Fits one network to each of several sequences of one shape, all in the same steps.

    Args:
        cubes: Sequences of the same radar and number of frames.
        field: modulated or base.
        num_values: Most parameters of each.
        options: Of networks.
        progress: Called with step, number of steps and mean error in dB.

    Returns:
        The fields.

    Raises:
        InputError: As `fit`, and for sequences of different shapes.
    """
    if field not in ("modulated", "base"):
        raise InputError(f"there is no field {field!r}; choose one of {', '.join(FIELDS)}")
    for cube in cubes:
        _check(cube)
    if len({(cube.grid.shape, cube.config) for cube in cubes}) != 1:
        raise InputError("signals that are fitted together must have one radar and one number of frames")
    return _Fit(cubes, field, num_values, options or FitOptions()).run(progress)


def _check(cube: RadarCube) -> None:
    if not (np.isfinite(cube.values).all() and cube.values.any()):
        raise InputError("the cube to be fitted is all zeros or holds values that are not finite; repair the recording")


def layers_network(field: str, shape: tuple[int, ...], num_values: int, options: FitOptions) -> BaseINR:
    """An untrained network of fully connected layers, as wide as its number of values allows.

    Args:
        field: modulated or base.
        shape: Of the cube, (frame, range, doppler, antenna).
        num_values: Most parameters.
        options: For encoding and activation.

    Raises:
        InputError: If the values do not suffice for a width of 1.
    """
    cells, share = shape if field == "base" else shape[1:], options.encoded_share
    encoding = PositionalEncoding(len(cells)) if share is None else PositionalEncoding.limited(cells, share)

    def make(width: int) -> BaseINR:
        if field == "base":
            return BaseINR(encoding=encoding, activation=options.activation, width=width)
        return ModulatedINR(shape[0], encoding=encoding, activation=options.activation, width=width)

    width = 1
    while _size(make(width + 1)) <= num_values:
        width += 1
    network = make(width)
    if _size(network) > num_values:
        raise InputError(f"{num_values} values are too few for {shape[0]} frames; give at least {_size(network)}")
    return network


class _Fit:
    """Networks in training, stacked along a leading axis."""

    def __init__(self, cubes: Sequence[RadarCube], field: str, num_values: int, options: FitOptions) -> None:
        self.cubes, self.options, self.shape = cubes, options, cubes[0].grid.shape
        self.response = PointResponse(cubes[0].config)
        self.axes = self.response.axes(cubes[0].grid)
        self.is_separable = field == "modulated" and options.is_separable
        values = torch.from_numpy(np.stack([cube.values for cube in cubes]))
        self.is_centred = options.is_centred or self.is_separable
        if self.is_centred:
            values = values * self.response.phasor(self.axes).conj()
        if options.is_centred:
            self.amplitude = RMS_OF_ONE * values.abs().square().mean((1, 2, 3, 4)).div(2).sqrt()
        else:
            self.amplitude = torch.view_as_real(values).abs().amax((1, 2, 3, 4, 5))
        self.target = values / self.amplitude[:, None, None, None, None]  # (signal, frame, range, doppler, antenna)
        torch.manual_seed(int(stream(options.seed, "inr", "weights").integers(2**31)))
        self.networks = [self._fresh(field, num_values) for _ in cubes]
        self._stack()

    def _stack(self) -> None:
        parameters, _ = stack_module_state(self.networks)
        self.parameters = {name: value.detach().requires_grad_() for name, value in parameters.items()}

    def _unstack(self) -> None:
        for index, network in enumerate(self.networks):
            network.load_state_dict({name: value[index].detach() for name, value in self.parameters.items()})

    def _fresh(self, field: str, num_values: int) -> Network:
        frames, options = self.shape[0], self.options
        if self.is_separable:
            self.ranks = ranks(frames, self.response.num_directions, num_values)
            if self.ranks[0] < 1:
                raise InputError(
                    f"{num_values} values are too few for {frames} frames; give {10 * frames + 100} or more"
                )
            return SeparableINR(frames, rank=0, num_shared=0, num_directions=self.response.num_directions)
        return layers_network(field, self.shape, num_values, options)

    def run(self, progress: Progress | None) -> list[InrField]:
        (self._run_separable if self.is_separable else self._run_layers)(progress)
        self._unstack()
        each = zip(self.networks, self.cubes, self.amplitude.tolist(), strict=True)
        return [
            InrField(
                network, config=cube.config, grid=cube.grid, scale=cube.scale, amplitude=amplitude,
                is_centred=self.is_centred,
            )
            for network, cube, amplitude in each
        ]  # fmt: skip

    def _call(self, *data: object) -> Tensor:
        def one(parameters: dict[str, Tensor], *own: object) -> Tensor:
            return functional_call(self.networks[0], parameters, own)

        return vmap(one, in_dims=(0, *[None if isinstance(each, Axes) else 0 for each in data]))(self.parameters, *data)

    def _adam(self, rate: float) -> torch.optim.Adam:
        groups = [
            {"params": [value], "lr": rate * next((RATES[key] for key in RATES if key in name), 1.0)}
            for name, value in self.parameters.items()
        ]
        return torch.optim.Adam(groups, betas=(0.9, 0.98) if self.is_separable else (0.9, 0.999))

    # separable: terms are placed in stages, and all cells are compared in every step
    def _run_separable(self, progress: Progress | None) -> None:
        steps, rate = self.options.steps or 600, self.options.learning_rate or 0.05
        energy = self.target.abs().square().sum((1, 2, 3, 4))
        truth = torch.view_as_real(self.target)
        ends = [round(GROWING * steps * (stage + 1) / STAGES) for stage in range(STAGES)]
        ends[-1] = steps
        done = 0
        for stage, end in enumerate(ends, start=1):
            with torch.no_grad():
                rest = torch.view_as_complex((truth - self._call(self.axes)).contiguous())
            self._unstack()
            for network, own in zip(self.networks, rest, strict=True):
                assert isinstance(network, SeparableINR), "the kind of network that grows"
                network.grow(own, self.axes, *(round(count * stage / STAGES) for count in self.ranks))
            self._stack()
            adam = self._adam(rate)
            decay = torch.optim.lr_scheduler.CosineAnnealingLR(adam, max(end - done, 1))
            for step in range(done, end):
                error = (self._call(self.axes) - truth).square().sum((1, 2, 3, 4, 5)) / energy
                _step(adam, error.sum())
                decay.step()
                _report(progress, step, steps, error)
            done = end

    # fully connected: samples of all cells
    def _run_layers(self, progress: Progress | None) -> None:
        options = self.options
        steps, rate = options.steps or 2000, options.learning_rate or 1e-2
        sampler, adam = _Sampler(self.cubes, options), self._adam(rate)
        truth = torch.view_as_real(self.target).flatten(2, 4)
        energy = truth.square().sum(-1).mean((1, 2))
        axes = [normalised(np.arange(float(num)), num) for num in self.shape]
        is_base = not isinstance(self.networks[0], ModulatedINR)
        for step in range(steps):
            if options.is_cosine:
                for group in adam.param_groups:
                    group["lr"] = rate * (0.5 + 0.5 * math.cos(math.pi * step / steps))
            cell, weight = sampler.cells()
            where = np.unravel_index(cell, self.shape[1:])
            x = torch.stack([axis[index] for axis, index in zip(axes[1:], where, strict=True)], dim=-1)
            if is_base:
                x = torch.cat([axes[0][:, None, None].expand(*x.shape[:-1], 1), x], dim=-1)
            wanted = truth.gather(2, torch.from_numpy(cell)[..., None].expand(-1, -1, -1, 2))
            error = ((self._call(x) - wanted).square().sum(-1) * weight).mean((1, 2)) / energy
            _step(adam, (error * energy).sum())
            _report(progress, step, steps, error)


class _Sampler:
    """Cells (signal, frame, point) of each step, half of them favoured, and the weight of each in the loss."""

    def __init__(self, cubes: Sequence[RadarCube], options: FitOptions) -> None:
        self.rng = stream(options.seed, "inr", "points")
        num_frames, *_, self.num_antennas = cubes[0].grid.shape
        self.half = max(1, options.points // num_frames // 2)
        masks = [_active(cube) if options.by_energy else _moving_ranges(cube) for cube in cubes]
        self.favoured = [[np.flatnonzero(frame) for frame in mask] for mask in masks]
        self.num_cells = masks[0][0].size
        # a favoured cell is sampled as often as others, and once more from its kind
        share = np.stack([mask.mean((1, 2), keepdims=True) for mask in masks])
        often = np.where(np.stack(masks), 0.5 + 0.5 / np.maximum(share, 1e-9), np.where(share > 0, 0.5, 1.0))
        self.weight = torch.from_numpy((1 / often if options.by_energy else 1 + 0 * often).astype(np.float32)).flatten(
            2
        )

    def cells(self) -> tuple[np.ndarray, Tensor]:
        """Numbers of cells (range, doppler, antenna), and weights."""
        own = np.stack([np.stack([self._frame(cells) for cells in frames]) for frames in self.favoured])
        weight = self.weight.gather(2, torch.from_numpy(own))
        return own * self.num_antennas + self.rng.integers(0, self.num_antennas, own.shape), weight

    def _frame(self, favoured: np.ndarray) -> np.ndarray:
        anywhere = self.rng.integers(0, self.num_cells, self.half)
        some = favoured[self.rng.integers(0, len(favoured), self.half)] if len(favoured) else anywhere[::-1]
        return np.concatenate([some, anywhere])


def _active(cube: RadarCube) -> np.ndarray:
    return active_mask(cube.values)


def _moving_ranges(cube: RadarCube) -> np.ndarray:
    """(frame, range, doppler), true in the whole range bin of a frame where anything in it moves."""
    power = range_doppler_power(cube)
    moving = (active_mask(cube.values) & moving_doppler(cube)).any(axis=2, keepdims=True)
    return np.broadcast_to(moving, power.shape)


def _size(network: torch.nn.Module) -> int:
    return sum(parameter.numel() for parameter in network.parameters())


def _step(adam: torch.optim.Adam, loss: Tensor) -> None:
    adam.zero_grad(set_to_none=True)
    loss.backward()
    adam.step()


def _report(progress: Progress | None, step: int, steps: int, error: Tensor) -> None:
    if progress is not None and ((step + 1) % REPORTED_EVERY == 0 or step + 1 == steps):
        progress(step + 1, steps, 10 * math.log10(max(float(error.detach().mean()), 1e-30)))
