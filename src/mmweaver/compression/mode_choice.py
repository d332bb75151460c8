"""Rate-distortion choice of a chunk's mode: transforms, scatterers, low rank (encoder side)."""

import math

import numpy as np
import torch

from mmweaver.compression.chunk import ChunkEncoder, ChunkMode, CodedChunk
from mmweaver.compression.chunk_transform import TransformChoice, choices_of
from mmweaver.fields.scatterers.fitting import FitRecipe, fitted
from mmweaver.fields.scatterers.layers import Layers

BYTES_A_POINT = 6.0  # few, well-fitted scatterers are worth more than many: the residual is coded separately
POINTS_A_FRAME = 50
FIT_STAGES, LAST_STEPS, LEAST_GAIN = 20, 6, 12.0
MOVING_SHARE = 0.2  # scatterers are fitted where moving cells have at least this share of the coded energy
MOST_MATRIX = 2**26  # multiplications of a singular value decomposition that is worth trying
NUM_TRIED = 1  # transforms that are coded; the others are judged by an estimate
SAME_MODE = 1.5  # difference of log(step) within which a mode is kept
MOST_DECISIONS = 2  # a size that jumps with every change of the mode cannot be met

FREE_MODES = ("transforms", "scatterers", "low rank")


class ModeChooser:
    """Encodes a chunk in the mode that costs least near the step; modes are tried anew where the step is far off.

    `without`: names of FREE_MODES that are left out, for ablations.
    """

    def __init__(self, encoder: ChunkEncoder, *, without: tuple[str, ...] = ()):
        self.encoder, self.without = encoder, without
        self._chosen: tuple[float, int, ChunkMode] | None = None
        self._plain: TransformChoice | None = None
        self._decisions = 0

    def encode(self, step: float, coarser: int) -> CodedChunk:
        """The chunk at a step."""
        if self._chosen is not None:
            at, before, mode = self._chosen
            is_near = before == coarser and abs(math.log(step / at)) < SAME_MODE
            if is_near or self._decisions >= MOST_DECISIONS:
                return self.encoder.encode(step, mode, coarser)
        best = min(self._tried(step, coarser), key=lambda coded: coded.cost(coarser))
        self._chosen = step, coarser, best.mode
        self._decisions += 1
        return best

    def even_estimate(self, step: float) -> tuple[float, float]:
        """`ChunkEncoder.even_estimate` of the transform chosen."""
        choice = self._plain if self._plain is not None else choices_of(self.encoder.target.shape)[0]
        return self.encoder.even_estimate(step, choice)

    def _tried(self, step: float, coarser: int) -> list[CodedChunk]:
        encoder = self.encoder
        if not np.any(encoder.target):
            return [encoder.encode(step, ChunkMode(), coarser)]
        choices = choices_of(encoder.target.shape)
        if "transforms" in self.without:
            choices = choices[:1]
        choices.sort(key=lambda choice: encoder.estimated_cost(step, choice, coarser))
        tried = [encoder.encode(step, ChunkMode(transform=choice), coarser) for choice in choices[:NUM_TRIED]]
        best = self._plain = min(tried, key=lambda coded: coded.cost(coarser)).mode.transform
        frames, num_range, doppler, antennas = encoder.target.shape
        sides = sorted((frames * num_range, doppler * antennas))
        if "low rank" not in self.without and sides[0] > 1 and sides[0] ** 2 * sides[1] <= MOST_MATRIX:
            tried.append(encoder.encode(step, ChunkMode(transform=best, with_rank=True), coarser))
        if "scatterers" not in self.without and self._has_scatterers(step, len(tried[0].data)):
            mode = ChunkMode(transform=TransformChoice(time=choices_of(encoder.target.shape)[0].time), with_points=True)
            tried.append(encoder.encode(step, mode, coarser))
        return tried

    def _has_scatterers(self, step: float, num_bytes: int) -> bool:
        """Fits scatterers where motion takes a good part of the bits; whether there are any."""
        encoder = self.encoder
        if encoder.layers is not None:
            return True
        if not encoder.frames.can_have_points:
            return False
        size = np.abs(encoder.target)
        octaves = np.log2(1 + np.maximum(size / step - 1, 0)).sum(axis=(0, 1, 3))
        middle = len(octaves) // 2
        still = octaves[max(0, middle - 1) : middle + 2].sum()
        if octaves.sum() - still < MOVING_SHARE * octaves.sum():
            return False
        encoder.with_layers(_fit(encoder, num_bytes))
        return True


def _fit(encoder: ChunkEncoder, num_bytes: int) -> Layers:
    window = encoder.frames.fit_window()
    frames = encoder.frames.num_frames
    # a single frame cannot separate static clutter from slow motion
    recipe = FitRecipe(
        num_points=min(POINTS_A_FRAME * frames, int(num_bytes / BYTES_A_POINT)), with_static=frames > 1,
        with_calibration=True, stages=FIT_STAGES, last_steps=LAST_STEPS, least_gain=LEAST_GAIN,
    )  # fmt: skip
    return fitted(torch.from_numpy(encoder.target), window, recipe)
