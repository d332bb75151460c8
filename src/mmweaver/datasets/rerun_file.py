"""A result as a recording for the Rerun viewer."""

from importlib import import_module
from pathlib import Path
from typing import Any

import numpy as np

from mmweaver.core.optional_packages import need
from mmweaver.core.skeleton import BONES
from mmweaver.datasets.formats import export_format
from mmweaver.io.stored_result import StoredResult
from mmweaver.signal.spectra import range_doppler_power


@export_format("rerun", "Rerun recording (.rrd)", ending=".rrd")
def write_rerun(result: StoredResult, out: Path) -> str:
    """Writes `result.rrd`: points, skeletons and range-Doppler maps over time.

    Raises:
        InputError: If rerun-sdk is not installed.
    """
    need("rerun", "Rerun's format", "rerun")
    rr: Any = import_module("rerun")
    recording = rr.RecordingStream("mmweaver", recording_id=f"mmweaver-{result.meta.get('seed', 0)}")
    recording.save(out / "result.rrd")
    recording.log("radar", rr.ViewCoordinates.RIGHT_HAND_Z_UP, static=True)
    power = range_doppler_power(result.cube)
    points = result.points
    place = points.xyz_m
    for index, time_s in enumerate(result.cube.grid.frame_time_s):
        recording.set_time("time", duration=float(time_s))
        own = points.frame == index
        recording.log("radar/points", rr.Points3D(place[own], radii=0.03))
        for person, pose in enumerate(result.poses):
            recording.log(
                f"radar/person_{person}", rr.LineStrips3D([pose.joints_m[index][list(bone)] for bone in BONES])
            )
        recording.log(
            "maps/range_doppler_db", rr.Tensor(10 * np.log10(power[index] + 1e-30), dim_names=["range", "doppler"])
        )
    recording.flush()
    return "a recording for Rerun"
