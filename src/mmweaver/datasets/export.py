"""Writes results and sets in any format."""

import shutil
from collections.abc import Iterator
from pathlib import Path
from tempfile import TemporaryDirectory

from mmweaver.core.atomic_files import atomic_file, staged_folder
from mmweaver.core.errors import InputError

# imported for their formats, which register themselves
from mmweaver.datasets import cloud_layouts, containers, rerun_file, robotics, tensor_layouts, videos  # noqa: F401
from mmweaver.datasets.formats import FORMATS
from mmweaver.datasets.set_results import results_of_set
from mmweaver.io.result_folder import radar_folder
from mmweaver.io.stored_result import StoredResult, read_result


def export_result(folder: Path | str, kind: str, out: Path | str, *, overwrite: bool = False) -> str:
    """Writes a result folder in another format, or nothing.

    Args:
        folder: The result; for some formats a folder of two radars of one scene.
        kind: Name in FORMATS.
        out: Folder that is written, or the one file of a format that has one.
        overwrite: Whether files may be replaced.

    Returns:
        What was written, in words.

    Raises:
        InputError: for another name, for a folder that is no result, and for a result that the format cannot hold.
    """
    if kind not in FORMATS:
        raise InputError(f"unknown format {kind!r}; known: {', '.join(FORMATS)}")
    if (write_pair := FORMATS[kind].write_pair) is not None and is_of_two_radars(Path(folder), kind):
        both = [read_result(Path(folder) / radar_folder(number)) for number in (1, 2)]
        with staged_folder(Path(out), overwrite=overwrite) as stage:
            return write_pair(both[0], both[1], stage)
    return export_stored(read_result(Path(folder)), kind, out, overwrite=overwrite)


def export_stored(result: StoredResult, kind: str, out: Path | str, *, overwrite: bool = False) -> str:
    """Writes a result in another format into the folder `out`, as `export_result` does.

    With the ending of a format of one file, as in walk.mp4, `out` is that file.
    """
    out, ending = Path(out), FORMATS[kind].ending
    if ending and out.suffix == ending and not out.is_dir():
        if out.exists() and not overwrite:
            raise InputError(f"{out} exists; choose another name, or add --overwrite")
        with atomic_file(out) as file, TemporaryDirectory() as folder:
            what = FORMATS[kind].write(result, Path(folder))
            shutil.copyfile(Path(folder) / f"result{ending}", file)
        return what
    with staged_folder(Path(out), overwrite=overwrite) as stage:
        return FORMATS[kind].write(result, stage)


def export_set(
    folder: Path | str, kind: str, out: Path | str, *, overwrite: bool = False
) -> Iterator[tuple[Path, str]]:
    """Writes every sequence of a set, labelled or of rooms, into a folder of its own below `out`.

    Args:
        folder: The set.
        kind: Name in FORMATS.
        out: Folder of the folders.
        overwrite: Whether files may be replaced.

    Yields:
        Each folder with what it holds.

    Raises:
        InputError: for a format that needs raw samples, which a set does not keep, and for what is no set.
    """
    if FORMATS[kind].needs_samples:
        raise InputError(f"{kind} needs raw samples, which a set does not keep; generate results with --bin")
    for name, result in results_of_set(Path(folder)):
        yield Path(out) / name, export_stored(result, kind, Path(out) / name, overwrite=overwrite)


def is_of_two_radars(folder: Path, kind: str) -> bool:
    """Whether a folder holds the results of several radars of one scene, and the format takes two together."""
    two = [folder / radar_folder(number) / "radar.npz" for number in (1, 2)]
    return FORMATS[kind].write_pair is not None and all(file.is_file() for file in two)
