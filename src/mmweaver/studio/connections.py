"""Deadlines and quotas of connections: whoever holds them open, sends slowly or never reads makes room for others.

A connection has HEADERS_S for the headers of a request, READ_S to take a part of an answer, and, answered before its
body was read, LINGER_BYTES more of it. Beyond MAX_WAITING connections without a request, and beyond MAX_OPEN, those of
the address that holds the most are closed, the oldest first. Bodies have a deadline in `Deadlines`.
"""

import asyncio
import time
from collections import Counter
from typing import Any

from starlette.types import ASGIApp, Message, Receive, Scope, Send
from uvicorn.protocols.http.h11_impl import H11Protocol

HEADERS_S = 10.0
READ_S = 60.0
BODY_PAUSE_S = 15.0  # longest time without a byte of a body
BODY_S, BODY_BYTES_A_SECOND = 30.0, 100_000  # a body of n bytes has BODY_S + n / BODY_BYTES_A_SECOND
MAX_WAITING = 200  # connections whose first request has not come
MAX_OPEN = 800
GRACE_S = 2.0  # a younger connection is not closed for others: its request may be on the way
LINGER_BYTES, LINGER_S = 4_000_000, 5.0


class BoundedProtocol(H11Protocol):
    """HTTP of uvicorn with deadlines; `uvicorn.Config(http=BoundedProtocol)`."""

    def connection_made(self, transport: asyncio.Transport) -> None:  # type: ignore[override]
        """Begins the deadline of the headers, and closes another connection if there are too many."""
        super().connection_made(transport)
        self.opened_s, self.lingered = time.monotonic(), 0
        self.deadline = self.loop.call_later(HEADERS_S, self._end_without_request)
        self.reading: asyncio.TimerHandle | None = None
        before = self.opened_s - GRACE_S
        others = [one for one in self.connections if isinstance(one, BoundedProtocol) and one.opened_s < before]
        waiting = [one for one in others if one.is_waiting]
        if len(waiting) >= MAX_WAITING:
            _close_oldest(waiting)
        elif len(others) >= MAX_OPEN and any(one.is_idle for one in others):
            _close_oldest([one for one in others if one.is_idle])

    @property
    def is_waiting(self) -> bool:
        """Whether no request has come yet."""
        return self.cycle is None and not self.transport.is_closing()

    @property
    def is_idle(self) -> bool:
        """Whether no request is being answered."""
        return (self.cycle is None or self.cycle.response_complete) and not self.transport.is_closing()

    @property
    def address(self) -> str:
        """Address of the client."""
        return self.client[0] if self.client else ""

    def data_received(self, data: bytes) -> None:
        """Takes what the client sends; a body that comes after its answer is dropped, and the connection with it."""
        if self.cycle is not None and self.cycle.response_complete and self.cycle.more_body:
            self.lingered += len(data)
            if self.lingered > LINGER_BYTES:
                self.transport.abort()
                return
        super().data_received(data)
        if self.cycle is not None or self.transport.get_protocol() is not self:
            self.deadline.cancel()

    def on_response_complete(self) -> None:
        """Keeps the connection only if the body of the request was read."""
        super().on_response_complete()
        if self.cycle is not None and self.cycle.more_body:
            self.loop.call_later(LINGER_S, self._end_after, self.cycle)
        else:
            self.deadline.cancel()

    def pause_writing(self) -> None:
        """Begins the deadline of a client that does not read."""
        super().pause_writing()
        self.reading = self.loop.call_later(READ_S, self.transport.abort)

    def resume_writing(self) -> None:
        """Ends it."""
        super().resume_writing()
        if self.reading is not None:
            self.reading.cancel()

    def connection_lost(self, exc: Exception | None) -> None:
        """Ends all deadlines."""
        self.deadline.cancel()
        if self.reading is not None:
            self.reading.cancel()
        super().connection_lost(exc)

    def _end_without_request(self) -> None:
        if self.is_waiting:
            self.transport.abort()

    def _end_after(self, cycle: Any) -> None:
        if self.cycle is cycle and cycle.more_body:
            self.transport.abort()


def _close_oldest(connections: list[BoundedProtocol]) -> None:
    """Closes the oldest connection of the address that has the most."""
    counts = Counter(one.address for one in connections)
    most = counts.most_common(1)[0][0]
    min((one for one in connections if one.address == most), key=lambda one: one.opened_s).transport.abort()


class LateError(Exception):
    """The body of a request did not come in time."""


class Deadlines:
    """Middleware: the body of a request comes in time, or the request is given up."""

    def __init__(self, app: ASGIApp):
        self._app = app

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Answers a request whose body has a deadline."""
        if scope["type"] != "http":
            await self._app(scope, receive, send)
            return
        length = dict(scope["headers"]).get(b"content-length", b"0")
        size = int(length) if length.isdigit() else 0
        until = time.monotonic() + BODY_S + min(size, 10**12) / BODY_BYTES_A_SECOND
        more = True

        async def received() -> Message:
            nonlocal more
            if not more:  # only whether the client is still there
                return await receive()
            try:
                left_s = min(BODY_PAUSE_S, until - time.monotonic())
                message = await asyncio.wait_for(receive(), max(left_s, 0.01))
            except TimeoutError:
                raise LateError from None
            more = message["type"] == "http.request" and message.get("more_body", False)
            return message

        await self._app(scope, received, send)
