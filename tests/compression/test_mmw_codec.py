from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from mmweaver.compression import optimiser
from mmweaver.compression.mmw_codec import compress_cube, describe_mmw, read_cube
from mmweaver.compression.mmw_field import open_mmw
from mmweaver.core.boards import AWR1843, BGT60
from mmweaver.core.errors import InputError
from mmweaver.core.records import CubeGrid, RadarCube
from mmweaver.core.seeding import stream
from tests.compression.echoes import SMALL, crowd, error_db


@pytest.fixture(scope="module")
def long_cube() -> RadarCube:
    cube = crowd(num_frames=5, num_points=5)
    return replace(cube, grid=replace(cube.grid, frame_time_s=2.0 + cube.grid.frame_time_s))


@pytest.fixture(scope="module")
def long_file(long_cube: RadarCube) -> bytes:
    """In three chunks."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(optimiser, "MAX_FRAMES", 2)
        return compress_cube(long_cube, num_bytes=8000, keep_noise=True, effort="fast")


def test_the_requested_size_is_not_exceeded(tmp_path: Path):
    cube, num_bytes = crowd(), 4000
    data = compress_cube(cube, num_bytes=num_bytes)
    assert data == compress_cube(cube, num_bytes=num_bytes)
    assert 0.97 * num_bytes <= len(data) <= num_bytes
    (tmp_path / "a.mmw").write_bytes(data)
    again = read_cube(tmp_path / "a.mmw")
    assert again.config == cube.config
    assert again.scale == cube.scale
    assert np.allclose(again.grid.frame_time_s, cube.grid.frame_time_s)
    assert error_db(again.values, cube.values) < -25


def test_the_requested_quality_is_met(tmp_path: Path):
    cube = crowd()
    (tmp_path / "a.mmw").write_bytes(compress_cube(cube, quality_db=25.0))
    again = read_cube(tmp_path / "a.mmw")
    power = np.mean(np.abs(cube.values) ** 2, axis=-1)
    active = power > np.median(power) * 10**1.2
    assert -27 < error_db(again.values[active], cube.values[active]) <= -25


def test_single_frames_are_read(long_cube: RadarCube, long_file: bytes, tmp_path: Path):
    path, data = tmp_path / "a.mmw", long_file
    path.write_bytes(data)
    whole = read_cube(path)
    assert error_db(whole.values, long_cube.values) < -20
    part = read_cube(path, slice(2, 4))
    assert np.array_equal(part.values, whole.values[2:4])
    assert np.allclose(part.grid.frame_time_s, whole.grid.frame_time_s[2:4])
    assert np.array_equal(read_cube(path, slice(None, None, -2)).values, whole.values[::-2])
    # damage in the last chunk does not touch the first
    path.write_bytes(data[:-40] + bytes([data[-40] ^ 1]) + data[-39:])
    assert np.array_equal(read_cube(path, slice(0, 3)).values, whole.values[:3])
    with pytest.raises(InputError, match="chunk 2"):
        read_cube(path)
    with pytest.raises(InputError, match="5 frames"):
        read_cube(path, slice(9, 12))


def test_a_file_is_described(long_file: bytes, tmp_path: Path):
    (tmp_path / "a.mmw").write_bytes(long_file)
    facts = describe_mmw(tmp_path / "a.mmw")
    assert facts["shape"] == [5, 24, 16, 12]
    assert [chunk["frames"] for chunk in facts["chunks"]] == [2, 1, 2]
    assert facts["first_frame_s"] == pytest.approx(2.0)
    assert facts["ratio"] > 20


@pytest.mark.parametrize(
    ("wish", "word"),
    [
        ({}, "either"),
        ({"num_bytes": 1000, "quality_db": 20.0}, "either"),
        ({"num_bytes": 10}, "at least 256"),
        ({"quality_db": 0.0}, "not possible"),
        ({"quality_db": float("nan")}, "not possible"),
    ],
)
def test_impossible_requests_are_refused(wish: dict, word: str):
    with pytest.raises(InputError, match=word):
        compress_cube(crowd(num_frames=1), **wish)


def test_cubes_that_cannot_be_stored_are_refused():
    cube = crowd(num_frames=1)
    broken = cube.values.copy()
    broken[0, 0, 0, 0] = np.nan
    other = CubeGrid.of(AWR1843, 1)
    for bad, word in (
        (replace(cube, values=broken), "not finite"),
        (replace(cube, values=cube.values[:, :9]), "shape"),
        (replace(cube, grid=replace(cube.grid, range_m=other.range_m[:24] + 1.0)), "range_m"),
    ):
        with pytest.raises(InputError, match=word):
            compress_cube(bad, num_bytes=2000)
    assert SMALL.num_range_bins == 24


def plain_cube(config, num_frames: int, kind: str = "noise") -> RadarCube:
    """A cube of a radar, without simulation: noise with a steady echo, one number everywhere, or few that are not 0."""
    grid = CubeGrid.of(config, num_frames)
    values = np.zeros(grid.shape, np.complex64)
    if kind == "noise":
        draw = stream(0, "cube").normal(size=(2, *grid.shape)).astype(np.float32)
        values = draw[0] + 1j * draw[1]
        values[:, grid.shape[1] // 2] += 100 * np.exp(1j * np.arange(num_frames) / 9)[:, None, None]
    if kind == "constant":
        values[...] = 7 + 1j
    if kind == "ten":
        draw = stream(0, "cube")
        values.flat[draw.integers(0, values.size, 10)] = draw.normal(size=10) + 1j
    if kind == "one":
        values.flat[values.size // 2] = 3 - 4j
    return RadarCube(values=values.astype(np.complex64), grid=grid, config=config, scale=float("nan"))


ONE_ANTENNA = replace(
    SMALL, tx_position_m=SMALL.tx_position_m[:1], rx_position_m=SMALL.rx_position_m[:1], tx_order=(0,)
)
SHAPES = {
    "one loop, 300 frames": (replace(SMALL, num_loops=1, num_range_bins=4), 300),
    "two loops, 120 frames": (replace(SMALL, num_loops=2, num_range_bins=4), 120),
    "three loops": (replace(SMALL, num_loops=3), 5),
    "one antenna": (ONE_ANTENNA, 6),
    "one antenna, one loop, one frame": (replace(ONE_ANTENNA, num_loops=1), 1),
    "one range bin": (replace(SMALL, num_range_bins=1), 3),
    "real samples": (BGT60, 30),
    "one frame": (SMALL, 1),
}


@pytest.mark.parametrize("name", SHAPES)
def test_cubes_of_any_shape_use_their_bytes(name: str, tmp_path: Path):
    cube = plain_cube(*SHAPES[name])
    data = compress_cube(cube, num_bytes=1500)
    (tmp_path / "a.mmw").write_bytes(data)
    again = read_cube(tmp_path / "a.mmw").values
    assert len(data) <= 1500
    if not np.array_equal(again, cube.values):
        assert len(data) >= 0.97 * 1500
        assert error_db(again, cube.values) < -10


def test_what_fits_is_stored_to_the_last_digit(tmp_path: Path):
    cube = plain_cube(SMALL, 1)
    (tmp_path / "a.mmw").write_bytes(compress_cube(cube, num_bytes=cube.values.nbytes + 500))
    np.testing.assert_allclose(read_cube(tmp_path / "a.mmw").values, cube.values, rtol=1e-6)
    assert describe_mmw(tmp_path / "a.mmw")["chunks"][0]["mode"] == "exact"
    np.testing.assert_allclose(open_mmw(tmp_path / "a.mmw").cube().values, cube.values, rtol=1e-6, atol=1e-6)


def test_a_file_that_was_cut_short_holds_the_frames_before(long_file: bytes, tmp_path: Path):
    path = tmp_path / "a.mmw"
    path.write_bytes(long_file)
    whole = read_cube(path)
    path.write_bytes(long_file[:-1])
    assert np.array_equal(read_cube(path).values, whole.values[:-2])
    facts = describe_mmw(path)
    assert facts["shape"][0] == 3
    assert facts["cut_short_bytes"] > 0
