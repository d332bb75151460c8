"""Export of results and sets to other formats."""

import shutil
from collections.abc import Iterator
from pathlib import Path
from tempfile import TemporaryDirectory

from mmweaver.core.atomic_files import atomic_file, staged_folder
from mmweaver.core.errors import InputError

# imported to register their formats
from mmweaver.datasets import cloud_layouts, containers, rerun_file, robotics, tensor_layouts, videos  # noqa: F401
from mmweaver.datasets.formats import FORMATS
from mmweaver.datasets.set_results import results_of_set
from mmweaver.io.result_folder import radar_folder
from mmweaver.io.stored_result import StoredResult, read_result


def export_result(folder: Path | str, kind: str, out: Path | str, *, overwrite: bool = False) -> str:
    """Exports a result folder to another format, completely or not at all.

    Args:
        folder: The result; for some formats a folder of two radars of one scene.
        kind: Key of FORMATS.
        out: Output folder, or the file of a single-file format.
        overwrite: Whether files may be replaced. Default: False.

    Returns:
        Description of what was written.

    Raises:
        InputError: If the format is unknown, the folder is not a result, or the format cannot represent it.
    """
    if kind not in FORMATS:
        raise InputError(f"unknown format {kind!r}; known: {', '.join(FORMATS)}")
    if (write_pair := FORMATS[kind].write_pair) is not None and is_of_two_radars(Path(folder), kind):
        both = [read_result(Path(folder) / radar_folder(number)) for number in (1, 2)]
        with staged_folder(Path(out), overwrite=overwrite) as stage:
            return write_pair(both[0], both[1], stage)
    return export_stored(read_result(Path(folder)), kind, out, overwrite=overwrite)


def export_stored(result: StoredResult, kind: str, out: Path | str, *, overwrite: bool = False) -> str:
    """Exports a result in memory, as `export_result` does.

    Args:
        result: The result.
        kind: Key of FORMATS.
        out: Output folder; with the suffix of a single-file format, such as walk.mp4, the file.
        overwrite: Whether files may be replaced. Default: False.

    Returns:
        Description of what was written.

    Raises:
        InputError: If the file exists without `overwrite`, or the format cannot represent the result.
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
    """Exports every sequence of a set, labelled or of rooms, to its own folder below `out`.

    Args:
        folder: The set.
        kind: Key of FORMATS.
        out: Parent folder.
        overwrite: Whether files may be replaced. Default: False.

    Yields:
        Each folder with a description of its content.

    Raises:
        InputError: If the format needs raw samples, which sets do not contain, or the folder is not a set.
    """
    if FORMATS[kind].needs_samples:
        raise InputError(f"{kind} needs raw samples, which a set does not keep; generate results with --bin")
    for name, result in results_of_set(Path(folder)):
        yield Path(out) / name, export_stored(result, kind, Path(out) / name, overwrite=overwrite)


def is_of_two_radars(folder: Path, kind: str) -> bool:
    """Whether a folder contains results of several radars of one scene that the format combines."""
    two = [folder / radar_folder(number) / "radar.npz" for number in (1, 2)]
    return FORMATS[kind].write_pair is not None and all(file.is_file() for file in two)
