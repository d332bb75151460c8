"""Sessions keep to themselves and leave nothing behind."""

from dataclasses import replace

import numpy as np
import pytest

from mmweaver.core.boards import AWR1843
from mmweaver.core.errors import InputError
from mmweaver.core.records import CubeGrid, PointCloud, RadarCube
from mmweaver.studio import sessions
from mmweaver.studio.sessions import Result, Sessions

NOTHING = PointCloud(
    frame=np.zeros(0, int), **{name: np.zeros(0) for name in ("x_m", "y_m", "z_m", "radial_velocity_mps", "snr_db")}
)


def result(frames: int = 1) -> Result:
    grid = CubeGrid.of(AWR1843, frames)
    cube = RadarCube(values=np.zeros(grid.shape, np.complex64), grid=grid, config=AWR1843, scale=1.0)
    return Result(cube=cube, points=NOTHING, poses=(), meta={})


def test_results_belong_to_their_session():
    both = Sessions()
    first, second = both.open(), both.open()
    name = first.add(result())
    assert first.result(name).cube.config is AWR1843
    with pytest.raises(InputError, match="no longer kept"):
        second.result(name)
    both.end_all()


def test_an_ended_session_takes_its_folder_along():
    one = Sessions()
    session = one.open()
    (session.folder / "upload").mkdir()
    (session.folder / "upload" / "rgb.png").write_bytes(b"...")
    assert session.folder.stat().st_mode & 0o077 == 0
    one.end(session)
    assert not session.folder.exists()
    with pytest.raises(InputError, match="has ended"):
        one.get(session.id)


def test_the_oldest_results_go_first():
    one = Sessions()
    session = one.open()
    names = [session.add(result()) for _ in range(sessions.MAX_RESULTS + 2)]
    assert list(session.results) == names[2:]
    one.end_all()


def test_all_sessions_together_fit_into_memory(monkeypatch: pytest.MonkeyPatch):
    both = Sessions()
    large, small = both.open(), both.open()
    kept = [large.add(result(4)) for _ in range(3)]
    other = small.add(result(1))
    monkeypatch.setattr(sessions, "MAX_RESULT_BYTES", 2 * large.result(kept[0]).num_bytes)
    both.keep_within_memory()
    assert list(large.results) == kept[2:]
    assert list(small.results) == [other]
    both.end_all()


def test_a_session_that_never_left_makes_room(monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(sessions, "MAX_SESSIONS", 1)
    one = Sessions()
    forgotten = one.open()
    with forgotten.answering(), pytest.raises(InputError, match="try again"):
        one.open()
    forgotten.used_s -= 2 * sessions.UNUSED_S
    assert one.open() is not forgotten
    assert not forgotten.folder.exists()
    one.end_all()


def test_of_the_client_with_the_most_an_unused_session_makes_room(monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(sessions, "MAX_SESSIONS", 4)
    one = Sessions()
    mine = one.open("honest")
    used, unused, last = (one.open("greedy") for _ in range(3))
    with used.answering():
        pass
    another = one.open("other")
    assert not unused.is_open
    assert all(session.is_open for session in (mine, used, last, another))
    one.end_all()


def test_a_result_is_a_record():
    assert replace(result(), meta={"text": "x"}).meta == {"text": "x"}
