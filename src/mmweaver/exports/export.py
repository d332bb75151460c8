"""The table of formats, and the one function that writes any of them."""

import shutil
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from importlib import import_module
from pathlib import Path
from tempfile import TemporaryDirectory

from mmweaver.core.atomic_files import atomic_file, staged_folder
from mmweaver.core.errors import InputError
from mmweaver.exports.set_results import results_of_set
from mmweaver.formats.result_folder import radar_folder
from mmweaver.formats.stored_result import StoredResult, read_result


@dataclass(frozen=True, kw_only=True)
class Format:
    """One format: what it is, and the function that writes it into a folder."""

    what: str
    module: str
    function: str
    needs_samples: bool = False
    ending: str = ""  # of the one file that it writes, where it does
    of_two_radars: str | None = None  # the function that writes two radars of one scene together

    def writer(self) -> Callable:
        """The function, imported at its first use: most formats need a package of their own."""
        return getattr(import_module(f"mmweaver.exports.{self.module}"), self.function)

    def writer_of_two(self) -> Callable:
        """The function for two radars of one scene."""
        return getattr(import_module(f"mmweaver.exports.{self.module}"), self.of_two_radars or "")


FORMATS = {
    "hupr": Format(
        what="HuPR's range-Doppler-angle arrays",
        module="tensor_layouts",
        function="write_hupr",
        needs_samples=True,
        of_two_radars="write_hupr_pair",
    ),
    "mmmesh": Format(what="mmMesh's point frames", module="tensor_layouts", function="write_mmmesh"),
    "rf_genesis": Format(
        what="RF-Genesis' radar frames", module="tensor_layouts", function="write_rf_genesis", needs_samples=True
    ),
    "drai": Format(what="dynamic range-angle images, 32 x 32", module="tensor_layouts", function="write_drai"),
    "radhar": Format(what="RadHAR's text of points", module="cloud_layouts", function="write_radhar"),
    "mars": Format(what="MARS's tables of points and joints", module="cloud_layouts", function="write_mars"),
    "mat": Format(what="MATLAB", module="containers", function="write_mat", ending=".mat"),
    "netcdf": Format(what="netCDF 3, for xarray", module="containers", function="write_netcdf", ending=".nc"),
    "zarr": Format(what="Zarr 3, for xarray", module="containers", function="write_zarr"),
    "ros2": Format(what="ROS 2 bag", module="robotics", function="write_ros2"),
    "mcap": Format(what="MCAP, for Foxglove", module="robotics", function="write_mcap", ending=".mcap"),
    "rerun": Format(what="Rerun recording (.rrd)", module="rerun_file", function="write_rerun", ending=".rrd"),
    "results": Format(
        what="a result folder, of each sequence of a set", module="set_results", function="write_results"
    ),
    "mp4": Format(what="video, H.264", module="videos", function="write_mp4", ending=".mp4"),
    "webm": Format(what="video, VP9", module="videos", function="write_webm", ending=".webm"),
}


def export_result(folder: Path | str, kind: str, out: Path | str, *, overwrite: bool = False) -> str:
    """Writes a result folder in another format into the folder `out`, or nothing; says what was written.

    `kind` is a name in FORMATS; for some of them `folder` may hold two radars of one scene. Raises InputError for
    another name, for a folder that is no result, and for a result that the format cannot hold.
    """
    if kind not in FORMATS:
        raise InputError(f"unknown format {kind!r}; known: {', '.join(FORMATS)}")
    if is_of_two_radars(Path(folder), kind):
        both = [read_result(Path(folder) / radar_folder(number)) for number in (1, 2)]
        with staged_folder(Path(out), overwrite=overwrite) as stage:
            return FORMATS[kind].writer_of_two()(*both, stage)
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
            what = FORMATS[kind].writer()(result, Path(folder))
            shutil.copyfile(Path(folder) / f"result{ending}", file)
        return what
    with staged_folder(Path(out), overwrite=overwrite) as stage:
        return FORMATS[kind].writer()(result, stage)


def export_set(
    folder: Path | str, kind: str, out: Path | str, *, overwrite: bool = False
) -> Iterator[tuple[Path, str]]:
    """Writes every sequence of a set, labelled or of rooms, into a folder of its own below `out`; gives each with what
    it holds.

    Raises InputError for a format that needs raw samples, which a set does not keep, and for what is no set.
    """
    if FORMATS[kind].needs_samples:
        raise InputError(f"{kind} needs raw samples, which a set does not keep; generate results with --bin")
    for name, result in results_of_set(Path(folder)):
        yield Path(out) / name, export_stored(result, kind, Path(out) / name, overwrite=overwrite)


def is_of_two_radars(folder: Path, kind: str) -> bool:
    """Whether a folder holds the results of several radars of one scene, and the format takes two together."""
    two = [folder / radar_folder(number) / "radar.npz" for number in (1, 2)]
    return FORMATS[kind].of_two_radars is not None and all(file.is_file() for file in two)
