"""Properties: a radar that loads gives a cube, what is written is read back, what is refused is one line."""

import json
import string
from collections.abc import Callable
from dataclasses import fields, replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import torch
import zarr
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

from mmweaver.compression.long_recording import MmwWriter
from mmweaver.compression.lossless_file import LosslessFile, compress_bin
from mmweaver.compression.mmw_codec import compress_cube, read_cube
from mmweaver.core.boards import AWR1843, PRESETS
from mmweaver.core.errors import MAX_CHARACTERS, InputError
from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.records import AdcCube, CubeGrid, RadarCube
from mmweaver.core.safe_files.safe_zarr import open_zarr
from mmweaver.core.tensor_files import read_tensors, write_tensors
from mmweaver.datasets.zarr_arrays import put_array, put_sequences
from mmweaver.io.dca1000 import read_bin, write_bin
from mmweaver.io.radar_file import load_radar
from mmweaver.propagation.receiver import Impairments, Receiver
from mmweaver.signal.cube import radar_cube

SMALL = replace(AWR1843, num_loops=2, num_samples=8, num_range_bins=4, first_range_bin=0)
CHECKS = [HealthCheck.function_scoped_fixture, HealthCheck.too_slow, HealthCheck.filter_too_much]
# make test tries few examples, always the same; every night many, and others each time
DEPTHS = [pytest.param(1, id="few"), pytest.param(60, id="many", marks=pytest.mark.slow)]
deep = pytest.mark.parametrize("depth", DEPTHS)


def hold(depth: int, few: int, example: Callable[..., None], **given_by: Any) -> None:
    """Tries a property with `few` examples, or `depth` times as many."""
    options = {"deadline": None, "suppress_health_check": CHECKS, "database": None}
    settings(max_examples=few * depth, derandomize=depth == 1, **options)(given(**given_by)(example))()


# radars -------------------------------------------------------------------------------------------------------------
FACTORS = st.sampled_from([0.0, -1.0, 1e-300, 1e-9, 1e-3, 0.1, 0.5, 0.9, 1.1, 2.0, 10.0, 1e3, 1e9, 1e300])
NUMBERS = [field.name for field in fields(RadarConfig) if isinstance(getattr(AWR1843, field.name), float)]
PLACES = st.lists(st.tuples(*[st.floats(-0.1, 0.1) for _ in range(3)]).map(list), min_size=1, max_size=3)


@st.composite
def radar_values(draw: st.DrawFn) -> dict[str, Any]:
    """The values of a radar.json: a small one of a preset, some of its numbers changed by up to everything."""
    values = json.loads(draw(st.sampled_from(list(PRESETS.values()))).to_json())
    for name, most in (("num_samples", 64), ("num_loops", 8)):
        values[name] = draw(st.integers(1, most)) if draw(st.booleans()) else min(values[name], most)
    values["first_range_bin"], values["num_range_bins"] = draw(st.integers(0, 8)), draw(st.integers(1, 16))
    for name in draw(st.lists(st.sampled_from([one for one in NUMBERS if one in values]), max_size=2)):
        values[name] *= draw(FACTORS)
    if draw(st.booleans()):
        name = draw(st.sampled_from(["tx_position_m", "rx_position_m"]))
        values[name] = draw(PLACES)
        if name == "tx_position_m":
            values["tx_order"] = list(range(len(values[name])))
    return values


@deep
def test_a_radar_that_loads_gives_a_finite_cube_of_its_shape(depth: int):
    loaded, refusals = [], []

    def example(values: dict[str, Any]) -> None:
        try:
            config = RadarConfig.from_values(values)
        except InputError as error:
            refusals.append(str(error))
            return
        loaded.append(config)
        shape = (2, config.num_loops, config.num_tx, config.num_rx, config.num_samples)
        silent = torch.zeros(shape, dtype=torch.complex64)
        echo = torch.full((2, *shape[2:]), 10 * config.noise_power_mw**0.5, dtype=torch.complex64)
        received = Receiver(config, Impairments(), seed=0).receive(silent, echo, torch.zeros_like(echo[0]), range(2))
        cube = radar_cube(AdcCube(samples=received.numpy(), config=config, scale=1.0))
        assert cube.values.shape == CubeGrid.of(config, 2).shape
        assert np.isfinite(cube.values).all()
        assert np.any(cube.values)

    hold(depth, 60, example, values=radar_values())
    assert len(loaded) > 10 * depth
    assert all(len(text) <= MAX_CHARACTERS and text.isprintable() for text in refusals)


# written, then read -------------------------------------------------------------------------------------------------
def finite(bits: int, most: float) -> st.SearchStrategy[float]:
    return st.floats(-most, most, width=bits)


def cubes(config: RadarConfig = SMALL) -> st.SearchStrategy[RadarCube]:
    def cube(parts: np.ndarray) -> RadarCube:
        values = np.ascontiguousarray(parts).view(np.complex64)[..., 0]
        return RadarCube(values=values, grid=CubeGrid.of(config, len(values)), config=config, scale=1.0)

    bins = (config.num_range_bins, config.num_loops, config.num_antennas, 2)
    shapes = st.integers(1, 3).map(lambda frames: (frames, *bins))
    return shapes.flatmap(lambda shape: hnp.arrays(np.float32, shape, elements=finite(32, 1e3))).map(cube)


def samples(config: RadarConfig = SMALL) -> st.SearchStrategy[AdcCube]:
    """Whole counts of 16 bits."""
    axes = (config.num_loops, config.num_tx, config.num_rx, config.num_samples, 2)
    shapes = st.integers(1, 2).map(lambda frames: (frames, *axes))
    words = shapes.flatmap(lambda shape: hnp.arrays(np.int16, shape, elements=st.integers(-(2**15), 2**15 - 1)))
    return words.map(
        lambda parts: AdcCube(
            samples=(parts[..., 0] + 1j * parts[..., 1]).astype(np.complex64), config=config, scale=1.0
        )
    )


COLUMNS = ("x_m", "y_m", "z_m", "radial_velocity_mps", "snr_db")


@deep
def test_recordings_are_read_as_they_were_written(depth: int, tmp_path: Path):
    """The .bin of a DCA1000, and .mmwl, byte for byte."""

    def example(adc: AdcCube, order: str, error: int) -> None:
        raw = tmp_path / "adc_data.bin"
        write_bin(raw, adc, iq_order=order, counts_per_unit=1.0)
        assert np.array_equal(read_bin(raw, adc.config, iq_order=order).samples, adc.samples)
        compress_bin(raw, tmp_path / "a.mmwl", adc.config)
        LosslessFile(tmp_path / "a.mmwl").decompress(tmp_path / "b.bin")
        assert (tmp_path / "b.bin").read_bytes() == raw.read_bytes()
        compress_bin(raw, tmp_path / "a.mmwl", adc.config, max_error=error)
        LosslessFile(tmp_path / "a.mmwl").decompress(tmp_path / "b.bin")
        words, near = (np.fromfile(file, "<i2").astype(int) for file in (raw, tmp_path / "b.bin"))
        assert np.abs(words - near).max() <= error

    hold(depth, 8, example, adc=samples(), order=st.sampled_from(["iq", "qi"]), error=st.integers(0, 5))


@deep
def test_a_cube_that_fits_is_read_to_the_bit_from_mmw(depth: int, tmp_path: Path):
    """In one piece, and appended piece by piece as records."""

    def example(cube: RadarCube) -> None:
        file, pieces = tmp_path / "a.mmw", tmp_path / "b.mmw"
        size = 2 * cube.values.nbytes + 2000
        file.write_bytes(compress_cube(cube, num_bytes=size))
        assert np.array_equal(read_cube(file).values, cube.values)
        pieces.unlink(missing_ok=True)
        with MmwWriter(pieces) as writer:
            for frame in range(len(cube.values)):
                one = CubeGrid.of(cube.config, 1, frame)
                writer.append(replace(cube, values=cube.values[frame : frame + 1], grid=one), num_bytes=size)
        again = read_cube(pieces)
        assert np.array_equal(again.values, cube.values)
        assert np.allclose(again.grid.frame_time_s, cube.grid.frame_time_s)

    hold(depth, 3, example, cube=cubes())


@deep
def test_radars_tensors_and_zarr_arrays_are_read_as_they_were_written(depth: int, tmp_path: Path):
    kinds = st.sampled_from([np.float16, np.float32, np.float64, np.uint8, np.int32, np.int64])
    shapes = hnp.array_shapes(min_dims=1, max_dims=4, min_side=0, max_side=5)
    arrays = st.tuples(kinds, shapes).flatmap(
        lambda both: (
            hnp.arrays(both[0], both[1], elements={"allow_nan": False, "allow_infinity": False})
            if np.dtype(both[0]).kind == "f"
            else hnp.arrays(both[0], both[1])
        )
    )
    names = st.text(string.ascii_letters + " é日", min_size=1, max_size=20).filter(str.strip)

    def example(values: np.ndarray, radar: RadarConfig, name: str, sharded: bool) -> None:
        named = replace(radar, name=name)
        (tmp_path / "radar.json").write_text(named.to_json(), encoding="utf-8")
        assert load_radar(str(tmp_path / "radar.json")) == named
        axes = tuple(f"axis_{k}" for k in range(values.ndim))
        group = zarr.open_group(tmp_path / "set", mode="w")
        if sharded and values.ndim > 1 and values.size:
            put_sequences(group, "a", values.dtype.name, values.shape, axes, values)
        else:
            put_array(group, "a", values, axes)
        found = open_zarr(tmp_path / "set").numbers("a", axes, kinds=values.dtype.kind)
        assert found.dtype == values.dtype
        assert np.array_equal(found, values)
        tensors = {"a": torch.from_numpy(values.copy())}
        write_tensors(tmp_path / "a.safetensors", tensors, {"card": name})
        again, header = read_tensors(tmp_path / "a.safetensors")
        assert torch.equal(again["a"], tensors["a"])
        assert header["card"] == name

    radars = st.sampled_from(list(PRESETS.values()))
    hold(depth, 15, example, values=arrays, radar=radars, name=names, sharded=st.booleans())


# refusals -----------------------------------------------------------------------------------------------------------
@deep
def test_any_refusal_is_one_short_line(depth: int):
    def example(text: str, place: str) -> None:
        said = str(InputError(f"{place} holds {text!r} and {text}; do this instead"))
        assert len(said) <= MAX_CHARACTERS
        assert said.isprintable()

    texts = st.text(max_size=2000)
    hold(depth, 60, example, text=texts, place=texts)
