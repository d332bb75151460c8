"""Conversion of a generated sequence to xarray and torch."""

import json
from typing import TYPE_CHECKING, Any

import numpy as np

from mmweaver.core.optional_packages import need
from mmweaver.core.records import AdcCube, PointCloud, PoseSequence, RadarCube
from mmweaver.core.skeleton import JOINT_NAMES
from mmweaver.io.result_folder import plain

if TYPE_CHECKING:
    from torch import Tensor
    from xarray import Dataset

POINT_COLUMNS = ("frame", "x_m", "y_m", "z_m", "radial_velocity_mps", "snr_db")
CUBE_DIMENSIONS = ("frame_time", "range", "radial_velocity", "antenna")
ADC_DIMENSIONS = ("frame_time", "loop", "transmitter", "receiver", "sample")


def to_dataset(
    cube: RadarCube, points: PointCloud, poses: tuple[PoseSequence, ...], adc: AdcCube | None, meta: dict[str, Any]
) -> "Dataset":
    """Converts a generated sequence to an xarray.Dataset; see `Generation.to_xarray`.

    Args:
        cube: Radar cube.
        points: Point cloud.
        poses: People, at the frames of the cube; may be empty.
        adc: Raw samples, or None.
        meta: Content of meta.json, from which text, seed, method, version and radar become attributes.

    Returns:
        Dataset with named dimensions and units.

    Raises:
        InputError: If xarray is not installed.
    """
    need("xarray", "to_xarray", "xarray")
    import xarray

    grid = cube.grid
    variables: dict[str, Any] = {
        "cube": (CUBE_DIMENSIONS, cube.values, {"scale_sqrt_mw": cube.scale}),
        **{f"point_{name}": ("point", getattr(points, name)) for name in POINT_COLUMNS},
    }
    if poses:
        variables["joints"] = (("person", "frame_time", "joint", "axis"), _joints_m(poses), {"units": "m"})
    if adc is not None:
        variables["adc"] = (ADC_DIMENSIONS, adc.samples, {"scale_sqrt_mw": adc.scale})
    coordinates: dict[str, Any] = {
        "frame_time": ("frame_time", grid.frame_time_s, {"units": "s", "long_name": "start of the radar frame"}),
        "range": ("range", grid.range_m, {"units": "m"}),
        "radial_velocity": (
            "radial_velocity",
            grid.radial_velocity_mps,
            {"units": "m/s", "long_name": "positive = moving away"},
        ),
        "antenna": np.arange(len(grid.antenna_position_m)),
        "antenna_position": (("antenna", "axis"), grid.antenna_position_m, {"units": "m"}),
        "axis": ["x", "y", "z"],
        "joint": list(JOINT_NAMES),
    }
    attributes = {
        "text": json.dumps(meta.get("text"), ensure_ascii=False),
        "seed": meta.get("seed"),
        "method": meta.get("method"),
        "wavelength_m": grid.wavelength_m,
        "mmweaver_version": meta.get("version"),
        "radar": json.dumps(plain(meta.get("radar"))),
    }
    return xarray.Dataset(
        variables, coordinates, {key: value for key, value in attributes.items() if value is not None}
    )


def to_tensors(
    cube: RadarCube, points: PointCloud, poses: tuple[PoseSequence, ...], adc: AdcCube | None
) -> "dict[str, Tensor]":
    """Converts a generated sequence to torch tensors; see `Generation.to_torch`.

    Args:
        cube: Radar cube.
        points: Point cloud, which becomes `points` (point, 6) with the columns `POINT_COLUMNS`.
        poses: People, which become `joints_m` (person, frame, 22, 3); may be empty.
        adc: Raw samples, or None.

    Returns:
        Tensors by name.
    """
    import torch

    columns = np.stack([np.asarray(getattr(points, name), np.float32) for name in POINT_COLUMNS], axis=1)
    arrays = {
        "cube": cube.values,
        "frame_time_s": cube.grid.frame_time_s,
        "range_m": cube.grid.range_m,
        "radial_velocity_mps": cube.grid.radial_velocity_mps,
        "antenna_position_m": cube.grid.antenna_position_m,
        "points": columns,
    }
    if poses:
        arrays["joints_m"] = _joints_m(poses)
    if adc is not None:
        arrays["adc"] = adc.samples
    return {name: torch.from_numpy(np.ascontiguousarray(array)) for name, array in arrays.items()}


def _joints_m(poses: tuple[PoseSequence, ...]) -> np.ndarray:
    """(person, frame, joint, 3) float32."""
    return np.stack([pose.joints_m for pose in poses]).astype(np.float32)
