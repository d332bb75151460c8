"""Properties of .mmw files: bytes and quality are kept to, whatever the shape, scale and content of a cube."""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from hypothesis import strategies as st

from mmweaver.compression.mmw_codec import FLOAT32_DB, MAX_PEAK, compress_cube, values_of_bytes
from mmweaver.compression.optimiser import error_db
from mmweaver.compression.quantised_cells import active_mask
from mmweaver.core.records import CubeGrid, RadarCube
from tests.compression.echoes import SMALL
from tests.fuzz.test_properties import deep, hold

SMALL_FILE, WORDS = 300, 12  # bytes below which a few words of the stream matter; what may then be left over
FEW_BYTES = 24  # by which the search for the best file of a quality may miss it
Shape = tuple[int, ...]


def _noise(draw: np.random.Generator, shape: Shape) -> np.ndarray:
    return draw.normal(size=shape) + 1j * draw.normal(size=shape)


def _some(draw: np.random.Generator, shape: Shape, num: int) -> np.ndarray:
    values = np.zeros(shape, complex)
    values.flat[draw.integers(0, values.size, num)] = _noise(draw, (num,))
    return values


def _echo(draw: np.random.Generator, shape: Shape) -> np.ndarray:
    values = _noise(draw, shape)
    values[:, shape[1] // 2] += 100 * np.exp(1j * np.arange(shape[0]) / 9)[:, None, None]
    return values


def _late(frames: int) -> np.ndarray:
    return (np.arange(frames) >= frames / 2)[:, None, None, None]


CONTENTS: dict[str, Callable[[np.random.Generator, Shape], np.ndarray]] = {
    "zeros": lambda _, shape: np.zeros(shape),
    "one": lambda draw, shape: _some(draw, shape, 1),
    "ten": lambda draw, shape: _some(draw, shape, 10),
    "constant": lambda _, shape: np.full(shape, 7 + 1j),
    "noise": _noise,
    "echo": _echo,
    "real": lambda draw, shape: draw.normal(size=shape),
    "integers": lambda draw, shape: np.round(10 * _noise(draw, shape)),
    "heavy tails": lambda draw, shape: _noise(draw, shape) * np.exp(3 * draw.normal(size=shape)),
    "low rank": lambda draw, shape: draw.normal(size=(*shape[:2], 1, 1)) * _noise(draw, (1, 1, *shape[2:])),
    "begins empty": lambda draw, shape: _noise(draw, shape) * _late(shape[0]),
}  # fmt: skip


@dataclass(frozen=True)
class Drawn:
    """What a cube is made of; hypothesis prints it."""

    frames: int
    ranges: int
    loops: int
    antennas: int
    content: str
    scale: float
    seed: int

    def cube(self) -> RadarCube:
        tx, rx = (1, self.antennas) if self.antennas <= SMALL.num_rx else (SMALL.num_tx, SMALL.num_rx)
        config = replace(
            SMALL, num_loops=self.loops, num_range_bins=self.ranges, tx_position_m=SMALL.tx_position_m[:tx],
            rx_position_m=SMALL.rx_position_m[:rx], tx_order=tuple(range(tx)),
        )  # fmt: skip
        grid = CubeGrid.of(config, self.frames)
        values = CONTENTS[self.content](np.random.default_rng(self.seed), grid.shape) * self.scale
        values *= min(1.0, 0.9 * MAX_PEAK / max(np.abs(values).max(), 1e-300))  # more is refused
        return RadarCube(values=values.astype(np.complex64), grid=grid, config=config, scale=float("nan"))


CUBES = st.builds(
    Drawn, frames=st.sampled_from([1, 2, 3, 5, 21, 60]), ranges=st.sampled_from([1, 2, 5, 24]),
    loops=st.sampled_from([1, 2, 3, 4, 16]), antennas=st.sampled_from([1, 2, 12]),
    content=st.sampled_from(list(CONTENTS)),
    scale=st.sampled_from([1e-36, 1e-30, 1e-12, 1.0, 1e9, 1e30, 1e33]), seed=st.integers(0, 9),
)  # fmt: skip


@deep
def test_bytes_are_used_and_never_exceeded(depth: int):
    def example(drawn: Drawn, num_bytes: int, keep_noise: bool) -> None:
        cube = drawn.cube()
        data = compress_cube(cube, num_bytes=num_bytes, keep_noise=keep_noise)
        left_db = error_db(cube.values, values_of_bytes(data), np.ones(cube.values.shape[:3], bool))
        assert len(data) <= num_bytes
        assert len(data) >= min(0.97 * num_bytes, num_bytes - WORDS * (num_bytes <= SMALL_FILE)) or left_db < FLOAT32_DB

    hold(depth, 6, example, drawn=CUBES, num_bytes=st.integers(256, 4000), keep_noise=st.booleans())


@deep
def test_quality_is_met_and_exceeded_only_by_files_that_cannot_be_smaller(depth: int):
    """Files of more than some 300 bytes have the quality asked for; smaller ones hold a few levels of 8 bits each."""

    def example(drawn: Drawn, quality_db: float, keep_noise: bool) -> None:
        cube = drawn.cube()
        data = compress_cube(cube, quality_db=quality_db, keep_noise=keep_noise)
        found_db = -error_db(cube.values, values_of_bytes(data), active_mask(cube.values))
        assert found_db >= quality_db
        if found_db > quality_db + 0.3 and len(data) > SMALL_FILE:
            worse = compress_cube(cube, quality_db=max(1.0, quality_db - 0.5), keep_noise=keep_noise)
            assert found_db > -FLOAT32_DB or len(worse) <= len(data) + FEW_BYTES

    hold(depth, 6, example, drawn=CUBES, quality_db=st.floats(1, 90), keep_noise=st.booleans())
