"""Many clients at once on a real server: each gets its own answer, memory is bounded, who leaves is not served."""

import asyncio
import socket
import threading
import time
from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest

pytest.importorskip("uvicorn", reason="the studio's extra is not installed")
pytest.importorskip("httpx", reason="httpx is not installed")

import httpx
import uvicorn

from mmweaver import Weaver
from mmweaver.studio import sessions
from mmweaver.studio.server import StudioServer
from mmweaver.studio.service import Service
from mmweaver.viz.body_in_photo import unpack
from mmweaver.viz.sequence import make_playback

TEXTS = ("a person walks to the left", "a person claps", "a person sits down", "a person waves")
ROOM_FOR = 12_000_000  # bytes of results: about four of them


@pytest.fixture(scope="module")
def served() -> Iterator[tuple[StudioServer, str]]:
    studio = StudioServer(Service(), workers=2)
    bound = socket.create_server(("127.0.0.1", 0))
    server = uvicorn.Server(uvicorn.Config(studio.app(), log_level="error", timeout_graceful_shutdown=2))
    thread = threading.Thread(target=server.run, kwargs={"sockets": [bound]})
    thread.start()
    while not server.started:
        time.sleep(0.02)
    yield studio, f"http://127.0.0.1:{bound.getsockname()[1]}"
    server.should_exit = True
    thread.join(20)


@pytest.mark.parametrize("count", [8, pytest.param(50, marks=pytest.mark.slow)])
def test_all_are_answered_right(served: tuple[StudioServer, str], count: int, monkeypatch: pytest.MonkeyPatch):
    """The same arrays as alone, whichever of the two workers made them while others asked."""
    monkeypatch.setattr(sessions, "MAX_RESULT_BYTES", ROOM_FOR)
    studio, address = served
    boards = ("typical:0", "ideal")
    asked = [(TEXTS[number % len(TEXTS)], number % 2, boards[number % 3 == 0]) for number in range(count)]

    async def client(text: str, seed: int, board: str) -> dict[str, Any]:
        async with httpx.AsyncClient(base_url=address, timeout=300) as page:
            own = {"x-session": (await page.post("/api/session")).json()["session"]}
            body = {"room": "demo", "text": [text], "seed": seed, "board": board}
            return unpack((await page.post("/api/generate", json=body, headers=own)).content)[1]

    async def all_at_once() -> list[dict[str, Any]]:
        return await asyncio.gather(*[client(*one) for one in asked])

    answers = asyncio.run(all_at_once())
    weaver = Weaver()
    room = weaver.sample_room()
    for text, seed, board in sorted(set(asked)):
        alone = weaver.generate(room, text, seed=seed, board=board)
        expected = make_playback(alone.cube, alone.points, alone.poses).arrays
        for one in (answer for answer, own in zip(answers, asked, strict=True) if own == (text, seed, board)):
            assert set(one) == set(expected)
            for name, values in expected.items():
                np.testing.assert_array_equal(one[name], values, err_msg=f"{text}, {seed}, {board}: {name}")
    kept = [
        result.num_bytes for session in studio.service.sessions._open.values() for result in session.results.values()
    ]
    assert 0 < sum(kept) <= ROOM_FOR
    assert studio.jobs.waiting == 0
    studio.service.sessions.end_all()


def test_who_leaves_is_not_served(served: tuple[StudioServer, str], monkeypatch: pytest.MonkeyPatch):
    """While both workers are busy a client asks and hangs up; another one who asks after it is answered."""
    studio, address = served
    made: list[int] = []
    generate = studio.service.generate
    monkeypatch.setattr(studio.service, "generate", lambda own, body: made.append(body["seed"]) or generate(own, body))
    hold = threading.Event()
    busy = [studio.jobs.submit(hold.wait) for _ in range(2)]
    try:
        with httpx.Client(base_url=address, timeout=60) as page:
            own = {"x-session": page.post("/api/session").json()["session"]}
            body = {"room": "demo", "text": [TEXTS[1]], "seed": 7}
            with pytest.raises(httpx.ReadTimeout):  # which closes the connection
                page.post("/api/generate", json=body, headers=own, timeout=0.5)
            while studio.jobs.waiting:
                time.sleep(0.05)
            later = threading.Timer(0.3, hold.set)
            later.start()
            assert page.post("/api/generate", json={**body, "seed": 8}, headers=own).status_code == 200
            later.join()
    finally:
        hold.set()
    for one in busy:
        one.result(10)
    assert made == [8]
