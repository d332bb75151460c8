"""mmweaver view: a result folder as one HTML file that plays in any browser."""

import argparse
import webbrowser
from pathlib import Path
from typing import Any

from mmweaver.core.output_checks import check_output_file

EXAMPLES = """examples:
  mmweaver view walk/                       # writes walk/view.html and opens it
  mmweaver view walk/ -o walk.html --no-browser
"""


def add_command(commands: Any) -> argparse.ArgumentParser:
    """Declares the command and its options."""
    parser = commands.add_parser(
        "view", help="play a result folder in the browser", epilog=EXAMPLES,
        description="Writes one HTML file with the result inside: people, points and maps over time. It needs no"
        " server and no network connection, so it can be sent to others.",
    )  # fmt: skip
    parser.add_argument("folder", type=Path, metavar="DIR", help="a folder of mmweaver generate or mmweaver process")
    parser.add_argument("-o", "--out", type=Path, metavar="HTML", help="the file (default: view.html in the folder)")
    parser.add_argument("--overwrite", action="store_true", help="replace the file where it exists")
    parser.add_argument("--no-browser", action="store_true", help="do not open it")
    parser.set_defaults(run=run)
    return parser


def run(arguments: argparse.Namespace) -> int:
    """Writes the page. Raises InputError for a folder that holds no result."""
    out = arguments.out or arguments.folder / "view.html"
    check_output_file(out, overwrite=arguments.overwrite)
    from mmweaver.playback.html_page import write_page
    from mmweaver.playback.sequence import make_playback
    from mmweaver.stored_result import read_result

    stored = read_result(arguments.folder)
    write_page(out, make_playback(stored.cube, stored.points, stored.poses, stored.meta), None, stored.title)
    print(out)
    if not arguments.no_browser:
        webbrowser.open(out.resolve().as_uri())
    return 0
