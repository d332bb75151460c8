"""mmweaver view: a result folder as one HTML file that plays in any browser."""

import webbrowser
from pathlib import Path
from typing import TYPE_CHECKING, Any

from mmweaver.cli.arguments import General
from mmweaver.core.errors import InputError
from mmweaver.core.options import MISSING, option, options
from mmweaver.core.output_checks import check_output_file

if TYPE_CHECKING:
    from mmweaver.io.stored_result import StoredResult
    from mmweaver.viz.sequence import Playback

EXAMPLES = """examples:
  mmweaver view walk/                       # writes walk/view.html and opens it
  mmweaver view walk/ -o walk.html --no-browser
"""


@options
class Options(General):
    """Writes one HTML file with the result inside: people, points and maps over time. It needs no server and no network
    connection, so it can be sent to others.
    """

    folder: Path = option("a folder of mmweaver generate or mmweaver process", "DIR", default=MISSING, positional=True)
    out: Path | None = option("the file (default: view.html in the folder)", "HTML", short="-o")
    overwrite: bool = option("replace the file where it exists", default=False)
    no_browser: bool = option("do not open it", default=False)


def run(asked: Options) -> int:
    """Writes the page.

    Raises:
        InputError: If the folder contains no result.
    """
    if asked.folder.is_file():
        raise InputError(f"{asked.folder} is a file; give a folder of mmweaver generate or mmweaver process")
    out = asked.out or asked.folder / "view.html"
    check_output_file(out, overwrite=asked.overwrite)
    from mmweaver.io.stored_result import read_result
    from mmweaver.viz.html_page import write_page
    from mmweaver.viz.sequence import make_playback

    stored = read_result(asked.folder)
    sequence = make_playback(stored.cube, stored.points, stored.poses, stored.meta)
    write_page(out, sequence, _room(stored), stored.title)
    print(out)
    if not asked.no_browser:
        webbrowser.open(out.resolve().as_uri())
    return 0


def _room(stored: "StoredResult") -> "Playback | None":
    """The room of a generated result, read again if its files are unchanged; a result folder contains none."""
    inputs = stored.meta.get("inputs")
    if not stored.poses or not isinstance(inputs, dict):
        return None
    from mmweaver.viz.html_page import OFFLINE_ROOM_POINTS
    from mmweaver.viz.sequence import room_playback
    from mmweaver.weaver.front_door import Weaver

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
