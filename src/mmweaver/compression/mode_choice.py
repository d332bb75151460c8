"""Rate-distortion choice of a chunk's mode: transforms, scatterers, low rank (encoder side)."""

import math
from dataclasses import replace

import numpy as np
import torch

from mmweaver.compression.cell_sample import CellSample
from mmweaver.compression.chunk import ChunkEncoder
from mmweaver.compression.chunk_transform import TransformChoice, choices_of
from mmweaver.compression.coded_chunk import ChunkMode, CodedChunk
from mmweaver.compression.moving_cells import FINER_STEPS, moving_cells
from mmweaver.compression.residual_stream import USUAL_PRICE, Price, cell_energy
from mmweaver.fields.scatterers.fitting import FitRecipe, fitted
from mmweaver.fields.scatterers.layers import Layers, fit_static, static_response, subtract_static

BYTES_A_POINT = 6.0  # few, well-fitted scatterers are worth more than many: the residual is coded separately
POINTS_A_FRAME, POINTS_OF_FEW_FRAMES = 35, (50, 250)  # of few frames: as many each, as many in all
LEAST_GAIN = 12.0
# stages, last steps and growth of a fit, of few frames and of more
FEW_FRAMES, FIT_OF_FEW_FRAMES, FIT = 4, (16, 3, 1.0), (22, 1, 1.3)
DEVIATIONS, MARGIN = 3.5, 3  # of noise, by which cells that scatterers are fitted to exceed it; cells around them
FINER_SHARE, MAP_BITS = 0.05, 6.0  # of the bytes that finer steps of moving cells may have; bits to say where one is
WEAKER, ENOUGH = 2.5, 2.5e-4  # power of active cells over that of weak moving ones; their error that is low enough
CLEAR = 0.995  # of the cost without layers: what layers must have, for estimates are not better
BEATEN, BEATEN_NEAR = 1.15, 1.0  # times the cost; difference of log(step) within which low rank is not tried again
MOST_MATRIX = 2**26  # multiplications of a singular value decomposition that is worth trying

FREE_MODES = ("transforms", "scatterers", "low rank", "noise layer", "DCT of ranges")
EFFORTS = {"full": (), "fast": ("scatterers",)}  # what is not tried: the fit takes most of the time


class ModeChooser:
    """Decides on the mode of a chunk that costs least near a step, by estimates, and encodes in it.

    `without`: names of FREE_MODES that are left out, for ablations. `most_bytes`: about as many as the chunk will have.
    """

    def __init__(self, encoder: ChunkEncoder, *, without: tuple[str, ...] = (), most_bytes: float = math.inf):
        self.encoder, self.most_bytes, self.had_points = encoder, most_bytes, False
        self._beaten_step: float | None = None  # at which low rank was far behind
        self.start_again(without)

    def start_again(self, without: tuple[str, ...]) -> None:
        """Forgets what was decided, and leaves out other modes."""
        self.without = without
        self.plain = ChunkMode(transform=choices_of(self.encoder.target.shape)[0])
        self.mode: ChunkMode | None = None
        self.sample: CellSample | None = None  # of the mode decided on, at the step of the decision

    def encode(
        self, step: float, coarser: int, noise_step: float = 0.0, price: Price = USUAL_PRICE, *, only_size: bool = False
    ) -> CodedChunk:
        """The chunk at a step, in the mode decided on; with a noise layer where it has a step.

        `only_size`: see `ChunkEncoder.encode`.
        """
        if self.mode is None:
            self.decide(step, coarser)
        assert self.mode is not None
        mode = replace(self.mode, noise_step=noise_step, finer=1) if noise_step else self.mode
        return self.encoder.encode(step, mode, coarser, price, only_size=only_size)

    def decide_transform(self, step: float, coarser: int) -> None:
        """Decides on the transform of `plain`, the best mode without any layer."""
        choices = choices_of(self.encoder.target.shape)
        if "transforms" in self.without or not np.any(self.encoder.target):
            choices = choices[:1]
        samples = {choice: self.encoder.sample(choice) for choice in choices}
        fit = [choice for choice in choices if samples[choice].front_bytes < self.most_bytes] or choices[:1]
        best = min(fit, key=lambda choice: samples[choice].at(step, coarser).cost(step, coarser))
        self.plain = ChunkMode(transform=best)

    @property
    def over_range(self) -> ChunkMode:
        """The best mode without any layer, with a DCT of the ranges."""
        return ChunkMode(transform=replace(self.plain.transform, range_dct=True))

    def decide(self, step: float, coarser: int) -> None:
        """Decides on the mode."""
        self.decide_transform(step, coarser)
        modes = [self.plain]
        if np.any(self.encoder.target):
            modes += self._layered(step, coarser)
        samples = [self.encoder.sample(self.plain.transform)]
        samples += [self.encoder.draft(step, mode, coarser, only_size=True).sample() for mode in modes[1:]]
        costs = [sample.at(step, coarser).cost(step, coarser) for sample in samples]
        best = int(np.argmin([costs[0] * CLEAR, *costs[1:]]))
        if modes[best].with_rank:  # its factors are coded before it is believed
            samples[best] = self.encoder.draft(step, modes[best], coarser).sample()
            costs[best] = samples[best].at(step, coarser).cost(step, coarser)
            best = int(np.argmin([costs[0] * CLEAR, *costs[1:]]))
        elif any(mode.with_rank and cost > BEATEN * costs[0] for mode, cost in zip(modes, costs, strict=True)):
            self._beaten_step = step
        mode, self.sample = modes[best], samples[best]
        self.had_points |= mode.with_points
        self.mode = replace(mode, finer=self._finer(step, self.sample.at(step, coarser).num_bytes))

    def _finer(self, step: float, num_bytes: float) -> int:
        """Which of FINER_STEPS weak moving cells need, as far as that costs little; 1 where they do not."""
        encoder = self.encoder
        is_moving, antennas = moving_cells(encoder.is_active), encoder.target.shape[3]
        num = int(np.count_nonzero(is_moving))
        if not num or encoder.frames.hop or num * antennas > 4 * FINER_SHARE * num_bytes:  # cheaply said for most cubes
            return 1
        power = cell_energy(np.moveaxis(encoder.target, 3, 0))
        moving, error = float(power[is_moving].mean()), antennas * step**2 / 6
        if power[encoder.is_active].mean() < WEAKER * moving:
            return 1
        cost = {one: num * (MAP_BITS + 2 * antennas * (1 + math.log2(one))) for one in FINER_STEPS[1:]}
        found = 1
        for one, bits in cost.items():
            if error / found**2 <= ENOUGH * moving or bits > 8 * FINER_SHARE * num_bytes:
                break
            found = one
        return found

    def _layered(self, step: float, coarser: int) -> list[ChunkMode]:
        encoder, modes = self.encoder, []
        frames, num_range, doppler, antennas = encoder.target.shape
        sides = sorted((frames * num_range, doppler * antennas))
        may_win = self._beaten_step is None or abs(math.log(step / self._beaten_step)) > BEATEN_NEAR
        is_small = sides[0] > 1 and sides[0] ** 2 * sides[1] <= MOST_MATRIX
        if "low rank" not in self.without and is_small and may_win:
            modes.append(ChunkMode(transform=self.plain.transform, with_rank=True))
        # of one antenna, a scatterer has about as many numbers as the cells that it fills
        if "scatterers" not in self.without and encoder.frames.can_have_points and antennas > 1:
            if encoder.layers is None:
                usual = choices_of(encoder.target.shape)[0]  # the step is one at which it has the bytes of the chunk
                layers = _fit(encoder, encoder.sample(usual).at(step, coarser).num_bytes)
                if not bool(layers.static.isfinite().all() & layers.points.amplitude.isfinite().all()):
                    return modes  # nearly empty cubes have no noise to compare scatterers with
                encoder.with_layers(layers)
            time = choices_of(encoder.target.shape)[0].time
            modes.append(ChunkMode(transform=TransformChoice(time=time), with_points=True))
        return modes


def _fit(encoder: ChunkEncoder, num_bytes: float) -> Layers:
    """Scatterers and static layer of a chunk, fitted where something moves."""
    window, frames = encoder.frames.fit_window(), encoder.frames.num_frames
    # a single frame cannot separate static clutter from slow motion
    each, most = POINTS_OF_FEW_FRAMES
    num_points = max(POINTS_A_FRAME * frames, min(each * frames, most))
    stages, last_steps, growth = FIT if window.num_working_frames > FEW_FRAMES else FIT_OF_FEW_FRAMES
    recipe = FitRecipe(
        num_points=min(num_points, int(num_bytes / BYTES_A_POINT)), with_static=frames > 1,
        with_calibration=True, stages=stages, last_steps=last_steps, growth=growth,
        least_gain=LEAST_GAIN, most_noise=encoder.noise_power,
    )  # fmt: skip
    response, axes = window.response, window.axes
    at_rest, moving = static_response(response, axes), encoder.target.copy()
    if recipe.with_static:
        subtract_static(moving, fit_static(moving, at_rest), at_rest)
    ranges, bins = _box(moving, encoder.noise_power, with_static=recipe.with_static)
    own = replace(axes, range_bin=axes.range_bin[ranges], doppler_bin=axes.doppler_bin[bins])
    target = torch.from_numpy(encoder.target)
    layers = fitted(target[:, ranges, bins].contiguous(), replace(window, axes=own), recipe)
    static = torch.zeros(target.shape[1], target.shape[3], dtype=layers.static.dtype)
    if recipe.with_static:
        points = replace(layers.points, amplitude=-layers.points.amplitude)
        rest = response.render(points, axes, target / layers.calibration).numpy()
        static = torch.from_numpy(fit_static(rest, at_rest))
    return replace(layers, static=static)


def _box(moving: np.ndarray, noise_power: float, *, with_static: bool) -> tuple[slice, slice]:
    """Ranges and Doppler bins of a chunk (frame, range, doppler, antenna) that hold signal, and some more."""
    power = np.square(moving.real).sum(axis=3) + np.square(moving.imag).sum(axis=3)
    antennas = moving.shape[3]
    strong = (power > (antennas + DEVIATIONS * math.sqrt(antennas) + LEAST_GAIN) * noise_power).any(axis=0)
    bins = strong.any(axis=0)
    if with_static:
        bins[len(bins) // 2] = True
    return _around(strong.any(axis=1)), _around(bins)


def _around(mask: np.ndarray) -> slice:
    """From the first to the last that is set, with a margin; all where none is."""
    found = np.flatnonzero(mask)
    return slice(max(0, found[0] - MARGIN), found[-1] + 1 + MARGIN) if len(found) else slice(None)
