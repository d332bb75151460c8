"""The studio's queue: first come, first served, one worker per core; a job whose tab is closed is dropped."""

import asyncio
import os
from collections.abc import Awaitable, Callable
from concurrent.futures import Future, ThreadPoolExecutor
from typing import TypeVar

MAX_WAITING = 200

T = TypeVar("T")


class BusyError(Exception):
    """The queue is full."""


class Jobs:
    """Threads that share rooms and weights; the arithmetic in them releases Python's lock."""

    def __init__(self, workers: int | None = None):
        self.workers = workers or max(1, len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else 2)
        self._pool = ThreadPoolExecutor(self.workers, thread_name_prefix="studio")
        self.waiting = 0

    async def run(self, work: Callable[[], T], gone: Callable[[], Awaitable[bool]] | None = None) -> T:
        """The result of `work`, run by the next free worker in the order of asking.

        `gone` is asked now and then whether the client has left; then a waiting job is dropped and
        asyncio.CancelledError raised. Raises BusyError where too many wait.
        """
        if self.waiting >= MAX_WAITING:
            raise BusyError
        self.waiting += 1
        try:
            submitted = self.submit(work)
            job = asyncio.wrap_future(submitted)
            while True:
                done, _ = await asyncio.wait([job], timeout=0.25)
                if done:
                    return job.result()
                if gone is not None and await gone():
                    submitted.cancel()  # at once: a cancelled asyncio future would reach the pool a turn later
                    raise asyncio.CancelledError
        finally:
            self.waiting -= 1

    def submit(self, work: Callable[[], T]) -> "Future[T]":
        """Queues `work` for the next free worker."""
        return self._pool.submit(work)

    def stop(self) -> None:
        """Drops what waits; a job under way ends by itself."""
        self._pool.shutdown(wait=False, cancel_futures=True)
