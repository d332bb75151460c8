"""The player in a notebook gets the same bytes and the same script as the page."""

import numpy as np
import pytest

from mmweaver.viz.body_in_photo import unpack
from mmweaver.viz.html_page import page_file
from mmweaver.viz.notebook import player_widget
from mmweaver.viz.sequence import Playback


def test_the_widget_holds_script_and_data():
    pytest.importorskip("anywidget", reason="the extra 'notebook' is not installed")
    sequence = Playback(header={"frames": 1}, arrays={"range_time": np.zeros((1, 4), np.uint8)})
    widget = player_widget(sequence, None)
    assert unpack(widget.sequence)[0] == {"frames": 1}
    assert widget.room is None
    assert len(page_file("mmweaver.js")) > 100_000
    assert "render" in page_file("mmweaver.js").decode()
