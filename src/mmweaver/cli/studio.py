"""mmweaver studio: a page in the browser on which radar data is made, watched and exported."""

from functools import partial
from pathlib import Path

from mmweaver.cli.arguments import General
from mmweaver.core.errors import InputError
from mmweaver.core.optional_packages import need
from mmweaver.core.options import option, options

EXAMPLES = """examples:
  mmweaver studio                                   # the bundled room, at http://127.0.0.1:8765
  mmweaver studio --room living_room/ --room lab/   # folders with rgb.png, depth.png and camera.json
  mmweaver studio capture/ walk/       # recordings and results to watch and compare with
  mmweaver studio --host 0.0.0.0                    # for others, who need the token that it prints
"""


@options
class Options(General):
    """Serves a page on which a sentence makes radar data at once: the room in 3D, maps, micro-Doppler, comparison and
    export. Nothing is fetched from outside. Needs the extra: pip install 'mmweaver[studio]'.
    """

    paths: list[Path] | None = option(
        "to watch and compare with: result folders, streams, captures, .dat, folders with a .bin and its .cfg; or a"
        " folder of mmweaver recognise train, whose labels Live shows",
        "PATH",
        positional=True,
    )
    room: list[Path] | None = option(
        "a folder with rgb.png, depth.png and camera.json; once more for each further room", "DIR"
    )
    host: str = option("address to listen on; the default is this machine only", "ADDRESS", default="127.0.0.1")
    port: int = option("port; 0 is any free one", "N", default=8765)
    workers: int | None = option("sequences made at a time (default: one per core)", "N")
    no_browser: bool = option("do not open a browser", default=False)


def run(asked: Options) -> int:
    """Serves until interrupted.

    Raises:
        InputError: If the port is taken, or a folder is not a room.
    """
    if not 0 <= asked.port <= 65535:
        raise InputError(f"the port must be 0 to 65535, not {asked.port}")
    if asked.workers is not None and not 1 <= asked.workers <= 64:
        raise InputError(f"--workers must be 1 to 64, not {asked.workers}")
    need("studio", "the studio")
    from mmweaver.recognition.recogniser import TREES_FILE
    from mmweaver.studio.server import serve

    paths = asked.paths or []
    recognisers = [path for path in paths if (path / TREES_FILE).is_file()]
    recordings = [path for path in paths if path not in recognisers]
    serve(
        asked.room or [],
        recordings,
        recognisers,
        host=asked.host,
        port=asked.port,
        workers=asked.workers,
        announce=partial(print, flush=True),
        open_browser=not asked.no_browser,
    )
    return 0
