"""Live: chunks of one motion without a break, on one scale, and sentences that come while it runs."""

import numpy as np
import pytest

from mmweaver import Weaver
from mmweaver.core.errors import InputError
from mmweaver.studio.live import Live
from mmweaver.studio.schemas import Form
from mmweaver.viz.body_in_photo import unpack


def test_joints_go_on_from_chunk_to_chunk():
    weaver = Weaver()
    live = Live(weaver, weaver.sample_room(), Form(room="demo", text=["a person waves with the left hand"]))
    chunks = [unpack(live.next_chunk()) for _ in range(2)]
    live.say("a person claps")
    chunks += [unpack(live.next_chunk()) for _ in range(3)]
    joints_m = np.concatenate([arrays["joints"][0] for _, arrays in chunks])
    period_s = chunks[0][0]["frame_period_s"]
    assert np.abs(np.diff(joints_m[:, 0], axis=0)).max() / period_s < 1.5  # the pelvis never jumps
    assert len({(header["db"]["low"], header["db"]["high"]) for header, _ in chunks}) == 1
    firsts = [header["live"]["first_frame"] for header, _ in chunks]
    frames = [header["frames"] for header, _ in chunks]
    assert firsts == list(np.cumsum([0, *frames[:-1]]))
    assert "clap" in chunks[-1][0]["live"]["text"]
    assert chunks[-1][0]["live"]["times_real_time"] > 0


def test_an_unknown_first_sentence_is_refused():
    weaver = Weaver()
    live = Live(weaver, weaver.sample_room(), Form(room="demo", text=["a person flies to the moon"]))
    with pytest.raises(InputError):
        live.next_chunk()


def test_one_person_only():
    weaver = Weaver()
    with pytest.raises(InputError, match="one person"):
        Live(weaver, weaver.sample_room(), Form(room="demo", text=["a person waves", "a person sits"]))
