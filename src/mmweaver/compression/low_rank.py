"""A chunk as a matrix of low rank, rows (frame, range) by columns (Doppler, antenna), with quantised factors.

It suits static scenes whose spectrum is spread over many Doppler bins alike, by phase noise or a strong leakage.
"""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Complex, Int

from mmweaver.compression.entropy import BitStream
from mmweaver.compression.level_coder import LevelCoder
from mmweaver.compression.level_size import estimated_bits

Array = np.ndarray
Components = tuple[Array, Array, Array]  # left (row, component), strength (component,), right (component, column)
MOST_RANK = 255
ROUNDING = 0.4
LEAST_GAIN = 0.3  # squared steps per bit that a component must remove
CORRELATED = True, False  # neighbouring rows of a factor predict each other's sign
PEAKED = 10  # largest level of the right factor over that of the left one
WIDER = 3.0  # noise of windowed cells is correlated: its strongest components exceed those of white noise


@dataclass(frozen=True, kw_only=True)
class RankFactors:
    """Levels (part, 1, component, row, 1) of the left factor and (part, 1, component, doppler, antenna) of the right.

    An error of one step in either factor leaves the same error in the matrix: columns of the left factor have the
    strength of their component, rows of the right one unit norm, so these have finer steps.
    """

    left: Int[Array, "2 1 rank row 1"]
    right: Int[Array, "2 1 rank doppler antenna"]

    @classmethod
    def of(
        cls, values: Complex[Array, "frame range doppler antenna"], step: float, noise_power: float = 0.0
    ) -> "RankFactors | None":
        """The components worth their bits at a step, or None where there are none.

        Components no stronger than noise of `noise_power` a cell would be are left out.
        """
        return cls.of_components(components_of(values), values.shape, step, noise_power)

    @classmethod
    def of_components(
        cls, components: Components, shape: tuple[int, ...], step: float, noise_power: float = 0.0
    ) -> "RankFactors | None":
        """As `of`, of the singular value decomposition of the values, which is the same for every step."""
        frames, num_range, doppler, antennas = shape
        left, strength, right = components
        rank = _worthwhile(strength, (frames * num_range, doppler * antennas), step, noise_power)
        if not rank:
            return None
        scaled = (left[:, :rank] * strength[:rank]).T
        left_levels = _rounded(scaled[None, :, :, None] / step)
        steps = _right_steps(left_levels)
        rows = right[:rank].reshape(1, rank, doppler, antennas)
        return cls(left=left_levels, right=_rounded(rows / steps[:, None, None]))

    @property
    def rank(self) -> int:
        """Number of components."""
        return self.left.shape[2]

    @property
    def is_peaked(self) -> bool:
        """Whether a few Doppler bins hold most: such factors have up to 1.7 times the bits that are estimated."""
        return bool(np.abs(self.right).max() > PEAKED * np.abs(self.left).max())

    @property
    def num_values(self) -> int:
        """Levels that are not zero."""
        return int(np.count_nonzero(self.left) + np.count_nonzero(self.right))

    def values(self, step: float, shape: tuple[int, int, int, int]) -> Complex[Array, "frame range doppler antenna"]:
        """The matrix as values of a chunk of this shape."""
        left = (self.left[0, 0, :, :, 0] + 1j * self.left[1, 0, :, :, 0]) * step
        steps = _right_steps(self.left)[:, None]
        right = (self.right[0, 0] + 1j * self.right[1, 0]).reshape(self.rank, -1) * steps
        return (left.T @ right).reshape(shape)

    def code(self, stream: BitStream) -> None:
        """Encodes the factors, or fills them in when decoding."""
        for levels in (self.left, self.right):
            every = np.ones(levels.shape[2:], np.int64)
            LevelCoder(levels.shape[1:], CORRELATED).code(stream, levels.reshape(2, levels.shape[1], -1), every)

    def estimated_bits(self) -> float:
        """About the bits of `code`."""
        bits = 0.0
        for levels in (self.left, self.right):
            every, one = np.ones(levels.shape[2:], np.int64), np.ones(1)
            coder = LevelCoder(levels.shape[1:], CORRELATED)
            bits += estimated_bits(coder, levels.reshape(2, 1, -1), every, one)
        return bits

    @classmethod
    def empty(cls, rank: int, shape: tuple[int, int, int, int]) -> "RankFactors":
        """Factors to decode into, of a chunk (frame, range, doppler, antenna)."""
        frames, num_range, doppler, antennas = shape
        return cls(
            left=np.zeros((2, 1, rank, frames * num_range, 1), np.int64),
            right=np.zeros((2, 1, rank, doppler, antennas), np.int64),
        )


def components_of(values: Complex[Array, "frame range doppler antenna"]) -> Components:
    """The singular value decomposition of values, (frame, range) by (Doppler, antenna)."""
    frames, num_range, doppler, antennas = values.shape
    left, strength, right = np.linalg.svd(values.reshape(frames * num_range, doppler * antennas), full_matrices=False)
    return left, strength, right


def _worthwhile(strength: Array, shape: tuple[int, int], step: float, noise_power: float) -> int:
    """Number of leading components whose energy is worth the bits of their factors."""
    noise = noise_power * WIDER * (np.sqrt(shape[0]) + np.sqrt(shape[1])) ** 2
    size = np.maximum(strength.astype(np.float64) ** 2 - noise, 1e-30)
    bits = sum(num * np.log2(1 + 6 * size / (num * step**2)) for num in shape)
    gain = size - sum(shape) * step**2 / 6
    worth = gain > LEAST_GAIN * step**2 * bits
    return min(int(np.argmin(worth)) if not worth.all() else len(worth), MOST_RANK)


def _rounded(values: Complex[Array, "..."]) -> Array:
    parts = np.stack([np.real(values), np.imag(values)])
    return (np.sign(parts) * np.floor(np.abs(parts) + ROUNDING)).astype(np.int64)


def _right_steps(left: Array) -> Array:
    """Step of each row of the right factor: that of the matrix over the strength of the component."""
    norm = np.sqrt(np.sum(left.astype(np.float64) ** 2, axis=(0, 1, 3, 4)))
    return 1 / np.maximum(norm, 1.0)
