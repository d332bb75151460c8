"""The result folder: the same files and pictures for generated and recorded signals."""

import dataclasses
import json
import math
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from mmweaver.core.atomic_files import staged_folder
from mmweaver.core.checksums import SUMS_FILE, sha256_of_file
from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.records import AdcCube
from mmweaver.core.stages import Stages
from mmweaver.io.dca1000 import write_bin
from mmweaver.io.npz_files import write_points_npz, write_pose_npz, write_radar_npz

if TYPE_CHECKING:
    from mmweaver.viz.figure_data import FigureData

META_VERSION = 1
BOARD_FILE, THINGS_FILE = "board.json", "things.npz"
FILES = {
    "radar.npz": "the cube, complex64 (frame, range, doppler, antenna), and its axes in m, m/s and s",
    "pose.npz": "22 joints of each person at each frame, in metres, in the radar's frame",
    THINGS_FILE: "moving things other than people: kind, place and velocity at each frame, in the radar's frame",
    "points.npz": "point cloud: frame, x, y, z in metres, radial velocity in m/s, SNR in dB",
    "adc_data.bin": "raw ADC samples as a DCA1000 writes them, int16",
    "radar.json": "the radar: chirp, array and frame; --radar reads it",
    BOARD_FILE: "the board whose errors the signal has; --board reads it",
    "meta.json": "all that is needed to make this again, and the assumptions",
    "request.toml": "the options of this run; --config reads them",
    SUMS_FILE: "the sha256 of all these files; mmweaver verify checks them",
    "preview.png": "one page of pictures",
    "preview.gif": "the same over time",
    "analysis.npz": "slow-time Doppler, displacement, micro-Doppler and tracks, in SI units",
    "slow_time.png": "Doppler over frames, displacement of the strongest moving cells, breathing and heart",
    "micro_doppler.png": "radial velocity over time, by STFT over chirps",
    "people.png": "tracked people",
}


def save_results(
    out: str | Path,
    view: "FigureData",
    meta: dict[str, Any],
    *,
    adc: AdcCube | None = None,
    iq_order: str | None = None,
    overwrite: bool = False,
    stages: Stages | None = None,
    pictures: "Mapping[str, Callable[[FigureData, Path], object]] | None" = None,
    extra: dict[str, str] | None = None,
    more: Callable[[Path], object] | None = None,
) -> dict[str, Any]:
    """Writes a result folder completely or not at all.

    Args:
        out: The folder.
        view: Cube, points and poses with the data of the figures.
        meta: Content of meta.json; files and timings are added.
        adc: Raw samples, written as `adc_data.bin`. Default: not written.
        iq_order: I/Q order of `adc_data.bin`. Default: the radar's.
        overwrite: Whether `out` may contain files. Default: False.
        stages: Timer of the job. Default: a new one.
        pictures: Function that draws each picture, by file name. Default: none.
        extra: Further text files by name. Default: none.
        more: Function that writes further files listed in `FILES` into a folder. Default: none.

    Returns:
        Content of meta.json.

    Raises:
        InputError: If `out` contains files without `overwrite`, or cannot be written.
    """
    stages = stages or Stages()
    with staged_folder(Path(out), overwrite=overwrite) as stage:
        meta = dict(meta)
        with stages("write files"):
            write_radar_npz(stage / "radar.npz", view.cube)
            write_points_npz(stage / "points.npz", view.points)
            if view.poses:
                write_pose_npz(stage / "pose.npz", *view.poses)
            elif view.aligned is not None:  # a generated empty room; recordings have no ground truth
                write_pose_npz(stage / "pose.npz", time_s=view.cube.grid.frame_time_s)
            if adc is not None:
                # simulated samples are integer ADC counts of this radar: with its own scale they are written losslessly
                own = None if math.isnan(adc.scale) else adc.scale / adc.config.adc_count_sqrt_mw
                counts = write_bin(stage / "adc_data.bin", adc, iq_order=iq_order, counts_per_unit=own)
                meta["adc_data_bin"] = {
                    "iq_order": iq_order or adc.config.lvds_iq_order,
                    "tx_order": adc.config.tx_order,
                    "counts_per_unit": counts,
                }
            (stage / "radar.json").write_text(view.cube.config.to_json(), encoding="utf-8")
            for name, text in (extra or {}).items():
                (stage / name).write_text(text, encoding="utf-8")
            if more is not None:
                more(stage)
        for name, draw in (pictures or {}).items():
            with stages(f"draw {name}"):
                draw(view, stage / name)
        names = {file.name for file in stage.iterdir()} | {"meta.json", SUMS_FILE}
        meta["files"] = {name: text for name, text in FILES.items() if name in names}
        meta["seconds"] = {name: round(seconds, 3) for name, seconds in stages.seconds.items()}
        (stage / "meta.json").write_text(
            json.dumps(plain(meta), indent=2, allow_nan=False, ensure_ascii=False) + "\n", encoding="utf-8"
        )
    return plain(meta)


def radar_folder(number: int) -> str:
    """Subfolder of one of several radars in a result folder, numbered from 1."""
    return f"radar_{number}"


def radar_meta(config: RadarConfig) -> dict[str, Any]:
    """Radar and its resolutions for meta.json."""
    return {
        "radar": config.to_values(),
        "resolution": {
            "range_m": config.range_resolution_m,
            "radial_velocity_mps": config.velocity_resolution_mps,
            "range_window_m": [float(config.range_m[0]), float(config.range_m[-1])],
            "max_velocity_mps": config.max_velocity_mps,
        },
    }


def plain(value: Any) -> Any:
    """Converts records, arrays and tuples to JSON types.

    Args:
        value: Any value; nan and infinity, which JSON lacks, become None, and other objects their str().

    Returns:
        Dicts, lists, numbers, texts, booleans and None.

    >>> plain({"at": (1, np.float32(0.5)), "noise": float("nan")})
    {'at': [1, 0.5], 'noise': None}
    """
    if dataclasses.is_dataclass(value) and not isinstance(value, type):
        return {field.name: plain(getattr(value, field.name)) for field in dataclasses.fields(value)}
    if isinstance(value, dict):
        return {str(key): plain(item) for key, item in value.items()}
    if isinstance(value, np.ndarray | np.generic):
        return plain(value.tolist())
    if isinstance(value, list | tuple | set | frozenset):
        return [plain(item) for item in value]
    if isinstance(value, float):
        return value if np.isfinite(value) else None
    if value is None or isinstance(value, str | bool | int):
        return value
    return str(value)


def file_digest(path: str | Path) -> dict[str, str]:
    """Path and SHA-256 of an input file, for meta.json.

    Args:
        path: The file.

    Raises:
        InputError: If it cannot be read.
    """
    return {"path": str(path), "sha256": sha256_of_file(Path(path))}
