"""Exports of the studio: the same files as the command line writes for the same request."""

import shutil
from collections.abc import Callable
from functools import partial
from importlib.util import find_spec
from pathlib import Path
from tempfile import gettempdir

from mmweaver.core.errors import InputError
from mmweaver.core.records import RadarCube
from mmweaver.core.safe_files.regular_files import read_bytes
from mmweaver.core.staging import remove, staging_path
from mmweaver.datasets.export import FORMATS, export_result
from mmweaver.io.npz_files import write_points_npz, write_radar_npz
from mmweaver.io.result_folder import save_results
from mmweaver.studio.sessions import Result
from mmweaver.viz.figure_data import FigureData
from mmweaver.viz.html_page import write_page
from mmweaver.viz.preview import PREVIEWS

MAX_EXPORT_BYTES = 4_000_000_000
Export = Callable[[Result, Path], Path]  # writes into a folder and returns the file
# formats of `mmweaver export` that need no samples, and the package that each needs
_OTHERS = {
    "zarr": "zarr",
    "mat": "scipy",
    "mcap": "foxglove",
    "ros2": "rosbags",
    "rerun": "rerun",
    "mp4": "av",
    "webm": "av",
}


def _radar_npz(result: Result, folder: Path) -> Path:
    write_radar_npz(folder / "radar.npz", _cube(result))
    return folder / "radar.npz"


def _points_npz(result: Result, folder: Path) -> Path:
    write_points_npz(folder / "points.npz", result.points)
    return folder / "points.npz"


def _folder(result: Result, folder: Path) -> Path:
    _save(result, folder / "result")
    return _zipped(folder / "result")


def _samples(result: Result, folder: Path) -> Path:
    """The result folder with its samples, for which the same request is generated again: results are kept without."""
    if result.with_samples is None:
        raise InputError("only what the studio generated has samples; generate a sequence first")
    result.with_samples().save(folder / "result", adc_data_bin=True, pictures=False)
    return _zipped(folder / "result")


def _html(result: Result, folder: Path) -> Path:
    page = folder / "mmweaver.html"
    if result.generation is not None:
        result.generation.save_html(page)
    else:
        write_page(page, result.playback(), None, result.title)
    return page


def _other(kind: str, result: Result, folder: Path) -> Path:
    _save(result, folder / "result", pictures=kind in ("mp4", "webm"))
    export_result(folder / "result", kind, folder / kind)
    files = list((folder / kind).iterdir())
    return files[0] if len(files) == 1 and files[0].is_file() else _zipped(folder / kind)


EXPORTS: dict[str, tuple[str, Export]] = {
    "npz": ("radar.npz", _radar_npz),
    "points": ("points.npz", _points_npz),
    "folder": ("result folder (zip)", _folder),
    "bin": ("with adc_data.bin (zip)", _samples),
    "html": ("page that plays offline (html)", _html),
    **{kind: (FORMATS[kind].what, partial(_other, kind)) for kind, package in _OTHERS.items() if find_spec(package)},
}


def export(result: Result, kind: str) -> tuple[str, bytes]:
    """Exports a result.

    Args:
        result: The result.
        kind: Format, a key of `EXPORTS`.

    Returns:
        Name and bytes of the file.

    Raises:
        InputError: For an unknown format.
    """
    if kind not in EXPORTS:
        raise InputError(f"unknown format {kind!r}; known: {', '.join(EXPORTS)}")
    folder = staging_path(Path(gettempdir()) / "mmweaver-export")
    folder.mkdir(mode=0o700)
    try:
        file = EXPORTS[kind][1](result, folder)
        return file.name, read_bytes(file, max_bytes=MAX_EXPORT_BYTES)
    finally:
        remove(folder)


def _save(result: Result, folder: Path, *, pictures: bool = True) -> None:
    if result.generation is not None:
        result.generation.save(folder, pictures=pictures)
        return
    view = FigureData(title=result.title, cube=_cube(result), points=result.points, poses=result.poses)
    save_results(folder, view, result.meta, pictures=PREVIEWS if pictures else None)


def _zipped(folder: Path) -> Path:
    return Path(shutil.make_archive(str(folder), "zip", folder.parent, folder.name))


def _cube(result: Result) -> RadarCube:
    if result.cube is None:
        raise InputError("the log holds points and no signal; export points.npz or the page")
    return result.cube
