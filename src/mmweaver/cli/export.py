"""mmweaver export: results in the formats of other tools."""

from pathlib import Path

from mmweaver.cli.option_groups import Written
from mmweaver.core.options import option, options

EXAMPLES = """examples:
  mmweaver export walk/ --to mat --out walk_mat/
  mmweaver export walk/ --to ros2 --out walk_bag/
  mmweaver generate --demo --radar hupr --bin --out walk/ && mmweaver export walk/ --to hupr --out hupr/
  mmweaver export set/ --to results --out folders/    # each sequence of a labelled set
  mmweaver export                                     # lists the formats
"""


@options
class Options(Written):
    """Writes result folders (or folders of results, such as --texts makes) for other tools: data-set layouts, MATLAB,
    netCDF, ROS 2, MCAP, Rerun and videos. Without a folder it lists the formats.
    """

    folder: Path | None = option("a result folder, a folder of them, or a labelled set", "DIR", positional=True)
    to: str | None = option("the format; mmweaver export lists them", "FORMAT")
    out: Path | None = option("folder for the files, or one file: walk.mp4", "DIR")


def run(asked: Options) -> int:
    """Exports one result or many.

    Raises:
        InputError: For a folder without results, or a format that is not available.
    """
    from mmweaver.core.errors import InputError
    from mmweaver.datasets.export import FORMATS, export_result, export_set, is_of_two_radars
    from mmweaver.datasets.room_sequences import is_set

    if asked.folder is None and asked.to is None:
        return _list(asked)
    if asked.folder is None or asked.to is None or asked.out is None:
        raise InputError("give a result folder, --to FORMAT and --out DIR (the formats: mmweaver export)")
    if asked.to not in FORMATS:
        raise InputError(f"unknown format {asked.to!r}; known: {', '.join(FORMATS)}")
    if is_set(asked.folder):
        every = export_set(asked.folder, asked.to, asked.out, overwrite=asked.overwrite)
        return _say({str(out): what for out, what in every}, asked)
    together = is_of_two_radars(asked.folder, asked.to)
    results = {asked.folder: ""} if together else _results(asked.folder)
    written = {}
    for folder, place in results.items():
        out = asked.out / place
        written[str(out)] = export_result(folder, asked.to, out, overwrite=asked.overwrite)
    return _say(written, asked)


def _list(asked: Options) -> int:
    from mmweaver.datasets.export import FORMATS

    listed = [{"format": name, "what": one.what, "needs_samples": one.needs_samples} for name, one in FORMATS.items()]
    notes = {True: " (needs samples: --bin)", False: ""}
    return asked.report(listed, *(f"{name:11s} {one.what}{notes[one.needs_samples]}" for name, one in FORMATS.items()))


def _say(written: dict[str, str], asked: Options) -> int:
    return asked.report(written, *(f"{out}: {what}" for out, what in written.items()))


def _results(folder: Path) -> dict[Path, str]:
    """Result folders, with their names below --out ("" for a single one). Raises InputError where there is none."""
    from mmweaver.core.errors import InputError
    from mmweaver.core.safe_files.regular_files import check_exists

    check_exists(folder, "a folder of mmweaver generate or mmweaver process")
    if (folder / "radar.npz").is_file():
        return {folder: ""}
    inside = sorted(file.parent for file in folder.glob("*/radar.npz")) if folder.is_dir() else []
    if not inside:
        raise InputError(f"{folder} holds no result; give a folder of mmweaver generate or mmweaver process")
    return {one: one.name for one in inside}
