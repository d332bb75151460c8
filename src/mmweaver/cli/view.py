"""mmweaver view: a result folder as one HTML file that plays in any browser."""

import argparse
import subprocess
import sys
import webbrowser
from pathlib import Path
from typing import TYPE_CHECKING, Any

from mmweaver.core.errors import InputError
from mmweaver.core.optional_packages import need
from mmweaver.core.output_checks import check_output_file

if TYPE_CHECKING:
    from mmweaver.playback.sequence import Playback
    from mmweaver.stored_result import StoredResult

EXAMPLES = """examples:
  mmweaver view walk/                       # writes walk/view.html and opens it
  mmweaver view walk/ -o walk.html --no-browser
  mmweaver view rerun/result.rrd            # of mmweaver export --to rerun: opens Rerun's viewer
"""


def add_command(commands: Any) -> argparse.ArgumentParser:
    """Declares the command and its options."""
    parser = commands.add_parser(
        "view", help="play a result folder in the browser", epilog=EXAMPLES,
        description="Writes one HTML file with the result inside: people, points and maps over time. It needs no"
        " server and no network connection, so it can be sent to others.",
    )  # fmt: skip
    parser.add_argument(
        "folder", type=Path, metavar="DIR|RRD",
        help="a folder of mmweaver generate or mmweaver process, or a Rerun recording of mmweaver export",
    )  # fmt: skip
    parser.add_argument("-o", "--out", type=Path, metavar="HTML", help="the file (default: view.html in the folder)")
    parser.add_argument("--overwrite", action="store_true", help="replace the file where it exists")
    parser.add_argument("--no-browser", action="store_true", help="do not open it")
    parser.set_defaults(run=run)
    return parser


def run(arguments: argparse.Namespace) -> int:
    """Writes the page, or opens Rerun's viewer. Raises InputError for a folder that holds no result."""
    if arguments.folder.suffix == ".rrd" and not arguments.folder.is_dir():
        return _open_rerun(arguments)
    out = arguments.out or arguments.folder / "view.html"
    check_output_file(out, overwrite=arguments.overwrite)
    from mmweaver.playback.html_page import write_page
    from mmweaver.playback.sequence import make_playback
    from mmweaver.stored_result import read_result

    stored = read_result(arguments.folder)
    sequence = make_playback(stored.cube, stored.points, stored.poses, stored.meta)
    write_page(out, sequence, _room(stored), stored.title)
    print(out)
    if not arguments.no_browser:
        webbrowser.open(out.resolve().as_uri())
    return 0


def _open_rerun(arguments: argparse.Namespace) -> int:
    """Rerun's own viewer, of the installed package; nothing is fetched."""
    if arguments.out is not None or arguments.no_browser:
        raise InputError(f"{arguments.folder} is opened in Rerun's viewer; leave out --out and --no-browser")
    if not arguments.folder.is_file():
        raise InputError(f"{arguments.folder} does not exist; make one: mmweaver export DIR --to rerun --out OUT")
    need("rerun", "Rerun's viewer", "rerun")
    return subprocess.run([sys.executable, "-m", "rerun", str(arguments.folder)], check=False).returncode


def _room(stored: "StoredResult") -> "Playback | None":
    """The room of a generated result, where its files are still what they were; a result folder holds none."""
    inputs = stored.meta.get("inputs")
    if not stored.poses or not isinstance(inputs, dict):
        return None
    from mmweaver.generate import Weaver
    from mmweaver.playback.html_page import OFFLINE_ROOM_POINTS
    from mmweaver.playback.room import room_playback

    weaver = Weaver(method="physics")
    if "sample" in inputs:
        room = weaver.sample_room()
    elif (rgb := _same(inputs, "rgb")) is not None and (depth := _same(inputs, "depth")) is not None:
        room = weaver.read_room(rgb, depth, _same(inputs, "camera"))
    else:
        return None
    range_m = stored.cube.grid.range_m
    return room_playback(room.scene, "room", (float(range_m[0]), float(range_m[-1])), max_points=OFFLINE_ROOM_POINTS)


def _same(inputs: dict[str, Any], name: str) -> Path | None:
    """An input file that has not changed since."""
    from mmweaver.core.checksums import sha256_of_file

    said = inputs.get(name)
    if not isinstance(said, dict):
        return None
    path = said.get("path")
    if not isinstance(path, str) or not Path(path).is_file() or sha256_of_file(Path(path)) != said.get("sha256"):
        return None
    return Path(path)
