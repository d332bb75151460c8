"""Results as MATLAB and netCDF files, and as Zarr stores."""

from pathlib import Path
from typing import Any

import numpy as np

from mmweaver.core.errors import InputError
from mmweaver.core.optional_packages import need
from mmweaver.core.skeleton import JOINT_NAMES
from mmweaver.datasets.formats import export_format
from mmweaver.datasets.zarr_arrays import consolidate
from mmweaver.io.conversions import to_dataset
from mmweaver.io.npz_files import POINT_COLUMNS
from mmweaver.io.stored_result import StoredResult

MAX_NETCDF_BYTES = 2_000_000_000  # per variable of netCDF 3


@export_format("mat", "MATLAB", ending=".mat")
def write_mat(result: StoredResult, out: Path) -> str:
    """Writes `result.mat` (MATLAB 5): cube (frame, range, doppler, antenna) as complex single, axes, points and joints.

    `points` (point, 6): frame from 1, x, y, z in metres, velocity in m/s, SNR in dB; `joints_m` (person, frame, 22, 3).
    """
    from scipy.io import savemat

    grid, points = result.cube.grid, result.points
    columns = [points.frame + 1, *(getattr(points, name) for name in POINT_COLUMNS)]
    values: dict[str, Any] = {
        "cube": result.cube.values,
        "range_m": grid.range_m,
        "radial_velocity_mps": grid.radial_velocity_mps,
        "frame_time_s": grid.frame_time_s,
        "antenna_position_m": grid.antenna_position_m,
        "wavelength_m": grid.wavelength_m,
        "scale_sqrt_mw": result.cube.scale,
        "points": np.stack(columns, axis=-1).astype(np.float64),
        "text": result.text,
    }
    if result.poses:
        values["joints_m"] = np.stack([pose.joints_m for pose in result.poses]).astype(np.float32)
        values["joint_names"] = np.array(JOINT_NAMES, dtype=object)
    savemat(out / "result.mat", values, do_compression=True)
    return "a MATLAB file"


@export_format("netcdf", "netCDF 3, for xarray", ending=".nc")
def write_netcdf(result: StoredResult, out: Path) -> str:
    """Writes `result.nc` (netCDF 3) with points and joints.

    The cube is split into `cube_real` and `cube_imag`, since netCDF lacks complex numbers. Dimensions and coordinates
    share their names, so that xarray's `.sel(range=2.0)` works.

    Raises:
        InputError: If xarray is not installed, or the cube is too large for the format.
    """
    need("export", "netCDF", "xarray")
    import xarray

    cube, grid = result.cube, result.cube.grid
    if cube.values.nbytes // 2 > MAX_NETCDF_BYTES:
        raise InputError("this cube is too large for netCDF 3 (2 GB a variable); export fewer frames, or to mat")
    dimensions = ("frame_time", "range", "radial_velocity", "antenna")
    variables: dict[str, Any] = {
        "cube_real": (dimensions, np.ascontiguousarray(cube.values.real), {"scale_sqrt_mw": cube.scale}),
        "cube_imag": (dimensions, np.ascontiguousarray(cube.values.imag), {"scale_sqrt_mw": cube.scale}),
        "point_frame": ("point", result.points.frame.astype(np.int32)),
        **{f"point_{name}": ("point", getattr(result.points, name)) for name in POINT_COLUMNS},
    }
    if result.poses:
        joints_m = np.stack([pose.joints_m for pose in result.poses]).astype(np.float32)
        variables["joints"] = (("person", "frame_time", "joint", "axis"), joints_m, {"units": "m"})
    coordinates = {
        "frame_time": ("frame_time", grid.frame_time_s, {"units": "s"}),
        "range": ("range", grid.range_m, {"units": "m"}),
        "radial_velocity": ("radial_velocity", grid.radial_velocity_mps, {"units": "m/s"}),
    }
    # time in seconds since the start is a number, not a date
    dataset = xarray.Dataset(variables, coordinates, {"text": result.text, "wavelength_m": grid.wavelength_m})
    dataset.to_netcdf(out / "result.nc", engine="scipy", format="NETCDF3_64BIT")
    return "a netCDF file"


@export_format("zarr", "Zarr 3, for xarray")
def write_zarr(result: StoredResult, out: Path) -> str:
    """Writes `result.zarr` (Zarr 3): the dataset of `Generation.to_xarray` with complex cube, for `xarray.open_zarr`.

    Names of joints and axes are attributes, since Zarr 3 has no stable type for fixed-length texts.

    Raises:
        InputError: If xarray or zarr is not installed.
    """
    need("export", "a Zarr store", "xarray", "zarr")
    dataset = to_dataset(result.cube, result.points, result.poses, None, result.meta)
    names = {f"{name}_names": [str(one) for one in dataset[name].values] for name in ("joint", "axis")}
    dataset = dataset.drop_vars(["joint", "axis"]).assign_attrs(names)
    dataset.to_zarr(out / "result.zarr", mode="w-", zarr_format=3, consolidated=False)
    consolidate(out / "result.zarr")
    return "a Zarr store"
