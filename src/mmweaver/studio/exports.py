"""What the studio exports: the same files as the command line writes for the same request."""

import shutil
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory

from mmweaver.core.errors import InputError
from mmweaver.core.safe_files.regular_files import read_bytes
from mmweaver.figures.figure_data import FigureData
from mmweaver.formats.npz_files import write_radar_npz
from mmweaver.geometry.aligned_photo import AlignedPhoto
from mmweaver.playback.html_page import write_page
from mmweaver.result_folder import save_results
from mmweaver.studio.sessions import Result

MAX_EXPORT_BYTES = 4_000_000_000
Export = Callable[[Result, Path], Path]  # writes into a folder and returns the file


def _radar_npz(result: Result, folder: Path) -> Path:
    write_radar_npz(folder / "radar.npz", result.cube)
    return folder / "radar.npz"


def _folder(result: Result, folder: Path) -> Path:
    aligned = None if result.scene is None else AlignedPhoto.of(result.scene)
    view = FigureData(title=_title(result), cube=result.cube, points=result.points, aligned=aligned, poses=result.poses)
    if result.generation is not None:
        view = replace(view, motions=result.generation.motions)
    save_results(folder / "result", view, result.meta)
    return Path(shutil.make_archive(str(folder / "result"), "zip", folder, "result"))


def _html(result: Result, folder: Path) -> Path:
    page = folder / "mmweaver.html"
    if result.generation is not None:
        result.generation.save_html(page)
    else:
        write_page(page, result.playback(), None, _title(result))
    return page


EXPORTS: dict[str, tuple[str, Export]] = {
    "npz": ("radar.npz", _radar_npz),
    "folder": ("result folder (zip)", _folder),
    "html": ("page that plays offline (html)", _html),
}


def export(result: Result, kind: str) -> tuple[str, bytes]:
    """The name and the bytes of a result in one of the formats of `EXPORTS`. Raises InputError for another."""
    if kind not in EXPORTS:
        raise InputError(f"unknown format {kind!r}; known: {', '.join(EXPORTS)}")
    with TemporaryDirectory(prefix="mmweaver-export-") as folder:
        file = EXPORTS[kind][1](result, Path(folder))
        return file.name, read_bytes(file, max_bytes=MAX_EXPORT_BYTES)


def _title(result: Result) -> str:
    text = result.meta.get("text") or ""
    return f"{text if isinstance(text, str) else ' | '.join(text)}   ({result.cube.config.name})"
