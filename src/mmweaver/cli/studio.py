"""mmweaver studio: a page in the browser on which radar data is made, watched and exported."""

import argparse
from functools import partial
from pathlib import Path
from typing import Any

from mmweaver.core.errors import InputError
from mmweaver.core.optional_packages import need

EXAMPLES = """examples:
  mmweaver studio                                   # the bundled room, at http://127.0.0.1:8765
  mmweaver studio --room living_room/ --room lab/   # folders with rgb.png, depth.png and camera.json
  mmweaver studio --recording capture/ --recording walk/   # recordings and results to watch and compare with
  mmweaver studio --host 0.0.0.0                    # for others, who need the token that it prints
"""
DEFAULT_PORT = 8765
LOOPBACK = "127.0.0.1"


def add_command(commands: Any) -> argparse.ArgumentParser:
    """Declares the command and its options."""
    parser = commands.add_parser(
        "studio", help="make and watch radar data in the browser", epilog=EXAMPLES,
        description="Serves a page on which a sentence makes radar data at once: the room in 3D, maps, micro-Doppler,"
        " comparison and export. Nothing is fetched from outside. Needs the extra: pip install 'mmweaver[studio]'.",
    )  # fmt: skip
    parser.add_argument(
        "--room", type=Path, action="append", default=[], metavar="DIR",
        help="a folder with rgb.png, depth.png and camera.json; once more for each further room",
    )  # fmt: skip
    parser.add_argument(
        "--recording", type=Path, action="append", default=[], metavar="PATH",
        help="a result folder, a stream, a capture, a .dat, or a folder with a .bin and its .cfg;"
        " once more for each further one",
    )  # fmt: skip
    parser.add_argument(
        "--recogniser", type=Path, action="append", default=[], metavar="DIR",
        help="a folder of mmweaver recognise train, whose labels Live shows; once more for each further one",
    )  # fmt: skip
    parser.add_argument(
        "--host", default=LOOPBACK, help=f"address to listen on (default {LOOPBACK}: this machine only)"
    )
    parser.add_argument(
        "--port", type=int, default=DEFAULT_PORT, help=f"port (default {DEFAULT_PORT}; 0: any free one)"
    )
    parser.add_argument("--workers", type=int, metavar="N", help="sequences made at a time (default: one per core)")
    parser.add_argument("--no-browser", action="store_true", help="do not open a browser")
    parser.set_defaults(run=run)
    return parser


def run(arguments: argparse.Namespace) -> int:
    """Serves until interrupted. Raises InputError for a port that is taken or a room that is none."""
    if not 0 <= arguments.port <= 65535:
        raise InputError(f"the port must be 0 to 65535, not {arguments.port}")
    if arguments.workers is not None and not 1 <= arguments.workers <= 64:
        raise InputError(f"--workers must be 1 to 64, not {arguments.workers}")
    need("studio", "the studio")
    from mmweaver.studio.serve import serve

    serve(
        arguments.room, arguments.recording, arguments.recogniser, host=arguments.host, port=arguments.port,
        workers=arguments.workers, announce=partial(print, flush=True), open_browser=not arguments.no_browser,
    )  # fmt: skip
    return 0
