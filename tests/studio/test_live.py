"""Live: chunks of one motion without a break, on one scale, and sentences that come while it runs."""

from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest

from mmweaver import Weaver
from mmweaver.core.errors import InputError
from mmweaver.core.records import PoseSequence
from mmweaver.studio.live import Live
from mmweaver.studio.schemas import Form
from mmweaver.viz.body_in_photo import unpack
from mmweaver.weaver.streaming import StreamChunk


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


class Watched(Weaver):
    """Keeps the dense motion of all that it streams."""

    def stream(self, *arguments: Any, **options: Any) -> Iterator[StreamChunk]:
        self.motions: list[PoseSequence] = []
        for chunk in super().stream(*arguments, **options):
            self.motions.append(chunk.motions[0])
            yield chunk


@pytest.mark.slow  # test_joints_go_on_from_chunk_to_chunk holds the pelvis
def test_no_joint_jumps_in_twenty_seconds():
    """No joint moves 5 cm between two samples of 120 Hz, within chunks, between them and between sentences."""
    weaver = Watched()
    live = Live(weaver, weaver.sample_room(), Form(room="demo", text=["a person walks to the left"]))
    said = iter(["a person claps", "a person sits down", "a person stands up, then waves", "a person walks"])
    frames = 0
    while frames < 200:
        header, _ = unpack(live.next_chunk())
        frames = header["live"]["frames"]
        if frames % 40 < 10:
            live.say(next(said, ""))
    time_s = np.concatenate([one.time_s for one in weaver.motions])
    joints_m = np.concatenate([one.joints_m for one in weaver.motions])
    order = np.argsort(time_s, kind="stable")
    time_s, joints_m = time_s[order], joints_m[order]
    assert np.diff(time_s).max() < 1.5 / 120
    assert np.linalg.norm(np.diff(joints_m, axis=0), axis=-1).max() < 0.05
