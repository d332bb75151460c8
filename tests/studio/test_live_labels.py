"""Labels of a recogniser while a stream is made."""

from pathlib import Path

import pytest

from mmweaver import Weaver
from mmweaver.core.errors import InputError
from mmweaver.recognition.recogniser import load_recogniser, save_recogniser
from mmweaver.studio.live import Live
from mmweaver.studio.schemas import Form
from mmweaver.studio.service import Offered, Service
from mmweaver.viz.body_in_photo import unpack
from tests.recognition.small_recogniser import small_recogniser

TASK = """radar = "awr1843"
window_s = 1.5

[activities]
a_rest = ["a person stands"]
b_moving = ["a person walks back and forth"]

[recordings]
frame_rate_hz = 10.0
"""


def test_live_says_what_is_recognised(tmp_path: Path):
    """The first label comes with the first whole window, and is the one that the whole recording gets."""
    (tmp_path / "task.toml").write_text(TASK)
    save_recogniser(tmp_path / "rest_or_not", small_recogniser(tmp_path / "task.toml"))
    offered = Offered("recogniser", [tmp_path / "rest_or_not"], load_recogniser)
    model = offered.get("rest_or_not")
    weaver = Weaver()
    live = Live(weaver, weaver.sample_room(), Form(room="demo", text=["a person walks"]), recogniser=model)
    labels = [unpack(live.next_chunk())[0]["live"]["label"] for _ in range(3)]
    assert labels[0] is None
    assert labels[1]["label"] in model.labels
    assert 0.5 <= labels[1]["share"] <= 1
    assert isinstance(labels[2]["is_outside"], bool)
    with pytest.raises(InputError, match="not known"):
        offered.get("/etc")


def test_what_is_no_recogniser_is_said(tmp_path: Path):
    with pytest.raises(InputError, match="holds no recogniser"):
        Service(recognisers=[tmp_path])
