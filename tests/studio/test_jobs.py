"""The queue keeps its order and drops what nobody waits for."""

import asyncio
import threading

import pytest

from mmweaver.studio import server
from mmweaver.studio.server import BusyError, Jobs


def test_first_come_first_served():
    async def ask() -> list[int]:
        queue, done = Jobs(1), []
        await asyncio.gather(*[queue.run(lambda number=number: done.append(number)) for number in range(20)])
        queue.stop()
        return done

    assert asyncio.run(ask()) == list(range(20))


def test_too_many_are_refused(monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(server, "MAX_WAITING", 2)

    async def ask() -> None:
        queue, hold = Jobs(1), threading.Event()
        waiting = [asyncio.create_task(queue.run(hold.wait)) for _ in range(2)]
        await asyncio.sleep(0)
        with pytest.raises(BusyError):
            await queue.run(lambda: None)
        hold.set()
        await asyncio.gather(*waiting)
        queue.stop()

    asyncio.run(ask())


def test_an_error_reaches_who_asked():
    async def ask() -> None:
        queue = Jobs(1)
        try:
            await queue.run(lambda: 1 / 0)
        finally:
            queue.stop()

    with pytest.raises(ZeroDivisionError):
        asyncio.run(ask())
