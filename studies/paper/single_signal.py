"""Fitting the paper's INR to one radar sequence: the paper's recipe, and a better one.

Reference: paper, "Model Training" (single signal: 500 epochs, Adam, 1e-4; 16,384 points an epoch).
"""

import time
from dataclasses import dataclass, replace

import numpy as np
import torch

from mmweaver.compression.signal_field import SignalField, centred
from mmweaver.core.errors import InputError
from mmweaver.core.records import RadarCube
from mmweaver.core.registry import Registry
from mmweaver.core.seeding import stream
from studies.paper.paper_inr import (
    ACTIVATIONS,
    BaseInrField,
    InrField,
    InrShape,
    first_layer_terms,
    fresh_modulation,
)
from studies.paper.positional_encoding import OCTAVES, harmonics, normalised
from studies.scores.cube_scores import Cells, cells_of


@dataclass(frozen=True, kw_only=True)
class InrFitRecipe:
    """Hyperparameters of fitting one sequence.

    `favour`: where half of the samples come from, "active_ranges" (ranges of frames with motion, as the paper says; the
    loss stays biased towards them) or "active_cells" (the loss is weighted back to uniform samples). `peak_is_one`: the
    network's 1.0 is the largest |I| or |Q|; otherwise its rms is 1/3.
    """

    name: str
    steps: int
    learning_rate: float
    points: int = 16_384
    favour: str = "active_ranges"
    is_centred: bool = False
    activation: str = "relu"
    # None: the paper's octaves; 0: no encoding; else evenly spaced up to this share of Nyquist
    highest_harmonic: float | None = None
    is_cosine: bool = False
    peak_is_one: bool = True
    has_time_axis: bool = False  # the base INR over (t, r, d, a)


PAPER = InrFitRecipe(name="paper", steps=500, learning_rate=1e-4)
PAPER_BASE = replace(PAPER, name="paper_base", has_time_axis=True)
# The other reading of "500 epochs": each passes over all points of a 20-frame cube, 30 batches.
PAPER_FULL_PASSES = replace(PAPER, name="paper_full_passes", steps=15_000)
PAPER_CENTRED = replace(PAPER_FULL_PASSES, name="paper_full_passes_centred", is_centred=True)
TUNED = InrFitRecipe(
    name="tuned",
    steps=15_000,
    learning_rate=1e-2,
    favour="active_cells",
    is_centred=True,
    activation="gauss",
    is_cosine=True,
    peak_is_one=False,
)
TUNED_SHORT = replace(TUNED, name="tuned_short", steps=2_000)
# Encoding no faster than 0.3 of what cells resolve: as good at the cells, and 7 dB better between them.
SMOOTH_SHORT = replace(TUNED_SHORT, name="smooth_short", highest_harmonic=0.3)
# The raw coordinates and sines instead of an encoding, as SIREN has it.
SIREN_SHORT = replace(TUNED_SHORT, name="siren_short", activation="sine", highest_harmonic=0.0, learning_rate=2e-3)
RELU_SHORT = replace(TUNED_SHORT, name="relu_short", activation="relu", learning_rate=2e-3)
RAW_SHORT = replace(RELU_SHORT, name="raw_short", is_centred=False)

RECIPES: Registry[InrFitRecipe] = Registry(
    "fit recipe",
    [
        (recipe.name, recipe)
        for recipe in (
            PAPER, PAPER_BASE, PAPER_FULL_PASSES, PAPER_CENTRED, TUNED, TUNED_SHORT, SMOOTH_SHORT, RELU_SHORT,
            SIREN_SHORT, RAW_SHORT,
        )
    ],
)  # fmt: skip


@dataclass(frozen=True, kw_only=True)
class Fit:
    """A fitted field and its cost."""

    field: SignalField
    seconds: float  # of CPU
    last_loss: float  # mean squared error of the last tenth of the steps, in units of the network


def fit(cube: RadarCube, recipe: InrFitRecipe, *, seed: int = 0, device: str = "cpu") -> Fit:
    """The paper's INR fitted to one cube by Adam on the squared error of I and Q.

    The same seed gives the same bits on one machine. Raises InputError where the cube is all zeros or not finite.
    """
    start = time.process_time()
    target = centred(cube) if recipe.is_centred else cube
    amplitude = _amplitude(target.values, recipe.peak_is_one)
    network = _Network(cube, recipe, seed, device)
    losses = network.train(target.values / np.float32(amplitude), _Draw(cube, recipe, seed))
    return Fit(
        field=network.field(cube, amplitude),
        seconds=time.process_time() - start,
        last_loss=float(np.mean(losses[-max(1, recipe.steps // 10) :])),
    )


def _amplitude(values: np.ndarray, peak_is_one: bool) -> float:
    """The value of the network's 1.0."""
    parts = np.ascontiguousarray(values).view(np.float32)
    amplitude = (
        float(np.abs(parts).max()) if peak_is_one else 3 * float(np.sqrt(np.mean(parts.astype(np.float64) ** 2)))
    )
    if not (np.isfinite(amplitude) and amplitude > 0):
        raise InputError("the cube to be fitted is all zeros or holds values that are not finite")
    return amplitude


@dataclass(frozen=True, kw_only=True)
class _Batch:
    """Cells of each frame (frame, slot), padded to one length; `weight` is 0 in the padding."""

    cell: np.ndarray  # number within its frame, (range, doppler, antenna) flattened
    weight: np.ndarray


class _Draw:
    """Batches of cells, and the weight of each in the loss."""

    def __init__(self, cube: RadarCube, recipe: InrFitRecipe, seed: int):
        self.rng = stream(seed, "single signal", "points")
        self.num_points = recipe.points
        self.num_frames, *_, self.num_antennas = cube.grid.shape
        self.num_cells = int(np.prod(cube.grid.shape))
        cells = cells_of(cube)
        favoured = cells.is_active if recipe.favour == "active_cells" else _active_ranges(cells)
        self.favoured = np.flatnonzero(favoured)  # (frame, range, doppler) flattened
        # half of the samples are even over all cells, half over those favoured
        inside, outside = (2 / (1 + 1 / favoured.mean()), 2.0) if len(self.favoured) else (1.0, 1.0)
        weighted = recipe.favour == "active_cells"
        self.weight = np.where(favoured.reshape(-1), inside, outside) if weighted else np.ones(favoured.size)

    def batch(self) -> _Batch:
        half = self.num_points // 2 if len(self.favoured) else 0
        chosen = self.favoured[self.rng.integers(0, len(self.favoured), half)] if half else self.favoured
        antenna = self.rng.integers(0, self.num_antennas, half)
        anywhere = self.rng.integers(0, self.num_cells, self.num_points - half)
        sampled = np.sort(np.concatenate([chosen * self.num_antennas + antenna, anywhere]))
        frame, cell = np.divmod(sampled, self.num_cells // self.num_frames)
        count = np.bincount(frame, minlength=self.num_frames)
        slot = np.arange(len(sampled)) - np.repeat(np.cumsum(count) - count, count)
        shape = (self.num_frames, int(count.max()))
        padded, weight = np.zeros(shape, np.int64), np.zeros(shape, np.float32)
        padded[frame, slot] = cell
        weight[frame, slot] = self.weight[sampled // self.num_antennas] / self.num_points
        return _Batch(cell=padded, weight=weight)


def _active_ranges(cells: Cells) -> np.ndarray:
    """(frame, range, doppler), true in the whole range bin of a frame where anything in it moves."""
    return np.broadcast_to(cells.is_moving.any(axis=2, keepdims=True), cells.is_moving.shape)


class _Network:
    """The parameters in training."""

    def __init__(self, cube: RadarCube, recipe: InrFitRecipe, seed: int, device: str):
        self.recipe, self.device, self.grid_shape = recipe, device, cube.grid.shape
        self.shape = inr_shape(recipe, cube.grid.shape)
        self.theta = self.shape.fresh(stream(seed, "single signal", "weights")).to(device).requires_grad_()
        gamma, beta = fresh_modulation(cube.grid.shape[0])
        self.gamma, self.beta = (part.to(device).requires_grad_() for part in (gamma, beta))
        axes = self.grid_shape if recipe.has_time_axis else self.grid_shape[1:]
        self.axes_norm = [torch.from_numpy(normalised(np.arange(float(num)), num)).float().to(device) for num in axes]

    def train(self, target: np.ndarray, draw: _Draw) -> list[float]:
        """Adam over the recipe's steps; returns the losses (every tenth)."""
        recipe = self.recipe
        truth = torch.from_numpy(np.ascontiguousarray(target).view(np.float32))
        truth = truth.view(self.grid_shape[0], -1, 2).to(self.device)
        parameters = [self.theta] if recipe.has_time_axis else [self.theta, self.gamma, self.beta]
        adam = torch.optim.Adam(parameters, lr=recipe.learning_rate)
        losses = []
        for step in range(recipe.steps):
            if recipe.is_cosine:
                adam.param_groups[0]["lr"] = recipe.learning_rate * 0.5 * (1 + np.cos(np.pi * step / recipe.steps))
            batch = draw.batch()
            cell, weight = (torch.from_numpy(part).to(self.device) for part in (batch.cell, batch.weight))
            wanted = torch.gather(truth, 1, cell[..., None].expand(-1, -1, 2))
            loss = ((self._at(cell) - wanted).square().mean(dim=2) * weight).sum()
            adam.zero_grad(set_to_none=True)
            loss.backward()
            adam.step()
            if step % 10 == 0:
                losses.append(float(loss.detach()))
        return losses

    def _at(self, cell: torch.Tensor) -> torch.Tensor:
        """I and Q at cells (frame, slot): the first layer from a table an axis, modulation folded into weights."""
        act = ACTIVATIONS[self.shape.activation]
        terms = first_layer_terms(self.shape, self.theta, self.axes_norm)
        index = _unravelled(cell.reshape(-1), self.grid_shape[1:])
        *hidden, (last_weight, last_bias) = self.shape.layers(self.theta)
        spatial = sum(term.index_select(0, at) for term, at in zip(terms[-3:], index, strict=True))
        z = torch.as_tensor(spatial).view(*cell.shape, -1)
        if self.recipe.has_time_axis:
            h = act(z + (hidden[0][1] + terms[0])[:, None])
            for weight, bias in hidden[1:]:
                h = act(torch.nn.functional.linear(h, weight, bias))
        else:
            gamma, beta = self.gamma, self.beta
            h = act(torch.addcmul((gamma[:, 0] * hidden[0][1] + beta[:, 0])[:, None], z, gamma[:, 0][:, None]))
            for at, (weight, bias) in enumerate(hidden[1:], start=1):
                folded = (gamma[:, at][:, :, None] * weight).transpose(1, 2)
                h = act(torch.baddbmm((gamma[:, at] * bias + beta[:, at])[:, None], h, folded))
        return torch.nn.functional.linear(h, last_weight, last_bias)

    def field(self, cube: RadarCube, amplitude: float) -> SignalField:
        about = {
            "config": cube.config,
            "grid": cube.grid,
            "scale": cube.scale,
            "shape": self.shape,
            "theta": self.theta,
            "amplitude": amplitude,
            "is_centred": self.recipe.is_centred,
        }
        if self.recipe.has_time_axis:
            return BaseInrField(**about)
        return InrField(**about, gamma=self.gamma, beta=self.beta)


def inr_shape(recipe: InrFitRecipe, grid_shape: tuple[int, ...]) -> InrShape:
    """The network of a recipe, on a grid of (frame, range, doppler, antenna) cells."""
    highest = recipe.highest_harmonic
    if highest is None:
        frequencies = (OCTAVES,) * len(grid_shape)
    else:
        frequencies = tuple(harmonics(num, highest) if highest else () for num in grid_shape)
    return InrShape(num_axes=4 if recipe.has_time_axis else 3, activation=recipe.activation, frequencies=frequencies)


def _unravelled(flat: torch.Tensor, shape: tuple[int, ...]) -> list[torch.Tensor]:
    index = []
    for size in reversed(shape):
        index.append(flat % size)
        flat = flat // size
    return index[::-1]
