"""The page's player as a widget of a notebook, by anywidget."""

from typing import Any

from mmweaver.core.optional_packages import need
from mmweaver.viz.body_in_photo import pack
from mmweaver.viz.html_page import page_file
from mmweaver.viz.sequence import Playback


def player_widget(sequence: Playback, room: Playback | None) -> Any:
    """An anywidget.AnyWidget that plays a sequence.

    Args:
        sequence: The sequence.
        room: Its room, if known.

    Raises:
        InputError: If the extra 'notebook' is not installed.
    """
    need("notebook", "show()", "anywidget")
    import anywidget
    import traitlets

    class PlayerWidget(anywidget.AnyWidget):
        _esm = page_file("mmweaver.js").decode()
        sequence = traitlets.Bytes().tag(sync=True)
        room = traitlets.Bytes(None, allow_none=True).tag(sync=True)

    return PlayerWidget(
        sequence=pack(sequence.header, sequence.arrays), room=None if room is None else pack(room.header, room.arrays)
    )
