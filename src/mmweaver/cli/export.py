"""mmweaver export: results in the formats of other tools."""

import argparse
from pathlib import Path
from typing import Any

EXAMPLES = """examples:
  mmweaver export walk/ --to mat --out walk_mat/
  mmweaver export walk/ --to ros2 --out walk_bag/
  mmweaver generate --demo --radar hupr --bin --out walk/ && mmweaver export walk/ --to hupr --out hupr/
  mmweaver export set/ --to results --out folders/    # each sequence of a labelled set
  mmweaver export --list
"""


def add_command(commands: Any) -> argparse.ArgumentParser:
    """Declares the command and its options."""
    parser = commands.add_parser(
        "export", help="write results in the formats of other tools", epilog=EXAMPLES,
        description="Writes result folders (or folders of results, such as --texts makes) for other tools: data-set"
        " layouts, MATLAB, netCDF, ROS 2, MCAP, Rerun and videos.",
    )  # fmt: skip
    parser.add_argument(
        "folder", type=Path, nargs="?", metavar="DIR", help="a result folder, a folder of them, or a labelled set"
    )
    parser.add_argument("--to", metavar="FORMAT", help="the format; --list names them")
    parser.add_argument("--out", type=Path, metavar="DIR", help="folder for the files, or one file: walk.mp4")
    parser.add_argument("--overwrite", action="store_true", help="replace files in --out")
    parser.add_argument("--list", action="store_true", help="list the formats")
    parser.add_argument("--json", action="store_true", help="print what was written, or --list, for machines")
    parser.set_defaults(run=run)
    return parser


def run(arguments: argparse.Namespace) -> int:
    """Exports one result or many. Raises InputError."""
    from mmweaver.core.errors import InputError
    from mmweaver.datasets.room_sequences import is_set
    from mmweaver.exports.export import FORMATS, export_result, export_set, is_of_two_radars

    if arguments.list:
        return _list(arguments)
    if arguments.folder is None or arguments.to is None or arguments.out is None:
        raise InputError("give a result folder, --to FORMAT and --out DIR (the formats: mmweaver export --list)")
    if arguments.to not in FORMATS:
        raise InputError(f"unknown format {arguments.to!r}; known: {', '.join(FORMATS)}")
    if is_set(arguments.folder):
        every = export_set(arguments.folder, arguments.to, arguments.out, overwrite=arguments.overwrite)
        return _say({str(out): what for out, what in every}, arguments)
    together = is_of_two_radars(arguments.folder, arguments.to)
    results = {arguments.folder: ""} if together else _results(arguments.folder)
    written = {}
    for folder, place in results.items():
        out = arguments.out / place
        written[str(out)] = export_result(folder, arguments.to, out, overwrite=arguments.overwrite)
    return _say(written, arguments)


def _list(arguments: argparse.Namespace) -> int:
    import json

    from mmweaver.exports.export import FORMATS

    if arguments.json:
        listed = [
            {"format": name, "what": one.what, "needs_samples": one.needs_samples} for name, one in FORMATS.items()
        ]
        print(json.dumps(listed, indent=2))
    else:
        for name, one in FORMATS.items():
            print(f"{name:11s} {one.what}{' (needs samples: --bin)' if one.needs_samples else ''}")
    return 0


def _say(written: dict[str, str], arguments: argparse.Namespace) -> int:
    import json

    if arguments.json:
        print(json.dumps(written, indent=2))
    else:
        for out, what in written.items():
            print(f"{out}: {what}")
    return 0


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
