"""MATLAB and HDF5 files of scipy and h5py, with arrays in other orders, come back as the samples that were put in."""

from pathlib import Path

import numpy as np
import pytest
from scipy import io

from mmweaver.core.errors import InputError
from mmweaver.io.mapped_arrays import read_mapped, read_mapping
from tests import captures


@pytest.fixture
def adc(tmp_path: Path):
    return captures.counts(captures.radar_of_cfg(tmp_path))


def mapping(folder: Path, **values: str):
    (folder / "map.toml").write_text("".join(f'{key} = "{value}"\n' for key, value in values.items()))
    return read_mapping(folder / "map.toml")


def by_antenna(adc) -> np.ndarray:
    """(frame, loop, antenna, sample), transmitters in firing order, which is that of their numbers here."""
    frames, loops, _, _, samples = adc.samples.shape
    return adc.samples.reshape(frames, loops, -1, samples)


def test_matlab_file_in_its_own_axes(tmp_path: Path, adc):
    io.savemat(tmp_path / "a.mat", {"adc": by_antenna(adc).transpose(3, 1, 2, 0), "other": np.ones(3)})
    found = read_mapped(
        tmp_path / "a.mat", mapping(tmp_path, array="adc", axes="sample,loop,antenna,frame"), adc.config
    )
    assert np.array_equal(found.samples, adc.samples)


def test_parts_in_two_arrays_or_along_an_axis(tmp_path: Path, adc):
    values = by_antenna(adc)
    io.savemat(tmp_path / "a.mat", {"i": values.real, "q": values.imag})
    how = mapping(tmp_path, array="i", imag="q", axes="frame,loop,antenna,sample")
    assert np.array_equal(read_mapped(tmp_path / "a.mat", how, adc.config).samples, adc.samples)
    np.save(tmp_path / "a.npy", np.stack([values.real, values.imag], axis=1))
    how = mapping(tmp_path, axes="frame,iq,loop,antenna,sample")
    assert np.array_equal(read_mapped(tmp_path / "a.npy", how, adc.config, slice(1, 3)).samples, adc.samples[1:3])


@pytest.mark.parametrize("suffix", [".h5", ".mat"])
def test_hdf5_and_matlab_7_3(tmp_path: Path, adc, suffix: str):
    h5py = pytest.importorskip("h5py")
    values = by_antenna(adc).astype(np.complex64)
    with h5py.File(tmp_path / f"a{suffix}", "w", userblock_size=512 if suffix == ".mat" else 0) as file:
        file["capture/radar"] = values.T if suffix == ".mat" else values
    how = mapping(tmp_path, array="capture/radar", axes="frame,loop,antenna,sample")
    assert np.array_equal(read_mapped(tmp_path / f"a{suffix}", how, adc.config).samples, adc.samples)


def test_what_is_missing_is_named(tmp_path: Path, adc):
    io.savemat(tmp_path / "a.mat", {"adc": np.ones((2, 2))})
    with pytest.raises(InputError, match="it has adc"):
        read_mapped(tmp_path / "a.mat", mapping(tmp_path, array="x", axes="frame,sample"), adc.config)
    with pytest.raises(InputError, match="known are"):
        mapping(tmp_path, axes="frame", unit="m")
