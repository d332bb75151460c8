"""A single HTML file that plays a result in any browser without a network connection."""

import html
from base64 import b64encode
from functools import cache
from pathlib import Path

from mmweaver.core.atomic_files import atomic_file
from mmweaver.core.errors import InputError
from mmweaver.core.safe_files.regular_files import MEGABYTE, read_bytes
from mmweaver.viz.body_in_photo import pack
from mmweaver.viz.sequence import Playback

OFFLINE_ROOM_POINTS = 30_000

_PAGE = """<!doctype html>
<html lang="en"><head><meta charset="utf-8"><meta name="viewport" content="width=device-width, initial-scale=1">
<meta http-equiv="Content-Security-Policy"
 content="default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; img-src data: blob:">
<title>{title}</title>
<style>html,body{{margin:0;height:100%}} #page{{min-height:100%;height:100vh;display:flex;flex-direction:column;
padding:8px;box-sizing:border-box;overflow:auto}} #page .player{{flex:1}}</style></head>
<body data-page="offline"><main id="page"></main>
{data}
<script type="module">{script}</script></body></html>
"""


@cache
def page_file(name: str) -> bytes:
    """A file of the page, as built into the package.

    Args:
        name: Name of the file.

    Raises:
        InputError: If the installation lacks it.
    """
    file = Path(__file__).with_name("page") / name
    if not file.is_file():
        raise InputError(f"this installation lacks the page's file {name}; install mmweaver anew")
    return read_bytes(file, max_bytes=10 * MEGABYTE)


def offline_page(sequence: Playback, room: Playback | None, title: str) -> str:
    """The page as text, with script and data embedded.

    Args:
        sequence: The sequence.
        room: Its room, if known.
        title: Title of the page.
    """
    parts = {"sequence": sequence, "room": room}
    data = "\n".join(
        f'<script type="application/octet-stream" id="{name}">'
        f"{b64encode(pack(part.header, part.arrays)).decode()}</script>"
        for name, part in parts.items()
        if part is not None
    )
    script = page_file("mmweaver.js").decode().replace("</script", "<\\/script")
    return _PAGE.format(title=html.escape(title), data=data, script=script)


def write_page(path: Path, sequence: Playback, room: Playback | None, title: str) -> None:
    """Writes the page atomically.

    Args:
        path: The HTML file.
        sequence: The sequence.
        room: Its room, if known.
        title: Title of the page.

    Raises:
        InputError: If it cannot be written.
    """
    with atomic_file(path) as temporary:
        temporary.write_text(offline_page(sequence, room, title), encoding="utf-8")
