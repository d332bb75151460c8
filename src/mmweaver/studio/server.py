"""The studio's server: the page, its API, and access control.

Runs the studio's server: binds, prints the address, opens the browser once it is ready.

Queue of the studio: first come, first served, one worker per core; a job whose tab is closed is dropped.
"""

import asyncio
import contextlib
import hmac
import os
import re
import secrets
import shutil
import socket
import tempfile
import webbrowser
from collections.abc import AsyncIterator, Awaitable, Callable
from concurrent.futures import Future, ThreadPoolExecutor
from pathlib import Path
from tempfile import mkdtemp
from typing import Any, TypeVar
from urllib.parse import urlsplit

import uvicorn
from starlette.applications import Starlette
from starlette.datastructures import UploadFile
from starlette.exceptions import HTTPException
from starlette.middleware import Middleware
from starlette.requests import ClientDisconnect, HTTPConnection, Request
from starlette.responses import JSONResponse, Response
from starlette.routing import Route, WebSocketRoute
from starlette.types import ASGIApp, Receive, Scope, Send
from starlette.websockets import WebSocket, WebSocketDisconnect

from mmweaver.core.errors import InputError
from mmweaver.core.safe_files.safe_text import parse_json
from mmweaver.studio import exports, sessions, uploads
from mmweaver.studio.connections import MAX_OPEN, BoundedProtocol, Deadlines, LateError
from mmweaver.studio.schemas import Form
from mmweaver.studio.service import Service
from mmweaver.studio.sessions import Session, remove_abandoned
from mmweaver.viz.html_page import page_file

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


Work = Callable[[Session, dict[str, Any]], Any]
LOOPBACK = {"127.0.0.1", "localhost", "::1"}
MAX_JSON_BYTES = 100_000
MAX_IN_FLIGHT = 2  # unacknowledged chunks of a live stream
BACKLOG = 2048  # connections that wait to be accepted
MAX_SENTENCES = 20  # that wait in a live stream
SOCKET_S = 5.0  # how often an open socket looks whether its session was ended
LIVE_S = 60.0  # longest time without an acknowledgement
_PLACES = re.compile(r"\S*\.mmweaver-[0-9a-f]{8}-\d+-\d+-\d+(/upload-[^/\s]*)?/?")  # folders of sessions in messages
SECURITY = {
    "content-security-policy": "default-src 'self'; style-src 'self' 'unsafe-inline'; img-src 'self' data: blob:;"
    " connect-src 'self' ws: wss:; frame-ancestors 'none'; base-uri 'none'; form-action 'none'",
    "x-content-type-options": "nosniff",
    "referrer-policy": "no-referrer",
    "cache-control": "no-store",
}
_INDEX = """<!doctype html>
<html lang="en"><head><meta charset="utf-8"><meta name="viewport" content="width=device-width, initial-scale=1">
<title>mmWeaver studio</title><link rel="icon" href="data:,">
<script type="module" src="page/mmweaver.js"></script></head><body data-page="studio"></body></html>
"""


class Door:
    """Admits only requests to the announced host, from its own pages, and with the token where there is one.

    The host name is checked because a foreign page could resolve its own name to this machine (DNS rebinding).
    """

    def __init__(self, app: ASGIApp, hosts: set[str], token: str | None):
        self._app, self._hosts, self._token = app, hosts, token

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        if scope["type"] in ("http", "websocket"):
            refusal = self._refusal(HTTPConnection(scope))
            if refusal is not None:
                if scope["type"] == "websocket":
                    await WebSocket(scope, receive, send).close(code=1008)
                else:
                    await JSONResponse({"error": refusal}, status_code=403)(scope, receive, send)
                return
        await self._app(scope, receive, send)

    def _refusal(self, asked: HTTPConnection) -> str | None:
        name = urlsplit(f"//{asked.headers.get('host', '')}").hostname
        if name not in self._hosts:
            return "this host name is not served; use the address that mmweaver studio printed"
        origin = asked.headers.get("origin")
        if origin is not None and urlsplit(origin).netloc != asked.headers.get("host"):
            return "requests from other pages are not answered"
        given = asked.headers.get("x-token") or asked.query_params.get("token") or ""
        needs_token = self._token is not None and asked.url.path.startswith("/api/")
        if needs_token and not hmac.compare_digest(given.encode(), str(self._token).encode()):
            return "the token is missing or wrong; use the address that mmweaver studio printed"
        return None


class StudioServer:
    """The API of the page. Everything that takes time goes through one queue."""

    def __init__(self, service: Service, *, workers: int | None = None):
        self.service = service
        self.jobs = Jobs(workers)

    def app(self, *, hosts: set[str] | None = None, token: str | None = None) -> Starlette:
        """The ASGI application.

        Args:
            hosts: Host names under which it may be requested; by default those of the loopback.
            token: Required token, None for none.
        """
        routes = [
            Route("/", self._index),
            Route("/page/mmweaver.js", self._script),
            Route("/api/session", self._open, methods=["POST"]),
            Route("/api/upload", self._upload, methods=["POST"]),
            Route("/api/export/{name}/{kind}", self._export),
            WebSocketRoute("/api/presence", self._presence),
            WebSocketRoute("/api/live", self._live),
            *(Route(f"/api/{path}", self._call(work), methods=[how]) for path, (how, work) in self._calls().items()),
        ]

        @contextlib.asynccontextmanager
        async def lifespan(_: Starlette) -> AsyncIterator[None]:
            remove_abandoned()
            await self.jobs.run(self.service.warm_up)
            yield
            self.jobs.stop()
            self.service.sessions.end_all()

        return Starlette(
            routes=routes,
            lifespan=lifespan,
            exception_handlers={InputError: _refused, BusyError: _busy, ClientDisconnect: _gone, LateError: _late},
            middleware=[Middleware(Deadlines), Middleware(Door, hosts=hosts or LOOPBACK, token=token)],
        )

    # the page --------------------------------------------------------------------------------------------------------
    async def _index(self, _: Request) -> Response:
        return Response(_INDEX, media_type="text/html", headers=SECURITY)

    async def _script(self, _: Request) -> Response:
        return Response(page_file("mmweaver.js"), media_type="text/javascript", headers=SECURITY)

    # its calls -------------------------------------------------------------------------------------------------------
    async def _open(self, request: Request) -> Response:
        session = self.service.sessions.open(request.client.host if request.client else "")
        offered = self.service.offer()
        kinds = [(kind, label) for kind, (label, _) in exports.EXPORTS.items()]
        return JSONResponse({"session": session.id, "exports": kinds, "live": True, "paths": True, **offered})

    def _calls(self) -> dict[str, tuple[str, Work]]:
        """API by path: functions from a session and the request's JSON to bytes for the page, or JSON."""
        service = self.service
        return {
            "room/{name}": (
                "GET",
                lambda own, got: service.room_bytes(
                    own, got["name"], got.get("radar", "awr1843"), got.get("range", "")
                ),
            ),
            "rays/{name}": ("GET", lambda own, got: service.rays(own, got["name"], got.get("frame", "0"))),
            "generate": ("POST", lambda own, got: service.generate(own, got["body"])),
            "depth/{name}": ("POST", lambda own, got: uploads.room_with_estimated_depth(own, got["name"])),
            "recording/{name}": ("POST", lambda own, got: service.recording(own, got["name"])),
            "result/{name}": ("GET", lambda own, got: service.result_bytes(own, got["name"])),
            "keep/{name}": ("POST", lambda own, got: own.keep(got["name"])),
            "compare/{a}/{b}": ("GET", lambda own, got: service.compare(own, got["a"], got["b"])),
        }

    def _call(self, work: Work) -> Callable[[Request], Awaitable[Response]]:
        async def answer(request: Request) -> Response:
            session = self._session(request)
            with session.answering():
                got = {**request.query_params, **request.path_params, "body": await _json(request)}
                found = await self._do(request, lambda: work(session, got))
            return _packed(found) if isinstance(found, bytes) else JSONResponse(found)

        return answer

    async def _export(self, request: Request) -> Response:
        session = self._session(request)
        result = session.result(request.path_params["name"])
        with session.answering():
            name, content = await self._do(request, lambda: exports.export(result, request.path_params["kind"]))
        headers = {**SECURITY, "content-disposition": f'attachment; filename="{name}"'}
        return Response(content, media_type="application/octet-stream", headers=headers)

    async def _upload(self, request: Request) -> Response:
        session = self._session(request)
        length = request.headers.get("content-length", "")
        if not length.isdecimal() or int(length) > uploads.MAX_BYTES:
            raise InputError(f"an upload has at most {uploads.MAX_BYTES // 1_000_000} MB")
        with session.answering(), self.service.sessions.uploading(int(length)):
            folder = Path(mkdtemp(prefix="upload-", dir=session.folder))
            try:
                found = await self._taken(request, session, folder)
                self.service.sessions.keep_within_memory()
                return JSONResponse(found)
            finally:  # what was read is in memory
                if not session.needs(folder):
                    shutil.rmtree(folder, ignore_errors=True)

    async def _taken(self, request: Request, session: Session, folder: Path) -> dict[str, Any]:
        """Receives the files of an upload and reads them."""
        async with request.form(max_files=uploads.MAX_FILES, max_fields=4) as form:
            radar = form.get("radar")
            files = [sent for sent in form.getlist("files") if isinstance(sent, UploadFile)]
            names = uploads.file_names(form.get("paths"), [one.filename for one in files])
            for sent, said in zip(files, names, strict=True):
                with uploads.place_of(folder, said).open("wb") as file:
                    while part := await sent.read(1 << 20):
                        file.write(part)
        chosen = self.service.radar_of(session, radar if isinstance(radar, str) else "awr1843")
        return await self._do(request, lambda: uploads.take(session, folder, chosen))

    async def _presence(self, socket: WebSocket) -> None:
        """Open for as long as the tab; closing it ends the session."""
        session = await self._accepted(socket)
        if session is None:
            return
        try:
            while session.is_open:
                await _said(socket, session)
            await socket.close(code=1008)
        except WebSocketDisconnect:
            pass
        finally:
            session.sockets -= 1
            self.service.end(session)

    async def _live(self, socket: WebSocket) -> None:
        """Receives sentences and sends chunks; at most MAX_IN_FLIGHT chunks are unacknowledged."""
        session = await self._accepted(socket)
        if session is None:
            return
        try:
            await self._stream(socket, session)
        except (InputError, BusyError) as error:
            code = getattr(error, "code", "busy")
            with contextlib.suppress(WebSocketDisconnect, RuntimeError):  # it may have been closed
                words = _public(error) or "too many are waiting; try again in a minute"
                await socket.send_json({"error": words, "code": code})
                await socket.close()
        except WebSocketDisconnect:
            pass
        finally:
            session.sockets -= 1

    async def _stream(self, socket: WebSocket, session: Session) -> None:
        request = parse_json(await _said(socket, session, LIVE_S), "the request")
        live = await self.jobs.run(lambda: self.service.live(session, request))
        in_flight = waiting = 0
        while session.is_open:
            if in_flight >= MAX_IN_FLIGHT:
                said = parse_json(await _said(socket, session, LIVE_S), "the request")
                if isinstance(said, dict) and "ack" in said:
                    in_flight, waiting = in_flight - 1, 0
                elif waiting < MAX_SENTENCES:
                    live.say(Form.of(said).sentences[0])
                    waiting += 1
                else:
                    raise InputError(f"more than {MAX_SENTENCES} sentences wait; send the next ones later")
                continue
            await socket.send_bytes(await self.jobs.run(live.next_chunk))
            in_flight += 1

    async def _accepted(self, socket: WebSocket) -> Session | None:
        """The session that the socket names; without one, the socket is closed."""
        try:
            session = self.service.sessions.get(socket.query_params.get("session", ""))
        except InputError:
            await socket.close(code=1008)
            return None
        if session.sockets >= sessions.MAX_SOCKETS:
            await socket.close(code=1008)
            return None
        session.sockets += 1
        try:
            await socket.accept()
        except BaseException:
            session.sockets -= 1
            raise
        return session

    # what they share -------------------------------------------------------------------------------------------------
    def _session(self, request: Request) -> Session:
        return self.service.sessions.get(request.headers.get("x-session", ""))

    async def _do(self, request: Request, work: Callable[[], T]) -> T:
        """Queues `work`, and drops it if the client leaves first."""

        async def gone() -> bool:
            return await request.is_disconnected()

        try:
            return await self.jobs.run(work, gone)
        except asyncio.CancelledError:
            raise HTTPException(499, "the client left") from None


async def _said(socket: WebSocket, session: Session, limit_s: float = float("inf")) -> str:
    """The next text of a socket; a WebSocketDisconnect for anything else, and at the end of its session."""
    waited_s = 0.0
    while True:
        receiving = asyncio.ensure_future(socket.receive())
        while not (await asyncio.wait([receiving], timeout=SOCKET_S))[0]:
            waited_s += SOCKET_S
            if not session.is_open or waited_s >= limit_s:
                receiving.cancel()
                await socket.close(code=1008)
                raise WebSocketDisconnect(1008)
        message = receiving.result()
        text = message.get("text")
        if isinstance(text, str):
            return text
        if message["type"] == "websocket.receive":
            await socket.close(code=1003)
        raise WebSocketDisconnect(message.get("code", 1003))


def _public(error: Exception) -> str:
    """A message in one line, without folders of the server."""
    return _PLACES.sub("", " ".join(str(error).split())).replace(tempfile.gettempdir(), "")


async def _json(request: Request) -> Any:
    body = bytearray()
    async for part in request.stream():  # bounded memory
        body += part
        if len(body) > MAX_JSON_BYTES:
            raise InputError("this request is too long")
    return parse_json(bytes(body), "the request") if body else None


def _packed(content: bytes) -> Response:
    return Response(content, media_type="application/octet-stream", headers=SECURITY)


async def _refused(_: Request, error: Exception) -> Response:
    recovery_options: list[Any] = getattr(error, "recovery_options", [])
    code = getattr(error, "code", InputError.code)
    words = {"error": " ".join(_public(error).split()), "code": code, "ways_on": recovery_options}
    return JSONResponse(words, status_code=422)


async def _gone(_: Request, __: Exception) -> Response:
    return Response(status_code=499)  # nobody reads it


async def _late(_: Request, __: Exception) -> Response:
    return JSONResponse({"error": "the request did not come in time"}, status_code=408, headers={"connection": "close"})


async def _busy(_: Request, __: Exception) -> Response:
    return JSONResponse({"error": "too many are waiting; try again in a minute", "code": "busy"}, status_code=503)


class _Announcing(uvicorn.Server):
    """Announces when it is ready to answer."""

    def __init__(self, config: uvicorn.Config, address: str, announce: Callable[[str], None], open_browser: bool):
        super().__init__(config)
        self._address, self._announce, self._open = address, announce, open_browser

    async def startup(self, sockets: list[socket.socket] | None = None) -> None:
        await super().startup(sockets)
        self._announce(f"mmweaver studio is ready: {self._address}   (Ctrl+C ends it)")
        if self._open:
            webbrowser.open(self._address)


def serve(
    rooms: list[Path],
    recordings: list[Path],
    recognisers: list[Path],
    *,
    host: str,
    port: int,
    workers: int | None,
    announce: Callable[[str], None],
    open_browser: bool,
) -> None:
    """Serves until interrupted.

    Args:
        rooms: Folders of rooms to offer.
        recordings: Recordings to offer.
        recognisers: Folders of recognisers to offer.
        host: Address to bind; other than the loopback requires a token.
        port: Port to bind; 0 for any free one.
        workers: Number of worker threads; by default one per core.
        announce: Called with each line for the user.
        open_browser: Whether the page is opened.

    Raises:
        InputError: If the address is not available, or a room, recording or recogniser is not valid.
    """
    bound = _bind(host, port)
    port = bound.getsockname()[1]
    token = None if host in LOOPBACK else secrets.token_urlsafe(24)
    names = LOOPBACK if token is None else LOOPBACK | {host, socket.gethostname(), *_own_addresses()}
    shown = "localhost" if host in ("0.0.0.0", "::") else host
    address = f"http://{shown}:{port}/" + ("" if token is None else f"?token={token}")
    try:
        studio = StudioServer(Service(rooms, recordings, recognisers), workers=workers)
        config = config_of(studio.app(hosts=set(names), token=token))
        announce("mmweaver studio is warming up ...")
        _Announcing(config, address, announce, open_browser).run(sockets=[bound])
    finally:
        bound.close()


def config_of(app: Any) -> uvicorn.Config:
    """How the studio is served."""
    return uvicorn.Config(
        app,
        http=BoundedProtocol,
        log_level="warning",
        ws_max_size=1 << 20,
        ws_max_queue=4,
        timeout_graceful_shutdown=2,
        limit_concurrency=2 * MAX_OPEN,
        backlog=BACKLOG,
    )


def _bind(host: str, port: int) -> socket.socket:
    family = socket.AF_INET6 if ":" in host else socket.AF_INET
    bound = socket.socket(family)
    bound.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
    try:
        bound.bind((host, port))
    except (OSError, OverflowError) as error:
        bound.close()
        reason = getattr(error, "strerror", None) or error
        raise InputError(f"cannot listen on {host} port {port}: {reason}; choose another --port or --host") from None
    return bound


def _own_addresses() -> set[str]:
    """Addresses of this machine's host name, where they can be resolved."""
    try:
        return {str(entry[4][0]) for entry in socket.getaddrinfo(socket.gethostname(), None)}
    except OSError:
        return set()
