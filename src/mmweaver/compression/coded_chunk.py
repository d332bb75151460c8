"""How a chunk is coded, what is coded of it before its cells, and what comes out (encoder side)."""

from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from mmweaver.compression.cell_sample import CellSample, Estimate
from mmweaver.compression.chunk_transform import ChunkTransform, TransformChoice
from mmweaver.compression.entropy import Encoder


@dataclass(frozen=True, kw_only=True)
class ChunkMode:
    """How a chunk is coded; each is one of the choices that the encoder compares by rate and distortion."""

    transform: TransformChoice = field(default_factory=TransformChoice)
    with_points: bool = False
    with_rank: bool = False
    noise_step: float = 0.0  # of the noise layer, where there is one
    finer: int = 1  # the step over that of moving cells
    only_noise: bool = False  # all of it as a noise layer, of the chunk's step

    def name(self) -> str:
        """For people."""
        if self.only_noise:
            return "noise"
        parts = ["scatterers"] * self.with_points + ["low rank"] * self.with_rank
        parts += ["noise"] * bool(self.noise_step)
        return " + ".join([*parts, self.transform.name()])


@dataclass(frozen=True, kw_only=True)
class ChunkLayers:
    """Layers of a chunk, coded or counted at a step, and the `target` that they leave (frame, range, doppler, antenna).

    `front`: bytes before the stream; `uncoded_bytes` of layers were only counted; `num_values` real numbers are in all.
    """

    step: float
    target: np.ndarray
    near: np.ndarray
    stream: Encoder = field(default_factory=Encoder)
    flags: int = 0
    front: bytes = b""
    uncoded_bytes: float = 0.0
    rank: int = 0
    num_values: int = 0
    transformed: dict[TransformChoice, tuple[ChunkTransform, np.ndarray]] = field(default_factory=dict)  # the target


@dataclass(frozen=True, kw_only=True)
class ChunkDraft:
    """A chunk whose cells are still to be coded. `front`: bytes before the stream, but for prefix and transform.

    `front_bytes`: of all but the cells, `num_values` real numbers among it; `uncoded_bytes` of these were only counted,
    and `noise_bytes` are the noise layer's.
    """

    step: float
    stream: Encoder
    flags: int
    front: bytes
    front_bytes: float
    uncoded_bytes: float
    noise_bytes: float
    near: np.ndarray
    rank: int
    num_values: int
    transform: ChunkTransform
    coefficients: np.ndarray
    is_active: np.ndarray
    energy: np.ndarray  # of the coefficients (time, range, index)

    def sample(self) -> CellSample:
        """Some cells, for estimates."""
        return CellSample.of(
            self.coefficients, self.is_active, self.front_bytes, front_values=self.num_values, front_step=self.step
        )


@dataclass(frozen=True, kw_only=True)
class CodedChunk:
    """A chunk's bytes, and the energy of its error in units of the squared peak: active cells, and all.

    Where only its size was asked for, `data` is empty, and `num_bytes` within some percent of what it would be.
    """

    data: bytes
    num_bytes: float
    active_error: float
    all_error: float
    step: float
    mode: ChunkMode
    draft: ChunkDraft

    @cached_property
    def sample(self) -> CellSample:
        """Some of its cells, for estimates."""
        return self.draft.sample()

    def cost(self, coarser: int) -> float:
        """Lagrangian cost in the units of the error: cells without signal count less."""
        own = Estimate(num_bytes=self.num_bytes, active_error=self.active_error, all_error=self.all_error)
        return own.cost(self.step, coarser)
