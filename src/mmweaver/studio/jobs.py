"""Queue of the studio: first come, first served, one worker per core; a job whose tab is closed is dropped."""

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
    """Threads that share rooms and weights; their computations release the GIL."""

    def __init__(self, workers: int | None = None):
        self.workers = workers or max(1, len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else 2)
        self._pool = ThreadPoolExecutor(self.workers, thread_name_prefix="studio")
        self.waiting = 0

    async def run(self, work: Callable[[], T], gone: Callable[[], Awaitable[bool]] | None = None) -> T:
        """Runs a job on the next free worker, in order of arrival.

        Args:
            work: The job.
            gone: Polled for whether the client has left; then a waiting job is dropped.

        Returns:
            The result of the job.

        Raises:
            BusyError: If too many jobs are waiting.
            asyncio.CancelledError: If the client has left.
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
        """Drops waiting jobs; a running job finishes on its own."""
        self._pool.shutdown(wait=False, cancel_futures=True)
